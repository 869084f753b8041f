"""What the programs of this folder share: runs of the simulator, and ends of a program in one line."""
import argparse
import csv
import functools
import hashlib
import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed


class Mistake(Exception):
    """Of the user: one line."""


def main(run):
    """Runs a program and returns its exit code: run()'s (none: 0), 2 after a mistake, 130 after Ctrl-C, with a line."""
    name = os.path.basename(sys.argv[0])
    try:
        return run() or 0
    except (Mistake, argparse.ArgumentError) as mistake:
        print(f"{name}: {mistake}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"{name}: stopped", file=sys.stderr)
        return 130


def simulator(given):
    if given:
        if not os.access(given, os.X_OK) or os.path.isdir(given):
            raise Mistake(f"--simulator {given}: no program; build razor-sim and give its path")
        return given
    found = shutil.which("razor-sim")
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../build/release/sim/program/razor-sim")
    if not found and not os.access(here, os.X_OK):
        raise Mistake("razor-sim is neither on the PATH nor in build/release; build it, or give --simulator PATH")
    return found or os.path.normpath(here)


class Pool(ThreadPoolExecutor):
    """Runs side by side. What ends the program (a mistake, Ctrl-C) ends those under way, and no further one begins."""

    under_way = set()
    ends = False  # no run that begins from now on is wanted

    def __exit__(self, kind, *more):
        if kind is not None:
            Pool.ends = True
            self.shutdown(wait=False, cancel_futures=True)
            for process in list(self.under_way):
                process.terminate()
        return super().__exit__(kind, *more)


def run(program, machine, settings, more, folder):
    """The JSON report of one run with these settings of the machine; `more` are further options."""
    report = os.path.join(folder, "report.json")
    command = [program, "run", "--quiet", "--machine", machine, *more, *(word for s in settings for word in ("-g", s)),
               "--json", report]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        Pool.under_way.add(process)
        if Pool.ends:
            process.terminate()
        try:
            errors = process.stderr.read()
        except BaseException:
            process.terminate()
            raise
        finally:
            Pool.under_way.discard(process)
    if process.returncode != 0:
        lines = errors.strip().splitlines() or [f"razor-sim ended with {process.returncode}"]
        raise Mistake(f"{', '.join(settings) or machine}: {lines[-1]}")
    with open(report, encoding="utf-8") as file:
        return json.load(file)


@functools.lru_cache(maxsize=None)
def digest_of_inputs(program, machine, *scenes):
    """Of what decides a run's figures besides its options: the program's bytes, the machine with all that it inherits, the
    scenes' files. (Models that a scene names are not looked into.)"""
    resolved = subprocess.run([program, "print-config", "--machine", machine], capture_output=True, check=False)
    if resolved.returncode != 0:
        raise Mistake(resolved.stderr.decode(errors="replace").strip())
    digest = hashlib.sha256(resolved.stdout)
    try:
        for path in (shutil.which(program), *scenes):
            with open(path, "rb") as file:
                digest.update(hashlib.sha256(file.read()).digest())
    except OSError as error:
        raise Mistake(f"{error.filename}: {error.strerror}; give a file") from None
    return digest.hexdigest()


def show_progress(runs, may_fail):
    """On a terminal, how many of these futures are done, until all are or (unless they may) one has failed."""
    if not sys.stderr.isatty():
        return
    done = 0
    for done, run in enumerate(as_completed(runs), 1):
        print(f"\r{done} of {len(runs)} runs", end="", file=sys.stderr, flush=True)
        if not may_fail and run.exception() is not None:
            break
    print("\r" + " " * len(f"{done} of {len(runs)} runs") + "\r", end="", file=sys.stderr, flush=True)


def check_writable(option, path):
    if path and not os.access(os.path.dirname(path) or ".", os.W_OK):
        raise Mistake(f"{option} {path}: its folder cannot be written to")


def split_arguments(arguments):
    """Those of the program, and what follows --: those of each run."""
    at = arguments.index("--") if "--" in arguments else len(arguments)
    return arguments[:at], arguments[at + 1:]


def parser(program, description):
    """With the options that all programs here have; ends in a Mistake, not in a usage text."""
    p = argparse.ArgumentParser(prog=program, description=description, add_help=True, allow_abbrev=False,
                                formatter_class=argparse.RawDescriptionHelpFormatter, exit_on_error=False)
    p.error = lambda message: (_ for _ in ()).throw(Mistake(f"{message}; see {program} --help"))
    p.add_argument("--machine", required=True, metavar="FILE")
    p.add_argument("--jobs", type=int, default=1, metavar="N", help="runs side by side")
    p.add_argument("--csv", metavar="FILE", help="the table, for programs")
    p.add_argument("--simulator", metavar="PATH", help="razor-sim; else from the PATH or build/release")
    return p


def checked(options, more):
    """Options of parser(), looked at and completed."""
    if options.jobs < 1:
        raise Mistake(f"--jobs {options.jobs}: give a number from 1")
    check_writable("--csv", options.csv)
    options.more = more
    options.simulator = simulator(options.simulator)
    return options


def write_csv(path, rows):
    """Rows are dictionaries of the same keys; a file is whole or is not there."""
    temporary = path + ".tmp"
    try:
        with open(temporary, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise Mistake(f"--csv {path}: {error.strerror}") from error
