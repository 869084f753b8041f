#!/usr/bin/python3
"""symbols.py TARGET OBJECT...: what an object library of kernels may define.

Code compiled with a target's flags must not be found by code of another target: everything it defines with external
linkage lies in a namespace named by the target, and nothing of it runs before main().
"""
import re
import subprocess
import sys

# Compiler support that holds no code of the target.
HARMLESS = re.compile(r"^(DW\.ref\.__gxx_personality_v0|__clang_call_terminate)$")


def main():
    target, *objects = sys.argv[1:]
    failures = []
    for path in objects:
        sections = subprocess.run(["objdump", "-h", path], capture_output=True, text=True, check=True).stdout
        if re.search(r"\s\.(init_array|ctors)\b", sections):
            failures.append(f"{path}: has global constructors")
        listing = subprocess.run(["nm", "-C", "--defined-only", path], capture_output=True, text=True, check=True).stdout
        for line in listing.splitlines():
            m = re.match(r"[0-9a-f]*\s+(\S)\s+(.*)", line)
            if not m:
                continue
            kind, name = m[1], m[2]
            if kind == "t" and "_GLOBAL__sub_I" in name:
                failures.append(f"{path}: has a global constructor: {name}")
            external = kind.isupper() or kind in "uvw"
            if external and f"{target}::" not in name and not HARMLESS.match(name):
                failures.append(f"{path}: defines {name}, which other targets may link")
    print("\n".join(failures) if failures else f"{len(objects)} objects of {target}: nothing leaks")
    sys.exit(1 if failures or not objects else 0)


main()
