#!/usr/bin/python3
"""misses_run.py MISSES BUILD: misses of a large L1 are cachegrind's but for some, in all and where most are; what the tool refuses.
Ends with 77 where there is no valgrind."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile

misses, build = sys.argv[1:]
machine = os.path.join(os.path.dirname(misses), "../../configs/machines/xeon-x5355-2s.toml")
frame = ["--", "--size", "16x16", "--spp", "1"]


def run(*arguments):
    return subprocess.run([sys.executable, misses, *arguments, "--build", build, *frame], capture_output=True, text=True, check=False)


def refuses(word, *arguments):
    done = run(*arguments)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, (arguments, done)


refuses("32KiB,8", "sse4", "--machine", machine, "--l1", "32")
refuses("invalid choice", "avx512", "--machine", machine)
refuses("simulating", "sse4", "--machine", machine + "s")
refuses("LRU", "sse4", "--machine", machine, "-g", "l1.replacement=random")
if not shutil.which("valgrind"):
    print("no valgrind on the PATH: nothing was counted")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    out = os.path.join(folder, "misses.csv")
    done = run("sse4", "--machine", machine, "--l1", "512KiB,16", "--csv", out)
    if "this build on this processor" in done.stderr:
        print(done.stderr)
        sys.exit(77)
    assert done.returncode == 0, done
    with open(out, encoding="utf-8", newline="") as file:
        rows = {row.pop("kernel"): {key: int(value) for key, value in row.items()} for row in csv.DictReader(file)}
total = rows.pop("all")
for key, value in total.items():
    assert value == sum(row[key] for row in rows.values()), key
for level in ("first", "last"):
    assert 0.75 < total[f"{level}_simulated"] / total[f"{level}_valgrind"] < 1.35, (level, total)
kernel, most = max(rows.items(), key=lambda item: item[1]["first_valgrind"])
assert 0.7 < most["first_simulated"] / most["first_valgrind"] < 1.4, (kernel, most)
