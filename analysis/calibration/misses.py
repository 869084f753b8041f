#!/usr/bin/python3
"""What a simulated machine's caches miss beside what cachegrind's miss, of a real build of the same kernels, by kernel.

    analysis/calibration/misses.py sse4 --machine configs/machines/xeon-x5355-2s.toml
    analysis/calibration/misses.py sse4 --machine configs/machines/tiny.toml --l1 8KiB,4 -- --size 48x48 --spp 4

Renders a frame with the target's kernels under valgrind (callgrind: cachegrind that knows who called whom), its data caches those
of the machine's L1 and L2, and the same frame on one worker of the machine, without prefetchers and store buffers, which
cachegrind has not. What follows -- is the frame: a scene and options as of `razor render`; the built-in scene at 64x64 with
one sample without. A table by kernel and in all: data references, misses of the L1 and of the L2, and misses over references; --csv
for programs. References differ by what compilers keep in registers and by how wide a reference is, and such references hit;
misses are of lines, and are to agree. Exit code: 0; 2 on a mistake.
"""
import argparse
import csv
import os
import re
import sys
import tempfile

import calibrate
import counts
from calibrate import FRAME, Mistake, ran, simulated_report

WITHOUT = ["l1.prefetcher=none", "l2.prefetcher=none"]  # what cachegrind has not
UNITS = {"": 1, "KiB": 1 << 10, "MiB": 1 << 20}


def cache_of(option, text):
    """'32KiB,8' as (bytes, ways)."""
    found = re.fullmatch(r"([1-9][0-9]*)(KiB|MiB|),([1-9][0-9]*)", text)
    if not found:
        raise Mistake(f"{option} '{text}' is no cache; give its size and its ways, as 32KiB,8")
    return int(found[1]) * UNITS[found[2]], int(found[3])


def counted_misses(options, machine, folder):
    profile = os.path.join(folder, "profile")
    caches = [f"--{name}={machine[level]['size_bytes']},{machine[level]['ways']},{machine[level]['line_bytes']}"
              for name, level in (("D1", "l1"), ("LL", "l2"))]
    ran([options.valgrind, "--quiet", "--tool=callgrind", "--cache-sim=yes", *caches, f"--callgrind-out-file={profile}",
         os.path.join(options.build, "analysis/native_frame"), "--isa", options.target, *options.frame], "counting")
    return counts.read_misses(profile, options.target, calibrate.SOURCES)


def simulated_misses(report):
    out = {}
    for row in report["traffic"]:
        sums = out.setdefault(row["phase"], {"references": 0, "first": 0, "last": 0})
        sums["references"] += row["l1_reads"] + row["l1_writes"]
        sums["first"] += row["l1_misses"]
        sums["last"] += row["l2_misses"]
    return out


def rows_of(counted, simulated):
    rows = []
    for kernel, c in counted.items():
        rows.append({"kernel": kernel, **{f"{key}_{of}": s.get(key, 0) for of, s in
                                          (("valgrind", c), ("simulated", simulated.get(kernel, {}))) for key in ("references", "first", "last")}})
    total = {key: sum(row[key] for row in rows) for key in rows[0] if key != "kernel"}
    return [*rows, {"kernel": "all", **total}]


def share(part, whole):
    return f"{100 * part / whole:6.3f}%" if whole else "      -"


def show(rows):
    print(f"{'':13} {'references, k':>17} {'misses of L1':>22} {'':6} {'of L2':>17} {'':6} {'L1 misses a reference':>21}")
    print(f"{'kernel':13} {'valgrind':>8} {'machine':>8} {'valgrind':>11} {'machine':>10} {'ratio':>6} {'valgrind':>8} {'machine':>8} {'ratio':>6}"
          f" {'valgrind':>10} {'machine':>10}")
    for r in rows:
        def ratio(key):
            return f"{r[key + '_simulated'] / r[key + '_valgrind']:6.2f}" if r[key + "_valgrind"] else "     -"
        print(f"{r['kernel']:13} {r['references_valgrind'] / 1e3:8.0f} {r['references_simulated'] / 1e3:8.0f} {r['first_valgrind']:11}"
              f" {r['first_simulated']:10} {ratio('first')} {r['last_valgrind']:8} {r['last_simulated']:8} {ratio('last')}"
              f" {share(r['first_valgrind'], r['references_valgrind']):>10} {share(r['first_simulated'], r['references_simulated']):>10}")


def read_options():
    arguments = sys.argv[1:]
    at = arguments.index("--") if "--" in arguments else len(arguments)
    p = argparse.ArgumentParser(prog="misses.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see misses.py --help"))
    p.add_argument("target", choices=("plain", "sse4", "avx2"), help="the kernels' target (valgrind runs no avx512)")
    p.add_argument("--machine", required=True, metavar="FILE")
    p.add_argument("-g", action="append", default=[], metavar="KEY=VALUE", help="of the machine")
    p.add_argument("--l1", metavar="SIZE,WAYS", help="in place of the machine's")
    p.add_argument("--l2", metavar="SIZE,WAYS", help="likewise")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs")
    p.add_argument("--build", default=os.path.join(calibrate.HERE, "../../build/release"), metavar="FOLDER")
    p.add_argument("--valgrind", default="valgrind", metavar="PATH")
    options = p.parse_args(arguments[:at])
    options.frame = arguments[at + 1:] or FRAME
    for level in ("l1", "l2"):
        if text := getattr(options, level):
            size, ways = cache_of(f"--{level}", text)
            options.g += [f"{level}.size_bytes={size}", f"{level}.ways={ways}"]
    if options.csv and not os.access(os.path.dirname(options.csv) or ".", os.W_OK):
        raise Mistake(f"--csv {options.csv}: its folder cannot be written to")
    return options


def main():
    options = read_options()
    with tempfile.TemporaryDirectory() as folder:
        report = simulated_report(options, folder, WITHOUT)
        if report["workers"] != 1 or any(report["machine"][level]["replacement"] != "lru" for level in ("l1", "l2")):
            raise Mistake(f"{options.machine}: cachegrind's caches are LRU; give -g l1.replacement=lru and -g l2.replacement=lru")
        rows = rows_of(counted_misses(options, report["machine"], folder), simulated_misses(report))
    show(rows)
    if options.csv:
        temporary = options.csv + ".tmp"
        with open(temporary, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
        os.replace(temporary, options.csv)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Mistake, counts.Malformed, argparse.ArgumentError) as mistake:
        print(f"misses.py: {mistake}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
