# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Keep each test process to itself: on this machine, in a DDS domain of its own, with its own logs.

All of it is set before anything imports rclpy, and is inherited by the processes that tests start.
"""

import os
from pathlib import Path
import shutil
import tempfile

from chromium import chromium, MISSING
from dds_domain import claim_domain
import interfaces
import viewers

ROOT = Path(__file__).resolve().parent.parent
_DOMAIN, _DOMAIN_MARK = claim_domain()
_LOGS = tempfile.mkdtemp(prefix='dynsim_ros_test_logs_')

os.environ.update(
    ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST', ROS_DOMAIN_ID=str(_DOMAIN), ROS_LOG_DIR=_LOGS)
for _name in ('ROS_LOCALHOST_ONLY', 'ROS_STATIC_PEERS', 'ROS_DISCOVERY_SERVER', 'ROS_NAMESPACE',
              'FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE'):
    os.environ.pop(_name, None)
# without kept byte code each process that tests start would compile the whole package first
os.environ.pop('PYTHONDONTWRITEBYTECODE', None)
# processes that tests start run this tree, installed or not
os.environ['PYTHONPATH'] = os.pathsep.join(
    [str(ROOT), *filter(None, [os.environ.get('PYTHONPATH')])])


def pytest_report_header():
    lines = [f'DDS domain {_DOMAIN}, discovery on this machine only']
    if chromium() is None:
        lines.append(f'the tests in test/browser are left out: {MISSING}')
    if not viewers.READY.exists():
        lines.append(f'the tests in test/readers are left out: {viewers.MISSING}')
    if interfaces.left_out():
        lines.append(f'{", ".join(interfaces.left_out())} left out: {interfaces.MISSING}')
    return lines


def pytest_unconfigure():
    shutil.rmtree(_LOGS, ignore_errors=True)
