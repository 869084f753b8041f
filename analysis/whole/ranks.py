"""How well one list of figures says the order, and the size, of another."""
import math
import random
import statistics


def ranks(values):
    """1 for the least; equal values share the mean of their ranks."""
    order = sorted(range(len(values)), key=values.__getitem__)
    out = [0.0] * len(values)
    begin = 0
    while begin < len(order):
        end = begin
        while end < len(order) and values[order[end]] == values[order[begin]]:
            end += 1
        for i in order[begin:end]:
            out[i] = (begin + 1 + end) / 2
        begin = end
    return out


def spearman(a, b):
    """Pearson's correlation of the ranks; None where a list has one value only."""
    x, y = ranks(a), ranks(b)
    mean = (len(x) + 1) / 2
    product = sum((p - mean) * (q - mean) for p, q in zip(x, y))
    squares = sum((p - mean) ** 2 for p in x) * sum((q - mean) ** 2 for q in y)
    return product / math.sqrt(squares) if squares > 0 else None


def sign(x):
    return (x > 0) - (x < 0)


def kendall(a, b):
    """Kendall's tau-b: pairs in the same order less those in the opposite one, over all, ties in either list left out
    (geometric mean of what is left of each); None where a list has one value only."""
    pairs = [(sign(a[i] - a[j]), sign(b[i] - b[j])) for i in range(len(a)) for j in range(i)]
    untied = sum(p != 0 for p, _ in pairs) * sum(q != 0 for _, q in pairs)
    return sum(p * q for p, q in pairs) / math.sqrt(untied) if untied else None


def quantile(ordered, q):
    """Of an ordered list, on the line between the two values beside it."""
    at = q * (len(ordered) - 1)
    below = math.floor(at)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (at - below) * (ordered[above] - ordered[below])


def interval(a, b, statistic, resamples=2000, seed=1, coverage=0.95):
    """Percentile bootstrap: `statistic` of pairs drawn with replacement, the middle `coverage` of it; resamples in which it
    is not defined are left out. None where it never is."""
    draw = random.Random(seed)
    found = []
    for _ in range(resamples):
        chosen = [draw.randrange(len(a)) for _ in a]
        value = statistic([a[i] for i in chosen], [b[i] for i in chosen])
        if value is not None:
            found.append(value)
    found.sort()
    rest = (1 - coverage) / 2
    return [quantile(found, rest), quantile(found, 1 - rest)] if found else None


def ratio_errors(ratios):
    """Geometric mean of the ratios; how far they are from 1, and from that mean: a ratio r from c by max(r/c, c/r) - 1, its
    mean and its largest."""
    common = statistics.geometric_mean(ratios)

    def errors(centre):
        off = [max(r / centre, centre / r) - 1 for r in ratios]
        return {"mean": statistics.fmean(off), "largest": max(off)}

    return {"common_factor": common, "before": errors(1), "after": errors(common)}


def disagreements(points):
    """Pairs of names whose order differs, `points` being (name, spread, spread): spreads are (least, largest), and only such
    pairs count as lie apart in both."""
    out = []
    for i, (name, a, b) in enumerate(points):
        for other, c, d in points[:i]:
            first = (a[0] > c[1]) - (a[1] < c[0])
            second = (b[0] > d[1]) - (b[1] < d[0])
            if first * second < 0:
                out.append((other, name))
    return out
