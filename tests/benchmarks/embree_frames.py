#!/usr/bin/python3
"""A frame of each scene by Razor and by Embree, pose to picture with every build, in turn.

    tests/benchmarks/embree_frames.py configs/scenes/*.toml --frame 40
    tests/benchmarks/embree_frames.py configs/scenes/forest.toml --size 512x512 --repeat 3 --pictures build/pictures

Embree draws the same scene, through the same camera, with the same samples of film, lens, lights and sky and the same shading
(tests/benchmarks/embree). It gets every advantage that keeps the frame what it is: cages are tessellated at fixed levels, by each
of several rules (--levels): uniform, every patch 2^K x 2^K quads; deviation, each instance as its mesh deviates from the surface,
in pixels at its nearest point; instance and mesh, by the length of edges there. Of each rule the lowest K is taken whose picture
is no further from the reference than Razor's, neither by RMSE nor by the mean of HDR-FLIP. The reference is Razor's picture at a
quarter of the edge length (--reference), or with --reference-finer Embree's; samples are the same, so that pictures differ by
geometry alone, but for last bits and the few rays that they turn: errors up to --least-error count as none. Of these Ks Embree
then draws instances as such and flattened, with BVHs of each --quality, and its fastest way is measured in turn with Razor.

Seconds are medians of --repeat frames (topology analysed, weights of limit points made); in brackets the shortest and longest;
processor seconds are of all threads. Megabytes: what a frame builds (vertices and BVHs; grids, kd-trees and lists), and what
outlives it (weights of limit points). Further options are those of `razor render` that choose and override a scene.
"""
import argparse
import json
import os
import shutil
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../analysis/levels"))
import view  # noqa: E402


def read_json(name):
    with open(name) as file:
        return json.load(file)


class Scene:
    """One scene's pictures and figures; pictures that are there already are kept."""

    def __init__(self, options, scene, folder):
        self.options, self.scene, self.folder = options, scene, folder
        self.name = os.path.basename(scene).removesuffix(".toml")
        self.frame = [scene, "--frame", str(options.frame), "--size", options.size, *options.more]

    def file(self, what):
        return os.path.join(self.folder, f"{self.name}_{what}")

    def razor_picture(self, what, *more):
        picture = self.file(what + ".exr")
        if not os.path.exists(picture):
            view.run([self.options.razor, "render", *self.frame, "--threads", str(self.options.threads), "--quiet",
                      "-o", picture, *more])
        return picture

    def embree(self, *more):
        """Figures of the baseline."""
        figures = self.file("figures.json")
        view.run([self.options.embree, *self.frame, "--threads", str(self.options.threads), "--json", figures, *more])
        return read_json(figures)

    def embree_picture(self, levels, finer):
        picture = self.file(f"embree_{levels}_{finer}.exr")
        if not os.path.exists(picture):
            self.embree("--levels", levels, "--finer", str(finer), "--repeat", "0", "-o", picture)
        return picture

    def error(self, picture, reference):
        figures = self.file("compare.json")
        view.run([self.options.razor, "compare", picture, reference, "--json", figures])
        found = read_json(figures)
        return found["rmse"], found["flip"]["mean"]


def choose(scene, levels, ours, reference):
    """The lowest K of a rule whose error is not above Razor's, if there is one, and the errors on the way."""
    options = scene.options
    errors = {}
    first, last = (0, 8) if levels == "uniform" else options.finer
    for finer in range(first, last + 1):
        errors[finer] = scene.error(scene.embree_picture(levels, finer), reference)
        if all(theirs <= max(mine, options.least_error) for theirs, mine in zip(errors[finer], ours)):
            return finer, errors
    return None, errors


def median(runs, key):
    values = [run[key] for run in runs]
    return statistics.median(values), min(values), max(values)


def fastest_way(scene, chosen):
    options = scene.options
    ways = [["--levels", levels, "--finer", str(finer), "--quality", quality, "--flatten", str(flatten)]
            for levels, finer in chosen.items() if finer is not None for quality in options.quality for flatten in options.flatten]
    if not ways:
        view.fail(f"{scene.scene}: no level is as near to the reference as Razor; let --finer end later")
    seconds = []
    for way in ways:
        made = scene.embree("--repeat", str(options.tries), *way)
        seconds.append(median(made["embree"]["runs"], "processor_seconds")[0])
    return ways[seconds.index(min(seconds))], {" ".join(way): s for way, s in zip(ways, seconds)}


def study(options, path, folder):
    scene = Scene(options, path, folder)
    if options.reference_finer is None:
        reference = scene.razor_picture("reference", "--edge-pixels", str(options.reference))
    else:
        reference = scene.embree_picture("deviation", options.reference_finer)
    ours = scene.error(scene.razor_picture("razor"), reference)
    found = {levels: choose(scene, levels, ours, reference) for levels in options.levels}
    way, tried = fastest_way(scene, {levels: finer for levels, (finer, _) in found.items()})
    made = scene.embree("--repeat", str(options.repeat), "--razor", *way)
    return {"scene": scene.name, "way": way, "tried": tried, "rmse": ours[0], "flip": ours[1],
            "levels": {levels: {"finer": finer, "rmse": {k: e[0] for k, e in errors.items()}, "flip": {k: e[1] for k, e in errors.items()}}
                       for levels, (finer, errors) in found.items()},
            "embree": made["embree"], "razor": made["razor"]}


