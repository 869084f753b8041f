#!/usr/bin/python3
"""compare.py [--bars WIDE,REGISTERS] ISA_COST TARGET...: what the vocabulary takes beside hand-written intrinsics.

Two kernels by hand: `wide`, operation by operation over all lanes as the vocabulary goes, so that the ratio is what the
vocabulary itself costs; and `by register`, each register's chain on its own, so that the ratio is also what that order costs in
spills where a value takes four or eight of sixteen registers. Instructions are counted by callgrind inside the kernel, but for
avx512, which it cannot run: there instructions are those of the object code (all of a straight-line kernel), by objdump.
Times are medians. Fails where results differ, and where a ratio of instructions exceeds its bar; exits with 77 (skipped) where
there is no valgrind.
"""
import re
import shutil
import subprocess
import sys

PACKETS = 6400
VERSIONS = {"wide": "wide_intrinsics", "by register": "intrinsics"}


def run(program, target, version, packets):
    done = subprocess.run([program, target, version, str(packets)], capture_output=True, text=True)
    return None if done.returncode == 2 else done.stdout


def counted(program, target, version):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
               f"--toggle-collect=isa_cost::{target}::{version}(*", program, target, version, str(PACKETS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr)[1]) / PACKETS


def in_code(program, target, version):
    listing = subprocess.run(["objdump", "-d", "-C", "--no-show-raw-insn", program], capture_output=True, text=True, check=True).stdout
    bodies = re.findall(rf"<isa_cost::{target}::{version}\(.*?>:\n(.*?)\n\n", listing, re.S)
    body = max(bodies, key=len)
    return sum(1 for line in body.splitlines() if not re.search(r"\bnopw?\b|\bxchg +%ax,%ax|\bdata16\b", line))


def nanoseconds(program, target, version):
    runs = [float(re.search(r": ([\d.]+) ns", run(program, target, version, 100000))[1]) for _ in range(9)]
    return sorted(runs)[len(runs) // 2]


def main():
    arguments = sys.argv[1:]
    bars = dict.fromkeys(VERSIONS, float("inf"))
    if arguments[0] == "--bars":
        bars = dict(zip(VERSIONS, map(float, arguments[1].split(","))))
        arguments = arguments[2:]
    program, *targets = arguments
    if shutil.which("valgrind") is None:
        print("no valgrind: instructions are not counted")
        sys.exit(77)
    failed = False
    for target in targets:
        results = run(program, target, "vocabulary", PACKETS)
        if results is None:
            print(f"{target}: this processor does not run it")
            continue
        count = in_code if target == "avx512" else counted
        ours, time = count(program, target, "vocabulary"), nanoseconds(program, target, "vocabulary")
        print(f"{target}: {ours:.1f} instructions{' of code' if count is in_code else ' a packet'}, {time:.1f} ns a packet")
        for name, version in VERSIONS.items():
            theirs, their_time = count(program, target, version), nanoseconds(program, target, version)
            print(f"    beside {name}: {theirs:.1f}, {their_time:.1f} ns; ratio {ours / theirs:.3f}, of times {time / their_time:.2f}")
            if ours > bars[name] * theirs:
                failed = True
                print(f"    FAILED: more than {bars[name]} of {name}")
            if run(program, target, version, PACKETS).split(",", 1)[1] != results.split(",", 1)[1]:
                failed = True
                print(f"    FAILED: results differ from {name}")
    sys.exit(1 if failed else 0)


main()
