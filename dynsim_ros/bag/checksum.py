# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""CRC-32, the checksum of MCAP: crc32(data, value=0) as zlib has it, where it can faster."""

try:
    from isal.isal_zlib import crc32
except ImportError:
    # It is compiled for few processors, and may lack where ROS is installed.
    from zlib import crc32

__all__ = ['crc32']