def spread(runs, key):
    middle, low, high = median(runs, key)
    return f"{middle:8.3f} [{low:.3f} {high:.3f}]"


def show(row):
    e, r = row["embree"], row["razor"]
    print(f"{row['scene']}: RMSE of Razor {row['rmse']:.5f}, FLIP {row['flip']:.5f}")
    for levels, of in row["levels"].items():
        last = list(of["rmse"])[-3:]
        print(f"  Embree {levels}: RMSE " + ", ".join(f"{of['rmse'][k]:.5f} at {k}" for k in last) +
              (f", FLIP {of['flip'][of['finer']]:.5f}; fastest " + "{:.3f} s".format(
                  min(s for way, s in row["tried"].items() if f"--levels {levels} " in way)) if of["finer"] is not None else "; too far"))
    print(f"  {' '.join(row['way'])}: {e['made']['triangles']:,} triangles, "
          f"{e['made']['instanced_triangles']:,} with instances; Razor made {r['made']['triangles']:,}")
    print(f"  {'':8} {'seconds':24} {'processor':24} {'pose':>7} {'tessel.':>7} {'build':>7} {'trace':>7} {'MB a frame':>10} {'MB kept':>8}")
    part = {key: median(e["runs"], key)[0] for key in ("pose", "tessellate", "build", "trace")}
    print(f"  {'Embree':8} {spread(e['runs'], 'seconds'):24} {spread(e['runs'], 'processor_seconds'):24} {part['pose']:7.3f} "
          f"{part['tessellate']:7.3f} {part['build']:7.3f} {part['trace']:7.3f} "
          f"{(e['made']['bvh_bytes'] + e['made']['vertex_bytes']) / 1e6:10.1f} {e['made']['topology_bytes'] / 1e6:8.1f}")
    part = {key: median(r["runs"], key)[0] for key in ("pose", "render")}
    print(f"  {'Razor':8} {spread(r['runs'], 'seconds'):24} {spread(r['runs'], 'processor_seconds'):24} {part['pose']:7.3f} "
          f"{'':>7} {part['render']:>15.3f} {r['made']['bytes'] / 1e6:10.1f} {r['made']['page_bytes'] / 1e6:8.1f}")
    ratios = [median(r["runs"], key)[0] / median(e["runs"], key)[0] for key in ("seconds", "processor_seconds")]
    print(f"  Razor takes {ratios[0]:.2f} times Embree's seconds, {ratios[1]:.2f} times its processor's", flush=True)


def integers(text):
    try:
        return [int(x) for x in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' are no numbers; write for example 0,1000000") from None


def span(text):
    ends = text.split(":")
    try:
        first, last = (int(x) for x in ends)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no span of levels; write for example -6:0") from None
    return first, last


def read_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("scenes", nargs="+", metavar="SCENE.toml")
    parser.add_argument("--frame", type=int, default=0)
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=5, help="frames of each that count")
    parser.add_argument("--tries", type=int, default=1, help="frames of each way of Embree's, to find its fastest")
    parser.add_argument("--levels", default="uniform,deviation", type=lambda text: text.split(","), help="rules to try: uniform, deviation, instance, mesh")
    parser.add_argument("--finer", type=span, default=(-5, 2), metavar="FIRST:LAST", help="K to try, the coarsest first; of uniform 0:8")
    parser.add_argument("--reference", type=float, default=0.25, metavar="PIXELS", help="edges of Razor's reference")
    parser.add_argument("--reference-finer", type=int, metavar="K", help="make the reference by Embree at this K of --levels deviation")
    parser.add_argument("--least-error", type=float, default=0.0003, metavar="X", help="RMSE and FLIP that pictures of one geometry may have")
    parser.add_argument("--quality", default="low,medium", type=lambda text: text.split(","), help="of Embree's BVHs: low, medium, high")
    parser.add_argument("--flatten", default=[0, 20_000_000], type=integers, metavar="N,...", help="triangles up to which instances are flattened")
    parser.add_argument("--pictures", metavar="FOLDER", help="keep pictures there, and take those that are; of the same options")
    parser.add_argument("--razor", help="the renderer; without it, that of the PATH or of build/release")
    parser.add_argument("--embree", default="build/release/tests/benchmarks/embree_frame", metavar="embree_frame")
    parser.add_argument("--json", metavar="FILE")
    options, options.more = parser.parse_known_args()
    options.razor = options.razor or shutil.which("razor") or "build/release/razor/program/razor"
    return options


def main():
    options = read_options()
    with tempfile.TemporaryDirectory() as folder:
        if options.pictures:
            os.makedirs(options.pictures, exist_ok=True)
        rows = []
        for scene in options.scenes:
            rows.append(study(options, scene, options.pictures or folder))
            show(rows[-1])
    if options.json:
        try:
            with open(options.json, "w") as file:
                json.dump(rows, file, indent=1)
                file.write("\n")
        except OSError as error:
            view.fail(f"{options.json}: {error.strerror}; give a file in a folder that is there")


if __name__ == "__main__":
    view.run_program(main)
