# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""All that is computed of runs: medians, intervals, exponents, fronts, and the one judgement of what is faster."""

import math
import statistics

# Of runs in one turn, or of two reports: less than this may come of where in memory something lies.
_LEAST_DIFFERENCE = 1.02
LEAST_CONFIDENCE = 0.95
# 97.5 % of Student's t for 1, 2, ... degrees of freedom; beyond the last nearly the normal distribution's.
_STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)


def rounded(value):
    """To the digits that a measured figure is kept with."""
    return float(f"{value:.7g}")


def median_interval(values):
    """(lower, upper, confidence) of one value or more: an interval that holds the median of all that might be measured,
    whatever their distribution, and how often it does, 0...1. It is between the k-th least and the k-th largest value,
    which miss the median as often as fewer than k of n throws of a coin are heads: 1 - 2 sum_{i<k} C(n, i) / 2^n. It is
    the narrowest of at least 95 %; of fewer than 6 values none has that, and it is from the least to the largest
    (Conover, Practical Nonparametric Statistics, 3.2)."""
    values, count = sorted(values), len(values)
    heads, k, confidence = 1, 1, max(0.0, 1 - 2 / 2**count)
    for i in range(1, (count + 1) // 2):
        heads += math.comb(count, i)
        if 1 - 2 * heads / 2**count < LEAST_CONFIDENCE:
            break
        k, confidence = i + 1, 1 - 2 * heads / 2**count
    return values[k - 1], values[count - k], confidence


def figures_of_times(values):
    """What a report tells of times or ratios of times, one a run."""
    lower, median, upper = statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3
    least, most, confidence = median_interval(values)
    return {
        "median": rounded(median),
        "lower_quartile": rounded(lower),
        "upper_quartile": rounded(upper),
        "interval_lower": rounded(least),
        "interval_upper": rounded(most),
        "confidence": confidence,
        "runs": len(values),
    }


def figures_of_few(values):
    """Of what takes seconds and is timed less often."""
    median, least, most = statistics.median(values), min(values), max(values)
    return {"median": rounded(median), "least": rounded(least), "most": rounded(most), "runs": len(values)}


def judge(ratio):
    """What a ratio of times says beyond noise: "faster", "slower", or nothing, "". All times are judged here alone.

    A ratio is of the runs of the same turn, so that what falls on both is not in it; its median's interval, by order
    statistics, holds the true median in 95 % of all cases, whatever the distribution, and narrows with more runs. That
    must be on one side of 1, and the median 2 % from it. Fewer than 6 runs have no such interval and say nothing."""
    if ratio["confidence"] < LEAST_CONFIDENCE:
        return ""
    if ratio["interval_upper"] < 1 and ratio["median"] * _LEAST_DIFFERENCE < 1:
        return "faster"
    if ratio["interval_lower"] > 1 and ratio["median"] > _LEAST_DIFFERENCE:
        return "slower"
    return ""


def ratio_of_reports(new, old):
    """The ratio of two times that were not measured in turns: an interval as wide as both of theirs together, so it is
    on one side of 1 where they do not meet."""
    return {
        "median": new["median"] / old["median"],
        "interval_lower": new["interval_lower"] / old["interval_upper"],
        "interval_upper": new["interval_upper"] / old["interval_lower"],
        "confidence": min(new["confidence"], old["confidence"]),
    }


def ratio_of_few(new, old):
    """As ratio_of_reports, of times with their least and most: those of n and m runs part by chance in two of
    C(n + m, n) cases."""
    return {
        "median": new["median"] / old["median"],
        "interval_lower": new["least"] / old["most"],
        "interval_upper": new["most"] / old["least"],
        "confidence": 1 - 2 / math.comb(new["runs"] + old["runs"], new["runs"]),
    }


def find_front(points):
    """Of (cost, error) pairs, the less the better: whether each lies on the Pareto front, that is no other is as good
    or better in both and better in one."""
    is_ahead = lambda a, b: a[0] <= b[0] and a[1] <= b[1] and a != b  # noqa: E731
    return [not any(is_ahead(other, point) for other in points) for point in points]


def fit_power(xs, ys):
    """y = c x^exponent by least squares of the logarithms: the exponent with its 95 % interval by Student's t, which
    takes the points' distances from the line for noise; a curve that is no power of x has a wide interval, too. Of
    three points or more, all positive."""
    xs, ys = [math.log(x) for x in xs], [math.log(y) for y in ys]
    slope, intercept = statistics.linear_regression(xs, ys)
    freedom = len(xs) - 2
    residual2 = sum((y - intercept - slope * x) ** 2 for x, y in zip(xs, ys))
    mean = statistics.fmean(xs)
    error = math.sqrt(residual2 / freedom / sum((x - mean) ** 2 for x in xs))
    reach = _STUDENT[min(freedom, len(_STUDENT)) - 1] * error
    return {"exponent": slope, "lower": slope - reach, "upper": slope + reach, "points": len(xs)}


def fit_doublings(xs, ys):
    """By how much y grows with each doubling of x, and the share of the variance that such a line explains."""
    doublings = [math.log2(x) for x in xs]
    slope = statistics.linear_regression(doublings, ys).slope
    return {"per_doubling": slope, "r_squared": statistics.correlation(doublings, ys) ** 2}


def mrays_per_s(count, times):
    """Of a report's figures of milliseconds."""
    return rounded(count / (1e3 * times["median"]))
