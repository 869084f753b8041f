#!/usr/bin/python3
"""The whole simulator beside a host: frames rendered natively and simulated, and whether what takes longer here does there.

    analysis/whole/whole.py --machine configs/machines/golden-cove-2c.toml --scenes SCENES
    analysis/whole/whole.py --machine A.toml B.toml --scenes SCENES --repeat 5 --json whole.json
    analysis/whole/whole.py --machine A.toml --only "scene 64" "scene 64, fixed" --points mine.toml

SCENES is a folder of models; points.toml says which, with which settings and on how many workers. Points whose model is
not there, or with more workers than there are processors, are named and skipped. The kernels are those of --isa; without
it of the machine's calibration, else the host's best. Every point is rendered in each of --repeat turns, --frames frames
after a first, which analyses the topology (that is free in the simulator); its time is the median of the turns' medians,
its spread their least and largest. Times are processor seconds of one worker, or until the last of several is done. The
machine renders two frames and counts the second, so that its caches are as warm; --seeds of noise (sim.jitter) are its
spread. One kd-tree for all workers, on both sides. Both must have rendered the same picture.

Printed for each machine: a row for each point; Spearman's rank correlation and Kendall's tau-b of native and simulated
seconds, and of seconds a ray, which more work of the same kind does not raise, with 95 % bootstrap intervals over the
points; ratios simulated / native: their geometric mean, and how far they are from 1 and from that mean (a ratio r from c
by max(r/c, c/r) - 1); and pairs of points whose order differs though both spreads keep them apart. Exit code: 0; 2 on a
mistake.
"""
import argparse
import os
import shlex
import statistics
import sys
import tempfile
import tomllib

import frames
import ranks
from frames import Mistake, simulation, spread

KEYS = {"name": str, "model": str, "scene": str, "options": list, "workers": int}
WORDS = {str: "text in quotes", list: "list", int: "whole number"}


def read_points(path):
    try:
        with open(path, "rb") as file:
            points = tomllib.load(file).get("point", [])
    except OSError as failure:
        raise Mistake(f"--points {path}: {failure.strerror}") from failure
    except tomllib.TOMLDecodeError as failure:
        raise Mistake(f"{path}: {failure}") from failure
    if not isinstance(points, list) or not all(isinstance(p, dict) for p in points):
        raise Mistake(f"{path}: `point` is no list of tables; write [[point]] for each")
    names = set()
    for n, point in enumerate(points, 1):
        where = f"{path}: point {n}"
        if not isinstance(point.get("name"), str) or not point["name"] or point["name"] in names:
            raise Mistake(f"{where}: give it a name that no other has")
        names.add(point["name"])
        for key, value in point.items():
            if key not in KEYS:
                raise Mistake(f"{where} ({point['name']}): {key}: no such key; there are {', '.join(KEYS)}")
            if type(value) is not KEYS[key]:  # True is an int otherwise
                raise Mistake(f"{where} ({point['name']}): {key}: give a {WORDS[KEYS[key]]}")
        if not all(isinstance(word, str) for word in point.setdefault("options", [])):
            raise Mistake(f"{where} ({point['name']}): options: give words in quotes")
        if point.setdefault("workers", 1) < 1:
            raise Mistake(f"{where} ({point['name']}): workers: give a number from 1")
        if "model" in point and "scene" in point:
            raise Mistake(f"{where} ({point['name']}): give a model or a scene, not both")
    return points


def chosen_points(options):
    """Points to run, each with the file of its scene, and lines that say which are not and why."""
    points, skipped, out = read_points(options.points), [], []
    names = [p["name"] for p in points]
    for name in options.only or []:
        if name not in names:
            raise Mistake(f"--only {name}: no such point; there are {', '.join(names)}")
    processors = len(os.sched_getaffinity(0))
    for point in points:
        if options.only and point["name"] not in options.only:
            continue
        point["file"] = os.path.join(frames.PROJECT, point["scene"]) if "scene" in point else None
        if "model" in point:
            point["file"] = os.path.join(options.scenes or "", point["model"])
            if not options.scenes or not os.path.exists(point["file"]):
                skipped.append(f"{point['name']}: {point['model']} is not there" + ("" if options.scenes else "; give --scenes"))
                continue
        if point["workers"] > processors:
            skipped.append(f"{point['name']}: {point['workers']} workers on {processors} processor{'s' * (processors > 1)}")
            continue
        out.append(point)
    if len(out) < 2:
        raise Mistake("; ".join(["fewer than two points to compare", *skipped]))
    return out, skipped


def measure(options, points, isa, folder):
    """Fills in each point's native seconds and what its machines took."""
    progress = frames.Progress()
    try:
        for turn in range(options.repeat):
            for p in points:
                progress.say(f"native, turn {turn + 1} of {options.repeat}: {p['name']}")
                p["host"] = frames.native(options.razor, p["file"], p["options"], p["workers"], isa, options.frames, folder)
                p.setdefault("turns", []).append(statistics.median(p["host"]["frame_seconds"]))
        for p in points:
            p["native"] = spread(p["turns"])
            for machine in options.machine:
                progress.say(f"simulated on {os.path.basename(machine)}: {p['name']}")
                seconds = []
                for seed in range(options.seeds):
                    settings = [*options.g, *([f"sim.jitter={seed}"] if seed else [])]
                    report = frames.simulated(options.simulator, machine, p["file"], p["options"], p["workers"], settings,
                                              folder, "--frames", "2", "--share", "chip", *(["--no-native"] * (seed > 0)))
                    if seed == 0:
                        frames.check_same_frame(p["name"], p["host"], report)
                        p["rays"] = report["renderer"]["counters"]["rays"]
                    seconds.append(report["seconds"])
                p.setdefault("simulated", {})[machine] = spread(seconds)
    finally:
        progress.say("")


