#!/usr/bin/python3
"""many_lights.py [OPTIONS] [N ...] [-- OPTION ...]: what choosing lights by their importance saves where there are many.

    tests/benchmarks/many_lights.py
    tests/benchmarks/many_lights.py 1000 --csv lights.csv -- --size 256x256

A court of boxes lit by N small lights of all kinds (400 and 2000, where no number is given), by one ray to each light and by
4, 16 and 32 to chosen ones (there must be more than twelve times as many). For each: native processor time (the least of --runs),
the relative error against a picture of many samples, and how well the time is spent, 1 / (time x squared error), over that of a
ray to each. What follows -- goes to each run, in place of --size 128x128.
"""
import argparse
import json
import os
import random
import subprocess
import sys
import tempfile

PROJECT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(PROJECT, "analysis/sweep"))
import simulation  # noqa: E402
from simulation import Mistake  # noqa: E402

FRAME = ["--size", "128x128"]
SAMPLES = 4  # a pixel
REFERENCE = 16  # times as many


def read_options():
    arguments, more = simulation.split_arguments(sys.argv[1:])
    p = argparse.ArgumentParser(prog="many_lights.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see many_lights.py --help"))
    p.add_argument("numbers", nargs="*", type=int, metavar="N")
    p.add_argument("--runs", type=int, default=3, metavar="N", help="of each native frame")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs")
    p.add_argument("--renderer", metavar="PATH", help="razor; else that of build/release")
    options = p.parse_args(arguments)
    if options.runs < 1:
        raise Mistake(f"--runs {options.runs}: give a number from 1")
    if any(n <= 384 for n in options.numbers):
        raise Mistake("32 rays are given by chance where there are more than 384 lights; give larger numbers")
    simulation.check_writable("--csv", options.csv)
    options.renderer = options.renderer or os.path.join(PROJECT, "build/release/razor/program/razor")
    if not os.access(options.renderer, os.X_OK):
        raise Mistake(f"{options.renderer}: no program; build razor, or give --renderer PATH")
    options.numbers = options.numbers or [400, 2000]
    options.more = more or FRAME
    return options


def write_scene(path, number):
    """Boxes on a floor within walls, and lights among them; the same for the same number."""
    rng = random.Random(number)
    text = ["[camera]\nposition = [0, 9, 16]\ntarget = [0, 0.5, 0]\nfov = 45\n[sky]\nradiance = 0\n",
            '[[material]]\nname = "stone"\nalbedo = 0.6\n']
    with open(os.path.join(os.path.dirname(path), "box.obj"), "w", encoding="utf-8") as file:
        for x in (-1, 1):
            for y in (0, 1):
                for z in (-1, 1):
                    file.write(f"v {x} {y} {z}\n")
        file.write("f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
    text.append('[[mesh]]\nname = "box"\nfile = "box.obj"\nscheme = "bilinear"\nmaterial = "stone"\n')
    text.append('[[object]]\nname = "floor"\nmesh = "box"\nscale = [10, 0.1, 10]\ntranslate = [0, -0.1, 0]\n')
    for k in range(24):
        x, z = rng.uniform(-9, 9), rng.uniform(-9, 9)
        text.append(f'[[object]]\nname = "box {k}"\nmesh = "box"\nscale = [{rng.uniform(0.3, 0.8)}, {rng.uniform(0.5, 2)}, {rng.uniform(0.3, 0.8)}]\n'
                    f"rotate = [0, {rng.uniform(0, 90)}, 0]\ntranslate = [{x}, 0, {z}]\n")
    for k in range(number):
        at = f"[{rng.uniform(-9.5, 9.5)}, {rng.uniform(0.3, 3)}, {rng.uniform(-9.5, 9.5)}]"
        colour = [rng.uniform(0.3, 1) * 60 / number for _ in range(3)]
        kind = ("point", "sphere", "spot", "disk")[k % 4]
        if kind in ("point", "spot"):
            shape = f'intensity = {colour}\n' + ("direction = [0, -1, 0]\ncone_angle = 50\ncone_delta = 20\n" if kind == "spot" else "")
        else:
            shape = f"radius = 0.1\nradiance = {[c * 40 for c in colour]}\n" + ("direction = [0, -1, 0.2]\n" if kind == "disk" else "")
        text.append(f'[[light]]\nkind = "{kind}"\nposition = {at}\n{shape}')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(text))


def call(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise Mistake((done.stderr.strip().splitlines() or [f"{command[0]} ended with {done.returncode}"])[-1])


def render(options, scene, picture, samples, choices, runs, seed):
    stats = picture + ".json"
    call([options.renderer, "render", scene, *options.more, "--spp", str(samples), "--light-samples", "1", "--light-choices", str(choices),
          "--seed", str(seed), "--threads", "1", "--repeat", str(runs), "--quiet", "-o", picture, "--stats", stats])
    with open(stats, encoding="utf-8") as file:
        frames = json.load(file)["statistics"]["host"]["frames"]
    return min(frame["render_processor_seconds"] for frame in frames)


def error(options, picture, reference):
    report = picture + ".error.json"
    call([options.renderer, "compare", picture, reference, "--json", report])
    with open(report, encoding="utf-8") as file:
        return json.load(file)["relative_mse"]


def rows_of(options, number, folder):
    scene = os.path.join(folder, f"{number}.toml")
    write_scene(scene, number)
    reference = os.path.join(folder, f"{number}.exr")
    render(options, scene, reference, SAMPLES * REFERENCE, 0, 1, 1)
    rows = []
    for choices in (0, 4, 16, 32):
        picture = os.path.join(folder, f"{number}-{choices}.exr")
        seconds = render(options, scene, picture, SAMPLES, choices, options.runs, 2)
        rows.append({"lights": number, "choices": choices, "seconds": seconds, "relative_mse": error(options, picture, reference)})
    for row in rows:
        row["efficiency"] = rows[0]["seconds"] * rows[0]["relative_mse"] / (row["seconds"] * row["relative_mse"])
    return rows


def main():
    options = read_options()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number in options.numbers:
            rows += rows_of(options, number, folder)
    print(f"{'lights':>6} {'rays a hit':>18} {'seconds':>8} {'relative MSE':>12} {'efficiency':>10}")
    for row in rows:
        rays = f"{row['choices']} to chosen lights" if row["choices"] else "one to each"
        print(f"{row['lights']:>6} {rays:>18} {row['seconds']:>8.3f} {row['relative_mse']:>12.5f} {row['efficiency']:>10.2f}")
    if options.csv:
        simulation.write_csv(options.csv, rows)
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(main))
