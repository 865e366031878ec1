# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The checksum of bags, beside that of zlib."""

import subprocess
import sys
import zlib

from dynsim_ros.bag.checksum import crc32
import numpy as np
import pytest


@pytest.mark.parametrize('size', [0, 1, 15, 16, 17, 4096, 262_145])
def test_checksum_is_that_of_zlib(size):
    data = np.random.default_rng(size).bytes(size)
    assert crc32(data) == zlib.crc32(data)
    assert crc32(memoryview(data)) == zlib.crc32(data)
    part = size // 3
    assert crc32(data[part:], crc32(data[:part])) == zlib.crc32(data)


def test_without_isal_it_is_zlib():
    code = ("import sys; sys.modules['isal'] = None; import zlib; "
            'from dynsim_ros.bag import checksum; assert checksum.crc32 is zlib.crc32')
    subprocess.run([sys.executable, '-c', code], check=True, timeout=60)
