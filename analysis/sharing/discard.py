#!/usr/bin/python3
"""What is it worth to tell caches which data are dead, and what does it cost to make them again, by the size of the caches.

    analysis/sharing/discard.py FOLDER [--scenes courtyard,interior,forest,showcase] [--l2 256KiB,1MiB,4MiB] [--share tile]
                                [--memory 4MiB,16MiB] [--full] [--jobs 2] [-- more options of razor-sim run]

For each scene and size of the L2s of two tiles of copernicus: lines of what a frame builds (grids, item lists, kd nodes, blended
blocks) that go to DRAM while it is rendered and, of what caches still hold when it has ended, after it; lines read again;
operations, and cycles of work. Without renderer.discard, and with it: lists that are done with, and at the end all that was
built, are then said to be dead, an instruction a line. What caches hold at the end is written back (sim.frame_end=write), as if
something else needed the caches; where the next frame writes over it first, only the first of both columns of writes counts.
With --memory, which bounds what a frame keeps (`razor-sim run --memory`), the same for each bound: what was dropped is made
again, and `again` is how many blocks more are made than without a bound.

FOLDER keeps the figures of each point, as of simulated.py, and gets discard.svg, .csv and .json. Exit code: 0; 2 on a mistake;
130 after Ctrl-C.
"""
import os
import sys

import points
from points import mean, width
from simulation import main, split_arguments

COLUMNS = ("transient_writes", "transient_left", "transient_reads", "discarded", "dram_reads", "dram_writes", "operations", "blocks",
           "work_cycles", "cycles")


def point_of(options, kind, seed):
    scene, size, discard, memory = kind
    m = options.machines["copernicus"]
    name = f"{os.path.basename(scene)}, L2 of {points.name_of(size)}, discard {discard}" + (f", {memory}" if memory else "")
    return points.point(name, m, points.scene_file(scene), options.crops[scene],
                        ["--share", options.share, *(["--memory", memory] if memory else []), *options.more],
                        [f"l2.size_bytes={size}", f"renderer.discard={discard}", "sim.frame_end=write"], m["workers"][-1], seed,
                        options.frame)


def rows_of(kinds, runs):
    rows = []
    for kind in kinds:
        scene, size, discard, memory = kind
        row = {"scene": scene, "l2_bytes": size, "discard": discard, "memory": memory or "", "runs": len(runs[kind]),
               **{key: mean(runs[kind], key) for key in COLUMNS}, "work_cycles_half_width": width(runs[kind], "work_cycles")}
        row["blocks_again"] = row["blocks"] - mean(runs[scene, size, discard, None], "blocks")
        rows.append(row)
    return rows


def show(rows):
    print(f"{'scene':10} {'L2':>8} {'memory':>8} {'discard':>7} {'written, k':>10} {'left, k':>8} {'read again, k':>13} {'dead, k':>8}"
          f" {'M operations':>12} {'again':>8} {'work, M':>8} {'+-':>6}")
    for r in rows:
        print(f"{os.path.basename(r['scene'])[:10]:10} {points.name_of(r['l2_bytes']):>8} {r['memory']:>8} {r['discard']:>7}"
              f" {r['transient_writes'] / 1e3:10.1f} {r['transient_left'] / 1e3:8.1f} {r['transient_reads'] / 1e3:13.1f}"
              f" {r['discarded'] / 1e3:8.1f} {r['operations'] / 1e6:12.1f} {r['blocks_again']:8.0f} {r['work_cycles'] / 1e6:8.2f}"
              f" {r['work_cycles_half_width'] / 1e6:6.2f}")


def say(options, rows):
    by = {(r["scene"], r["l2_bytes"], r["memory"], r["discard"]): r for r in rows}
    for scene in options.scenes:
        for memory in options.memory:
            parts = []
            for size in options.sizes:
                off, on = (by[scene, size, memory or "", discard] for discard in ("off", "on"))
                before = off["transient_writes"] + off["transient_left"]
                after = on["transient_writes"] + on["transient_left"]
                parts.append(f"{points.name_of(size)} {100 * (1 - after / before):.0f} %" if before else f"{points.name_of(size)} none")
            print(f"{os.path.basename(scene)}{', ' + memory if memory else ''}: writes of what frames build that discarding spares: "
                  + ", ".join(parts))


def picture(pyplot, options, rows):
    figure, axes = pyplot.subplots(1, len(options.scenes), figsize=(3.2 * len(options.scenes) + 0.6, 3.4), squeeze=False)
    for a, scene in zip(axes[0], options.scenes):
        for memory in options.memory:
            for discard in ("off", "on"):
                mine = [r for r in rows if (r["scene"], r["memory"], r["discard"]) == (scene, memory or "", discard)]
                label = f"discard {discard}" + (f", {memory}" if memory else "")
                line, = a.plot([r["l2_bytes"] for r in mine], [(r["transient_writes"] + r["transient_left"]) / 1e3 for r in mine],
                               marker="o", markersize=3, label=label)
                a.plot([r["l2_bytes"] for r in mine], [r["transient_writes"] / 1e3 for r in mine], linestyle=":",
                       color=line.get_color())
        a.set_title(os.path.basename(scene).removesuffix(".toml"))
        a.set_xscale("log", base=2)
        a.set_ylim(bottom=0)
        a.set_xticks(options.sizes, [points.name_of(s) for s in options.sizes], rotation=45)
        a.minorticks_off()
        a.set_xlabel("L2 of a tile")
    axes[0][0].set_ylabel("lines written to DRAM, thousands\n(dotted: before the frame's end)")
    axes[0][0].legend(fontsize=7)
    figure.tight_layout()
    return figure


def study():
    arguments, more = split_arguments(sys.argv[1:])
    p = points.parser("discard.py", __doc__)
    points.add_options(p, "keeps the figures of all points")
    p.add_argument("--share", default="tile", help="who shares a kd-tree")
    p.add_argument("--memory", default="", metavar="SIZES", help="bounds of what a frame keeps, with commas, beside none")
    options = points.checked(p.parse_args(arguments), more, "discard")
    options.memory = [None, *(part for part in options.memory.split(",") if part)]
    for part in options.memory[1:]:
        points.bytes_of(part)
    folder = points.Folder(options.folder, options.simulator)
    kinds = [(scene, size, discard, memory) for scene in options.scenes for memory in options.memory for size in options.sizes
             for discard in ("off", "on")]
    wanted = [(kind, seed) for kind in kinds for seed in options.seeds]
    asked = [point_of(options, kind, seed) for kind, seed in wanted]
    figures = folder.take_all(asked, options.jobs)
    runs = {}
    for (kind, _), f in zip(wanted, figures):
        runs.setdefault(kind, []).append(f)
    rows = rows_of(kinds, runs)
    show(rows)
    say(options, rows)
    points.name_large(options, asked, figures)
    points.write_tables(options, rows)
    points.draw(options, picture, rows)


if __name__ == "__main__":
    sys.exit(main(study))
