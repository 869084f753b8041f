#!/usr/bin/python3
"""machines.py [OPTIONS] [MACHINE.toml ...] [-- OPTION ...]: how fast the simulator runs each of the shipped machines.

    tests/benchmarks/machines.py
    tests/benchmarks/machines.py --runs 5 configs/machines/niagara-like.toml -- --size 96x96 -g sim.quantum=100

One small frame of each machine (all in configs/machines, where none is given) in both modes. What follows -- goes to each run
of razor-sim, in place of --size 32x32 --spp 1. Runs of all are done in turn, so that what else the host does falls on all alike: the median of their processor
time, how far apart they lay, and operations a second. A machine far below the others has a unit whose model is slow where
many wait for it; profile that.
"""
import argparse
import glob
import os
import statistics
import sys
import tempfile

PROJECT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(PROJECT, "analysis/sweep"))
import simulation  # noqa: E402
from simulation import Mistake  # noqa: E402

MODES = "fast", "reference"
FRAME = ["--size", "32x32", "--spp", "1"]


def read_options():
    arguments, more = simulation.split_arguments(sys.argv[1:])
    p = argparse.ArgumentParser(prog="machines.py", description=__doc__, allow_abbrev=False, exit_on_error=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see machines.py --help"))
    p.add_argument("machines", nargs="*", metavar="MACHINE.toml")
    p.add_argument("--runs", type=int, default=3, metavar="N", help="of each machine and mode")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs")
    p.add_argument("--simulator", metavar="PATH", help="razor-sim; else from the PATH or build/release")
    options = p.parse_args(arguments)
    if options.runs < 1:
        raise Mistake(f"--runs {options.runs}: give a number from 1")
    simulation.check_writable("--csv", options.csv)
    options.simulator = simulation.simulator(options.simulator)
    options.machines = options.machines or sorted(glob.glob(os.path.join(PROJECT, "configs/machines/*.toml")))
    options.more = more or FRAME
    return options


def row_of(machine, mode, hosts, operations):
    seconds = [host["processor_seconds"] for host in hosts]
    median = statistics.median(seconds)
    return {"machine": os.path.basename(machine).removesuffix(".toml"), "mode": mode, "runs": len(hosts),
            "operations": operations, "processor_seconds": median, "spread": (max(seconds) - min(seconds)) / median,
            "operations_per_second": operations / median}


def main():
    options = read_options()
    cases = [(machine, mode) for machine in options.machines for mode in MODES]
    hosts = {case: [] for case in cases}
    operations = {}
    turns = [case for _ in range(options.runs) for case in cases]
    with tempfile.TemporaryDirectory() as folder:
        for done, (machine, mode) in enumerate(turns):
            if sys.stderr.isatty():
                print(f"\r{done} of {len(turns)} runs", end="", file=sys.stderr, flush=True)
            try:
                report = simulation.run(options.simulator, machine, [f"sim.mode={mode}"],
                                        ["--no-native", "--no-calibration", *options.more], folder)
            except Mistake as mistake:
                raise Mistake(f"{machine}: {mistake}") from mistake
            operations[machine, mode] = report["core"]["vops"]
            hosts[machine, mode].append(report["host"])
    if sys.stderr.isatty():
        print("\r" + " " * 30 + "\r", end="", file=sys.stderr, flush=True)
    rows = [row_of(*case, hosts[case], operations[case]) for case in cases]
    best = {mode: max(row["operations_per_second"] for row in rows if row["mode"] == mode) for mode in MODES}
    print(f"{'machine':<20} {'mode':<10} {'M operations':>12} {'seconds':>8} {'spread':>7} {'M a second':>10} {'of the fastest':>14}")
    for row in rows:
        print(f"{row['machine']:<20} {row['mode']:<10} {row['operations'] / 1e6:>12.2f} {row['processor_seconds']:>8.2f} "
              f"{row['spread']:>7.0%} {row['operations_per_second'] / 1e6:>10.2f} "
              f"{row['operations_per_second'] / best[row['mode']]:>14.0%}")
    if options.csv:
        simulation.write_csv(options.csv, rows)


if __name__ == "__main__":
    sys.exit(simulation.main(main))
