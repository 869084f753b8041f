#!/usr/bin/python3
"""phase_one.py [OPTIONS] [SCENE.toml ...] [-- OPTION ...]: what shading at vertices of grids takes, and what at hits.

    tests/benchmarks/phase_one.py
    tests/benchmarks/phase_one.py configs/scenes/forest-textured.toml -- --size 256x256 --spp 4

Each scene (the four benchmark scenes with patterns, where none is given) with textures evaluated at vertices of grids, as far as
surfaces have any, and at hits only. A table: evaluations a pixel either way and their ratio; how many lanes of those at
vertices are at work; native processor time either way (the least of --runs); how far the pictures' albedo is apart (root mean
square). What follows -- goes to each run, in place of --size 512x512 --spp 16.
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
    pictures = {where: os.path.join(folder, f"{where}.exr") for where in ("grids", "hits")}
    counters, seconds = {}, {}
    for where, picture in pictures.items():
        counters[where], seconds[where] = rendered(options, scene, where, picture, folder)
    report = os.path.join(folder, "compare.json")
    call([options.renderer, "compare", pictures["grids"], pictures["hits"], "--json", report])
    with open(report, encoding="utf-8") as file:
        channels = json.load(file)["channels"]
    apart = [c["rmse"] for c in channels if c["name"].startswith("albedo.")]
    grids = counters["grids"]
    return {"scene": os.path.basename(scene).removesuffix(".toml"), "hits": grids["textured_hits"],
            "evaluations": grids["shading_evaluations"],
            "ratio": grids["shading_evaluations"] / max(grids["textured_hits"], 1),
            "lanes": grids["grid_evaluations"] / max(grids["grid_lanes"], 1), "time": seconds["grids"] / seconds["hits"],
            "apart": (sum(x * x for x in apart) / len(apart)) ** 0.5}


def main():
    options = read_options()
    print(f"{'scene':22}{'textured hits':>14}{'evaluations':>13}{'ratio':>8}{'lanes':>8}{'time':>8}{'albedo apart':>14}")
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            r = row_of(options, scene, folder)
            print(f"{r['scene']:22}{r['hits']:14}{r['evaluations']:13}{r['ratio']:8.3f}{r['lanes']:8.3f}{r['time']:8.3f}"
                  f"{r['apart']:14.5f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(main))
