#!/usr/bin/python3
"""Who should share a kd-tree, by machine, workers and the size of its caches, in the simulator.

    analysis/sharing/simulated.py FOLDER [--scenes courtyard,interior,forest,showcase] [--l2 256KiB,1MiB,4MiB] [--seeds 1,2]
                                  [--full] [--jobs 2] [-- more options of razor-sim run]

A table: for two tiles of copernicus and for zen4-2c, numbers of workers and ways of sharing (nobody, a core's, a tile's, all):
cycles of the frame and of work, what was built more than once, bytes built, lines from DRAM and to it. Then the same for all
workers of copernicus with L2s of other sizes: which way is the cheapest at each, and where that changes; a plot. Points are crops
from the middle of each scene's picture: a part of its screen tiles, with the footprints of the whole. Work is what the threads
took without waiting for the last one to end, which in a crop of few tiles is chance. Each point is run once for each seed of
noise, and ways that lie no farther apart than these runs leave open are not told apart.

FOLDER keeps the figures of each point: a study that was stopped goes on where it was, one with other options runs what is
missing. The plot, CSV and JSON go there too (simulated.svg, .csv, .json), unless --output, --csv, --json say where else.
Without --full copernicus's tiles have one core of two threads; with it, eight of four. Exit code: 0; 2 on a mistake;
130 after Ctrl-C.
"""
import math
import os
import sys

import points
from points import best_of, mean, width
from simulation import main, split_arguments

TREES = {"nobody": "a tree each", "a core's": "a tree for each core", "a tile's": "a tree for each tile", "all": "one tree for all"}
NAMES = {"worker": "nobody", "core": "a core's", "tile": "a tile's", "chip": "all"}
COLUMNS = ("cycles", "work_cycles", "operations", "waiting", "duplicate_nodes", "duplicate_blocks", "built_bytes", "dram_reads",
           "dram_writes")


def kinds_of(options):
    """Of the table and of the curve: (machine, scene, workers, way, size of the L2 or none)."""
    table = [(name, scene, workers, way, None) for name, m in options.machines.items() for scene in options.scenes
             for workers in m["workers"] for way in (m["ways"] if workers > 1 else m["ways"][-1:])]
    m = options.machines["copernicus"]
    curve = [("copernicus", scene, m["workers"][-1], way, size) for scene in options.scenes for size in options.sizes
             for way in m["ways"]]
    return table, curve


def point_of(options, kind, seed):
    name, scene, workers, way, size = kind
    at = f", L2 of {points.name_of(size)}" if size else ""
    return points.point(f"{name}, {os.path.basename(scene)}, {workers} workers, {NAMES[way]}{at}", options.machines[name],
                        points.scene_file(scene), options.crops[scene], ["--share", way, *options.more],
                        [f"l2.size_bytes={size}"] if size else [], workers, seed, options.frame)


def rows_of(kinds, runs):
    rows = []
    for kind in kinds:
        name, scene, workers, way, size = kind
        rows.append({"machine": name, "scene": scene, "workers": workers, "share": way, "l2_bytes": size or "",
                     "runs": len(runs[kind]), **{key: mean(runs[kind], key) for key in COLUMNS},
                     "work_cycles_half_width": width(runs[kind], "work_cycles")})
    return rows


def cheapest(runs, kind):
    """Which ways are the cheapest, where all else is as in `kind`."""
    ways = {other[3]: made for other, made in runs.items() if other[:3] == kind[:3] and other[4] == kind[4]}
    return best_of(ways, "work_cycles") if len(ways) > 1 else []


def show(kinds, runs):
    print(f"{'machine':11} {'scene':10} {'workers':>7} {'share':>8} {'L2':>8} {'M cycles':>9} {'work, M':>8} {'+-':>6} {'':8}"
          f" {'waiting':>7} {'dup. nodes, blocks':>18} {'built MB':>8} {'DRAM reads':>11} {'writes, M':>9}")
    for kind in kinds:
        name, scene, workers, way, size = kind
        made = runs[kind]
        best = cheapest(runs, kind)
        word = "cheapest" if best == [way] else "or this" if way in best else ""
        f = {key: mean(made, key) for key in COLUMNS}
        print(f"{name:11} {os.path.basename(scene)[:10]:10} {workers:7} {NAMES[way]:>8} {points.name_of(size) if size else '':>8}"
              f" {f['cycles'] / 1e6:9.2f} {f['work_cycles'] / 1e6:8.2f} {width(made, 'work_cycles') / 1e6:6.2f} {word:8}"
              f" {100 * f['waiting']:6.1f}% {100 * f['duplicate_nodes']:9.1f}% {100 * f['duplicate_blocks']:6.1f}%"
              f" {f['built_bytes'] / 1e6:8.1f} {f['dram_reads'] / 1e6:11.3f} {f['dram_writes'] / 1e6:9.3f}")


