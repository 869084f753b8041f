#!/usr/bin/python3
"""chance_test.py FOLDER: intervals of analysis/sweep (FOLDER) beside what they mean, by simulation."""
import random
import statistics
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import chance  # noqa: E402
import sweep  # noqa: E402


def rows(*cycles_and_chance):
    return [{"value": str(i), "cycles": c, "chance": h} for i, (c, h) in enumerate(cycles_and_chance)]


class Chance(unittest.TestCase):
    def test_intervals_hold_the_mean_nineteen_times_of_twenty(self):
        draw = random.Random(3)
        for n in (2, 3, 5, 10, 31, 40):
            held = 0
            for _ in range(4000):
                values = [draw.gauss(100, 7) for _ in range(n)]
                held += abs(statistics.fmean(values) - 100) <= chance.half_width(values)
            self.assertAlmostEqual(held / 4000, 0.95, delta=0.013, msg=f"of {n} runs")

    def test_differences_of_two_means(self):
        draw = random.Random(4)
        held = 0
        for _ in range(4000):
            one, other = ([draw.gauss(0, 1) for _ in range(10)] for _ in range(2))
            width = chance.of_difference(chance.half_width(one), chance.half_width(other))
            held += abs(statistics.fmean(one) - statistics.fmean(other)) <= width
        self.assertGreater(held / 4000, 0.94)
        self.assertLess(held / 4000, 0.98)

    def test_one_run_says_nothing(self):
        self.assertEqual(chance.half_width([5.0]), 0)

    def test_steps_within_chance_do_not_count(self):
        self.assertEqual(sweep.direction(rows((100, 0), (95, 0)), "cycles", 0.005)[1:], (False, True))
        self.assertEqual(sweep.direction(rows((100, 0.04), (95, 0.04)), "cycles", 0.005)[1:], (False, False))
        self.assertEqual(sweep.direction(rows((100, 0.04), (95, 0.01)), "cycles", 0.005)[1:], (False, True))
        self.assertEqual(sweep.direction(rows((100, 0.01), (104, 0.01), (90, 0.01)), "cycles", 0.005)[1:], (True, True))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
