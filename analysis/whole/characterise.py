#!/usr/bin/python3
"""What the simulated Xeon and Niagara do with Razor's kernels, beside what was published of Razor on such machines.

    analysis/whole/characterise.py
    analysis/whole/characterise.py car.obj woman.obj --json c.json -- --size 48x48 --spp 1

Frames of the built-in scene and of the models given; what follows -- goes to every run (without, 64 x 64 pixels with a
shadow ray to the light and one to the sky for each).
The published ranges are those of Govindaraju et al. 2008 as an excerpt of its Table 2 gives them, of other scenes on real
machines: a value within its range is plausible, not proven, and no parameter was fitted to any of them.

Loads and stores are those that the L1 or a store buffer answers, over machine instructions: operands from memory are no
instructions of their own. Branches are a share of instructions. Spills and overhead are among them; one worker on the Xeon.
"Four lanes against one" and "out of order" are its cycles with core.lanes = 1, or core.window = 1 (source order, as the
compiler has it), over its own; with a window of 8, code that a compiler has reordered for a core in order, for comparison.
Instructions a cycle are those of a core, until the last of its threads has no more work: of one worker on the Xeon, of a
worker on every thread of Niagara, whose cores share a unit.
Exit code: 0, whatever lies within; 2 on a mistake.
"""
import argparse
import os
import shlex
import sys
import tempfile

import frames
from frames import Mistake, simulation

FRAME = ["--size", "64x64", "--spp", "1", "--light-samples", "1", "--sky-samples", "1"]


def branches(report):
    """Their share of machine instructions."""
    return sum(report["instructions_by_class"]["branch"].values()) / report["core"]["instructions"]


def references(report):
    """Loads and stores, operands from memory among them, a machine instruction."""
    of_l1 = sum(row["l1_reads"] + row["l1_writes"] for row in report["traffic"])
    return (of_l1 + report["core"]["forwarded_loads"]) / report["core"]["instructions"]


def ipc(report):
    """Of the cores with work, each until the last of its threads is done."""
    ends, instructions = {}, 0
    for thread in report["threads"]:
        if thread["instructions"]:
            core = thread["tile"], thread["core"]
            ends[core] = max(ends.get(core, 0), thread["finish"])
            instructions += thread["instructions"]
    return instructions / sum(ends.values())


# Name of a run: machine, settings.
RUNS = {
    "xeon": ("xeon", []),
    "one lane": ("xeon", ["core.lanes=1"]),
    "in order": ("xeon", ["core.window=1"]),
    "scheduled": ("xeon", ["core.window=8"]),
    "niagara": ("niagara", []),
}
# What, the published range or none, how it is written, what it is of the runs.
FIGURES = [
    ("loads and stores", (0.20, 0.27), "{:.1%}", lambda r: references(r["xeon"])),
    ("branches", (0.02, 0.07), "{:.1%}", lambda r: branches(r["xeon"])),
    ("four lanes against one", (3.1, 4.2), "{:.2f}", lambda r: r["one lane"]["cycles"] / r["xeon"]["cycles"]),
    ("out of order against in order", (2.6, 3.7), "{:.2f}", lambda r: r["in order"]["cycles"] / r["xeon"]["cycles"]),
    ("out of order against a window of 8", None, "{:.2f}", lambda r: r["scheduled"]["cycles"] / r["xeon"]["cycles"]),
    ("instructions a cycle, Xeon", (0.8, 1.2), "{:.2f}", lambda r: ipc(r["xeon"])),  # "near 1"
    ("instructions a cycle, Niagara", (0.3, 0.4), "{:.2f}", lambda r: ipc(r["niagara"])),
]


def verdict(value, limits):
    if limits is None:
        return "-"
    return "below" if value < limits[0] else "above" if value > limits[1] else "within"


def runs_of(options, scene, folder, progress):
    out = {}
    for name, (machine, settings) in RUNS.items():
        progress.say(f"{os.path.basename(scene or 'the built-in scene')}: {name}")
        file = getattr(options, machine)
        out[name] = frames.simulated(options.simulator, file, scene, options.more, options.workers[machine], settings, folder,
                                     "--no-native")
    progress.say("")
    return out


def parse(arguments):
    arguments, more = simulation.split_arguments(arguments)
    parser = argparse.ArgumentParser(prog="characterise.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see characterise.py --help"))
    parser.add_argument("scenes", nargs="*", metavar="MODEL")
    for name, file in (("xeon", "xeon-x5355-2s"), ("niagara", "niagara-like")):
        parser.add_argument(f"--{name}", default=os.path.join(frames.PROJECT, f"configs/machines/{file}.toml"), metavar="FILE")
    parser.add_argument("--simulator", metavar="PATH", help="razor-sim; else from the PATH or build/release")
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args(arguments)
    for scene in options.scenes:
        if not os.path.isfile(scene):
            raise Mistake(f"{scene}: no such file; give a model or a scene")
    options.more = more or FRAME
    simulation.check_writable("--json", options.json)
    options.simulator = simulation.simulator(options.simulator)
    chip = frames.configuration(options.simulator, options.niagara)["chip"]
    options.workers = {"xeon": 1, "niagara": chip["tiles"] * chip["cores"] * chip["threads"]}
    return options


def run(options):
    scenes = [None, *options.scenes]
    titles = ["built-in scene", *(os.path.splitext(os.path.basename(s))[0] for s in options.scenes)]
    progress, values = frames.Progress(), []
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            runs = runs_of(options, scene, folder, progress)
            values.append([figure(runs) for *_, figure in FIGURES])
    print(f"frames: {shlex.join(options.more)}\n\n| what | published | " + " | ".join(titles) + " |")
    print("|" + " --- |" * (len(titles) + 2))
    rows = []
    for i, (what, limits, form, _) in enumerate(FIGURES):
        published = f"{form.format(limits[0])} to {form.format(limits[1])}" if limits else "-"
        cells = [f"{form.format(v[i])} {verdict(v[i], limits)}" if limits else form.format(v[i]) for v in values]
        print(f"| {what} | {published} | " + " | ".join(cells) + " |")
        rows.append({"what": what, "published": limits,
                     "scenes": {t: {"value": v[i], "verdict": verdict(v[i], limits)} for t, v in zip(titles, values)}})
    if options.json:
        frames.write_json(options.json, {"command": shlex.join(["characterise.py", *sys.argv[1:]]), "figures": rows})


if __name__ == "__main__":
    sys.exit(simulation.main(lambda: run(parse(sys.argv[1:]))))
