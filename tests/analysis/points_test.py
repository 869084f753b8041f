#!/usr/bin/python3
"""points_test.py FOLDER: studies of analysis/sharing (FOLDER: analysis) with a simulator that only says what it is told to say:
points are kept and not run twice, designs within chance are not told apart, crossovers lie where they were put."""
import csv
import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.abspath(sys.argv.pop())
sys.path.insert(0, os.path.join(FOLDER, "sharing"))
import points  # noqa: E402
import simulated  # noqa: E402

# Trees of each worker's own take fewer cycles from 1.4 MiB on; a core's and a tile's are as dear as all workers' one, but for noise.
FAKE = f"""#!{sys.executable}
import json, os, sys
a = sys.argv[1:]
value = lambda option: a[a.index(option) + 1]
if a[0] == "print-config":
    sys.exit(sys.stdout.write(open(value("--machine")).read()) and 0)
settings = dict(word.split("=") for option, word in zip(a, a[1:]) if option == "-g")
with open(os.environ["CALLS"], "a") as log:
    log.write(" ".join(a) + "\\n")
if os.environ.get("FAILS_AT") and sum(1 for _ in open(os.environ["CALLS"])) > int(os.environ["FAILS_AT"]):
    print("razor-sim: enough", file=sys.stderr)
    sys.exit(2)
size, seed = int(settings.get("l2.size_bytes", 1 << 20)), int(value("--jitter"))
workers = int(value("--workers"))
mega = size / (1 << 20)
work = {{"worker": 14e6 / mega, "core": 10.01e6, "tile": 9.99e6, "chip": 10e6}}[value("--share")] * (1 + 0.01 * (seed - 2))
on = settings.get("renderer.discard") == "on"
bounded = "--memory" in a
rows = [{{"structure": s, "phase": p, "memory_reads": 100, "memory_writes": w}}
        for s, p, w in (("grids", "build", 20 if on else 80), ("item lists", "frame end", 0 if on else 120), ("frame buffer", "frame end", 7))]
report = {{"core": {{"vops": 4e8 if workers > 1 else 1e6, "instructions": 1}}, "cycles": 2 * work, "workers": workers,
          "stack": {{"busy": work * workers, "idle": 3 * work, "synchronise": 0}}, "memory": {{"reads": 1000, "writes": 2000}},
          "l1": {{"discarded": 5 if on else 0}}, "l2": {{"discarded": 6 if on else 0}}, "traffic": rows,
          "renderer": {{"built": {{"inner_nodes": 6, "leaves": 4, "grid_bytes": 1, "node_bytes": 2, "list_bytes": 3}},
                       "counters": {{"blocks_made": 30 if bounded else 20}}, "duplicates": {{"kd_nodes": 5, "blocks": 2}}}}}}
with open(value("--json"), "w") as file:
    json.dump(report, file)
"""


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = folder.name
        self.simulator = self.file("razor-sim", FAKE)
        os.chmod(self.simulator, os.stat(self.simulator).st_mode | stat.S_IXUSR)
        self.scene = self.file("s.toml", "[settings]\nsize = [1024, 1024]\n")
        self.calls = os.path.join(self.path, "calls")

    def file(self, name, text):
        path = os.path.join(self.path, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def study(self, program, *options, code=0, fails_at=""):
        open(self.calls, "w").close()
        result = subprocess.run([sys.executable, os.path.join(FOLDER, "sharing", program), os.path.join(self.path, "out"), "--simulator",
                                 self.simulator, "--scenes", self.scene, *options],
                                capture_output=True, text=True, env={**os.environ, "CALLS": self.calls, "FAILS_AT": fails_at})
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def called(self):
        with open(self.calls, encoding="utf-8") as file:
            return file.read().splitlines()

    def table(self, name):
        with open(os.path.join(self.path, "out", name), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_who_should_share(self):
        sizes = ("--l2", "512KiB..4MiB", "--seeds", "1,2,3")
        result = self.study("simulated.py", *sizes)
        # copernicus: one worker, 4 by three ways; zen4-2c: one worker, 2 by two; four sizes by three ways: three seeds each.
        self.assertEqual(len(self.called()), 3 * (1 + 3 + 1 + 2 + 4 * 3))
        self.assertTrue(all("--crop 480,480,64,64 --frame 40" in call for call in self.called()))
        self.assertIn("s.toml: the cheapest: a tile's or all (512 KiB to 1 MiB); nobody (2 MiB to 4 MiB)", result.stdout)
        self.assertIn("trees of nobody become cheaper than one for all at an L2 of 1434 KiB", result.stdout)
        self.assertIn("trees of a tile's and one for all: no crossover", result.stdout)
        self.assertIn("51 of 57 points take more than 300 million operations, at most 400: ", result.stderr)
        rows = self.table("simulated.csv")
        self.assertEqual(len(rows), 19)
        self.assertEqual({row["runs"] for row in rows}, {"3"})
        row = next(r for r in rows if r["share"] == "worker" and r["l2_bytes"] == str(4 << 20))
        self.assertAlmostEqual(float(row["work_cycles"]), 3.5e6)
        self.assertAlmostEqual(float(row["work_cycles_half_width"]), 4.303 * 0.035e6 / 3 ** 0.5, delta=1)
        self.assertAlmostEqual(float(row["duplicate_nodes"]), 0.5)
        self.assertAlmostEqual(float(row["duplicate_blocks"]), 0.1)
        with open(os.path.join(self.path, "out", "simulated.json"), encoding="utf-8") as file:
            self.assertEqual(len(json.load(file)), 19)
        if "no plot" not in result.stderr:  # where there is nothing to draw with
            with open(os.path.join(self.path, "out", "simulated.svg"), encoding="utf-8") as file:
                self.assertTrue("one tree for all" in file.read())

        # Told anew without a run; another size is all that is missing; another program's points are others.
        again = self.study("simulated.py", *sizes)
        self.assertEqual((self.called(), again.stdout), ([], result.stdout))
        self.study("simulated.py", "--l2", "512KiB..8MiB", "--seeds", "1,2,3")
        self.assertEqual(len(self.called()), 3 * 3)
        with open(self.simulator, "a", encoding="utf-8") as file:
            file.write("# another\n")
        self.study("simulated.py", "--l2", "1MiB", "--seeds", "2")
        self.assertEqual(len(self.called()), 10)
        with open(self.scene, "a", encoding="utf-8") as file:  # the same name
            file.write("# another\n")
        self.study("simulated.py", "--l2", "1MiB", "--seeds", "2")
        self.assertEqual(len(self.called()), 10)

    def test_a_stopped_study_goes_on(self):
        options = ("--l2", "1MiB", "--seeds", "2", "--jobs", "1")
        result = self.study("simulated.py", *options, code=2, fails_at="5")
        self.assertIn("enough", result.stderr)
        self.assertNotIn("simulated.csv", os.listdir(os.path.join(self.path, "out")))
        done = [name for name in os.listdir(os.path.join(self.path, "out")) if name.endswith(".json")]
        self.assertEqual(len(done), 5)
        with open(os.path.join(self.path, "out", done[0]), "w", encoding="utf-8") as file:
            file.write("{")  # of a host that went down
        self.study("simulated.py", *options)
        self.assertEqual(len(self.called()), 10 - 4)

    def test_discarding(self):
        result = self.study("discard.py", "--l2", "256KiB,1MiB", "--seeds", "1,2", "--memory", "4MiB")
        self.assertEqual(len(self.called()), 2 * 2 * 2 * 2)
        self.assertTrue(all("sim.frame_end=write" in call and "--share tile" in call for call in self.called()))
        self.assertIn("that discarding spares: 256 KiB 90 %, 1 MiB 90 %", result.stdout)
        rows = self.table("discard.csv")
        self.assertEqual(len(rows), 8)
        by = {(r["l2_bytes"], r["discard"], r["memory"]): r for r in rows}
        off, on = by["262144", "off", ""], by["262144", "on", "4MiB"]
        self.assertEqual([float(off[k]) for k in ("transient_writes", "transient_left", "transient_reads", "blocks_again")], [80, 120, 200, 0])
        self.assertEqual([float(on[k]) for k in ("transient_writes", "transient_left", "discarded", "blocks_again")], [20, 0, 11, 10])

    def test_mistakes(self):
        for program, options, words in (("simulated.py", ("--l2", "3kb"), "no size of a cache"), ("simulated.py", ("--l2", "2MiB..1MiB"), "ends before"),
                                        ("simulated.py", ("--seeds", "a"), "--seeds 'a'"),
                                        ("simulated.py", ("--seeds", "1,2,1"), "1 is given twice; give each number once"),
                                        ("simulated.py", ("--crop", "64"), "WIDTHxHEIGHT"),
                                        ("simulated.py", ("--crop", "2048x16"), "is no part of"), ("simulated.py", ("--jobs", "0"), "--jobs 0"),
                                        ("simulated.py", ("--output", "a.pdf"), ".svg or .png"), ("simulated.py", ("--lod", "x"), "--help"),
                                        ("discard.py", ("--memory", "4"), "no size of a cache"), ("discard.py", ("--json", "/no/where"), "folder")):
            lines = self.study(program, *options, code=2).stderr.splitlines()
            self.assertEqual(len(lines), 1, lines)
            self.assertIn(words, lines[0])
            self.assertEqual(self.called(), [])

    def test_sizes_are_in_order(self):
        self.assertEqual(points.sizes_of("4MiB,512KiB,1024KiB,1MiB"), [512 << 10, 1 << 20, 4 << 20])
        self.assertEqual(points.sizes_of("256KiB..1MiB"), [256 << 10, 512 << 10, 1 << 20])
        said = {self.study("simulated.py", "--l2", sizes, "--seeds", "1,2,3").stdout for sizes in ("512KiB,2MiB,4MiB", "4MiB,512KiB,2MiB,512KiB")}
        self.assertEqual(len(said), 1, said)
        self.assertIn("trees of nobody become cheaper than one for all", said.pop())

    def test_crossings(self):
        def runs(*values):
            return [{"work_cycles": v} for v in values]

        sizes = [1, 2, 4, 8]
        falling = {1: runs(8), 2: runs(4), 4: runs(2), 8: runs(1)}
        flat = {s: runs(4 / 2 ** 0.5) for s in sizes}
        (at, wins), = simulated.crossings(sizes, falling, flat)
        self.assertAlmostEqual(at, 2 * 2 ** 0.5)
        self.assertTrue(wins)
        (at, wins), = simulated.crossings(sizes, flat, falling)
        self.assertFalse(wins)
        noisy = {s: runs(1, 4, 3) for s in sizes}
        self.assertEqual(simulated.crossings(sizes, noisy, flat), [])
        # What chance leaves open in between does not hide that sides were changed.
        gap = {1: runs(8, 8), 2: runs(1, 7), 4: runs(0.9, 5), 8: runs(1, 1)}
        self.assertEqual(len(simulated.crossings(sizes, gap, flat)), 1)
        self.assertEqual(points.best_of({"a": runs(1, 1), "b": runs(0.9, 1.2), "c": runs(2, 2)}, "work_cycles"), ["a", "b"])


if __name__ == "__main__":
    unittest.main()
