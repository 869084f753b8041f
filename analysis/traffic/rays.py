#!/usr/bin/python3
"""What the rays of some kinds did to the caches and to memory, out of reports of razor-sim (--json).

    analysis/traffic/rays.py fixed.json recursive.json
    analysis/traffic/rays.py fixed.json recursive.json --kinds camera --structures grids "blended blocks"

A row a report and part of the work. Traced: descent, blocks and blending while packets of these kinds are traced; built:
what these rays were the first to need (kd nodes, lists, blocks). Lines are different lines accessed in an L1, whoever
accessed them as well. Spilled registers are left out. Numbers but the lines are counts; DRAM is lines read and written.
"""
import argparse
import json
import sys

PARTS = {"traced": {"traverse", "intersect", "morph"}, "built": {"build", "tessellate"}}
COLUMNS = {"L1 accesses": ("l1_reads", "l1_writes"), "L1 misses": ("l1_misses",), "L2 misses": ("l2_misses",),
           "DRAM reads": ("memory_reads",), "DRAM writes": ("memory_writes",)}


def read(path):
    try:
        with open(path) as file:
            report = json.load(file)
        report["traffic"][0]["kind"], report["touched_lines"]
    except (OSError, ValueError, KeyError, IndexError, TypeError) as error:
        print(f"{path}: not a report of razor-sim run --json: {error!r}; write it anew", file=sys.stderr)
        sys.exit(2)
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", nargs="+")
    parser.add_argument("--kinds", nargs="+", default=["light", "sky"])
    parser.add_argument("--structures", nargs="+", help="only these; without it all but spill")
    options = parser.parse_args()
    counts = lambda structure: structure in options.structures if options.structures else structure != "spill"
    print(f"{'report':24} {'part':7}" + "".join(f" {name:>12}" for name in [*COLUMNS, "lines"]))
    for path in options.report:
        report = read(path)
        for part, phases in PARTS.items():
            rows = [r for r in report["traffic"]
                    if r["kind"] in options.kinds and r["phase"] in phases and counts(r["structure"])]
            sums = [sum(r[c] for r in rows for c in columns) for columns in COLUMNS.values()]
            lines = sum(r["lines"] for r in report["touched_lines"] if counts(r["structure"])
                        and any(phases & set(r["by"].get(k, ())) for k in options.kinds))
            print(f"{path[-24:]:24} {part:7}" + "".join(f" {n:12}" for n in [*sums, lines]))


if __name__ == "__main__":
    main()
