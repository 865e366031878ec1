# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Print what Rerun has made of a bag as JSON: {path: [[log time [ns], {component: values}], ...]}.

It runs in an environment of its own, which has Rerun and none of this package.
Usage: python read_with_rerun.py FILE.rrd
"""

import json
import sys

from rerun.chunk import RrdReader


def read(path):
    """Return what is printed."""
    found = {}
    for chunk in RrdReader(path).stream():
        if not chunk.is_static:
            found.setdefault(str(chunk.entity_path), []).extend(rows(chunk.to_record_batch()))
    return {name: sorted(of_one, key=lambda row: row[0]) for name, of_one in found.items()}


def rows(batch):
    """Return [log time [ns], {component: values}] of each row of a batch of Arrow's."""
    times = batch.column('message_log_time').cast('int64').to_pylist()
    columns = {name: batch.column(name).to_pylist() for name in batch.schema.names
               if ':' in name}
    return [[time, {name: column[row] for name, column in columns.items() if column[row]}]
            for row, time in enumerate(times)]


if __name__ == '__main__':
    json.dump(read(sys.argv[1]), sys.stdout)
