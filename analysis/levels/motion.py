#!/usr/bin/python3
"""What it costs to go from one frame to the next where much stands still: sequences of one pawn that moves before more and more
that do not, instances of one mesh.

    analysis/levels/motion.py --counts 1,4096,262144

Milliseconds to load the first frame (topology, instances, the tree of boxes) and the later ones (medians of --frames, the second
left out), where the pawn moves alone, where the camera moves as well (levels of detail are measured from it, so those of all
instances may be others), and where all pawns move. Beside them how many instances and nodes of the tree of boxes a frame of the
first kind wrote anew.
"""
import argparse
import json
import os
import shutil
import statistics
import tempfile

import view

SCENE = """name = "motion"
[settings]
size = [16, 16]
samples = 1
light_samples = 1
sky_samples = 0
[camera]
position = [0, 2, 12]
{camera}
[sky]
radiance = 0.5
[[light]]
corner = [-2, 6, 8]
edge_u = [0, 0, 2]
edge_v = [2, 0, 0]
radiance = 20
[[mesh]]
name = "wall"
shape = "box"
scale = [9, 9, 0.1]
translate = [0, 0, -3]
[[mesh]]
name = "pawn"
shape = "pawn"
[[group]]
name = "many"
[[group.object]]
mesh = "pawn"
array = [{x}, 1, {z}]
spacing = [{step_x}, 0, {step_z}]
translate = [-100, 0, -20]
[[object]]
group = "many"
{many}
[[object]]
mesh = "pawn"
[[object.key]]
time = 0
translate = [-2, 0, 0]
[[object.key]]
time = 2
translate = [2, 0, 0]
"""
KEYS = """[[{header}.key]]
time = 0
{key} = {first}
[[{header}.key]]
time = 2
{key} = {last}
"""
KINDS = {"one": {"camera": "", "many": ""},
         "camera": {"camera": KEYS.format(header="camera", key="position", first="[0, 2, 12]", last="[1, 3, 11]"), "many": ""},
         "all": {"camera": "", "many": KEYS.format(header="object", key="rotate", first="[0, 0, 0]", last="[0, 5, 0]")}}


def frames(options, count, folder, kind):
    """Statistics of each frame."""
    power = count.bit_length() - 1
    if 1 << power != count:
        view.fail(f"--counts: {count} is no power of two; write for example 1,64,4096")
    x, z = 1 << (power + 1) // 2, 1 << power // 2
    scene = os.path.join(folder, "scene.toml")
    with open(scene, "w") as file:
        file.write(SCENE.format(x=x, z=z, step_x=200 / x, step_z=-200 / z, **KINDS[kind]))
    view.run([options.razor, "render", scene, "--frames", f"0:{options.frames}", "--threads", "1", "--quiet", "-o",
              os.path.join(folder, "%d.png"), "--stats", os.path.join(folder, "%d.json")])
    made = []
    for n in range(options.frames + 1):
        with open(os.path.join(folder, f"{n}.json")) as file:
            made.append(json.load(file)["statistics"])
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--counts", default="1,64,4096,32768,262144", help="powers of two")
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    try:
        counts = [int(x) for x in options.counts.split(",")]
    except ValueError:
        view.fail(f"--counts: '{options.counts}' are no numbers; write for example 1,64,4096")
    if options.frames < 3:
        view.fail(f"--frames {options.frames}: too few for a median; write 3 or more")
    rows = []
    print(f"{'still':>8} {'first ms':>9} {'one ms':>8} {'camera ms':>9} {'all ms':>8} {'instances':>9} {'nodes':>6}")
    with tempfile.TemporaryDirectory() as folder:
        for count in counts:
            row = {"still": count}
            for kind in KINDS:
                made = frames(options, count, folder, kind)
                loads = [1e3 * frame["host"]["load_seconds"] for frame in made]
                if kind == "one":
                    row.update(first=loads[0], instances=made[-1]["touched"]["instances"],
                               nodes=statistics.median(frame["touched"]["graph_nodes"] for frame in made[2:]))
                row[kind] = statistics.median(loads[2:])
            rows.append(row)
            print(f"{count:8} {row['first']:9.2f} {row['one']:8.3f} {row['camera']:9.3f} {row['all']:8.2f} "
                  f"{row['instances']:9} {row['nodes']:6.0f}", flush=True)
    view.write_rows(rows, options.json)


if __name__ == "__main__":
    view.run_program(main)
