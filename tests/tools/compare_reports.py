#!/usr/bin/python3
"""compare_reports.py A.json B.json: reports of the same simulated run are equal, but for what the host adds.

"host" (times, host name, compiler) is left out at the top level. Prints the first differences; exits with 1 if any.
"""
import json
import sys

LEFT_OUT = {"host"}
SHOWN = 20


def differences(a, b, path=""):
    if isinstance(a, dict) and isinstance(b, dict):
        for key in [*a, *(k for k in b if k not in a)]:
            if not path and key in LEFT_OUT:
                continue
            where = f"{path}.{key}" if path else key
            if key not in a or key not in b:
                yield f"{where}: only in {'the first' if key in a else 'the second'}"
            else:
                yield from differences(a[key], b[key], where)
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for index, (x, y) in enumerate(zip(a, b)):
            yield from differences(x, y, f"{path}[{index}]")
    elif a != b or type(a) is not type(b):
        yield f"{path}: {json.dumps(a)[:100]} and {json.dumps(b)[:100]}"


def values(a):
    children = a.values() if isinstance(a, dict) else a if isinstance(a, list) else None
    return 1 if children is None else sum(values(c) for c in children)


def main():
    if len(sys.argv) != 3:
        sys.exit("compare_reports.py: give two reports: compare_reports.py A.json B.json")
    first, second = (json.load(open(path)) for path in sys.argv[1:])
    found = list(differences(first, second))
    for line in found[:SHOWN]:
        print(line)
    print(f"{values(first)} values, {len(found)} differ")
    sys.exit(1 if found else 0)


main()
