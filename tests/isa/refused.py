#!/usr/bin/python3
"""refused.py COMPILER SOURCE FLAG...: SOURCE compiles with CASE=0, and with no other of its cases.

A case counts as refused only if every error is reported on a line of that case (or in a header, called from there).
Cases marked [simulated] are tried only where a flag says ISA_TARGET=simulated.
"""
import concurrent.futures
import os
import re
import subprocess
import sys


def cases(source):
    """[(number, description, first line, last line)]"""
    found = []
    for number, line in enumerate(open(source), 1):
        m = re.match(r"#(?:el)?if CASE == (\d+)\s+// (.*)", line)
        if found and line.startswith("#el") and found[-1][3] is None:
            found[-1] = (*found[-1][:3], number)
        if m:
            found.append((int(m[1]), m[2].strip(), number, None))
    return found


def compile_case(compiler, source, flags, case):
    command = [compiler, *flags, "-std=c++20", "-fsyntax-only", "-w", f"-DCASE={case}", source]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    return done.returncode, done.stderr


def main():
    compiler, source, *flags = sys.argv[1:]
    status, message = compile_case(compiler, source, flags, 0)
    if status != 0:
        sys.exit(f"{source} does not compile without any case:\n{message}")
    simulated = "-DISA_TARGET=simulated" in flags
    wanted = [c for c in cases(source) if simulated or not c[1].startswith("[simulated]")]
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = pool.map(lambda c: compile_case(compiler, source, flags, c[0]), wanted)
        for (case, description, first, last), (status, message) in zip(wanted, results):
            lines = [int(n) for n in re.findall(re.escape(os.path.basename(source)) + r":(\d+):\d+: (?:fatal )?error", message)]
            if status == 0:
                print(f"{source}:{first}: compiles, and must not: {description}")
                failures += 1
            elif not lines or any(not first < n < last for n in lines):
                print(f"{source}:{first}: refused for another reason: {description}\n{message}")
                failures += 1
    print(f"{len(wanted)} cases, {failures} failures")
    sys.exit(1 if failures or not wanted else 0)


main()