def compare(options, points, machine):
    """Everything that is said of one machine."""
    rows = [{"name": p["name"], "workers": p["workers"], "options": p["options"], "rays": p["rays"],
             "native_seconds": p["native"], "simulated_seconds": p["simulated"][machine],
             "ratio": p["simulated"][machine]["median"] / p["native"]["median"]} for p in points]
    native = [r["native_seconds"]["median"] for r in rows]
    modelled = [r["simulated_seconds"]["median"] for r in rows]
    out = {"machine": machine, "points": rows, **ranks.ratio_errors([r["ratio"] for r in rows]), "order": {}}
    lists = {"seconds": (native, modelled)}
    if all(r["rays"] for r in rows):
        lists["seconds a ray"] = tuple([t / r["rays"] for t, r in zip(values, rows)] for values in (native, modelled))
    for what, (a, b) in lists.items():
        out["order"][what] = {name: {"value": f(a, b), "interval": ranks.interval(a, b, f, options.resamples, options.seed)}
                              for name, f in (("spearman", ranks.spearman), ("kendall", ranks.kendall))}
    ends = [(r["name"], *((r[k]["least"], r[k]["largest"]) for k in ("native_seconds", "simulated_seconds"))) for r in rows]
    out["pairs"] = len(rows) * (len(rows) - 1) // 2
    out["disagreements"] = ranks.disagreements(ends)
    return out


def in_ms(times):
    return f"{times['median'] * 1e3:.2f} [{times['least'] * 1e3:.2f} .. {times['largest'] * 1e3:.2f}]"


def print_comparison(c):
    print(f"\n{c['machine']}\n\n| point | workers | native, ms | simulated, ms | ratio | over the mean |")
    print("| --- | --- | --- | --- | --- | --- |")
    for r in c["points"]:
        print(f"| {r['name']} | {r['workers']} | {in_ms(r['native_seconds'])} | {in_ms(r['simulated_seconds'])} | "
              f"{r['ratio']:.2f} | {r['ratio'] / c['common_factor']:.2f} |")
    print()
    for what, found in c["order"].items():
        for name, title in (("spearman", "Spearman's rank correlation"), ("kendall", "Kendall's tau-b")):
            value, ends = found[name]["value"], found[name]["interval"]
            said = f"{value:.3f} [{ends[0]:.3f} .. {ends[1]:.3f}]" if value is not None and ends else "not defined: all are equal"
            print(f"{title} of {what}: {said}")
    print(f"simulated / native: geometric mean {c['common_factor']:.3f}")
    for key, title in (("before", "ratios from 1"), ("after", "ratios from their mean")):
        print(f"{title}: {c[key]['mean']:.1%} off on average, {c[key]['largest']:.1%} at most")
    print(f"in another order beyond both spreads: {len(c['disagreements'])} of {c['pairs']} pairs")
    for a, b in c["disagreements"]:
        print(f"  {a} | {b}")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="whole.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see whole.py --help"))
    parser.add_argument("--machine", required=True, nargs="+", metavar="FILE")
    parser.add_argument("-g", action="append", default=[], metavar="KEY=VALUE", help="overrides a setting of all machines")
    parser.add_argument("--scenes", metavar="SCENES")
    parser.add_argument("--points", default=os.path.join(frames.HERE, "points.toml"), metavar="FILE")
    parser.add_argument("--only", nargs="+", metavar="POINT")
    parser.add_argument("--isa", metavar="NAME", help="of the native frames")
    for name, default, what in (("repeat", 5, "turns of native runs"), ("frames", 5, "timed a native run, after a first"),
                                ("seeds", 1, "of noise, simulated runs a point"), ("resamples", 2000, "of the bootstrap")):
        parser.add_argument(f"--{name}", type=int, default=default, metavar="N", help=what)
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the bootstrap")
    parser.add_argument("--razor", metavar="PATH")
    parser.add_argument("--simulator", metavar="PATH", help="razor-sim; both else from the PATH or build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args(arguments)
    for name in ("repeat", "frames", "seeds", "resamples"):
        if getattr(options, name) < 1:
            raise Mistake(f"--{name} {getattr(options, name)}: give a number from 1")
    if options.scenes is not None and not os.path.isdir(options.scenes):
        raise Mistake(f"--scenes {options.scenes}: no such folder; give that of the models")
    simulation.check_writable("--json", options.json)
    options.razor = frames.renderer(options.razor)
    options.simulator = simulation.simulator(options.simulator)
    return options


def target(options):
    """The one of all machines."""
    targets = {machine: frames.target_of(options.simulator, machine) for machine in options.machine}
    if options.isa:
        return options.isa
    if len(set(targets.values())) > 1:
        raise Mistake("machines of different instruction sets: " + ", ".join(f"{m} {t}" for m, t in targets.items()) +
                      "; give --isa, or one machine")
    return targets[options.machine[0]]


def run(options):
    isa = target(options)
    points, skipped = chosen_points(options)
    for line in skipped:
        print(f"skipped: {line}", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        measure(options, points, isa, folder)
    comparisons = [compare(options, points, machine) for machine in options.machine]
    used = points[0]["host"]["statistics"]["target"]["isa"]
    print(f"native frames: {used}, {options.repeat} turns of {options.frames} frames")
    for c in comparisons:
        print_comparison(c)
    if options.json:
        frames.write_json(options.json, {"command": shlex.join(["whole.py", *sys.argv[1:]]), "isa": used, "skipped": skipped,
                                         "machines": comparisons})


if __name__ == "__main__":
    sys.exit(simulation.main(lambda: run(parse(sys.argv[1:]))))
