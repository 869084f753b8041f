"""How far a mean of a few runs may be off by chance."""
import math
import statistics

# Student's t, 97.5 %, for 1 ... 30 degrees of freedom.
T_975 = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
         2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042]


def half_width(values):
    """Of the 95 % interval of the mean of independent runs; 0 for one run, of which nothing is known."""
    n = len(values)
    if n < 2:
        return 0.0
    t = T_975[n - 2] if n - 2 < len(T_975) else statistics.NormalDist().inv_cdf(0.975)
    return t * statistics.stdev(values) / math.sqrt(n)


def of_difference(one, other):
    """Half width for the difference of two means that are independent, from theirs."""
    return math.hypot(one, other)
