#!/usr/bin/python3
"""How far runs computed in closed form are off, beside whole ones in the reference mode.

    analysis/estimates/closed_form.py FOLDER [--machines copernicus,larrabee-like,niagara-like] [--scenes default,courtyard,...]
                                      [--tiles 1,4,16] [--size 32x32] [--forest-size 16x16] [--program razor-sim] [-- more options]

Each machine runs each scene once on one tile, for the seed, which says of every number of tiles what is expected; beside it are
simulated runs of the reference mode with DRAM's queues. A row a point: errors of cycles and of bytes from and to DRAM in percent, the
time of the model in milliseconds, and processor seconds to count work natively and to simulate the whole. FOLDER keeps each
simulated run's report, and each seed, under its command: the same command goes on where it was stopped. Exit code: 0; 1 where a run
fails; 2 on a mistake; 130 after Ctrl-C.
"""
import hashlib
import json
import os
import statistics
import subprocess
import sys

import simulator


def options():
    parser = simulator.parser_of(__doc__)
    parser.add_argument("--machines", default="copernicus,larrabee-like,niagara-like")
    parser.add_argument("--scenes", default="default,courtyard,interior,forest,showcase")
    parser.add_argument("--tiles", default="1,4,16")
    parser.add_argument("--size", default="32x32")
    parser.add_argument("--forest-size", default="16x16")
    found, more = simulator.parsed(parser)
    if not all(n.isdigit() and int(n) > 0 for n in found.tiles.split(",")):
        parser.error("--tiles is numbers of tiles, such as 1,4,16")
    return found, more


def run(program, arguments):
    done = subprocess.run([program, "run", *arguments], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, check=False)
    if done.returncode != 0:
        print(done.stderr.strip(), file=sys.stderr)
        sys.exit(130 if done.returncode == 130 else 1)


def kept(folder, name, inputs, arguments):
    """A file's name by the command that makes it and what that reads."""
    key = chr(0).join([inputs, *arguments])
    return os.path.join(folder, f"{name}-{hashlib.sha256(key.encode()).hexdigest()[:12]}.json")


def figures(report):
    line = max((level["line_bytes"] for name, level in report["machine"].items() if name[0] == "l" and name[1:].isdigit()
                and level.get("size_bytes", 0) > 0), default=64)
    return {"cycles": report["cycles"], "dram_bytes": line * (report["memory"]["reads"] + report["memory"]["writes"])}


def main():
    found, more = options()
    os.makedirs(found.folder, exist_ok=True)
    print(f"{'machine':14} {'scene':10} {'tiles':>5} {'cycles, %':>10} {'DRAM, %':>9} {'model, ms':>10} {'count, s':>9} {'whole, s':>9}")
    errors = {"cycles": [], "dram_bytes": []}
    for machine in found.machines.split(","):
        for scene in found.scenes.split(","):
            size = found.forest_size if scene == "forest" else found.size
            files = f"configs/machines/{machine}.toml", f"configs/scenes/{scene}.toml"
            inputs = simulator.digest_of_inputs(found.program, *files)
            common = ["--quiet", "--no-native", "--no-calibration", "--machine", files[0], "--scene", files[1], "--size", size,
                      "--spp", "1", "-g", "sim.mode=reference", "-g", "memory.controller=queued", *more]
            seed = kept(found.folder, f"seed-{machine}-{scene}", inputs, common)
            for tiles in found.tiles.split(","):
                arguments = [*common, "-g", f"chip.tiles={tiles}"]
                whole = kept(found.folder, f"{machine}-{scene}-{tiles}", inputs, arguments)
                if not os.path.exists(whole):
                    run(found.program, [*arguments, "--json", whole])
                computed = os.path.join(found.folder, f"computed-{machine}-{scene}-{tiles}.json")
                run(found.program, [*arguments, "--estimate", "closed-form", "--seed-report", seed, "--json", computed])
                with open(whole, encoding="utf-8") as opened:
                    truth = json.load(opened)
                with open(computed, encoding="utf-8") as opened:
                    estimate = json.load(opened)
                off = {f: 100 * (figures(estimate)[f] / figures(truth)[f] - 1) for f in errors}
                for figure, error in off.items():
                    errors[figure].append(error)
                print(f"{machine:14} {scene:10} {tiles:>5} {off['cycles']:+10.1f} {off['dram_bytes']:+9.1f} "
                      f"{1000 * estimate['host']['model_seconds']:10.2f} {estimate['host']['count_seconds']:9.2f} "
                      f"{truth['host']['processor_seconds']:9.2f}", flush=True)
    for figure, all_errors in errors.items():
        size = sorted(map(abs, all_errors))
        print(f"{figure}: mean {statistics.mean(size):.1f} %, median {statistics.median(size):.1f} %, largest {size[-1]:.1f} %, "
              f"below 20 % in {sum(e < 20 for e in size)} of {len(size)}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
