#!/usr/bin/python3
"""What a simulated core counts beside a real build of the same kernels: instructions and data references, by kernel.

    analysis/calibration/calibrate.py sse4 --machine configs/machines/xeon-x5355-2s.toml -o sse4.json
    analysis/calibration/calibrate.py avx2 --machine configs/machines/zen4-2c-avx2.toml --no-fit -- --size 48x48 --spp 4

Renders a frame with the target's kernels under valgrind (callgrind: cachegrind that knows who called whom) and the same
frame on one worker of the machine with each of --registers and --interleaved, and fits core.vector_registers,
core.interleaved_values, core.scalar_moves and core.vector_moves to all kernels alike; or (--no-fit) on the machine as it is.
What follows -- is the frame: a scene and options as of `razor render`; the built-in scene at 64x64 with one sample without.
-o writes what remains between both for a machine file's `calibration`.

valgrind counts a gather and the memory operand of a fused multiplication of avx2 as eight references, so that references
are fitted for other targets alone. Bars: 20 % of instructions, 25 % of references. Exit code: 0; 2 on a mistake.
"""
import argparse
import itertools
import json
import os
import subprocess
import sys
import tempfile

import counts
import fit

BARS = {"instructions": 0.20, "references": 0.25}
FRAME = ["--size", "64x64", "--spp", "1"]
FITTED = ("core.vector_registers", "core.interleaved_values", "core.scalar_moves", "core.vector_moves")
# What decides what is counted, beside these (a key, or a section): a machine that differs in any is not the one that was
# calibrated.
DECISIVE = ("core.lanes", "core.broadcasts", "core.memory_operands", "core.scalar_overhead", "core.gather", "core.address_folding", "core.skip_idle", "lanes", "instructions")


HERE = os.path.dirname(os.path.abspath(__file__))
SOURCES = os.path.join(HERE, "../../razor/kernels")
# Loads that a store buffer answers do not reach the L1: the references are those of a core without one.
COUNTING = ["core.store_buffer=0"]


class Mistake(Exception):
    """Of the user, or of a program that ran: one line."""


def ran(command, what):
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as failure:
        raise Mistake(f"{what}: {command[0]} cannot be run: {failure.strerror}; build the programs, install valgrind") from failure
    if done.returncode != 0:
        raise Mistake(f"{what}: {(done.stderr.strip().splitlines() or ['no word'])[-1]}")
    return done.stdout


def frame_of_run(words):
    """The same frame for razor-sim, which takes the scene as an option."""
    return ["--scene", *words] if words and not words[0].startswith("-") else words


def native_counts(options, folder):
    profile = options.profile or os.path.join(folder, "profile")
    said = ""
    if not options.profile:
        said = ran([options.valgrind, "--quiet", "--tool=callgrind", "--cache-sim=yes",
                    f"--callgrind-out-file={profile}",
                    os.path.join(options.build, "analysis/native_frame"), "--isa", options.target, *options.frame],
                   "counting")
    try:
        return counts.read_kernels(profile, options.target, SOURCES), said.strip()
    except OSError as failure:
        raise Mistake(f"--profile {profile}: {failure.strerror}") from failure


def simulated_report(options, folder, settings):
    path = os.path.join(folder, "report.json")
    more = [word for setting in [*options.g, *COUNTING, *settings] for word in ("-g", setting)]
    ran([os.path.join(options.build, "sim/program/razor-sim"), "run", "--machine", options.machine, "--workers", "1", "--no-native",
         "--no-calibration", "--quiet", "--json", path, "--report", os.path.join(folder, "report.txt"), *more, *frame_of_run(options.frame)],
        "simulating")
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def simulated_counts(report):
    out = {p["phase"]: {"instructions": p["instructions"], "references": 0} for p in report["phases"]}
    for row in report["traffic"]:
        out[row["phase"]]["references"] += row["l1_reads"] + row["l1_writes"]
    return out


def setting(report, key):
    section, _, name = key.partition(".")
    return report["machine"][section][name]


def settings_of(report, name):
    """{key: value} of a key, or of a section's keys."""
    if "." in name:
        return {name: setting(report, name)}
    return {f"{name}.{key}": value for key, value in report["machine"][name].items()}


def complete(counted, simulated):
    missing = [k for k in counted if not simulated.get(k, {}).get("instructions")]
    if missing:
        raise Mistake(f"the simulated frame has no phase {missing[0]}; build both programs anew")
    return simulated


def as_it_is(options, folder, counted, figures):
    """A report of the machine's own settings, ratios, these settings of FITTED, and the error."""
    report = simulated_report(options, folder, [])
    simulated = complete(counted, simulated_counts(report))
    none = {k: 0 for k in counted}
    error = fit.error(fit.ratios(counted, simulated, (none, none), (0, 0), figures))
    return (report, fit.ratios(counted, simulated, (none, none), (0, 0), list(BARS)),
            [setting(report, key) for key in FITTED], error)


