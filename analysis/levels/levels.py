#!/usr/bin/python3
"""Levels of detail compared: time and error of each scheme on one scene, camera and shadow rays apart.

    analysis/levels/levels.py model.obj
    analysis/levels/levels.py map.obj --scheme bilinear --up z --from 1300,150,-100 --to 1000,120,-700

Every scheme renders the same samples; the error is the RMSE of the picture beside one of `--lod recursive` with edges
shorter by --reference. Times are processor seconds of one thread, everything built on the way: medians of --repeat runs,
interleaved. Shadow rays: the time with them less that without. made/needed: triangles
made over twice the pixels covered, over the square of the target edge in pixels.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import tempfile

import view

SCHEMES = ["recursive", "discrete", "patch", "paper", "camera", "fixed", "fixed:1", "fixed:2", "fixed:3"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)
    view.add_options(parser, "512x512", 3)
    parser.add_argument("--reference", type=float, default=8, help="how much shorter edges of the reference are")
    parser.add_argument("--schemes", nargs="+", default=SCHEMES)
    options, options.scene = parser.parse_known_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        scene = view.write_scene(options, folder)
        with open(scene) as file:
            edge = float(re.search(r"(?m)^edge_pixels = (.*)$", file.read())[1])
        dark = ["--light-samples", "0", "--sky-samples", "0"]
        reference = view.render(options, scene, folder, "reference", "--lod", "recursive", "--edge-pixels",
                                str(edge / options.reference))[0]
        times = {}
        for _ in range(options.repeat):
            for scheme in options.schemes:
                camera = view.render(options, scene, folder, "camera", "--lod", scheme, *dark)[1]
                picture, whole, _ = view.render(options, scene, folder, "whole" + scheme.replace(":", "_"), "--lod", scheme)
                times.setdefault(scheme, []).append(tuple(s["host"]["render_processor_seconds"] for s in (camera, whole))
                                                    + (camera, whole, picture))
        for scheme in options.schemes:
            runs = times[scheme]
            camera, whole, picture = runs[0][2:]
            seconds, total = (statistics.median(r[i] for r in runs) for i in (0, 1))
            figures = os.path.join(folder, "error.json")
            view.run([options.razor, "compare", picture, reference, "--json", figures])
            with open(figures) as file:
                error = find(json.load(file), "rmse")
            counters = whole["counters"]
            needed = 2 * counters["camera_hits"] / options.spp / edge**2  # pixels covered / half a square edge
            rows.append({"scheme": scheme, "rmse": error, "camera_seconds": seconds, "shadow_seconds": total - seconds,
                         "triangles": camera["counters"]["triangles_made"],
                         "made_over_needed": camera["counters"]["triangles_made"] / needed,
                         "blended": counters["blended_tests"] / max(counters["block_tests"], 1),
                         "grid_bytes": whole["built"]["grid_bytes"]})
    show(rows)
    if options.json:
        with open(options.json, "w") as file:
            json.dump(rows, file, indent=1)
            file.write("\n")


def find(tree, key):
    for name, value in tree.items():
        if name.lower() == key:
            return value
        if isinstance(value, dict):
            inner = find(value, key)
            if inner is not None:
                return inner
    return None


def show(rows):
    print(f"{'scheme':10} {'RMSE':>9} {'camera s':>9} {'shadow s':>9} {'triangles':>10} {'made/needed':>11} "
          f"{'blended':>8} {'grids MB':>9}")
    for r in rows:
        print(f"{r['scheme']:10} {r['rmse']:9.5f} {r['camera_seconds']:9.3f} {r['shadow_seconds']:9.3f} "
              f"{r['triangles']:10d} {r['made_over_needed']:11.2f} {r['blended']:8.1%} {r['grid_bytes'] / 1e6:9.1f}")


if __name__ == "__main__":
    main()
