#!/usr/bin/python3
"""plot_test.py FOLDER: pictures of analysis/sweep (FOLDER) hold the numbers of their files. 77 without matplotlib."""
import os
import subprocess
import sys
import tempfile
import types
import unittest

FOLDER = sys.argv.pop(1)
sys.path.insert(0, FOLDER)

try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: python3-matplotlib is not there")
    sys.exit(77)

import plot  # noqa: E402

ERRORS = """sim.quantum,cycles,host_seconds,error,error_chance
reference,1000,20.0,0.0,0.0
1,1010,12.5,0.01,0.002
100,990,8.0,-0.01,0.003
"""
TORNADO = """key,value,changed,first,ratio,verdict,noise
,,,1.0,1.2,unchanged,0.03
l2.latency,20,10,0.9,1.1,stays,0.03
core.window,8,16,1.0,0.8,FLIPS,0.03
l2.latency,20,40,1.1,1.25,stays,0.03
l1.ways,4,2,1.0,1.21,stays,0.03
"""


class Plots(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name, text=None):
        path = os.path.join(self.folder.name, name)
        if text is not None:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        return path

    def run_plot(self, *arguments):
        return subprocess.run(["/usr/bin/python3", os.path.join(FOLDER, "plot.py"), *arguments], capture_output=True,
                              text=True, check=False)

    def test_errors_lie_where_the_file_says(self):
        options = types.SimpleNamespace(files=[self.path("one.csv", ERRORS)])
        axes = plot.draw_errors(plot.drawing(), options).axes[0]
        tried, reference = (line for line in axes.lines if line.get_marker() == "o")
        self.assertEqual(list(tried.get_xdata()), [12.5, 8.0])
        self.assertEqual(list(tried.get_ydata()), [1.0, -1.0])
        self.assertEqual((list(reference.get_xdata()), list(reference.get_ydata())), ([20.0], [0]))
        ends = [segment[:, 1].tolist() for segment in axes.collections[0].get_segments()]
        for (low, high), (error, chance) in zip(ends, [(1.0, 0.2), (-1.0, 0.3)]):
            self.assertAlmostEqual(low, error - chance)
            self.assertAlmostEqual(high, error + chance)
        self.assertEqual([text.get_text() for text in axes.texts], ["1", "100"])

    def test_bars_go_from_the_unchanged_ratio(self):
        options = types.SimpleNamespace(files=[self.path("t.csv", TORNADO)], top=2)
        axes = plot.draw_tornado(plot.drawing(), options).axes[0]
        self.assertEqual([label.get_text() for label in axes.get_yticklabels()], ["core.window", "l2.latency"])
        bars = [(round(b.get_y() + b.get_height() / 2), b.get_x(), b.get_width())
                for container in axes.containers for b in container]
        for (place, left, width), expected in zip(bars, [(0, 1.2, -0.4), (1, 1.2, -0.1), (1, 1.2, 0.05)], strict=True):
            self.assertEqual(place, expected[0])
            self.assertAlmostEqual(left, expected[1])
            self.assertAlmostEqual(width, expected[2])
        for patch, centre in zip(axes.patches, (1, 1.2)):
            band = patch.get_extents().transformed(axes.transData.inverted())
            self.assertAlmostEqual(band.x0, centre * 0.97)
            self.assertAlmostEqual(band.x1, centre * 1.03)

    def test_equal_files_give_equal_bytes(self):
        source = self.path("one.csv", ERRORS)
        for name in ("a.svg", "a.png"):
            pictures = []
            for _ in range(2):
                done = self.run_plot("errors", source, "--output", self.path(name))
                self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
                with open(self.path(name), "rb") as file:
                    pictures.append(file.read())
            self.assertEqual(*pictures)
        with open(self.path("a.svg"), encoding="utf-8") as file:
            self.assertIn("sim.quantum", file.read())

    def test_mistakes_are_one_line(self):
        good = self.path("good.csv", ERRORS)
        for arguments, part in [
                (["errors", self.path("none.csv")], "none.csv: No such file"),
                (["errors", self.path("empty.csv", "")], "no rows"),
                (["errors", self.path("t.csv", TORNADO)], "has no column error; write it with sweep.py --reference"),
                (["errors", self.path("bad.csv", ERRORS.replace("12.5", "soon"))], "line 3: host_seconds is 'soon'"),
                (["errors", self.path("nan.csv", ERRORS.replace("12.5", "nan"))], "line 3: host_seconds is 'nan'"),
                (["errors", self.path("alone.csv", ERRORS.replace("reference", "2"))], "no run of the reference mode"),
                (["tornado", good], "has no column ratio; write it with assumptions.py"),
                (["tornado", self.path("old.csv", TORNADO.replace("noise", "chance"))], "has no column noise"),
                (["tornado", self.path("r.csv", TORNADO.replace("unchanged", "stays"))], "no row of what is unchanged"),
                (["tornado", self.path("v.csv", TORNADO.replace("20,10", "much,10"))], "'much'"),
                (["stars", good], "invalid choice"),
                (["errors", good, "--top", "0"], "--top 0"),
        ]:
            done = self.run_plot(*arguments, "--output", self.path("x.svg"))
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(part, done.stderr)
            self.assertFalse(os.path.exists(self.path("x.svg")))
        self.assertIn("name a .svg or .png", self.run_plot("errors", good, "--output", "x.gif").stderr)
        self.assertIn("/none/x.svg", self.run_plot("errors", good, "--output", "/none/x.svg").stderr)


if __name__ == "__main__":
    unittest.main()
