#!/usr/bin/python3
"""Levels of detail compared: time and error of each scheme on one scene, camera and shadow rays apart.

    analysis/levels/levels.py model.obj
    analysis/levels/levels.py map.obj --scheme bilinear --up z --from 1300,150,-100 --to 1000,120,-700

Every scheme renders the same samples; the error is the RMSE of the picture beside one of --reference-lod with edges
shorter by --reference. Times are processor seconds of one thread for a frame, everything built on the way but the
topology's pages, which an animation makes once: medians of --frames frames after a first, and of --repeat runs.
These take turns, and ratios of times are medians, with the least and the largest, of ratios within a turn: whatever
slows the machine for longer than one cancels. "first": the first frame's, pages and all. Shadow rays: the time with them
less that without. made/needed: triangles made over twice the squares of the target edge that the visible surface is
large (as seen through the centres of pixels, with shading normals; 32 a pixel at most, where it is seen edge-on).

Fixed levels are powers of two apart, so none has just the error of another scheme. Where at least two are among the
schemes ("fixed:-1" has edges half as long as "fixed"), "/fixed" is a time over that of a fixed level of equal error,
by a line through the logarithms of error and time of the two fixed levels beside it; "<" over the finest of them where
none has as small an error, "-" where none has as large a one. "/object": the same for levels that each instance has of its own.
"/discrete": over that of "discrete", which has the same levels and blends nothing.
"""
import argparse
import json
import math
import os
import re
import shutil
import statistics
import tempfile

import view

LADDERS = ["fixed", "object"]  # one level, K coarser: "fixed:K"
RAYS = ["camera", "shadow", "first_camera", "first_shadow"]
SCHEMES = ["recursive", "discrete", "patch", "paper", "camera", "fixed", "fixed:1", "fixed:2", "fixed:3"]


def parser(size="512x512", repeat=3):
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                allow_abbrev=False)
    view.add_options(p, size, repeat)
    p.add_argument("--frames", type=int, default=3, help="frames timed a run, after a first")
    p.add_argument("--reference", type=float, default=8, help="how much shorter edges of the reference are")
    p.add_argument("--reference-lod", default="camera", help="the reference's scheme")
    p.add_argument("--schemes", nargs="+", default=SCHEMES)
    p.add_argument("--write-scene", metavar="FILE",
                   help="write what is seen as a scene, for razor and razor-sim, and end")
    return p


def parse(arguments=None, **defaults):
    """What parser() does not know goes to the renderer, the scene first."""
    options, options.scene = parser(**defaults).parse_known_args(arguments)
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    return options


def measure(options):
    """A row of figures for each scheme."""
    for name in ("repeat", "frames"):
        if getattr(options, name) < 1:
            view.fail(f"--{name} {getattr(options, name)}: at least 1")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        scene = view.write_scene(options, os.path.join(folder, "scene.toml"))
        with open(scene) as file:
            edge = float(re.search(r"(?m)^edge_pixels = (.*)$", file.read())[1])
        dark = ["--light-samples", "0", "--sky-samples", "0"]
        references = [view.render(options, scene, folder, f"reference{seed}", "--lod", options.reference_lod, "--seed",
                                  str(seed), "--edge-pixels", str(edge / options.reference))[0] for seed in (1, 2)]
        times, last = {}, {}
        for _ in range(options.repeat):
            for scheme in options.schemes:
                lod = [*level_of_detail(scheme, edge), "--repeat", str(options.frames + 1)]
                camera = view.render(options, scene, folder, "camera", *lod, *dark)[1]
                whole = view.render(options, scene, folder, "whole", *lod)[1]
                times.setdefault(scheme, []).append((frame_seconds(camera), frame_seconds(whole)))
                last[scheme] = camera, whole
        for scheme in options.schemes:
            camera, whole = last[scheme]
            turns = {"camera": [c[1] for c, _ in times[scheme]], "shadow": [w[1] - c[1] for c, w in times[scheme]],
                     "first_camera": [c[0] for c, _ in times[scheme]],
                     "first_shadow": [w[0] - c[0] for c, w in times[scheme]]}
            pictures = [view.render(options, scene, folder, f"seed{seed}", "--seed", str(seed),
                                    *level_of_detail(scheme, edge))[0] for seed in (1, 2)]
            error, noise = errors(options, folder, pictures, references)
            counters = whole["counters"]
            needed = 2 * whole["visible"]["squares"] / edge**2  # visible area / half a square edge
            rows.append({"scheme": scheme, "rmse": error, "noise": noise,
                         **{f"{rays}_seconds": statistics.median(turns[rays]) for rays in RAYS},
                         **{f"{rays}_turns": turns[rays] for rays in RAYS},
                         "triangles": camera["counters"]["triangles_made"],
                         "made_over_needed": camera["counters"]["triangles_made"] / needed,
                         "blended": counters["blended_tests"] / max(counters["block_tests"], 1),
                         "grid_bytes": whole["built"]["grid_bytes"]})
    for ladder in LADDERS:
        compare_with(ladder, rows)
    for r in rows:
        for discrete in (d for d in rows if d["scheme"] == "discrete"):
            for rays in RAYS:
                r[f"{rays}_over_discrete"] = over(r, rays, discrete, discrete, 0)
    return rows


