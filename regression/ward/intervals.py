"""Means of correlated data with 95 % intervals, from the distributions of Student and Fisher.
Standard library only."""
import math
import statistics


def incomplete_beta(a, b, x):
    """Regularised incomplete beta function, by its continued fraction (DLMF 8.17.22)."""
    if x <= 0 or x >= 1:
        return float(x >= 1)
    if x > (a + 1) / (a + b + 2):
        return 1 - incomplete_beta(b, a, 1 - x)
    front = math.exp(
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) +
        b * math.log1p(-x)) / a
    c, d = 1.0, 1 / (1 - (a + b) * x / (a + 1))
    value = d
    for m in range(1, 1000):
        even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        before = value
        for term in (even, odd):
            d = 1 / (1 + term * d)
            c = 1 + term / c
            value *= c * d
        if abs(value - before) < 1e-15 * abs(value):
            return front * value
    raise ArithmeticError(f"incomplete beta function: no convergence at {a}, {b}, {x}")


def student95(freedom):
    """t that Student's |t| stays below in 95 % of cases."""
    low, high = 0.0, 1e3
    for _ in range(200):
        t = (low + high) / 2
        outside = incomplete_beta(freedom / 2, 0.5, freedom / (freedom + t * t))
        low, high = (t, high) if outside > 0.05 else (low, t)
    return high


def fisher_probability(ratio, freedom_1, freedom_2):
    """Probability of a ratio of variances at least as large."""
    return incomplete_beta(freedom_2 / 2, freedom_1 / 2,
                           freedom_2 / (freedom_2 + freedom_1 * ratio))


def half_width(values):
    """Half-width of the 95 % interval of the mean of independent values."""
    return student95(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))


def estimate(replicas):
    """Mean of batches of equal length, in replicas of equally many.

    @return mean; half the width of its 95 % interval, the wider one of Student's over the replicas'
    means and over all batches; probability that means of replicas scatter so much beyond their
    batches by chance (analysis of variance)
    """
    batches = [value for replica in replicas for value in replica]
    means = [statistics.fmean(replica) for replica in replicas]
    between, within = statistics.variance(means), statistics.fmean(
        statistics.variance(replica) for replica in replicas)
    each = len(replicas[0])
    consistent = 1.0 if within == 0 else fisher_probability(each * between / within,
                                                            len(replicas) - 1,
                                                            len(batches) - len(replicas))
    return statistics.fmean(batches), max(half_width(means), half_width(batches)), consistent
