# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Curves thinned for drawing: the picture stays what it was, to a pixel."""

from dynsim_ros.cli.plot_scale import limits, prefixed
from dynsim_ros.cli.plot_thinning import thinned
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
import numpy as np
import pytest


def picture(time, values):
    """Return the pixels of a curve drawn 300 wide, as `plot` does but without antialiasing."""
    figure = Figure(figsize=(1.5, 1), dpi=200)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.plot(time, values, 'k', linewidth=0.9, antialiased=False)
    axes.set(xlim=(0, 1), ylim=(-3, 3))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., 0] < 128


def grown(pixels):
    """Return what is at most one pixel away from a picture."""
    padded = np.pad(pixels, 1)
    height, width = pixels.shape
    return np.any([padded[y:y + height, x:x + width] for y in range(3) for x in range(3)], axis=0)


@pytest.mark.parametrize('even', [True, False])
def test_peaks_stay(even):
    random = np.random.default_rng(1)
    time = np.linspace(0, 1, 100_000) if even else np.sort(random.random(100_000) ** 3)
    values = np.sin(300 * time) + 0.1 * random.standard_normal(len(time))
    values[12_345], values[77_777] = 2.9, -2.9
    few_times, few = thinned(time, values, 300)
    assert len(few) <= 1200
    assert {2.9, -2.9} <= set(few) and np.isin(few_times, time).all()
    assert (few_times[0], few_times[-1]) == (time[0], time[-1])
    assert (np.diff(few_times) >= 0).all()
    whole, thin = picture(time, values), picture(few_times, few)
    assert not (whole & ~grown(thin)).any() and not (thin & ~grown(whole)).any()


def test_few_samples_stay_as_they_are():
    time, values = np.arange(1200.0), np.arange(1200.0) ** 2
    assert thinned(time, values, 300)[0] is time


@pytest.mark.parametrize('values', [
    np.full(5000, np.nan), np.zeros(5000), np.where(np.arange(5000) % 7 == 0, np.nan, 1.0)])
def test_odd_values(values):
    time, few = thinned(np.arange(5000.0), values, 100)
    assert len(time) == len(few) <= 400 and len(time) >= 100


def test_all_at_one_time():
    _, few = thinned(np.zeros(5000), np.arange(5000.0), 100)
    assert few.tolist() == [0.0, 4999.0]


@pytest.mark.parametrize(('unit', 'largest', 'expected'), [
    ('m', 1.5, ('m', 1.0)), ('J', 3e-9, ('nJ', 1e-9)), ('N m', 0.019, ('mN m', 1e-3)),
    ('N', 2.5e4, ('kN', 1e3)), ('rad/s', 999e-6, ('µrad/s', 1e-6)), ('J', 0.0, ('J', 1.0)),
    ('', 1e-9, ('', 1.0)), ('J', 1e-99, ('J', 1.0))])
def test_prefixes(unit, largest, expected):
    assert prefixed(unit, largest) == expected


@pytest.mark.parametrize(('values', 'expected'), [
    ([0.0, 0.0], (-1.0, 1.0, 0.0)), ([np.nan], (-1.0, 1.0, 0.0)), ([], (-1.0, 1.0, 0.0)),
    ([-9.81, -9.81], (-10.791, -8.829, 9.81)), ([0.0, 1.0, np.inf], (-0.06, 1.06, 1.0)),
    ([5.0, 5.0 + 1e-9], (4.5, 5.5, 5.0))])
def test_limits(values, expected):
    assert limits([np.array(values)]) == pytest.approx(expected)