def main():
    options = parse()
    if options.write_scene:
        return view.write_scene(options, options.write_scene)
    rows = measure(options)
    show(rows)
    view.write_rows(rows, options.json)


def frame_seconds(figures):
    """Of the first frame, and of one after it."""
    first, *later = (frame["render_processor_seconds"] for frame in figures["host"]["frames"])
    return first, statistics.median(later)


def level_of_detail(scheme, edge):
    """The renderer's options: fixed levels finer than the target edge are those of shorter edges."""
    name, _, level = scheme.partition(":")
    if level.startswith("-"):
        return "--lod", name, "--edge-pixels", str(edge * 2.0 ** int(level))
    return "--lod", scheme


def compare_with(ladder, rows):
    """Adds each scheme's times over those of a level of equal error of the ladder, [least, median, largest] of the turns;
    for one of less error than all of these, over the finest: one of equal error would take longer, so that the ratio is
    at most that. None where the error is lost in the noise."""
    levels = sorted((r for r in rows if r["scheme"].startswith(ladder) and r["rmse"] > 0), key=lambda r: r["rmse"])
    for r in rows:
        if levels and 0 < r["rmse"] < levels[0]["rmse"]:
            for rays in RAYS:
                r[f"{rays}_over_{ladder}_at_most"] = over(r, rays, levels[0], levels[0], 0)
        for low, high in zip(levels, levels[1:]):
            if low["rmse"] <= r["rmse"] <= high["rmse"] and low["rmse"] < high["rmse"]:
                part = math.log(r["rmse"] / low["rmse"]) / math.log(high["rmse"] / low["rmse"])
                for rays in RAYS:
                    r[f"{rays}_over_{ladder}"] = over(r, rays, low, high, part)
                break


def over(row, rays, low, high, part):
    """Of each turn, the time of a row over that at a part of the way from one level to another, in logarithms."""
    times = zip(*([max(seconds, 1e-9) for seconds in r[rays + "_turns"]] for r in (row, low, high)))
    ratios = sorted(t / (a * (b / a) ** part) for t, a, b in times)
    return [ratios[0], statistics.median(ratios), ratios[-1]]


def errors(options, folder, pictures, references):
    """Of pictures of two seeds beside references of the same samples: the root mean square of what remains of their
    difference as samples grow without bound, and of the difference itself. The mean product of two independent
    differences is without noise: 2 x y = x^2 + y^2 - (x - y)^2."""
    def rmse(a, b, *more):
        figures = os.path.join(folder, "error.json")
        view.run([options.razor, "compare", a, b, "--json", figures, *more])
        with open(figures) as file:
            return json.load(file)["rmse"]

    differences = [os.path.join(folder, f"difference{i}.exr") for i in (1, 2)]
    x, y = (rmse(p, r, "-o", d) for p, r, d in zip(pictures, references, differences))
    product = (x * x + y * y - rmse(*differences)**2) / 2
    return math.copysign(math.sqrt(abs(product)), product), math.sqrt((x * x + y * y) / 2)


def ratio(row, rays, ladder):
    """Beside a ladder's level of equal error, or `discrete`, as text: the median turn's, and from the least to the largest."""
    name = f"{rays}_over_{ladder}"
    bound = name + "_at_most" in row
    if not bound and name not in row:
        return "-"
    least, median, largest = (f"{x:.2f}" for x in row[name + "_at_most" * bound])
    return "<" * bound + median + (f" ({least}-{largest})" if least != largest else "")


def show(rows):
    ladders = [ladder for ladder in LADDERS if any(r["scheme"].startswith(ladder + ":") for r in rows)]
    ladders += ["discrete"] * any(r["scheme"] == "discrete" for r in rows)

    headings = [heading for rays in ("camera", "shadow", "first", "shadow")
                for heading in (f"{rays + ' s':>8}", *(f"{'/' + ladder:>17}" for ladder in ladders))]
    print(f"{'scheme':10} {'error':>9} {'noisy':>9} {' '.join(headings)} {'triangles':>10} {'made/needed':>11} "
          f"{'blended':>8} {'grids MB':>9}")
    for r in rows:
        times = [figure for rays in RAYS
                 for figure in (f"{r[rays + '_seconds']:8.3f}", *(f"{ratio(r, rays, l):>17}" for l in ladders))]
        print(f"{r['scheme']:10} {r['rmse']:9.5f} {r['noise']:9.5f} {' '.join(times)} {r['triangles']:10d} "
              f"{r['made_over_needed']:11.2f} {r['blended']:8.1%} {r['grid_bytes'] / 1e6:9.1f}")


if __name__ == "__main__":
    view.run_program(main)
