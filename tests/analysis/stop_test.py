#!/usr/bin/python3
"""stop_test.py FOLDER: what ends a study of analysis (FOLDER) ends its runs, begins no further one and leaves no file."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

FOLDER = sys.argv.pop(1)

# In place of any program: notes that it began, and takes a minute; with l2.ways=3 it fails at once.
SLOW = """#!/bin/sh
case "$*" in *l2.ways=3*) echo "razor-sim: three ways" >&2; exit 2;; esac
echo $$ >> "$(dirname "$0")/begun"
exec sleep 60
"""


def ended(number):
    """Whether a process has; that nobody has asked for its exit code yet is its parents' affair."""
    try:
        with open(f"/proc/{number}/stat", encoding="utf-8") as file:
            return file.read().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def ends(number):
    """Whether a process that was told to end does so, long before it would by itself; a busy host takes its time."""
    until = time.monotonic() + 20
    while not ended(number) and time.monotonic() < until:
        time.sleep(0.02)
    return ended(number)


class Stops(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.program, self.begun, self.output = (os.path.join(folder.name, n) for n in ("program", "begun", "output"))
        with open(self.program, "w", encoding="utf-8") as file:
            file.write(SLOW)
        os.chmod(self.program, 0o755)

    def start(self, program, *options):
        return subprocess.Popen([sys.executable, os.path.join(FOLDER, program), *options], stderr=subprocess.PIPE, text=True)

    def start_sweep(self, program, *options):
        return self.start(program, "--machine", "any.toml", "--simulator", self.program, "--csv", self.output, "--jobs", "2",
                          *options)

    def numbers(self):
        if not os.path.exists(self.begun):
            return []
        with open(self.begun, encoding="utf-8") as file:
            return [int(line) for line in file.read().split("\n")[:-1]]

    def check(self, study, code, line):
        """Ends soon, with this code and line, and its runs with it."""
        _, errors = study.communicate(timeout=30)
        self.assertEqual((study.returncode, errors), (code, line + "\n"))
        self.assertLessEqual(len(self.numbers()), 2)
        for number in self.numbers():
            self.assertTrue(ends(number))
        self.assertFalse(os.path.exists(self.output))

    def stop(self, study, line, begun):
        until = time.monotonic() + 30
        while len(self.numbers()) < begun and time.monotonic() < until:
            time.sleep(0.02)
        study.send_signal(signal.SIGINT)
        self.check(study, 130, line)

    def test_sweep(self):
        self.stop(self.start_sweep("sweep/sweep.py", "--key", "l2.ways", "--values", "1", "2", "4", "8"), "sweep.py: stopped", 2)

    def test_assumptions(self):
        self.stop(self.start_sweep("sweep/assumptions.py", "--designs", "l2.ways=2", "l2.ways=4"), "assumptions.py: stopped", 2)

    def test_calibrate(self):
        self.stop(self.start("calibration/calibrate.py", "sse4", "--machine", "any.toml", "--valgrind", self.program, "-o",
                             self.output), "calibrate.py: stopped", 1)

    def test_whole(self):
        self.stop(self.start("whole/whole.py", "--machine", "any.toml", "--simulator", self.program, "--razor",
                             self.program, "--json", self.output), "whole.py: stopped", 1)

    def test_characterise(self):
        self.stop(self.start("whole/characterise.py", "--simulator", self.program, "--json", self.output),
                  "characterise.py: stopped", 1)

    def test_a_mistake_of_one_run(self):
        study = self.start_sweep("sweep/sweep.py", "--key", "l2.ways", "--values", "3", "2", "4", "8")
        self.check(study, 2, "sweep.py: l2.ways=3: razor-sim: three ways")


if __name__ == "__main__":
    unittest.main()
