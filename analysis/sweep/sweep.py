#!/usr/bin/python3
"""One machine, one key, several values: what each costs, what limits it, and whether more of it is always better.

    analysis/sweep/sweep.py --machine configs/machines/tiny.toml --key l2.size_bytes --values 32KiB..512KiB -- --size 64x64 --spp 1
    analysis/sweep/sweep.py --machine M.toml --key memory.channels --values 1 2 8 --expect falling --csv channels.csv -- --scene S.toml

With --reference the machine also runs once in the reference mode, and the table says how far each row is from its
cycles, and what both took of the host:

    analysis/sweep/sweep.py --reference --machine configs/machines/study.toml --key sim.quantum --values 1 10 100 1000 -- --size 64x64 --spp 1

With --seeds N each row is N runs, with sim.jitter 1 to N: the figures are means, and what chance leaves open is printed
beside the cycles (and the error), as half the width of a 95 % interval. Steps no larger than that do not count:

    analysis/sweep/sweep.py --seeds 10 --machine configs/machines/tiny.toml --key l2.ways --values 2..16 -- --size 64x64 --spp 1

plot.py draws error and host time of what --reference --csv writes.

A..B doubles from A to B. What follows -- goes to every run of `razor-sim run` (-g settings too). Runs are deterministic;
--jobs runs several side by side. Exit code: 0; 1 where --expect does not hold; 2 on a mistake; 130 after
Ctrl-C.
"""
import re
import statistics
import sys
import tempfile

import chance
import simulation
from simulation import Mistake

