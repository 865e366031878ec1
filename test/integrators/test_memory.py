# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The memory of the methods."""

from dynsim_ros.integrators.memory import new_memory
import pytest

LINE = 64  # bytes, of the caches of all processors that ROS 2 runs on


@pytest.mark.parametrize('springs', [0, 1, 3])
@pytest.mark.parametrize('size', [10, 17, 43])
def test_no_lanes_lie_across_two_lines_of_the_cache(size, springs):
    # Several: where one lies in memory by chance must not decide.
    for memory in [new_memory(size, springs) for _ in range(5)]:
        assert memory.ctypes.data % LINE == 0
        assert memory.flags.c_contiguous and not memory.any()
