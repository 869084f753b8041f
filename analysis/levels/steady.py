#!/usr/bin/python3
"""Whether time and memory stay as they are over a long sequence: its last frames beside the same frames of a process of their own.

    analysis/levels/steady.py configs/scenes/courtyard.toml configs/scenes/forest.toml --frames 500

A table: processor milliseconds of the first --last frames (but frame 0, which analyses topology) and of the last ones, medians;
how long each of the last took over the same frame in a process that begins with them, the median, least and greatest; megabytes of memory in use
after the first --last frames, half of all and all of them, and at the end of the other process.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import tempfile

import view


def resident_megabytes(pid):
    with open(f"/proc/{pid}/status") as file:
        for line in file:
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) / 1024
    return 0.0 # it is gone


def sequence(options, scene, first, last, folder):
    """Of each frame: processor seconds, and megabytes in use once it is told."""
    command = [options.razor, "render", scene, "--frames", f"{first}:{last}", "--size", options.size, "--spp", "1",
               "--threads", str(options.threads), "-o", os.path.join(folder, "p_%04d.png"), "--stats", os.path.join(folder, "s_%04d.json")]
    memory = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            if line.startswith("frame "):
                memory.append(resident_megabytes(process.pid))
        mistake = process.stderr.read().strip()
    if process.returncode != 0:
        view.fail(mistake)
    seconds = []
    for frame in range(first, last + 1):
        with open(os.path.join(folder, f"s_{frame:04d}.json")) as file:
            seconds.append(json.load(file)["statistics"]["host"]["frames"][0]["render_processor_seconds"])
    return seconds, memory


def row_of(options, scene):
    n, last = options.frames, options.last
    with tempfile.TemporaryDirectory() as folder:
        seconds, memory = sequence(options, scene, 0, n - 1, folder)
    with tempfile.TemporaryDirectory() as folder: # one frame more before those compared, as it analyses topology
        fresh, fresh_memory = sequence(options, scene, n - last - 1, n - 1, folder)
    over = [a / b for a, b in zip(seconds[-last:], fresh[-last:])]
    return {"scene": os.path.basename(scene).removesuffix(".toml"), "first_ms": statistics.median(seconds[1:last + 1]) * 1e3,
            "last_ms": statistics.median(seconds[-last:]) * 1e3, "over_fresh": statistics.median(over), "least": min(over),
            "greatest": max(over), "megabytes": [memory[last], memory[n // 2], memory[-2]], "fresh_megabytes": fresh_memory[-2]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("scenes", nargs="+", metavar="SCENE.toml")
    parser.add_argument("--frames", type=int, default=500)
    parser.add_argument("--last", type=int, default=20, help="frames that are compared")
    parser.add_argument("--size", default="128x72")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    if options.last < 2 or options.frames < 2 * options.last + 2:
        view.fail(f"--frames {options.frames} are too few for --last {options.last}, of at least 2; give more than twice as many and one")
    rows = []
    print(f"{'scene':16} {'first ms':>9} {'last ms':>9} {'over fresh':>20} {'MB, first':>10} {'half':>8} {'all':>8} {'fresh':>8}")
    for scene in options.scenes:
        row = row_of(options, scene)
        rows.append(row)
        over = f"{row['over_fresh']:.2f} [{row['least']:.2f} {row['greatest']:.2f}]"
        early, half, late = row["megabytes"]
        print(f"{row['scene']:16} {row['first_ms']:9.1f} {row['last_ms']:9.1f} {over:>20} {early:10.1f} {half:8.1f} {late:8.1f} "
              f"{row['fresh_megabytes']:8.1f}", flush=True)
    view.write_rows(rows, options.json)


if __name__ == "__main__":
    view.run_program(main)
