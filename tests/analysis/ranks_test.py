#!/usr/bin/python3
"""ranks_test.py FOLDER: the statistics of analysis/whole (FOLDER) beside closed forms and brute force."""
import itertools
import math
import random
import statistics
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import ranks  # noqa: E402


def lists_with_ties():
    draw = random.Random(7)
    for _ in range(300):
        n = draw.randrange(2, 12)
        yield [draw.randrange(4) for _ in range(n)], [draw.randrange(4) for _ in range(n)]


class Order(unittest.TestCase):
    def test_ranks_count_who_is_less(self):
        for values, _ in lists_with_ties():
            plain = [sum(w < v for w in values) + (sum(w == v for w in values) + 1) / 2 for v in values]
            self.assertEqual(ranks.ranks(values), plain)

    def test_all_permutations(self):
        for n in range(2, 7):
            taus = []
            for p in itertools.permutations(range(n)):
                squares = sum((i - x) ** 2 for i, x in enumerate(p))
                inversions = sum(p[i] > p[j] for j in range(n) for i in range(j))
                first = [math.exp(i) for i in range(n)]  # any rising function: order is all that counts
                self.assertAlmostEqual(ranks.spearman(first, p), 1 - 6 * squares / (n * (n * n - 1)))
                taus.append(ranks.kendall(first, p))
                self.assertAlmostEqual(taus[-1], 1 - 4 * inversions / (n * (n - 1)))
            self.assertAlmostEqual(statistics.fmean(taus), 0)
            self.assertAlmostEqual(statistics.pvariance(taus), 2 * (2 * n + 5) / (9 * n * (n - 1)))

    def test_ties(self):
        for a, b in lists_with_ties():
            if len(set(a)) == 1 or len(set(b)) == 1:
                self.assertIsNone(ranks.spearman(a, b))
                self.assertIsNone(ranks.kendall(a, b))
                continue
            self.assertAlmostEqual(ranks.spearman(a, b), statistics.correlation(ranks.ranks(a), ranks.ranks(b)))
            # tau-b from the sizes of groups of equal values.
            pairs = math.comb(len(a), 2)
            tied = [sum(math.comb(x.count(v), 2) for v in set(x)) for x in (a, b)]
            agree = sum((a[i] - a[j]) * (b[i] - b[j]) > 0 for i in range(len(a)) for j in range(i))
            against = sum((a[i] - a[j]) * (b[i] - b[j]) < 0 for i in range(len(a)) for j in range(i))
            tau = (agree - against) / math.sqrt((pairs - tied[0]) * (pairs - tied[1]))
            self.assertAlmostEqual(ranks.kendall(a, b), tau)

    def test_disagreements_lie_apart_in_both(self):
        def point(name, a, b, widths=(0.1, 0.1)):
            return name, (a - widths[0], a + widths[0]), (b - widths[1], b + widths[1])
        self.assertEqual(ranks.disagreements([point("a", 1, 2), point("b", 2, 1)]), [("a", "b")])
        self.assertEqual(ranks.disagreements([point("b", 2, 1), point("a", 1, 2)]), [("b", "a")])
        self.assertEqual(ranks.disagreements([point("a", 1, 1), point("b", 2, 2)]), [])
        self.assertEqual(ranks.disagreements([point("a", 1, 2, (0.6, 0.1)), point("b", 2, 1, (0.6, 0.1))]), [])
        self.assertEqual(ranks.disagreements([point("a", 1, 2, (0.1, 0.6)), point("b", 2, 1, (0.1, 0.6))]), [])
        # Without widths they are the discordant pairs that tau counts.
        for a, b in lists_with_ties():
            found = ranks.disagreements([(i, (x, x), (y, y)) for i, (x, y) in enumerate(zip(a, b))])
            plain = {(j, i) for i in range(len(a)) for j in range(i) if (a[i] - a[j]) * (b[i] - b[j]) < 0}
            self.assertEqual(set(found), plain)


class Bootstrap(unittest.TestCase):
    def test_quantiles(self):
        values = [0.0, 1.0, 4.0, 9.0]
        for q, expected in ((0, 0), (1, 9), (1 / 3, 1), (0.5, 2.5), (5 / 6, 6.5)):
            self.assertAlmostEqual(ranks.quantile(values, q), expected)
        for n in range(2, 30):
            values = sorted(random.Random(n).random() for _ in range(n))
            self.assertAlmostEqual(ranks.quantile(values, 0.5), statistics.median(values))

    def test_all_resamples_of_few_points(self):
        # Five points have 3125 resamples with replacement, all equally likely.
        a, b = [1, 2, 3, 4, 5], [2.0, 1.0, 4.0, 16.0, 8.0]

        def statistic(x, y):
            return sum(p * q for p, q in zip(x, y))  # pairs stay pairs, or this is another distribution
        exact = sorted(statistic([a[i] for i in c], [b[i] for i in c]) for c in itertools.product(range(5), repeat=5))
        for coverage in (0.5, 0.8, 0.95):
            found = ranks.interval(a, b, statistic, resamples=40000, coverage=coverage)
            for value, q in zip(found, ((1 - coverage) / 2, (1 + coverage) / 2)):
                # Three standard errors of a quantile's rank.
                within = 3 * math.sqrt(q * (1 - q) / 40000)
                self.assertGreaterEqual(value, ranks.quantile(exact, max(q - within, 0)))
                self.assertLessEqual(value, ranks.quantile(exact, min(q + within, 1)))

    def test_seeds(self):
        a, b = list(range(20)), [i + 3 * (i % 5) for i in range(20)]
        first = ranks.interval(a, b, ranks.kendall, 500, 1)
        self.assertEqual(first, ranks.interval(a, b, ranks.kendall, 500, 1))
        self.assertNotEqual(first, ranks.interval(a, b, ranks.kendall, 500, 2))
        self.assertTrue(first[0] < ranks.kendall(a, b) < first[1])

    def test_undefined(self):
        self.assertIsNone(ranks.interval([1, 1, 1], [1, 2, 3], ranks.spearman, 50))
        # Of two points half of the resamples have one alone; the others agree.
        self.assertEqual(ranks.interval([1, 2], [3, 4], ranks.spearman, 50), [1, 1])


class Ratios(unittest.TestCase):
    def test_errors(self):
        found = ranks.ratio_errors([2, 2, 2])
        self.assertAlmostEqual(found["common_factor"], 2)
        self.assertAlmostEqual(found["before"]["mean"], 1)
        self.assertAlmostEqual(found["after"]["largest"], 0)
        found = ranks.ratio_errors([0.5, 2, 0.25, 4])
        self.assertAlmostEqual(found["common_factor"], 1)
        self.assertAlmostEqual(found["before"]["mean"], 2)
        self.assertAlmostEqual(found["before"]["largest"], 3)
        self.assertEqual(found["before"], found["after"])

    def test_a_common_factor_changes_what_it_must(self):
        ratios = [0.9, 1.1, 1.7]
        one, ten = ranks.ratio_errors(ratios), ranks.ratio_errors([10 * r for r in ratios])
        self.assertAlmostEqual(ten["common_factor"], 10 * one["common_factor"])
        for name in ("mean", "largest"):
            self.assertAlmostEqual(ten["after"][name], one["after"][name])
        self.assertAlmostEqual(ten["before"]["largest"], 16)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