BINARY = {"": 1, "KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30}
NEVER_WAITS = {"busy", "idle"}  # causes of the CPI stack that are no waiting for the machine

# Name in the table, width, text of a row's figure.
COLUMNS = [
    ("cycles", 12, lambda r: f"{r['cycles']:.0f}"),
    ("of first", 9, lambda r: f"{r['of_first']:.3f}"),
    ("M vops", 9, lambda r: f"{r['vops'] / 1e6:.2f}"),
    ("IPC/core", 9, lambda r: f"{r['ipc']:.3f}"),
    ("L1 miss", 9, lambda r: f"{r['l1_miss']:.2%}"),
    ("L2 miss", 9, lambda r: f"{r['l2_miss']:.2%}"),
    ("DRAM reads", 11, lambda r: f"{r['dram_reads']:.0f}"),
    ("writes", 10, lambda r: f"{r['dram_writes']:.0f}"),
    ("GB/s", 8, lambda r: f"{r['dram_gb_s']:.2f}"),
    ("busiest resource", 18, lambda r: f"{r['resource']} {r['utilisation']:.0%}"),
    ("largest wait", 18, lambda r: f"{r['wait']} {r['waiting']:.0%}"),
]


# With --reference.
ERRORS = [
    ("error", 9, lambda r: f"{r['error']:+.2%}"),
    ("host s", 9, lambda r: f"{r['host_seconds']:.1f}"),
    ("M vops/s", 9, lambda r: f"{r['vops'] / r['host_seconds'] / 1e6:.2f}"),
]
REFERENCE = "reference"  # the value of that run's row
# With --seeds, behind the cycles and the error.
CHANCE = ("+-", 9, lambda r: f"{r['chance']:.2%}")
ERROR_CHANCE = ("+-", 9, lambda r: f"{r['error_chance']:.2%}")


def amount(text):
    """Number and unit of "64KiB"; None where it is not of that form."""
    match = re.fullmatch(r"(\d+)\s*(|KiB|MiB|GiB)", text)
    return match and (int(match[1]) * BINARY[match[2]])


def expand(words):
    values = []
    for word in words:
        first, dots, last = word.partition("..")
        if not dots:
            values.append(word)
            continue
        begin, end = amount(first), amount(last)
        if not begin or not end or begin > end:
            raise Mistake(f"--values {word}: give A..B with whole numbers from 1, A at most B")
        while begin <= end:
            unit = max((u for u in BINARY if begin % BINARY[u] == 0), key=lambda u: BINARY[u])
            values.append(f"{begin // BINARY[unit]}{unit}")
            begin *= 2
    return values


def run(options, value, seed, folder):
    settings = ["sim.mode=reference" if value == REFERENCE else f"{options.key}={value}"]
    if seed:
        settings.append(f"sim.jitter={seed}")
    return simulation.run(options.simulator, options.machine, settings, options.more, folder)


def share(part, whole):
    return part / whole if whole else 0.0


def figures(report, value):
    """What the table shows of one run."""
    chip = report["machine"]["chip"]
    cores = chip.get("tiles", 1) * chip["cores"]
    cycles, core, memory = report["cycles"], report["core"], report["memory"]
    resources = {level: band["utilisation"] for level, band in report["bandwidth"].items()}
    resources["issue"] = share(core["instructions"], cycles * cores * report["machine"]["core"]["issue_width"])
    busiest = max(resources, key=resources.get)
    worked = sum(report["stack"].values()) - report["stack"].get("idle", 0)
    waits = {cause: n for cause, n in report["stack"].items() if cause not in NEVER_WAITS}
    wait = max(waits, key=waits.get)
    return {
        "value": value,
        "cycles": cycles,
        "vops": core["vops"],
        "ipc": share(core["instructions"], cycles * cores),
        "l1_miss": share(report["l1"]["misses"], report["l1"]["hits"] + report["l1"]["misses"]),
        "l2_miss": share(report["l2"]["misses"], report["l2"]["hits"] + report["l2"]["misses"]),
        "dram_reads": memory["reads"],
        "dram_writes": memory["writes"],
        "dram_gb_s": report["bandwidth"]["memory"]["achieved_gb_s"],
        "resource": busiest,
        "utilisation": resources[busiest],
        "wait": wait,
        "waiting": share(waits[wait], worked),
        "host_seconds": report["host"]["processor_seconds"],
        "tiles_a_worker": report["renderer"]["screen_tiles"] / report["workers"],
    }


def mean_of(runs):
    """One row of those of several seeds: means, and words where most agree."""
    row = {}
    for name, first in runs[0].items():
        values = [r[name] for r in runs]
        if isinstance(first, str):
            row[name] = statistics.mode(values)
        else:
            row[name] = first if len(runs) == 1 else statistics.fmean(values)
    row["chance"] = share(chance.half_width([r["cycles"] for r in runs]), row["cycles"])
    return row


def direction(rows, name, tolerance):
    """How a figure goes along the values, in words, and whether it ever rises or falls beyond the tolerance, and beyond
    what chance leaves open of the cycles."""
    steps = [(a["value"], b["value"], share(b[name] - a[name], a[name]),
              max(tolerance, chance.of_difference(a["chance"], b["chance"]))) for a, b in zip(rows, rows[1:])]
    rises = [s[:3] for s in steps if s[2] > s[3]]
    falls = [s[:3] for s in steps if s[2] < -s[3]]
    if rises and falls:
        few = rises if len(rises) <= len(falls) else falls
        odd = ", ".join(f"{a} to {b} ({change:+.1%})" for a, b, change in few)
        word = "falls but rises" if few is rises else "rises but falls"
        return f"not monotone: {word} from {odd}", True, True
    word = "rises" if rises else "falls" if falls else "stays"
    return f"monotone: {word}, {rows[-1][name]:.0f} of {rows[0][name]:.0f}", bool(rises), bool(falls)


def table(options, rows):
    columns = COLUMNS[:1] + ERRORS + COLUMNS[2:] if options.reference else list(COLUMNS)
    if options.seeds > 1:
        columns[1:1] = [CHANCE]
        if options.reference:
            columns[3:3] = [ERROR_CHANCE]
    width = max(len(options.key), *(len(r["value"]) for r in rows)) + 1
    print(f"{options.key:<{width}}" + "".join(f"{name:>{w}}" for name, w, _ in columns))
    for row in rows:
        print(f"{row['value']:<{width}}" + "".join(f"{text(row):>{w}}" for _, w, text in columns))


def parse(arguments):
    arguments, more = simulation.split_arguments(arguments)
    parser = simulation.parser("sweep.py", __doc__)
    parser.add_argument("--key", required=True, metavar="KEY", help="of the machine, such as l2.size_bytes")
    parser.add_argument("--values", required=True, nargs="+", metavar="VALUE")
    parser.add_argument("--expect", choices=["falling", "rising"], help="what the cycles must do")
    parser.add_argument("--tolerance", type=float, default=0.5, metavar="PERCENT", help="of a step; 0.5 by default")
    parser.add_argument("--reference", action="store_true", help="compare with a run in the reference mode")
    parser.add_argument("--seeds", type=int, default=1, metavar="N", help="runs a row, each with noise of its own")
    options = parser.parse_args(arguments)
    if options.seeds < 1:
        raise Mistake(f"--seeds {options.seeds}: give a number from 1")
    if not options.tolerance >= 0:
        raise Mistake(f"--tolerance {options.tolerance}: give a percentage from 0")
    options.values = expand(options.values)
    return simulation.checked(options, more)


def sweep(options):
    with tempfile.TemporaryDirectory() as folder, simulation.Pool(options.jobs) as pool:
        values = [REFERENCE] * options.reference + options.values
        seeds = range(1, options.seeds + 1) if options.seeds > 1 else [0]
        runs = {v: [pool.submit(run, options, v, s, tempfile.mkdtemp(dir=folder)) for s in seeds] for v in values}
        simulation.show_progress([r for all_of_row in runs.values() for r in all_of_row], may_fail=False)
        rows = [mean_of([figures(r.result(), v) for r in runs[v]]) for v in values]
    for row in rows:
        row["of_first"] = share(row["cycles"], rows[0]["cycles"])
        if options.reference:
            row["error"] = row["of_first"] - 1
            between = chance.of_difference(row["chance"], rows[0]["chance"])
            row["error_chance"] = 0.0 if row is rows[0] else row["of_first"] * between
    if options.csv:
        names = {"value": options.key}
        simulation.write_csv(options.csv, [{names.get(k, k): v for k, v in row.items()} for row in rows])
    table(options, rows)
    few = [row["value"] for row in rows if row["tiles_a_worker"] < 4]
    if few:
        print(f"few screen tiles a worker at {', '.join(few)}: the last one to end decides the time; a larger --size says more")
    rows = rows[options.reference:]
    cycles, rises, falls = direction(rows, "cycles", options.tolerance / 100)
    print(f"cycles      {cycles}")
    print(f"DRAM reads  {direction(rows, 'dram_reads', options.tolerance / 100)[0]}")
    if (options.expect == "falling" and rises) or (options.expect == "rising" and falls):
        print(f"expected {options.expect} cycles: NOT so (steps within {options.tolerance} % do not count)")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(lambda: sweep(parse(sys.argv[1:]))))
