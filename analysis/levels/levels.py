#!/usr/bin/python3
"""Levels of detail compared: time and error of each scheme on one scene, camera and shadow rays apart.

    analysis/levels/levels.py model.obj
    analysis/levels/levels.py map.obj --scheme bilinear --up z --from 1300,150,-100 --to 1000,120,-700

Every scheme renders the same samples; the error is the RMSE of the picture beside
one of `--lod recursive` with edges an eighth as long. Times are processor seconds of one thread, everything built on the
way: the least of --repeat runs, interleaved. Shadow rays: the time with them less that without. made/needed: triangles
made over twice the pixels covered, over the square of the target edge in pixels.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

SCHEMES = ["recursive", "discrete", "patch", "paper", "camera", "fixed", "fixed:1", "fixed:2", "fixed:3"]


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"levels.py: {' '.join(command)}: {(done.stderr or done.stdout).strip().splitlines()[-1]}")
    return done.stdout


def described(options, renderer):
    """The scene with every default filled in, seen from where the options say."""
    text = run([renderer, "render", *options.scene, "--size", options.size, "--spp", str(options.spp), "--print-config"])
    for flag, key in ((options.origin, "position"), (options.to, "target")):
        if flag:
            place = ", ".join(str(float(x)) for x in flag.split(","))
            text = re.sub(rf"(?m)^{key} = \[.*\]$", f"{key} = [{place}]", text, count=1)
    if options.origin or options.to:
        text = re.sub(r"(?m)^focus_distance = .*\n", "", text, count=1)
    return text


def render(renderer, scene, folder, name, scheme, *more):
    out, stats = os.path.join(folder, name + ".exr"), os.path.join(folder, name + ".json")
    run([renderer, "render", scene, "--threads", "1", "--lod", scheme, "--stats", stats, "-o", out, *more])
    with open(stats) as file:
        return out, json.load(file)["statistics"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--spp", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--from", dest="origin", metavar="X,Y,Z", help="where the camera stands")
    parser.add_argument("--to", metavar="X,Y,Z", help="what it looks at")
    parser.add_argument("--schemes", nargs="+", default=SCHEMES)
    parser.add_argument("--razor", default=shutil.which("razor") or "build/release/razor/program/razor")
    parser.add_argument("--json", metavar="FILE")
    options, options.scene = parser.parse_known_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w") as file:
            file.write(described(options, options.razor))
        with open(scene) as file:
            edge = float(re.search(r"(?m)^edge_pixels = (.*)$", file.read())[1])
        dark = ["--light-samples", "0", "--sky-samples", "0"]
        reference, _ = render(options.razor, scene, folder, "reference", "recursive", "--edge-pixels", str(edge / 8))
        times = {}
        for _ in range(options.repeat):
            for scheme in options.schemes:
                _, camera = render(options.razor, scene, folder, "camera", scheme, *dark)
                picture, whole = render(options.razor, scene, folder, "whole" + scheme.replace(":", "_"), scheme)
                times.setdefault(scheme, []).append(
                    (camera["host"]["render_seconds"], whole["host"]["render_seconds"], camera, whole, picture))
        for scheme in options.schemes:
            runs = times[scheme]
            camera, whole, picture = runs[0][2:]
            seconds, total = min(r[0] for r in runs), min(r[1] for r in runs)
            figures = os.path.join(folder, "error.json")
            run([options.razor, "compare", picture, reference, "--json", figures])
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
