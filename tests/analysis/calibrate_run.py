#!/usr/bin/python3
"""calibrate_run.py CALIBRATE BUILD: the tool on a small frame, and what it refuses; and that calibrated machines keep their bars on
this frame, which no parameter was fitted to. Ends with 77 where there is no valgrind."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

calibrate, build = sys.argv[1:]
root = os.path.join(os.path.dirname(calibrate), "../..")
machine = os.path.join(root, "configs/machines/xeon-x5355-2s.toml")
frame = ["--", "--size", "16x16", "--spp", "1", "--light-samples", "1", "--sky-samples", "1", "--edge-pixels", "16"]


def run(*arguments, given=frame):
    return subprocess.run([sys.executable, calibrate, "--build", build, *arguments, *given], capture_output=True, text=True, check=False)


def refuses(word, *arguments, given=frame):
    done = run(*arguments, given=given)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and word in done.stderr, (arguments, done)


with tempfile.TemporaryDirectory() as folder:
    profile, out = os.path.join(folder, "profile"), os.path.join(folder, "out.json")
    with open(profile, "w", encoding="utf-8") as file:
        file.write("events: Ir\n")
    refuses("count anew", "sse4", "--machine", machine, "--profile", profile)
    refuses("No such file", "sse4", "--machine", machine, "--profile", profile + "s")
    refuses("install valgrind", "sse4", "--machine", machine, "--valgrind", profile + "s")
    refuses("from 1", "sse4", "--machine", machine, "--registers", "0")
    refuses("from 0", "sse4", "--machine", machine, "--interleaved", "-1")
    refuses("invalid choice", "sse5", "--machine", machine)
    if not shutil.which("valgrind"):
        print("no valgrind on the PATH: no kernel was counted")
        sys.exit(77)
    done = run("sse4", "--machine", machine, "--registers", "2", "--interleaved", "1", "-o", out)
    if "this build on this processor" in done.stderr:
        print(done.stderr)
        sys.exit(77)
    assert done.returncode == 0, done
    refuses("simulating", "sse4", "--machine", machine + "s")
    refuses("--sky-samples", "sse4", "--machine", machine, given=[*frame, "--sky-samples", "no"])
    with open(out, encoding="utf-8") as file:
        result = json.load(file)
    assert {row["kernel"] for row in result["kernels"]} >= {"build", "tessellate", "traverse", "intersect", "shade"}, result
    assert abs(sum(row["share"] for row in result["kernels"]) - 1) < 1e-9, result
    assert all(0.25 < row["instructions"]["ratio"] < 4 for row in result["kernels"] if row["share"] > 0.05), result
    assert result["settings"]["core.interleaved_values"] == 1, result
    assert result["settings"]["core.vector_registers"] == 2 and result["settings"]["lanes.masked"] == "on", result
    assert result["build"].split()[:4] == [result["build"].split()[0], "lanes", "of", "sse4,"], result
    held_out = {"sse4": ["instructions", "references"], "avx2": ["instructions"]}  # valgrind counts references of avx2 otherwise
    if "compiler 12." not in result["build"]:
        print(f"counts of {result['build']} were not compared: machines are calibrated to g++ 12")
        held_out = {}
    for target, figures in held_out.items():
        name = {"sse4": "xeon-x5355-2s", "avx2": "zen4-2c-avx2"}[target]
        done = run(target, "--machine", os.path.join(root, f"configs/machines/{name}.toml"), "--no-fit", "-o", out)
        if "this build on this processor" in done.stderr:
            continue
        assert done.returncode == 0, done
        with open(out, encoding="utf-8") as file:
            result = json.load(file)
        assert len(result["kernels"]) >= 7, result
        for row in result["kernels"]:
            # Kernels of less than a fiftieth of the instructions are off by up to a half (sim/README.md).
            assert all(row[figure]["within"] or row["share"] < 0.02 for figure in figures), (target, row)
