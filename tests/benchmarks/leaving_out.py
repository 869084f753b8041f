#!/usr/bin/python3
"""leaving_out.py [OPTIONS] [SCENE.toml ...] [-- OPTION ...]: what a frame saves by leaving out what its scene does not need.

    tests/benchmarks/leaving_out.py
    tests/benchmarks/leaving_out.py --machine configs/machines/zen4-2c.toml configs/scenes/forest.toml -- --size 64x64

Each scene (the four benchmark scenes and the one of materials, where none is given) with the kernels that it needs, and with those
that can do everything: the pictures must be the same, to the last bit. A table of what everything costs more: native processor
time (the least of --runs), bytes built, and in the simulator instructions and lines from and to DRAM. What follows -- goes to
each run, in place of --size 64x64 --spp 4. Exit code 1 if a picture differs.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

PROJECT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(PROJECT, "analysis/sweep"))
import simulation  # noqa: E402
from simulation import Mistake  # noqa: E402

SCENES = "courtyard", "interior", "forest", "showcase", "materials"
FRAME = ["--size", "64x64", "--spp", "4"]


def read_options():
    arguments, more = simulation.split_arguments(sys.argv[1:])
    p = argparse.ArgumentParser(prog="leaving_out.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see leaving_out.py --help"))
    p.add_argument("scenes", nargs="*", metavar="SCENE.toml")
    p.add_argument("--machine", default=os.path.join(PROJECT, "configs/machines/tiny.toml"), metavar="FILE",
                   help="on which the simulator counts; without it, tiny.toml")
    p.add_argument("--runs", type=int, default=3, metavar="N", help="of each native frame")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs")
    p.add_argument("--renderer", metavar="PATH", help="razor; else that beside razor-sim")
    p.add_argument("--simulator", metavar="PATH", help="razor-sim; else from the PATH or build/release")
    options = p.parse_args(arguments)
    if options.runs < 1:
        raise Mistake(f"--runs {options.runs}: give a number from 1")
    simulation.check_writable("--csv", options.csv)
    options.simulator = simulation.simulator(options.simulator)
    beside = os.path.join(os.path.dirname(options.simulator), "../../razor/program/razor")
    options.renderer = options.renderer or os.path.normpath(beside)
    if not os.access(options.renderer, os.X_OK):
        raise Mistake(f"{options.renderer}: no program; build razor, or give --renderer PATH")
    options.scenes = options.scenes or [os.path.join(PROJECT, f"configs/scenes/{name}.toml") for name in SCENES]
    options.more = more or FRAME
    return options


def call(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1):
        raise Mistake((done.stderr.strip().splitlines() or [f"{command[0]} ended with {done.returncode}"])[-1])
    return done


def native(options, scene, flags, picture, folder):
    """Processor seconds, bytes built and the plan."""
    stats = os.path.join(folder, "stats.json")
    call([options.renderer, "render", scene, *options.more, *flags, "--threads", "1", "--repeat", str(options.runs), "--quiet",
          "-o", picture, "--stats", stats])
    with open(stats, encoding="utf-8") as file:
        s = json.load(file)["statistics"]
    seconds = min(frame["render_processor_seconds"] for frame in s["host"]["frames"])
    return seconds, sum(s["built"][key] for key in ("grid_bytes", "node_bytes", "list_bytes")), s["plan"]


def row_of(options, scene, folder):
    row = {"scene": os.path.basename(scene).removesuffix(".toml")}
    pictures = [os.path.join(folder, name) for name in ("own.exr", "all.exr")]
    figures = []
    for flags, picture in zip(([], ["--everything"]), pictures):
        report = simulation.run(options.simulator, options.machine, [],
                                ["--no-native", "--no-calibration", "--scene", scene, *options.more, *flags], folder)
        figures.append((*native(options, scene, flags, picture, folder), report["core"]["instructions"],
                        report["memory"]["reads"] + report["memory"]["writes"]))
    row["same"] = call([options.renderer, "compare", "--identical", *pictures]).returncode == 0
    row["plan"] = figures[0][2]
    for k, key in ((0, "native_seconds"), (1, "built_bytes"), (3, "instructions"), (4, "dram_lines")):
        row[key], row[f"{key}_everything"] = figures[0][k], figures[1][k]
    return row


def main():
    options = read_options()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for done, scene in enumerate(options.scenes):
            if sys.stderr.isatty():
                print(f"\r{done} of {len(options.scenes)} scenes", end="", file=sys.stderr, flush=True)
            rows.append(row_of(options, scene, folder))
    if sys.stderr.isatty():
        print("\r" + " " * 30 + "\r", end="", file=sys.stderr, flush=True)
    print(f"everything, over what the scene needs:\n{'scene':<12} {'picture':<9} {'native time':>11} {'built':>7} {'instructions':>12}"
          f" {'DRAM lines':>10}  plan")
    for row in rows:
        ratio = {key: row[f"{key}_everything"] / row[key] for key in ("native_seconds", "built_bytes", "instructions", "dram_lines")}
        print(f"{row['scene']:<12} {'same bits' if row['same'] else 'DIFFERS':<9} {ratio['native_seconds']:>11.3f}"
              f" {ratio['built_bytes']:>7.3f} {ratio['instructions']:>12.4f} {ratio['dram_lines']:>10.4f}  {row['plan']}")
    if options.csv:
        simulation.write_csv(options.csv, rows)
    return 0 if all(row["same"] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(simulation.main(main))
