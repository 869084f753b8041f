#!/usr/bin/python3
"""How far sampled runs are off, how often their intervals hold the truth, and what they cost the host.

    analysis/estimates/coverage.py FOLDER [--machine configs/machines/study.toml] [--scenes configs/scenes/courtyard.toml,...]
                                   [--fraction 0.06] [--seeds 50] [--jobs 1] [--program razor-sim]
                                   [-- more options of razor-sim run]

Each scene is run once in detail and once for each seed of `--estimate sample:FRACTION`. A row a scene: the mean and the largest
error of cycles and of bytes from and to DRAM, in how many runs the interval of each holds what the detailed run says, and the
processor time of a sampled run beside the detailed one (medians), which runs side by side (--jobs) lengthen. FOLDER keeps each run's report under its command: the same one
goes on where it was stopped. Exit code: 0; 1 where a run fails; 2 on a mistake; 130 after Ctrl-C.
"""
import concurrent.futures
import hashlib
import json
import os
import statistics
import subprocess
import sys

import simulator

FIGURES = ("cycles", "dram_bytes")


def options():
    parser = simulator.parser_of(__doc__)
    parser.add_argument("--machine", default="configs/machines/study.toml")
    parser.add_argument("--scenes", default=",".join(f"configs/scenes/{s}.toml" for s in
                                                     ("courtyard", "interior", "forest", "showcase")))
    parser.add_argument("--fraction", type=float, default=0.06)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--jobs", type=int, default=1)
    found, more = simulator.parsed(parser)
    if not 0.001 <= found.fraction < 1 or found.seeds < 1 or found.jobs < 1:
        parser.error("--fraction is from 0.001 to below 1, --seeds and --jobs are at least 1")
    return found, more


class RunFailed(Exception):
    """What a run said, and the exit code that follows."""


def report(name, given, scene, estimate):
    """The report of one run, from the folder if it is there."""
    found, more = given
    command = [found.program, "run", "--quiet", "--no-native", "--no-calibration", "--machine", found.machine, "--scene", scene,
               *estimate, *more]
    inputs = simulator.digest_of_inputs(found.program, found.machine, scene)
    key = hashlib.sha256("\0".join([inputs, *command[1:]]).encode()).hexdigest()[:12]
    file = os.path.join(found.folder, f"{name}-{key}.json")
    if not os.path.exists(file):
        run = subprocess.run([*command, "--json", file, "--report", file[:-5] + ".txt"], stderr=subprocess.PIPE, text=True,
                             check=False)
        if run.returncode != 0:
            raise RunFailed(f"{name}: {run.stderr.strip()}", 130 if run.returncode == 130 else 1)
    with open(file, encoding="utf-8") as opened:
        return json.load(opened)


def truth(full):
    line = max((level["line_bytes"] for name, level in full["machine"].items() if name[0] == "l" and name[1:].isdigit()
                and level.get("size_bytes", 0) > 0), default=64)
    return {"cycles": full["cycles"], "dram_bytes": line * (full["memory"]["reads"] + full["memory"]["writes"])}


def main():
    given = found, _ = options()
    os.makedirs(found.folder, exist_ok=True)
    print(f"{'scene':16} {'runs':>4}" + "".join(f" {name + ', %':>16} {'held':>8}" for name in FIGURES) + f" {'time':>6}")
    scenes = {os.path.splitext(os.path.basename(scene))[0]: scene for scene in found.scenes.split(",")}
    if len(scenes) != len(found.scenes.split(",")):
        sys.exit("coverage.py: two scenes are of one name; give them one after the other")
    with concurrent.futures.ThreadPoolExecutor(found.jobs) as pool:
        runs = {}
        for name, scene in scenes.items():
            runs[name] = [pool.submit(report, name, given, scene, [])]
            runs[name] += [pool.submit(report, f"{name}-{found.fraction:g}-{seed}", given, scene,
                                       ["--estimate", f"sample:{found.fraction:g}", "--estimate-seed", str(seed)])
                           for seed in range(1, found.seeds + 1)]
        try:
            for name in scenes:
                print(row(name, *(run.result() for run in runs[name])), flush=True)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def row(name, full, *samples):
    right, errors, held, times = truth(full), {f: [] for f in FIGURES}, {f: 0 for f in FIGURES}, []
    for one in samples:
        for figure in FIGURES:
            value = one["estimate"]["figures"][figure]
            errors[figure].append(100 * (value["value"] / right[figure] - 1))
            held[figure] += value["low"] <= right[figure] <= value["high"]
        times.append(one["host"]["processor_seconds"] / full["host"]["processor_seconds"])
    text = f"{name:16} {len(samples):4}"
    for figure in FIGURES:
        worst = max(errors[figure], key=abs)
        text += f" {statistics.mean(errors[figure]):+7.2f} {worst:+8.2f} {held[figure]:4}/{len(samples):<3}"
    return text + f" {statistics.median(times):6.3f}"


if __name__ == "__main__":
    try:
        main()
    except RunFailed as failed:
        print(failed.args[0], file=sys.stderr)
        sys.exit(failed.args[1])
    except KeyboardInterrupt:
        sys.exit(130)