def fitted(options, folder, counted, figures):
    """The same with those of FITTED that have the least error; the report is of one without moves."""
    def run(*values):
        return simulated_report(options, folder, [f"{key}={value}" for key, value in zip(FITTED, values)])

    reports = {values: run(*values, 0, 0) for values in itertools.product(options.registers, options.interleaved)}
    simulated = {values: simulated_counts(report) for values, report in reports.items()}
    least = next(iter(reports))
    slopes = []
    for one in ((1, 0), (0, 1)):
        more = complete(counted, simulated_counts(run(*least, *one)))
        slopes.append({k: more[k]["instructions"] - simulated[least][k]["instructions"] for k in counted})
    (values, *moves), error = fit.fit(counted, simulated, slopes, figures)
    ratios = fit.ratios(counted, simulated[values], slopes, moves, list(BARS))
    return reports[values], ratios, (*values, *moves), error


def calibrate(options, folder):
    """What is to be written."""
    counted, said = native_counts(options, folder)
    figures = ["instructions"] if options.target == "avx2" else ["instructions", "references"]
    report, everything, found, remains = (fitted if options.fit else as_it_is)(options, folder, counted, figures)
    whole = sum(c["instructions"] for c in counted.values())
    kernels = []
    for kernel, ratio in everything.items():
        row = {"kernel": kernel, "share": counted[kernel]["instructions"] / whole}
        for figure, bar in BARS.items():
            row[figure] = {"counted": counted[kernel][figure], "ratio": round(ratio[figure], 3),
                           "within": abs(ratio[figure] - 1) <= bar, "fitted": figure in figures}
        kernels.append(row)
    settings = {key: value for name in DECISIVE for key, value in settings_of(report, name).items()}
    settings.update(zip(FITTED, found))
    return {"target": options.target, "settings": settings, "error": round(remains, 4), "frame": " ".join(options.frame),
            "build": said.splitlines()[-1] if said else "", "made_by": options.command, "kernels": kernels}


def show(result):
    print(", ".join(f"{key} = {result['settings'][key]}" for key in FITTED))
    print(f"{'kernel':12}{'of all':>8}" + "".join(f"{f:>16}{'simulated':>11}" for f in BARS))
    for row in result["kernels"]:
        line = f"{row['kernel']:12}{row['share']:8.1%}"
        for figure in BARS:
            of = row[figure]
            line += f"{of['counted']:16}{of['ratio'] - 1:+10.0%}{' ' if of['within'] else '!'}"
        print(line)
    for figure, bar in BARS.items():
        beyond = [row["kernel"] for row in result["kernels"] if not row[figure]["within"]]
        fitted = all(row[figure]["fitted"] for row in result["kernels"])
        note = "" if fitted else "; not fitted, as valgrind counts some instructions' references eight times"
        print(f"{figure}: {len(result['kernels']) - len(beyond)} of {len(result['kernels'])} kernels within {bar:.0%}"
              f"{': beyond it ' * bool(beyond)}{', '.join(beyond)}{note}")
    print(f"error {result['error']:.3f} (root mean square of logarithms)")


def parse(arguments):
    command = " ".join(["analysis/calibration/calibrate.py", *arguments])
    frame = FRAME
    if "--" in arguments:
        at = arguments.index("--")
        arguments, frame = arguments[:at], arguments[at + 1:] or FRAME
    parser = argparse.ArgumentParser(prog="calibrate.py", description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter, exit_on_error=False)
    parser.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see calibrate.py --help"))
    parser.add_argument("target", choices=["plain", "sse4", "avx2"], help="whose kernels are counted")
    parser.add_argument("--machine", required=True, metavar="FILE")
    parser.add_argument("-g", action="append", default=[], metavar="KEY=VALUE", help="overrides a setting of the machine")
    parser.add_argument("--registers", nargs="+", type=int, default=[1, 2, 3, 4, 6, 8], metavar="N", help="to try")
    parser.add_argument("--interleaved", nargs="+", type=int, default=[0, 1, 2, 3, 4, 6], metavar="N", help="likewise")
    parser.add_argument("--no-fit", dest="fit", action="store_false", help="take the machine's own settings: for frames held out")
    parser.add_argument("-o", "--output", metavar="FILE.json", help="write what remains, for a machine's `calibration`")
    parser.add_argument("--profile", metavar="FILE", help="callgrind's of the same frame, instead of counting anew")
    parser.add_argument("--valgrind", default="valgrind", metavar="PROGRAM")
    parser.add_argument("--build", metavar="FOLDER", help="of the programs; build/release without it",
                        default=os.path.join(HERE, "../../build/release"))
    options = parser.parse_args(arguments)
    if min(options.registers) < 1:
        raise Mistake("--registers: give numbers from 1")
    if min(options.interleaved) < 0:
        raise Mistake("--interleaved: give numbers from 0")
    options.frame, options.command = frame, command
    return options


def write(path, result):
    try:
        with open(path + ".tmp", "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
            file.write("\n")
        os.replace(path + ".tmp", path)
    except OSError as failure:
        raise Mistake(f"-o {path}: {failure.strerror}") from failure


def main():
    try:
        options = parse(sys.argv[1:])
        with tempfile.TemporaryDirectory() as folder:
            result = calibrate(options, folder)
        show(result)
        if options.output:
            write(options.output, result)
        return 0
    except (Mistake, counts.Malformed, argparse.ArgumentError) as mistake:
        print(f"calibrate.py: {mistake}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("calibrate.py: stopped", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
