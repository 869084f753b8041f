#!/usr/bin/python3
"""What objects cost that no ray sees: frames of a wall with more and more objects behind it, lazily and eagerly (--eager).

    analysis/levels/hidden.py --counts 1,64,4096,65536

Camera and light stand before the wall, which fills the picture; the objects, pawns of 144 faces, stand in a block behind it, each
an instance of one mesh, two more at its ends. Seconds of one thread: to load (topology, boxes of instances, the tree of boxes), and of the frame
(boxes refitted, everything built, every ray), the medians of --repeat runs; megabytes: what the frame built. Eager frames end at
--most-eager objects. Both pictures must be the same, bit for bit.
"""
import argparse
import os
import shutil
import statistics
import tempfile

import view

SCENE = """name = "hidden"
[settings]
size = [{size}]
samples = 4
light_samples = 4
[camera]
position = [0, 0, 10]
target = [0, 0, 0]
fov = 40
[[light]]
corner = [-2, 6, 8]
edge_u = [0, 0, 2]
edge_v = [2, 0, 0]
radiance = 20
[[mesh]]
name = "wall"
shape = "knot"
scale = 1.5
[[mesh]]
name = "back"
shape = "plane"
scheme = "bilinear"
rotate = [90, 0, 0]
translate = [0, 0, -3]
[mesh.parameters]
width = 4000.0
depth = 4000.0
[[mesh]]
name = "pawn"
shape = "pawn"
[[object]] # ends of the block: however many are between, the scene is as large
mesh = "pawn"
translate = [-{half}, -{half}, -20]
[[object]]
mesh = "pawn"
translate = [{half}, {half}, -{far}]
[[object]]
mesh = "pawn"
translate = [{corner}]
array = [{counts}]
spacing = [{spacing}]
"""
SIDE = 200 # of the block


def block(count):
    """Three powers of two, as equal as can be, whose product is count."""
    power = count.bit_length() - 1
    if 1 << power != count:
        view.fail(f"--counts: {count} is no power of two; write for example 1,64,4096")
    return [1 << ((power + k) // 3) for k in range(3)]


def figures(options, count, folder, eager):
    x, y, z = block(count)
    scene = os.path.join(folder, "scene.toml")
    with open(scene, "w") as file:
        steps = [SIDE / n for n in (x, y, z)]
        file.write(SCENE.format(size=options.size.replace("x", ", "), half=SIDE / 2, far=SIDE + 20, counts=f"{x}, {y}, {z}",
                                corner=f"{steps[0] / 2 - SIDE / 2}, {steps[1] / 2 - SIDE / 2}, {-20 - steps[2] / 2}",
                                spacing=f"{steps[0]}, {steps[1]}, {-steps[2]}"))
    made = [view.render(options, scene, folder, f"{count}_{eager}", *(["--eager"] if eager else [])) for _ in range(options.repeat)]
    built = made[0][1]["built"]
    return {"picture": made[0][0], "load": statistics.median(m[1]["host"]["load_seconds"] for m in made),
            "seconds": statistics.median(m[1]["host"]["frames"][0]["render_processor_seconds"] for m in made),
            "megabytes": sum(built[k] for k in ("grid_bytes", "node_bytes", "list_bytes", "patch_table_bytes")) / 1e6,
            "opened": made[0][1]["opened"]["instances"]["count"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--counts", default="1,8,64,512,4096,32768,262144", help="powers of two")
    parser.add_argument("--most-eager", type=int, default=512)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    try:
        counts = [int(x) for x in options.counts.split(",")]
    except ValueError:
        view.fail(f"--counts: '{options.counts}' are no numbers; write for example 1,64,4096")
    rows = []
    print(f"{'hidden':>8} {'opened':>7} {'load s':>8} {'lazy s':>8} {'MB':>8} {'eager s':>9} {'MB':>8}")
    with tempfile.TemporaryDirectory() as folder:
        for count in counts:
            lazy = figures(options, count, folder, False)
            eager = figures(options, count, folder, True) if count <= options.most_eager else None
            if eager:
                view.run([options.razor, "compare", lazy["picture"], eager["picture"], "--identical"])
            rows.append({"hidden": count, "lazy": lazy, "eager": eager})
            rest = f"{eager['seconds']:9.3f} {eager['megabytes']:8.1f}" if eager else f"{'-':>9} {'-':>8}"
            print(f"{count:8} {lazy['opened']:7} {lazy['load']:8.4f} {lazy['seconds']:8.3f} {lazy['megabytes']:8.1f} {rest}", flush=True)
    for row in rows:
        for made in filter(None, (row["lazy"], row["eager"])):
            del made["picture"]
    view.write_rows(rows, options.json)


if __name__ == "__main__":
    view.run_program(main)
