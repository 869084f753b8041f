#!/usr/bin/python3
"""studies_test.py FOLDER RAZOR SCENES: studies of what frames build (FOLDER: analysis), on small pictures of scenes that are
shipped (SCENES)."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SCENES, RAZOR, FOLDER = sys.argv.pop(), sys.argv.pop(), sys.argv.pop()


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "study.json")

    def run_study(self, program, *options):
        result = subprocess.run([sys.executable, os.path.join(FOLDER, program), *options, "--razor", RAZOR, "--json", self.file],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.file, encoding="utf-8") as file:
            return json.load(file), result.stdout

    def refused(self, program, *options):
        result = subprocess.run([sys.executable, os.path.join(FOLDER, program), *options, "--razor", RAZOR], capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, 2, result.stderr)
        return result.stderr

    def test_hidden_objects_are_built_eagerly_alone(self):
        rows, table = self.run_study("levels/hidden.py", "--counts", "1,64,512", "--most-eager", "64", "--size", "32x32",
                                     "--repeat", "1")
        self.assertEqual([row["hidden"] for row in rows], [1, 64, 512])
        self.assertEqual(len(table.splitlines()), 4)
        self.assertIsNone(rows[2]["eager"])
        self.assertLess(rows[2]["lazy"]["megabytes"], 1.2 * rows[0]["lazy"]["megabytes"])
        self.assertGreater(rows[1]["eager"]["megabytes"], 1.5 * rows[0]["eager"]["megabytes"])
        self.assertIn("no power of two", self.refused("levels/hidden.py", "--counts", "3"))

    def test_what_stands_still_is_not_touched(self):
        rows, table = self.run_study("levels/motion.py", "--counts", "1,1024", "--frames", "3")
        self.assertEqual([row["still"] for row in rows], [1, 1024])
        self.assertEqual(len(table.splitlines()), 3)
        for row in rows:
            self.assertEqual(row["instances"], 1)
            self.assertTrue(0 < row["nodes"] < 20, row)
        self.assertIn("no power of two", self.refused("levels/motion.py", "--counts", "3"))
        self.assertIn("too few", self.refused("levels/motion.py", "--frames", "2"))

    def test_memory_stays_as_it_is_over_a_sequence(self):
        rows, table = self.run_study("levels/steady.py", os.path.join(SCENES, "courtyard.toml"), "--frames", "150", "--last", "10",
                                     "--size", "24x16", "--threads", "1")
        self.assertEqual(len(table.splitlines()), 2)
        _, half, late = rows[0]["megabytes"]
        self.assertLess(late, half + 0.5) # of 75 frames
        # Pages of the program itself are resident or not, as its host likes: up to some megabytes.
        self.assertLess(late, 1.25 * rows[0]["fresh_megabytes"])
        self.assertGreater(rows[0]["over_fresh"], 0)
        self.assertIn("too few", self.refused("levels/steady.py", "x.toml", "--frames", "10", "--last", "10"))

    def test_one_tree_has_no_duplicates(self):
        scene = os.path.join(SCENES, "crowd.toml")
        rows, table = self.run_study("sharing/sharing.py", scene, "--workers", "1,4", "--size", "96x96", "--repeat", "1", "--spp",
                                     "1")
        self.assertEqual([(row["workers"], row["share"]) for row in rows], [(1, "chip"), (4, "worker"), (4, "2"), (4, "chip")])
        self.assertEqual(len(table.splitlines()), 5)
        for row in rows:
            if row["share"] == "chip":
                self.assertEqual((row["duplicate_nodes"], row["duplicate_blocks"]), (0, 0))
        self.assertIn("no such file", self.refused("sharing/sharing.py", "nowhere.toml"))

    def test_lazy_and_eager_frames_of_a_scene(self):
        rows, _ = self.run_study("levels/laziness.py", os.path.join(SCENES, "crowd.toml"), "--size", "32x32", "--repeat", "1")
        self.assertLess(rows["lazy"]["built_bytes"], rows["eager"]["built_bytes"])
        self.assertEqual(rows["lazy"]["instances_in_all"], rows["eager"]["instances_in_all"])

    def test_samples_by_noise(self):
        rows, table = self.run_study("sampling/adaptive.py", os.path.join(SCENES, "lights.toml"), "--size", "48x32", "--uniform",
                                     "8,32", "--noise", "0.04,0.02", "--most", "128", "--reference", "256")
        self.assertEqual(len(table.splitlines()), 5)
        even, by_noise = rows[:2], rows[2:]
        self.assertLess(even[1]["error"], even[0]["error"])
        self.assertLess(by_noise[1]["noise"], by_noise[0]["noise"])
        self.assertLess(by_noise[0]["samples"], by_noise[1]["samples"])
        for row in by_noise:
            self.assertLess(row["samples"], row["most"])
            self.assertGreater(row["gain"], 0)
        self.assertIn("no numbers", self.refused("sampling/adaptive.py", "x.toml", "--noise", "little"))


if __name__ == "__main__":
    unittest.main()
