# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Computes statistics of runs (medians, quartiles, intervals and growth), and reads the files of promin-lab with all
runs."""

import json
import math
import pathlib
import statistics

_LEAST_CONFIDENCE = 0.95


def _rounded(value):
    return float(f"{value:.7g}")


def median_interval(values):
    """Returns (lower, upper, confidence) for one value or more. With that confidence, the interval from lower to upper
    contains the true median, whatever the distribution is. The interval lies between the k-th smallest and the k-th
    largest value. Its confidence is the chance that of n throws of a coin at least k are heads and at least k are
    tails: 1 - 2 sum_{i<k} C(n, i) / 2^n. The function returns the narrowest such interval of at least 95 %. Fewer than
    6 values have none, and give the smallest and the largest value (Conover, Practical Nonparametric Statistics,
    3.2)."""
    values, count = sorted(values), len(values)
    heads, k, confidence = 1, 1, max(0.0, 1 - 2 / 2**count)
    for i in range(1, (count + 1) // 2):
        heads += math.comb(count, i)
        if 1 - 2 * heads / 2**count < _LEAST_CONFIDENCE:
            break
        k, confidence = i + 1, 1 - 2 * heads / 2**count
    return values[k - 1], values[count - k], confidence


def figures_of_times(values):
    """Returns the figures of times or of ratios of times, of which each run has one."""
    lower, median, upper = statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3
    least, most, confidence = median_interval(values)
    return {
        "median": _rounded(median),
        "lower_quartile": _rounded(lower),
        "upper_quartile": _rounded(upper),
        "interval_lower": _rounded(least),
        "interval_upper": _rounded(most),
        "confidence": confidence,
        "runs": len(values),
    }


def fit_doublings(xs, ys):
    """Returns the growth of y with each doubling of x, and the fraction of the variance that such a line explains."""
    doublings = [math.log2(x) for x in xs]
    slope = statistics.linear_regression(doublings, ys).slope
    return {"per_doubling": slope, "r_squared": statistics.correlation(doublings, ys) ** 2}


def mrays_per_s(count, times):
    return _rounded(count / (1e3 * times["median"]))


def _summarise(value):
    """Replaces arrays of runs by figures."""
    if isinstance(value, list) and value and isinstance(value[0], (int, float)):
        return figures_of_times(value)
    if isinstance(value, list):
        return [_summarise(part) for part in value]
    if isinstance(value, dict):
        return {key: _summarise(part) for key, part in value.items()}
    return _rounded(value) if isinstance(value, float) else value


def read_figures(file):
    """Returns the content of a file of promin-lab or of peers.py, with medians and rates in place of the runs."""
    report = _summarise(json.loads(pathlib.Path(file).read_text(encoding="utf-8")))
    for section in ("rates", "robustness"):
        for row in report.get(section, {}).get("rows", []):
            for who in ("promin", "peer", "peer_packets", "robust", "plain"):
                if f"{who}_ms" in row:
                    row[f"{who}_mrays_per_s"] = mrays_per_s(row["count"], row[f"{who}_ms"])
    return report
