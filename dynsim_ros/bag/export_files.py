# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Loaded bags as files for other programs: CSV and JSON lines, or arrays of numpy."""

from __future__ import annotations

from collections.abc import Mapping
import csv
import errno
import json
import os
from pathlib import Path
import re
import shutil

import numpy as np
from numpy.lib.recfunctions import repack_fields
import yaml

from .load_run import LoadedRun
from .run_names import SCENE_ATTACHMENT

# Messages with more numbers are no table; rows that are turned into text at once.
_MOST_COLUMNS, _ROWS = 200, 65536


def write_folder(run: LoadedRun, folder: Path) -> list[str]:
    """
    Write a new folder with a file for each topic that has messages; return their names.

    That is CSV, the time [s] first, whose numbers read back to the same bits; JSON lines where
    messages have no fixed layout, or very many numbers. Beside them lie the scene and the
    parameters of the beginning. Raises FileExistsError for a folder that holds anything.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder))
    try:
        for topic, name in _names(run).items():
            fields = run.columns(topic) if topic in run else {}
            if 0 < len(fields) <= _MOST_COLUMNS:
                _write_csv(folder / f'{name}.csv', {'time': run.time(topic), **fields})
            else:
                _write_json_lines(folder / f'{name}.jsonl', run, topic)
        if SCENE_ATTACHMENT in run.attachments:
            (folder / SCENE_ATTACHMENT).write_bytes(run.attachments[SCENE_ATTACHMENT][1])
        if run.parameters:
            text = yaml.safe_dump(run.parameters, sort_keys=False)
            (folder / 'parameters.yaml').write_text(text, encoding='utf-8')
        return sorted(path.name for path in folder.iterdir())
    except BaseException:
        shutil.rmtree(folder)
        raise


def write_arrays(run: LoadedRun, path: Path) -> list[str]:
    """
    Write a new .npz file with the arrays of all topics that have one; return their names.

    For each topic, named without the node, that is 'sphere/pose', structured as the messages are,
    and 'sphere/pose/time' [s]. Raises FileExistsError.
    """
    arrays = {}
    for topic, values in run.items():
        arrays[f'{run.short(topic)}/time'] = run.time(topic)
        arrays[run.short(topic)] = repack_fields(values, recurse=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, 'xb') as stream:
        try:
            np.savez(stream, **arrays)
        except BaseException:
            path.unlink()
            raise
    return sorted(arrays)


def _names(run: LoadedRun) -> dict[str, str]:
    """Return {topic: name of its file without ending}, no name twice."""
    names: dict[str, str] = {}
    for topic in run.channels:
        if topic in run or topic in run.irregular:
            name = re.sub(r'[^\w-]+', '_', run.short(topic)).strip('_') or 'topic'
            others = [name, *(f'{name}_{number}' for number in range(2, len(names) + 2))]
            names[topic] = next(other for other in others if other not in names.values())
    return names


def _write_csv(path: Path, columns: Mapping[str, np.ndarray]):
    arrays = list(columns.values())
    with path.open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(columns)
        for start in range(0, len(arrays[0]), _ROWS):
            # Of a float csv writes what repr gives: the shortest text that reads back to it.
            writer.writerows(zip(*(array[start:start + _ROWS].tolist() for array in arrays)))


def _write_json_lines(path: Path, run: LoadedRun, topic: str):
    with path.open('w', encoding='utf-8') as file:
        for time_ns, message in run.messages(topic):
            line = {'time': (time_ns - run.origin_ns) / 1e9, **message}
            file.write(json.dumps(line, default=list, ensure_ascii=False) + '\n')
