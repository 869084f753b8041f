#!/usr/bin/python3
"""What laziness spares: one scene rendered as rays ask, and with all that they could ask for built first (--eager).

    analysis/levels/laziness.py map.obj --scheme bilinear --up z --from 1344,150,-300 --to 1344,120,700
    analysis/levels/laziness.py city.instances --array 9,1,9 --spacing 17,0,15 --from 66,0.3,67 --to 66,0.3,55 --fov 50

Shares are of what the scene has (graph nodes, instances, clusters, patches) or of what the eager frame built (blocks, kd
nodes). Seconds are of one thread: processor time of the frame (boxes refitted, everything built, every ray), and the time
until the first packet of camera rays is shaded, both the medians of --repeat runs. Memory: what the frame built, and the
most that the process held. Both pictures must be the same.
"""
import argparse
import shutil
import statistics
import tempfile

import view


def built_bytes(figures):
    built = figures["built"]
    return sum(built[key] for key in ("grid_bytes", "node_bytes", "list_bytes", "patch_table_bytes", "topology_page_bytes"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)
    view.add_options(parser, "256x256", 3)
    options, options.scene = parser.parse_known_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        scene = view.write_scene(options, f"{folder}/scene.toml")
        runs = {"lazy": [], "eager": []}
        for _ in range(options.repeat):
            runs["lazy"].append(view.render(options, scene, folder, "lazy"))
            runs["eager"].append(view.render(options, scene, folder, "eager", "--eager"))
        view.run([options.razor, "compare", runs["lazy"][0][0], runs["eager"][0][0], "--identical"])
        for name, made in runs.items():
            figures = made[0][1]
            opened = figures["opened"]
            rows[name] = {
                **{key: opened[key]["count"] for key in ("graph_nodes", "instances", "clusters", "patches")},
                **{key + "_in_all": opened[key]["of"] for key in ("graph_nodes", "instances", "clusters", "patches")},
                "blocks": figures["counters"]["blocks_made"],
                "kd_nodes": opened["kd_nodes"]["count"],
                "first_packet_seconds": statistics.median(m[1]["host"]["first_packet_seconds"] for m in made),
                "frame_seconds": statistics.median(m[1]["host"]["frames"][0]["render_processor_seconds"] for m in made),
                "built_bytes": built_bytes(figures),
                "most_bytes": max(m[2].ru_maxrss for m in made) * 1024,
            }
    show(rows["lazy"], rows["eager"])
    view.write_rows(rows, options.json)


def show(lazy, eager):
    print(f"{'':22} {'lazy':>12} {'eager':>12} {'share':>8}")
    for key in ("graph_nodes", "instances", "clusters", "patches", "blocks", "kd_nodes"):
        print(f"{key.replace('_', ' '):22} {lazy[key]:12d} {eager[key]:12d} {lazy[key] / max(eager[key], 1):8.1%}")
    for key, unit in (("first_packet_seconds", 1), ("frame_seconds", 1), ("built_bytes", 1e6), ("most_bytes", 1e6)):
        text = key.replace("_", " ").replace("bytes", "MB")
        print(f"{text:22} {lazy[key] / unit:12.4g} {eager[key] / unit:12.4g} {lazy[key] / eager[key]:8.1%}")


if __name__ == "__main__":
    view.run_program(main)
