#!/usr/bin/python3
"""Noise against run time: the same samples everywhere, and as many as a noise threshold asks for (--noise-threshold).

    analysis/sampling/adaptive.py configs/scenes/materials.toml --size 96x64 --reference 4096

Each picture is compared with one of --reference samples and another seed (whose own error is part of all): root mean square error of
luminance, and the noise that --quiet percent of the tiles of 8 x 8 pixels are within, as thresholds measure it: root mean square
error over the square root of the luminance. Seconds are processor time of rendering by one thread, the median of --repeat runs.
`told`: the error that the renderer itself estimates, over the true one. `gain`: seconds that uniform samples take for the same
error, and for the same noise, over the seconds taken: by lines through what was measured, and on along the last two, in
logarithms.
"""
import argparse
import json
import math
import os
import shutil
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../levels"))
import view  # noqa: E402

import exr

SIDE = 8 # of a tile, pixels


def numbers(option, text, kind):
    try:
        values = [kind(x) for x in text.split(",")]
    except ValueError:
        view.fail(f"{option}: '{text}' are no numbers; write for example 16,64,256")
    if any(x <= 0 for x in values):
        view.fail(f"{option}: all must be more than 0")
    return values


def render(options, folder, name, *more):
    made = [view.render(options, options.scene, folder, name, "--size", options.size, "--quiet", *more) for _ in range(options.repeat)]
    stats = made[0][1]
    seconds = statistics.median(m[1]["host"]["frames"][0]["render_processor_seconds"] for m in made)
    return made[0][0], seconds, stats


def luminance(picture):
    width, height, planes = exr.read(picture)
    return width, height, [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(planes["R"], planes["G"], planes["B"])]


def errors(picture, reference, quiet):
    """Root mean square error, and the noise that a part of the tiles is within."""
    width, height, light = luminance(picture)
    truth = luminance(reference)[2]
    noise, squares = [], 0
    for top in range(0, height, SIDE):
        for left in range(0, width, SIDE):
            pixels = [y * width + x for y in range(top, min(top + SIDE, height)) for x in range(left, min(left + SIDE, width))]
            off = sum((light[i] - truth[i]) ** 2 for i in pixels)
            squares += off
            noise.append(math.sqrt(off / max(sum(truth[i] for i in pixels), 1e-12)))
    return math.sqrt(squares / len(light)), sorted(noise)[max(0, math.ceil(quiet / 100 * len(noise)) - 1)]


def seconds_for(error, key, uniform):
    """Of uniform samples, by lines through what was measured, in logarithms of seconds and error. None where no error has one."""
    points = sorted((math.log(u[key]), math.log(u["seconds"])) for u in uniform if u[key] > 0)
    if len(points) < 2 or not error > 0:
        return None
    at = math.log(error)
    low = next((i for i in range(len(points) - 1) if at <= points[i + 1][0]), len(points) - 2)
    (x0, y0), (x1, y1) = points[low], points[low + 1]
    return math.exp(y0 + (at - x0) * (y1 - y0) / (x1 - x0)) if x1 != x0 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("scene")
    parser.add_argument("--uniform", default="16,32,64,128,256", help="samples a pixel")
    parser.add_argument("--noise", default="0.06,0.04,0.03,0.02", help="thresholds")
    parser.add_argument("--most", type=int, default=2048, help="samples of a pixel, with a threshold")
    parser.add_argument("--reference", type=int, default=4096, help="samples a pixel")
    parser.add_argument("--size", default="192x128")
    parser.add_argument("--lod", default="recursive")
    parser.add_argument("--quiet", type=float, default=95, help="percent of the tiles")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    uniform = numbers("--uniform", options.uniform, int)
    noise = numbers("--noise", options.noise, float)
    rows = []
    print(f"{'samples':>9} {'most':>5} {'threshold':>9} {'seconds':>8} {'error':>9} {'noise':>7} {'told':>5} {'gain':>5} {'noise':>5}")
    with tempfile.TemporaryDirectory() as folder:
        repeat, options.repeat = options.repeat, 1
        reference, _, _ = render(options, folder, "reference", "--lod", options.lod, "--spp", str(options.reference), "--seed", "7919")
        options.repeat = repeat

        def measure(name, threshold, *more):
            picture, seconds, stats = render(options, folder, name, "--lod", options.lod, *more)
            error, tiles = errors(picture, reference, options.quiet)
            passes = stats.get("passes", {})
            row = {"threshold": threshold, "seconds": seconds, "error": error, "noise": tiles, "samples": passes.get("mean_samples"),
                   "most": passes.get("samples"), "told_error": passes.get("error"),
                   "within_threshold": passes.get("within_threshold")}
            row["gain"] = row["gain_noise"] = None
            rows.append(row)
            return row

        def show(row):
            told = f"{row['told_error'] / row['error']:5.2f}" if row["told_error"] else f"{'-':>5}"
            gain = f"{row['gain']:5.2f} {row['gain_noise']:5.2f}" if row["gain"] else f"{'-':>5} {'-':>5}"
            print(f"{row['samples']:9.1f} {row['most']:5} {row['threshold'] or '-':>9} {row['seconds']:8.2f} {row['error']:9.5f} "
                  f"{row['noise']:7.4f} {told} {gain}", flush=True)

        even = []
        for samples in uniform:
            row = measure(f"uniform_{samples}", 0, "--spp", str(samples))
            row["samples"] = row["most"] = samples
            even.append(row)
            show(row)
        for threshold in noise:
            row = measure(f"noise_{threshold}", threshold, "--spp", str(options.most), "--noise-threshold", str(threshold))
            for gain, key in (("gain", "error"), ("gain_noise", "noise")):
                seconds = seconds_for(row[key], key, even)
                row[gain] = seconds / row["seconds"] if seconds else None
            show(row)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    view.run_program(main)
