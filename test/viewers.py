# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags as Rerun and Foxglove read them, which `make test-readers` sets up beside Python."""

import json
from pathlib import Path
import subprocess
import sys

from tree import output_of, outside_environment, ROOT

SET_UP = Path(sys.prefix, 'readers')
READY = SET_UP / 'ready'
MISSING = 'Rerun and the readers of Foxglove are not set up (make test-readers does it)'
PROGRAMS = ROOT / 'test' / 'readers'


def by_foxglove(path, way):
    """Return messages, metadata and attachments of a bag; way: 'indexed' or 'streamed'."""
    return json.loads(output_of(
        ['node', PROGRAMS / 'read_with_foxglove.cjs', way, path],
        env=outside_environment(NODE_PATH=SET_UP / 'node_modules')))


def by_rerun(path, folder):
    """Return {path: [[log time [ns], {component: values}]]}; Rerun has nothing to complain of."""
    programs, recording = SET_UP / 'rerun' / 'bin', folder / 'run.rrd'
    environment = outside_environment(XDG_CONFIG_HOME=SET_UP / 'config', RUST_LOG='warn')
    done = subprocess.run(
        [programs / 'rerun', 'mcap', 'convert', path, '--application-id', 'run',
         '--output', recording], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')
    return json.loads(output_of(
        [programs / 'python', PROGRAMS / 'read_with_rerun.py', recording], env=environment))
