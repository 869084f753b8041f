#!/usr/bin/python3
"""Who should share a kd-tree? Frames by several workers, each with a tree of its own, or groups of them with one.

    analysis/sharing/sharing.py configs/scenes/courtyard.toml configs/scenes/forest.toml --workers 1,2,4 --size 512x512

For each scene, number of workers and way of sharing: seconds of a frame and processor seconds of all threads, both medians of
--repeat frames whose topology is analysed (ways take turns, so that what else the host does harms all alike); what was built
more than once, as shares of what was built (kd nodes, blocks); megabytes that the frame built, and that the process held at
most. All pictures of a scene must be the same, bit for bit. Further options are those of `razor render`.
"""
import argparse
import json
import os
import shutil
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../levels"))
import view  # noqa: E402


def ways(workers):
    """From a tree for each worker to one for all."""
    groups = [1]
    while groups[-1] * 2 < workers:
        groups.append(groups[-1] * 2)
    return ["chip"] if workers == 1 else ["worker"] + [str(n) for n in groups[1:]] + ["chip"]


def frame(options, scene, workers, share, folder):
    stats, picture = os.path.join(folder, "s.json"), os.path.join(folder, f"{workers}_{share}.exr")
    _, usage = view.run([options.razor, "render", scene, *options.render, "--size", options.size, "--threads", str(workers), "--share", share,
                         "--repeat", "2", "--stats", stats, "-o", picture])
    with open(stats) as file:
        figures = json.load(file)["statistics"]
    built, time = figures["built"], figures["host"]["frames"][-1]
    return {"picture": picture, "seconds": time["render_seconds"], "processor_seconds": time["render_processor_seconds"],
            "duplicate_nodes": figures["duplicates"]["kd_nodes"] / max(1, built["inner_nodes"] + built["leaves"]),
            "duplicate_blocks": figures["duplicates"]["blocks"] / max(1, figures["counters"]["blocks_made"]),
            "built_bytes": sum(built[key] for key in ("grid_bytes", "node_bytes", "list_bytes", "patch_table_bytes")),
            "most_bytes": usage.ru_maxrss * 1024}


def study(options, scene):
    rows = []
    kinds = [(workers, share) for workers in options.workers for share in ways(workers)]
    with tempfile.TemporaryDirectory() as folder:
        runs = {kind: [] for kind in kinds}
        for _ in range(options.repeat):
            for kind in kinds:
                runs[kind].append(frame(options, scene, *kind, folder))
        pictures = [runs[kind][0]["picture"] for kind in kinds]
        for other in pictures[1:]:
            view.run([options.razor, "compare", pictures[0], other, "--identical"])
    for workers, share in kinds:
        made = runs[workers, share]
        rows.append({"scene": os.path.basename(scene), "workers": workers, "share": share,
                     **{key: statistics.median(m[key] for m in made) for key in made[0] if key != "picture"}})
    return rows


def show(rows):
    print(f"{'scene':20} {'workers':>7} {'share':>7} {'seconds':>8} {'processor':>9} {'dup. nodes':>10} {'dup. blocks':>11}"
          f" {'built MB':>9} {'most MB':>8}")
    for r in rows:
        print(f"{r['scene'][:20]:20} {r['workers']:7} {r['share']:>7} {r['seconds']:8.3f} {r['processor_seconds']:9.3f}"
              f" {100 * r['duplicate_nodes']:9.1f}% {100 * r['duplicate_blocks']:10.1f}% {r['built_bytes'] / 1e6:9.1f}"
              f" {r['most_bytes'] / 1e6:8.1f}", flush=True)


def numbers(text):
    try:
        values = [int(x) for x in text.split(",")]
    except ValueError:
        values = []
    if not values or min(values) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' are no numbers of workers; write for example 1,2,4")
    return values


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--workers", type=numbers, default=[1, 2, 4])
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--json", metavar="FILE")
    options, options.render = parser.parse_known_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    rows = [row for scene in options.scenes for row in study(options, scene)]
    show(rows)
    if options.json:
        try:
            with open(options.json, "w") as file:
                json.dump(rows, file, indent=1)
                file.write("\n")
        except OSError as error:
            view.fail(f"{options.json}: {error.strerror}; give a file in a folder that is there")


if __name__ == "__main__":
    view.run_program(main)
