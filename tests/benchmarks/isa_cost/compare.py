#!/usr/bin/python3
"""compare.py [--bar RATIO] ISA_COST TARGET...: instructions that the vocabulary takes beside hand-written intrinsics, which
go through their work one register at a time.

Counted by callgrind inside the kernel, for targets it can run (not avx512, which is timed only). Fails where results differ,
and where the vocabulary takes more than RATIO times as many over all targets counted; exits with 77 (skipped) where there is no valgrind. At a
logical width of one or two registers the ratio is what the vocabulary itself costs; at 32 lanes it is also what spilling
costs where a vector takes four or eight of sixteen registers.
"""
import re
import shutil
import subprocess
import sys

PACKETS = 6400


def instructions(program, target, version):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
               f"--toggle-collect=isa_cost::{target}::{version}*", program, target, version, str(PACKETS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr)[1]) / PACKETS, done.stdout.split(",", 1)[1]


def nanoseconds(program, target, version):
    runs = []
    for _ in range(9):
        done = subprocess.run([program, target, version, "100000"], capture_output=True, text=True)
        if done.returncode == 2:
            return None
        runs.append(float(re.search(r": ([\d.]+) ns", done.stdout)[1]))
    return sorted(runs)[len(runs) // 2]


def main():
    arguments = sys.argv[1:]
    bar = float("inf")
    if arguments[0] == "--bar":
        bar = float(arguments[1])
        arguments = arguments[2:]
    program, *targets = arguments
    if shutil.which("valgrind") is None:
        print("no valgrind: instructions are not counted")
        sys.exit(77)
    failed, ours_all, theirs_all = False, 0, 0
    for target in targets:
        time = [nanoseconds(program, target, v) for v in ("vocabulary", "intrinsics")]
        if None in time:
            print(f"{target}: this processor does not run it")
            continue
        line = f"{target}: {time[0]:.1f} against {time[1]:.1f} ns a packet, ratio {time[0] / time[1]:.3f}"
        if target != "avx512":
            (ours, our_results), (theirs, their_results) = [instructions(program, target, v) for v in ("vocabulary", "intrinsics")]
            failed |= our_results != their_results
            ours_all, theirs_all = ours_all + ours, theirs_all + theirs
            line += f"; {ours:.1f} against {theirs:.1f} instructions a packet, ratio {ours / theirs:.3f}"
            if our_results != their_results:
                line += f"; RESULTS DIFFER:{our_results}{their_results}"
        print(line)
    if theirs_all:
        print(f"all that was counted: ratio {ours_all / theirs_all:.3f} (at most {bar})")
        failed |= ours_all > bar * theirs_all
    sys.exit(1 if failed else 0)


main()
