# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Percentiles from counts, beside numpy's from all values."""

from dynsim_ros.ros.histogram import add, Histogram
import numba
import numpy as np
import pytest


@pytest.mark.parametrize('percent', [1, 50, 99, 99.5, 100])
def test_percentiles(percent):
    values = np.random.default_rng(1).lognormal(10.0, 3.0, 20_000).astype(int)
    histogram = Histogram()
    for value in values.tolist():
        histogram.add(value)
    exact = np.percentile(values, percent, method='inverted_cdf')
    assert exact <= histogram.percentile(percent) <= exact * 1.13 + 1
    assert histogram.longest == values.max()


def test_nothing_and_very_much():
    histogram = Histogram()
    assert histogram.percentile(50) is None
    for value in (-5, 0, 2 ** 70):
        histogram.add(value)
    assert (histogram.percentile(60), histogram.longest) == (0, 2 ** 63 - 1)


@numba.njit
def add_all(values, tally):
    for value in values:
        add(value, tally)


def test_counted_by_compiled_code():
    values = np.random.default_rng(2).lognormal(10.0, 3.0, 1000).astype(np.int64)
    histograms = Histogram(), Histogram()
    for value in values.tolist():
        histograms[0].add(value)
    add_all(values, histograms[1].tally)
    for percent in range(1, 101):
        exact = np.percentile(values, percent, method='inverted_cdf')
        one, other = (histogram.percentile(percent) for histogram in histograms)
        assert one == other and exact <= other <= exact * 1.13 + 1
    assert histograms[1].longest == values.max()
