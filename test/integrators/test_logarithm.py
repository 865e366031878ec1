# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Powers for the control of steps: as near to the exact ones as they say, the same bits plain."""

from dynsim_ros.integrators.logarithm import binary_logarithm, binary_power
from dynsim_ros.physics.jit import kernel
import numpy as np


@kernel
def both(x, out):
    """Write log2(2^x) and 2^x, as they are here, to out."""
    out[1] = binary_power(x)
    out[0] = binary_logarithm(out[1])


def test_logarithm():
    x = np.logspace(-300, 300, 20011)
    found = np.array([binary_logarithm(number) for number in x])
    np.testing.assert_allclose(found, np.log2(x), rtol=0, atol=7.7e-3)
    assert (np.diff(found) > 0).all()
    assert [binary_logarithm(2.0 ** n) for n in range(-1000, 1001)] == [*range(-1000, 1001)]


def test_power():
    x = np.linspace(-1000, 1000, 20011)
    found = np.array([binary_power(number) for number in x])
    np.testing.assert_allclose(found, np.exp2(x), rtol=2.7e-3)
    assert (np.diff(found) > 0).all()
    assert [binary_power(float(n)) for n in range(-1000, 1001)] == [
        2.0 ** n for n in range(-1000, 1001)]


def test_compiled_as_plain():
    out = np.zeros(2)
    for x in np.linspace(-99, 99, 333):
        both(x, out)
        assert out[1] == binary_power(x)
        assert out[0] == binary_logarithm(out[1])
