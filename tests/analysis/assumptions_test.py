#!/usr/bin/python3
"""assumptions_test.py FOLDER: studies of assumptions (FOLDER: analysis/sweep) against a machine whose cycles are a formula: what
flips, what is kept and not run again, the page, mistakes."""
import csv
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

FOLDER = sys.argv.pop(1)

# In the place of razor-sim: design a takes 100 l + w cycles, b 80 l + 30 w; three numbers are assumed, of which n takes no part.
SIMULATOR = """#!/usr/bin/python3
import json, sys
words = sys.argv[1:]
if words[0] == "--version":
    print("fake 1")
    sys.exit()
options = {}
set_to = {"design": "a", "x.l": 1.0, "x.w": 1.0, "x.n": 4, "sim.jitter": 0}
for key, value in zip(words[1:], words[2:]):
    if key == "-g":
        name, _, text = value.partition("=")
        set_to[name] = text if name == "design" else float(text)
if words[0] == "print-config":
    print(open(words[words.index("--machine") + 1]).read(), set_to)
    sys.exit()
with open("begun", "a") as file:
    file.write(" ".join(words) + "\\n")
if set_to["x.n"] == 2:
    print("razor-sim: x.n is 2; write more", file=sys.stderr)
    sys.exit(2)
l, w = set_to["x.l"], set_to["x.w"]
cycles = 100 * l + w if set_to["design"] == "a" else 80 * l + 30 * w
cycles *= 1 + 0.001 * (set_to["sim.jitter"] if set_to["design"] == "a" else 0)
json.dump({"cycles": cycles, "machine": {"x": {k[2:]: set_to[k] if k != "x.n" else int(set_to[k]) for k in ("x.l", "x.w", "x.n")}},
           "machine_provenance": {k: {"mark": "assumed"} for k in ("x.l", "x.w", "x.n")}}, open(words[words.index("--json") + 1], "w"))
"""
STUDY = """kind = "assumptions"
title = "a < b & more"
seeds = 3
designs = ["design=a", "design=b"]
[settings]
machine = "m.toml"
size = "8x8"
[full]
seeds = 5
[full.settings]
size = "16x16"
"""


class Assumptions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name, text in (("sim", SIMULATOR), ("m.toml", "x = 1\n"), ("study.toml", STUDY)):
            self.write(name, text)
        os.chmod(os.path.join(self.folder, "sim"), 0o755)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def text(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return file.read()

    def study(self, *options, simulator="./sim"):
        return subprocess.run(["/usr/bin/python3", os.path.join(FOLDER, "assumptions.py"), "study.toml", "-o", "out", "--simulator",
                               simulator, *options], cwd=self.folder, capture_output=True, text=True, check=False)

    def test_says_what_flips(self):
        done = self.study("--jobs", "2")
        self.assertEqual(done.returncode, 1, done.stderr)  # something flips
        # a takes 101, b 110; with l doubled 201 and 190, with w halved 100.5 and 95: both flip. Others stay.
        with open(os.path.join(self.folder, "out/study.csv"), encoding="utf-8") as file:
            rows = {(r["key"], r["changed"]): r for r in csv.DictReader(file)}
        self.assertAlmostEqual(float(rows["", ""]["ratio"]), sum(110 / (101 * (1 + 0.001 * s)) for s in (1, 2, 3)) / 3)
        for (key, changed), (a, b, verdict) in {("x.l", "2.0"): (201, 190, "FLIPS"), ("x.l", "0.5"): (51, 70, "stays"),
                                                ("x.w", "2.0"): (102, 140, "stays"), ("x.w", "0.5"): (100.5, 95, "FLIPS"),
                                                ("x.n", "8"): (101, 110, "stays")}.items():
            self.assertAlmostEqual(float(rows[key, changed]["ratio"]), b / a)
            self.assertEqual(rows[key, changed]["verdict"], verdict)
        self.assertIn("not changed: x.n x 0.5 (x.n is 2; write more)", done.stdout)
        self.assertIn("of 5 changes the conclusion stays in 3, is lost in 0, appears in 0, flips in 2", done.stdout)
        page = self.text("out/study.html")
        self.assertIn("a &lt; b &amp; more", page)
        self.assertIn("flips in 2", page)
        if "<svg" in page:  # with matplotlib
            xml.etree.ElementTree.fromstring(page[page.index("<svg"):page.index("</svg>") + 6])
            self.assertTrue(os.path.exists(os.path.join(self.folder, "out/study.png")))
        begun = self.text("begun").splitlines()
        self.assertTrue(all("--size 8x8" in line for line in begun))

    def test_goes_on_where_it_was(self):
        first = self.study()
        runs = len(self.text("begun").splitlines())
        self.assertEqual(runs, 2 * 3 + 2 * 6)  # noise; changes, one of them refused
        again = self.study()
        self.assertEqual(again.stdout, first.stdout)
        self.assertEqual(len(self.text("begun").splitlines()), runs + 2)  # what was refused
        # Another machine of the same name is another.
        self.write("m.toml", "x = 2\n")
        self.study()
        self.assertEqual(len(self.text("begun").splitlines()), 2 * runs + 2)
        # Another program of the same name and version is another.
        self.write("sim", SIMULATOR + "# built anew\n")
        self.study()
        self.assertEqual(len(self.text("begun").splitlines()), 3 * runs + 2)
        # The full size.
        self.study("--full")
        last = self.text("begun").splitlines()[3 * runs + 2:]
        self.assertEqual(len(last), 2 * 5 + 2 * 6)
        self.assertTrue(all("--size 16x16" in line for line in last))

    def test_mistakes_are_one_line(self):
        for part, by, says in (('"assumptions"', '"sweep"', "kind is 'sweep'"), ("seeds = 3", "seed = 3", "unknown key seed"),
                               ('size = "8x8"', "sizes = 1", "unknown setting sizes"),
                               (', "design=b"', "", "designs is ['design=a']"), ('machine = "m.toml"', "", "no settings.machine"),
                               ("seeds = 3", "seeds = ", "study.toml: "), ('size = "8x8"', "x.l = [1, 2]", "x.l is a list")):
            with self.subTest(by):
                self.write("study.toml", STUDY.replace(part, by, 1))
                done = self.study()
                self.assertEqual(done.returncode, 2)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(says, done.stderr)
                self.assertFalse(os.path.exists(os.path.join(self.folder, "out/study.html")))
        os.remove(os.path.join(self.folder, "study.toml"))
        self.assertIn("study.toml: No such file", self.study().stderr)


if __name__ == "__main__":
    unittest.main()
