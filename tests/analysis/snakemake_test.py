#!/usr/bin/python3
"""snakemake_test.py PROJECT SIMULATOR: the Snakefile of sweeps on local cores: every point once, collected; what is done is not run
again; failing points are results. Without Snakemake: skipped (exit code 77)."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import small_sweep

SIMULATOR, PROJECT = os.path.abspath(sys.argv.pop()), os.path.abspath(sys.argv.pop())


class Snakemake(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        small_sweep.write(self.folder, PROJECT)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def snakemake(self, *options):
        own = dict(os.environ, PATH=os.path.join(self.folder, "bin") + os.pathsep + os.environ["PATH"])
        return subprocess.run(small_sweep.snakemake(PROJECT, SIMULATOR, "out", *options), cwd=self.folder,
                              env=small_sweep.environment(self.folder, own), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=500)

    def on_this_host(self):
        return self.snakemake("--cores", "2", "--rerun-triggers", "mtime")

    def test_points_run_and_are_collected(self):
        first = self.on_this_host()
        self.assertEqual(first.returncode, 0, first.stdout)
        results = os.path.join(self.folder, "out", "results")
        self.assertEqual(len(os.listdir(results)), 4)
        small_sweep.check_collected(self, os.path.join(self.folder, "out"))
        # One that is lost is run again, and no other.
        lost = sorted(os.listdir(results))[0]
        times = {name: os.stat(os.path.join(results, name)).st_mtime_ns for name in os.listdir(results)}
        os.remove(os.path.join(results, lost))
        self.assertEqual(self.on_this_host().returncode, 0)
        for name, time in times.items():
            now = os.stat(os.path.join(results, name)).st_mtime_ns
            (self.assertNotEqual if name == lost else self.assertEqual)(now, time, name)

    def test_the_profile_sends_each_point_to_the_cluster(self):
        # In the place of Slurm's, a program that notes its options and runs the job at once.
        os.mkdir(os.path.join(self.folder, "bin"))
        self.write("bin/sbatch", '#!/bin/sh\necho "$@" >>"$HOME/sent"\nfor script; do :; done\nsh "$script" >/dev/null 2>&1\necho 1\n')
        os.chmod(os.path.join(self.folder, "bin", "sbatch"), 0o755)
        result = self.snakemake("--profile", os.path.join(PROJECT, "analysis/sweep/slurm"))
        self.assertEqual(result.returncode, 0, result.stdout)
        with open(os.path.join(self.folder, "sent"), encoding="utf-8") as file:
            sent = file.read().splitlines()
        self.assertEqual(len(sent), 4)
        for line in sent:
            self.assertIn("--parsable --cpus-per-task=1 --mem=2000M", line)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "out", "study.html")))

    def test_mistakes_end_it(self):
        with open(os.path.join(self.folder, "study.toml"), encoding="utf-8") as file:
            study = file.read()
        self.write("study.toml", study.replace("core.lanes", "core.lane"))
        result = self.on_this_host()
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("did you mean core.lanes?", result.stdout)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "out")))


if __name__ == "__main__":
    if shutil.which("snakemake") is None:
        print("skipped: there is no snakemake; ./test.sh --all installs it")
        sys.exit(77)
    unittest.main()
