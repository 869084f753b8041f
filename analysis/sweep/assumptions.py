#!/usr/bin/python3
"""Does a conclusion hang on what a machine file assumes? Two designs compared, every assumed number halved and doubled.

    analysis/sweep/assumptions.py --machine configs/machines/tiny.toml --designs kdtree.share=chip kdtree.share=worker -- --size 64x64 --spp 1
    analysis/sweep/assumptions.py --machine M.toml --designs l2.size_bytes=1MiB l2.size_bytes=2MiB --only memory l2 --csv a.csv
    analysis/sweep/assumptions.py configs/studies/assumptions-copernicus.toml -o out/assumptions-copernicus --jobs 2

A study (assumptions_study.py says how it reads) ends in a page, FOLDER/study.html, with the tornado (study.png too, where
Debian's python3-matplotlib is), and study.csv. FOLDER/runs keeps what has been run: the same command goes on after whatever
stopped it.

The conclusion is which design takes fewer cycles, if they differ by more than what an irrelevant change may move. That is
measured: both designs run --seeds times with sim.jitter, their ratio is the mean, and noise two standard deviations of it;
or --noise says it in percent. A row for each change: cycles of the first design over those with
nothing changed; the second design's over the first's; and what became of the conclusion: it stays, is lost (no design
is better beyond noise any more), appears (where there was none), or flips. Rows are in order of how far the change moves
the designs apart or together; the first row of --csv is the run with nothing changed; plot.py draws that file. What
cannot be halved (1, or what other parameters forbid) is named at the end. Numbers that take no part in time (energies)
and the simulator's own are left out. What follows -- goes to every run of `razor-sim run`.

Exit code: 0; 1 if the conclusion flips anywhere; 2 on a mistake; 130 after Ctrl-C.
"""
import argparse
import functools
import os
import statistics
import sys
import tempfile

import assumptions_study
import simulation
from simulation import Mistake

FACTORS = [0.5, 2]
TOP = 24  # bars of a page's tornado
WITHOUT_TIME = ("energy.", "sim.")  # beginnings of keys
ENERGIES = ("_pj", "_mw")  # ends of keys


def assumed_numbers(report, designs):
    """Key and value of each, but for what the designs set themselves."""
    own = {setting.partition("=")[0] for setting in designs}
    for key, origin in report["machine_provenance"].items():
        group, name = key.split(".", 1)
        value = report["machine"].get(group, {}).get(name)
        if (origin.get("mark") != "assumed" or key in own or key.startswith(WITHOUT_TIME) or key.endswith(ENERGIES)
                or isinstance(value, bool) or not isinstance(value, (int, float)) or value == 0):
            continue
        yield key, value


def changed(value, factor):
    """The number halved or doubled, of its own kind; None where that leaves it as it is, or makes it 0."""
    new = int(value * factor) if isinstance(value, int) else value * factor
    return new if new not in (value, 0) else None


def conclusion(ratio, noise):
    """Which of the designs is better: -1 the second, 1 the first, 0 neither."""
    return 0 if abs(ratio - 1) <= noise else 1 if ratio > 1 else -1


def verdict(before, after):
    if before == after:
        return "stays"
    return "FLIPS" if before * after < 0 else "lost" if after == 0 else "appears"


def measure(options):
    """Rows, the unchanged ratio, its noise, and what could not be changed, with the reason."""
    with tempfile.TemporaryDirectory() as folder, simulation.Pool(options.jobs) as pool:

        def start(*settings):
            return [pool.submit(options.run, options.simulator, options.machine, [design, *settings], options.more,
                                tempfile.mkdtemp(dir=folder)) for design in options.designs]

        seeds = range(1, options.seeds + 1) if options.noise is None else [0]
        pairs = [start(f"sim.jitter={s}") if s else start() for s in seeds]
        simulation.show_progress([run for pair in pairs for run in pair], may_fail=False)
        pairs = [[run.result() for run in pair] for pair in pairs]
        base = pairs[0][0]
        ratios = [b["cycles"] / a["cycles"] for a, b in pairs]
        first, unchanged = statistics.mean(a["cycles"] for a, _ in pairs), statistics.mean(ratios)
        noise = 2 * statistics.stdev(ratios) if options.noise is None else options.noise / 100
        pending, refused = [], []
        for key, value in assumed_numbers(base, options.designs):
            if options.only and not key.startswith(tuple(options.only)):
                continue
            for factor in FACTORS:
                new = changed(value, factor)
                if new is None:
                    refused.append((key, factor, f"{value} is the least"))
                else:
                    pending.append((key, factor, value, new, start(f"{key}={new}")))
        if not pending:
            raise Mistake("no assumed number is left to change; see --only, and the marks of the machine file")
        rows = []
        simulation.show_progress([run for *_, runs in pending for run in runs], may_fail=True)
        for key, factor, value, new, runs in pending:
            try:
                a, b = (r.result()["cycles"] for r in runs)
            except Mistake as mistake:
                refused.append((key, factor, str(mistake).rpartition(": ")[2]))
                continue
            rows.append({"key": key, "value": value, "changed": new, "first": a / first, "ratio": b / a,
                         "verdict": verdict(conclusion(unchanged, noise), conclusion(b / a, noise)),
                         "noise": noise})
    rows.sort(key=lambda r: -abs(r["ratio"] / unchanged - 1))
    return rows, unchanged, noise, refused


