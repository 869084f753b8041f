"""One frame, natively and simulated: what both programs of this folder run."""
import json
import os
import shutil
import statistics
import subprocess
import sys
import tomllib

HERE = os.path.dirname(os.path.abspath(__file__))
PROJECT = os.path.normpath(os.path.join(HERE, "../.."))
sys.path.insert(0, os.path.join(HERE, "../sweep"))
import simulation  # noqa: E402
from simulation import Mistake  # noqa: E402


def renderer(given):
    if given:
        if not os.access(given, os.X_OK) or os.path.isdir(given):
            raise Mistake(f"--razor {given}: no program; build razor and give its path")
        return given
    here = os.path.join(PROJECT, "build/release/razor/program/razor")
    found = shutil.which("razor") or here
    if not os.access(found, os.X_OK):
        raise Mistake("razor is neither on the PATH nor in build/release; build it, or give --razor PATH")
    return found


def output_of(command, what):
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as failure:
        raise Mistake(f"{what}: {command[0]} cannot be run: {failure.strerror}") from failure
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"{os.path.basename(command[0])} ended with {done.returncode}"]
        raise Mistake(f"{what}: {lines[-1]}")
    return done.stdout


def configuration(simulator, machine):
    """A machine with everything that it inherits, as tables of its file."""
    return tomllib.loads(output_of([simulator, "print-config", "--machine", machine], machine))


def target_of(simulator, machine):
    """The instruction set that a machine was calibrated with; the host's best one where it was with none."""
    path = configuration(simulator, machine).get("calibration")
    if path is None:
        return "auto"
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)["target"]
    except (OSError, ValueError, KeyError) as failure:
        raise Mistake(f"{machine}: calibration {path}: names no target") from failure


def native(razor, scene, options, workers, isa, frames, folder):
    """Statistics of one run, with "frame_seconds" of `frames` frames after a first one, which analyses the topology:
    processor time where one worker is alone, else until the last worker is done."""
    stats = os.path.join(folder, "stats.json")
    output_of([razor, "render", *([scene] if scene else []), *options, "--threads", str(workers), "--isa", isa, "--repeat",
               str(frames + 1), "--quiet", "--stats", stats, "-o", os.path.join(folder, "native.exr")], "native")
    with open(stats, encoding="utf-8") as file:
        out = json.load(file)
    kind = "render_processor_seconds" if workers == 1 else "render_seconds"
    out["frame_seconds"] = [f[kind] for f in out["statistics"]["host"]["frames"][1:]]
    return out


def simulated(simulator, machine, scene, options, workers, settings, folder, *more):
    """The report of one run; the scene as an option."""
    words = [*(["--scene", scene] if scene else []), *options, "--workers", str(workers), "--no-calibration", "--report",
             os.path.join(folder, "report.txt"), *more]
    return simulation.run(simulator, machine, settings, words, folder)


def check_same_frame(name, host, report):
    """Both rendered the same picture of the same scene, or what is compared means nothing."""
    if host["scene"] != report["scene"]:
        raise Mistake(f"{name}: the native frame and the simulated one are not of the same scene")
    seen = report["host"]["native"]
    if not seen["picture_equal"] and seen["isa"] != "sse4":  # which rounds twice where others fuse
        raise Mistake(f"{name}: the simulated picture differs from that of {seen['isa']}")
    for count in ("rays", "camera_hits"):
        ours, theirs = host["statistics"]["counters"][count], report["renderer"]["counters"][count]
        if ours != theirs and seen["picture_equal"]:
            raise Mistake(f"{name}: {ours} {count} natively, {theirs} simulated")


def spread(values):
    return {"median": statistics.median(values), "least": min(values), "largest": max(values)}


class Progress:
    """What is being done, on a terminal only."""

    def __init__(self):
        self.shown = sys.stderr.isatty()

    def say(self, text):
        if self.shown:
            print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def write_json(path, value):
    """A file is whole or is not there."""
    temporary = path + ".tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            json.dump(value, file, indent=1)
            file.write("\n")
        os.replace(temporary, path)
    except OSError as failure:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise Mistake(f"--json {path}: {failure.strerror}") from failure