def crossings(sizes, one, other):
    """Sizes at which one way's means come to lie on the other side of another's, read off straight lines in logarithms; by
    {size: runs}. Only from where they differ by more than chance to where they do again."""
    out, before = [], None
    for size in sizes:
        a, b = mean(one[size], "work_cycles"), mean(other[size], "work_cycles")
        chance = points.chance.of_difference(width(one[size], "work_cycles"), width(other[size], "work_cycles"))
        if abs(a - b) <= chance or a == b:
            continue
        ratio = math.log(a / b)
        if before and before[1] * ratio < 0:
            part = before[1] / (before[1] - ratio)
            out.append((math.exp(math.log(before[0]) + part * math.log(size / before[0])), ratio < 0))
        before = (size, ratio)
    return out


def say_crossovers(options, runs):
    """Of each scene: where which way is the cheapest, and where it becomes another than all sharing."""
    m = options.machines["copernicus"]
    for scene in options.scenes:
        of = {way: {size: runs["copernicus", scene, m["workers"][-1], way, size] for size in options.sizes} for way in m["ways"]}
        spans = []
        for size in options.sizes:
            best = tuple(best_of({way: of[way][size] for way in m["ways"]}, "work_cycles"))
            if spans and spans[-1][0] == best:
                spans[-1][2] = size
            else:
                spans.append([best, size, size])
        said = "; ".join(f"{' or '.join(NAMES[w] for w in best)} ({points.name_of(a)}" + (f" to {points.name_of(b)})" if b != a else ")")
                         for best, a, b in spans)
        print(f"{os.path.basename(scene)}: the cheapest: {said}")
        for way in m["ways"][:-1]:
            for at, wins in crossings(options.sizes, of[way], of["chip"]):
                print(f"{os.path.basename(scene)}: trees of {NAMES[way]} become {'cheaper' if wins else 'dearer'} than one for all at"
                      f" an L2 of {at / points.KIB:.0f} KiB")
            if not crossings(options.sizes, of[way], of["chip"]):
                print(f"{os.path.basename(scene)}: trees of {NAMES[way]} and one for all: no crossover")


def picture(pyplot, options, runs):
    m = options.machines["copernicus"]
    figure, axes = pyplot.subplots(2, len(options.scenes), figsize=(3.2 * len(options.scenes) + 0.6, 5.6), squeeze=False, sharex=True)
    for column, scene in enumerate(options.scenes):
        for way in m["ways"]:
            made = [runs["copernicus", scene, m["workers"][-1], way, size] for size in options.sizes]
            axes[0][column].errorbar(options.sizes, [mean(r, "work_cycles") / 1e6 for r in made],
                                     [width(r, "work_cycles") / 1e6 for r in made], marker="o", markersize=3, capsize=2,
                                     label=NAMES[way])
            axes[1][column].plot(options.sizes, [(mean(r, "dram_reads") + mean(r, "dram_writes")) / 1e6 for r in made], marker="o",
                                 markersize=3, label=NAMES[way])
        axes[0][column].set_title(os.path.basename(scene).removesuffix(".toml"))
        for row in (0, 1):
            a = axes[row][column]
            a.set_xscale("log", base=2)
            a.set_xticks(options.sizes, [points.name_of(s) for s in options.sizes], rotation=45)
            a.minorticks_off()
        axes[1][column].set_yscale("log")  # work hardly differs by the size, traffic by several times
        axes[1][column].yaxis.set_major_locator(pyplot.matplotlib.ticker.LogLocator(10, subs=(1, 2, 3, 5, 7)))
        axes[1][column].yaxis.set_minor_locator(pyplot.matplotlib.ticker.NullLocator())
        axes[1][column].yaxis.set_major_formatter("{x:g}")
    axes[0][0].set_ylabel("work of a worker, million cycles")
    axes[1][0].set_ylabel("lines from and to DRAM, millions")
    for a in axes[1]:
        a.set_xlabel("L2 of a tile")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, [TREES[label] for label in labels], loc="upper center",
                  ncol=len(labels), frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.95))
    return figure


def study():
    arguments, more = split_arguments(sys.argv[1:])
    p = points.parser("simulated.py", __doc__)
    points.add_options(p, "keeps the figures of all points")
    options = points.checked(p.parse_args(arguments), more, "simulated")
    folder = points.Folder(options.folder, options.simulator)
    table, curve = kinds_of(options)
    kinds = [*table, *curve]
    wanted = [(kind, seed) for kind in kinds for seed in options.seeds]
    asked = [point_of(options, kind, seed) for kind, seed in wanted]
    figures = folder.take_all(asked, options.jobs)
    runs = {}
    for (kind, _), f in zip(wanted, figures):
        runs.setdefault(kind, []).append(f)
    show(kinds, runs)
    say_crossovers(options, runs)
    points.name_large(options, asked, figures)
    points.write_tables(options, rows_of(kinds, runs))
    points.draw(options, picture, runs)


if __name__ == "__main__":
    sys.exit(main(study))