def told(options, rows, ratio, noise, refused):
    """The table, a line of conclusion before and after it."""
    first, second = options.designs
    better = {-1: f"{second} is better", 0: "neither is better", 1: f"{first} is better"}
    out = [f"{second} takes {ratio:.3f} of the cycles of {first}: {better[conclusion(ratio, noise)]}"
          f" (noise {100 * noise:.3g} %{'' if options.noise is not None else f', of {options.seeds} seeds'})"]
    width = max(len(r["key"]) for r in rows) + 1
    out.append(f"{'assumed':<{width}}{'value':>12}{'changed':>12}{'first':>9}{'ratio':>9}  conclusion")
    for r in rows:
        out.append(f"{r['key']:<{width}}{r['value']:>12g}{r['changed']:>12g}{r['first']:>9.3f}{r['ratio']:>9.3f}  {r['verdict']}")
    if refused:
        out.append("not changed: " + "; ".join(f"{key} x {factor:g} ({why})" for key, factor, why in refused))
    counts = [f"{words} in {sum(r['verdict'] == verdict for r in rows)}" for verdict, words in
              (("stays", "stays"), ("lost", "is lost"), ("appears", "appears"), ("FLIPS", "flips"))]
    out.append(f"of {len(rows)} changes the conclusion {', '.join(counts)}")
    return out


def parse_study(arguments):
    """Of a study's file; its folder is where its results are."""
    parser = argparse.ArgumentParser(prog="assumptions.py", allow_abbrev=False, exit_on_error=False)
    parser.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see assumptions.py --help"))
    parser.add_argument("study", metavar="STUDY.toml")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="without it, out/ and the study's name")
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--jobs", default="1", metavar="N")
    parser.add_argument("--simulator", metavar="PATH")
    given = parser.parse_args(arguments)
    study = assumptions_study.read(given.study, given.full)
    name = os.path.splitext(os.path.basename(given.study))[0]
    folder = given.output or os.path.join("out", name)
    kept = assumptions_study.Kept(os.path.join(folder, "runs"))
    own, more = assumptions_study.arguments(given.study, study)
    own += ["--jobs", given.jobs, "--csv", os.path.join(folder, "study.csv")]
    options = parse([*own, *(["--simulator", given.simulator] if given.simulator else []), "--", *more])
    options.run = functools.partial(kept.run, simulation.run)
    options.page, options.title = os.path.join(folder, "study.html"), str(study.get("title", name))
    return options


def parse(arguments):
    if arguments and not arguments[0].startswith("-"):
        return parse_study(arguments)
    arguments, more = simulation.split_arguments(arguments)
    parser = simulation.parser("assumptions.py", __doc__)
    parser.add_argument("--designs", required=True, nargs=2, metavar="KEY=VALUE", help="what is compared")
    parser.add_argument("--only", nargs="+", metavar="PREFIX", help="of keys to change, such as memory or l2.latency")
    parser.add_argument("--seeds", type=int, default=10, metavar="N", help="that noise is measured with; 10 by default")
    parser.add_argument("--noise", type=float, metavar="PERCENT", help="that means nothing, instead of measuring it")
    options = parser.parse_args(arguments)
    options.run, options.page = simulation.run, None
    for design in options.designs:
        if "=" not in design:
            raise Mistake(f"--designs {design}: give KEY=VALUE")
    if options.seeds < 2:
        raise Mistake(f"--seeds {options.seeds}: give a number from 2")
    if options.noise is not None and not options.noise >= 0:
        raise Mistake(f"--noise {options.noise}: give a percentage from 0")
    return simulation.checked(options, more)


def main():
    options = parse(sys.argv[1:])
    rows, ratio, noise, refused = measure(options)
    if not rows:
        raise Mistake("every change was refused: " + refused[0][2])
    if options.csv:
        unchanged = {"key": "", "value": "", "changed": "", "first": 1.0, "ratio": ratio, "verdict": "unchanged",
                     "noise": noise}
        simulation.write_csv(options.csv, [unchanged, *rows])
    lines = told(options, rows, ratio, noise, refused)
    print("\n".join(lines))
    if options.page:
        assumptions_study.write_page(options.page, options.title, lines, options.csv, TOP)
    return 1 if any(r["verdict"] == "FLIPS" for r in rows) else 0


if __name__ == "__main__":
    sys.exit(simulation.main(main))
