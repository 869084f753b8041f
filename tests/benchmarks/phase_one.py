#!/usr/bin/python3
"""phase_one.py [OPTIONS] [SCENE.toml ...] [-- OPTION ...]: what shading at vertices of grids takes, over that at hits.

    tests/benchmarks/phase_one.py
    tests/benchmarks/phase_one.py configs/scenes/forest-textured.toml -- --size 256x256 --spp 4

Each scene (the four benchmark scenes with patterns, where none is given) with textures evaluated at vertices of grids, as far as
surfaces have any; with flat faces cut into grids for it; and at hits only. A table: evaluations at hits; what part of that the
other two ways take, how many lanes of those at vertices are at work, and their native processor time over that at hits (the
least of --runs); how far the albedo of the second and the last way is apart (root mean square). What follows -- goes to each run, in
place of --size 512x512 --spp 16.
"""
import argparse
import json
import os
import sys
import tempfile

PROJECT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(PROJECT, "analysis/sweep"))
import simulation  # noqa: E402
from leaving_out import call  # noqa: E402
from simulation import Mistake  # noqa: E402

SCENES = "courtyard", "interior", "forest", "showcase"
FRAME = ["--size", "512x512", "--spp", "16"]


def read_options():
    arguments, more = simulation.split_arguments(sys.argv[1:])
    p = argparse.ArgumentParser(prog="phase_one.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see phase_one.py --help"))
    p.add_argument("scenes", nargs="*", metavar="SCENE.toml")
    p.add_argument("--runs", type=int, default=1, metavar="N", help="of each frame")
    p.add_argument("--renderer", metavar="PATH", default=os.path.join(PROJECT, "build/release/razor/program/razor"),
                   help="razor; else that of build/release")
    options = p.parse_args(arguments)
    if options.runs < 1:
        raise Mistake(f"--runs {options.runs}: give a number from 1")
    if not os.access(options.renderer, os.X_OK):
        raise Mistake(f"{options.renderer}: no program; build razor, or give --renderer PATH")
    options.scenes = options.scenes or [os.path.join(PROJECT, f"configs/scenes/{name}-textured.toml") for name in SCENES]
    options.more = more or FRAME
    return options


def rendered(options, scene, where, picture, folder):
    """Counters, processor seconds and pixels."""
    stats = os.path.join(folder, "stats.json")
    call([options.renderer, "render", scene, *options.more, "--shading", where, "--repeat", str(options.runs), "--quiet", "-o",
          picture, "--stats", stats])
    with open(stats, encoding="utf-8") as file:
        s = json.load(file)["statistics"]
    return s["counters"], min(frame["render_processor_seconds"] for frame in s["host"]["frames"])


def row_of(options, scene, folder):
    pictures = {where: os.path.join(folder, f"{where}.exr") for where in ("diced", "grids", "hits")}
    counters, seconds = {}, {}
    for where, picture in pictures.items():
        counters[where], seconds[where] = rendered(options, scene, where, picture, folder)
    report = os.path.join(folder, "compare.json")
    call([options.renderer, "compare", pictures["diced"], pictures["hits"], "--json", report])
    with open(report, encoding="utf-8") as file:
        channels = json.load(file)["channels"]
    apart = [c["rmse"] for c in channels if c["name"].startswith("albedo.")]
    one_by_one = counters["hits"]["shading_evaluations"]
    row = {"scene": os.path.basename(scene).removesuffix(".toml"), "hits": one_by_one}
    for where in ("grids", "diced"):
        c = counters[where]
        row[where] = {"ratio": c["shading_evaluations"] / max(one_by_one, 1), "lanes": c["grid_evaluations"] / max(c["grid_lanes"], 1),
                      "time": seconds[where] / seconds["hits"]}
    row["apart"] = (sum(x * x for x in apart) / len(apart)) ** 0.5
    return row


def main():
    options = read_options()
    print(f"{'':20}{'evaluated':>12}    at vertices, if there are some  flat faces cut for it\n{'scene':20}{'at hits':>12}"
          f"{'  evaluated   lanes    time' * 2}  albedo apart")
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            r = row_of(options, scene, folder)
            figures = "".join(f"{r[w]['ratio']:11.3f}{r[w]['lanes']:8.3f}{r[w]['time']:8.3f}" for w in ("grids", "diced"))
            print(f"{r['scene']:20}{r['hits']:12}{figures}{r['apart']:14.5f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(main))
