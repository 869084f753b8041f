#!/usr/bin/python3
"""refused.py COMPILER SOURCE FLAG...: SOURCE compiles without its cases, and with -DCASES each of them is refused.

A case is refused if an error is reported on one of its lines. There may be no other errors in SOURCE. Cases marked
[simulated] are there only where a flag says ISA_TARGET=simulated.
"""
import os
import re
import subprocess
import sys


def cases(source):
    """[(description, first line, last line)]"""
    found = []
    for number, line in enumerate(open(source), 1):
        m = re.match(r"REFUSED \{ // (.*)", line)
        if m:
            found.append((m[1], number, None))
        elif line.startswith("}") and found and found[-1][2] is None:
            found[-1] = (*found[-1][:2], number)
    return found


def compile_source(compiler, source, flags):
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True).stdout
    every_error = "-ferror-limit=0" if "clang" in version else "-fmax-errors=0"
    command = [compiler, *flags, "-std=c++20", "-fsyntax-only", "-w", every_error, source]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    return done.returncode, done.stderr


def main():
    compiler, source, *flags = sys.argv[1:]
    status, message = compile_source(compiler, source, flags)
    if status != 0:
        sys.exit(f"{source} does not compile without its cases:\n{message}")
    simulated = "-DISA_TARGET=simulated" in flags
    wanted = [c for c in cases(source) if simulated or not c[0].startswith("[simulated]")]
    status, message = compile_source(compiler, source, [*flags, "-DCASES"])
    places = re.findall(r"^(?:.*/)?" + re.escape(os.path.basename(source)) + r":(\d+):\d+: (?:fatal )?error", message, re.M)
    lines = {int(n) for n in places}
    compiled = [c for c in wanted if not any(c[1] < n < c[2] for n in lines)]
    for description, first, _ in compiled:
        print(f"{source}:{first}: compiles, and must not: {description}")
    elsewhere = sorted(n for n in lines if not any(c[1] < n < c[2] for c in wanted))
    for n in elsewhere:
        print(f"{source}:{n}: an error outside of all cases")
    if compiled or elsewhere:
        print(message)
    print(f"{len(wanted)} cases, {len(compiled) + len(elsewhere)} failures")
    sys.exit(1 if compiled or elsewhere or not wanted else 0)


main()
