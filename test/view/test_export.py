# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run as one HTML file: what it plays, against the bag."""

import base64
import re

from bag_numbers import row
from dynsim_ros.cli.view import main
import msgspec
import numpy as np
import pytest
import zstandard


@pytest.fixture(scope='module')
def written(bag, tmp_path_factory):
    path = tmp_path_factory.mktemp('export') / 'run.html'
    assert main([str(bag), '--output', str(path), '--quiet']) == 0
    return path.read_text(encoding='utf-8')


@pytest.fixture(scope='module')
def recording(written):
    """Return what the page plays: {'durationSeconds', 'messages': [(time [s], message)]}."""
    data = base64.b64decode(re.search('__VISER_EMBED_DATA__="([^"]+)"', written).group(1))
    content = zstandard.ZstdDecompressor().decompress(data[8:])
    return msgspec.msgpack.decode(content[8:8 + int.from_bytes(content[:8], 'little')])


def test_needs_nothing_else(written):
    assert not re.search(r'<(?:script|img|iframe)[^>]* src=|<link[^>]* href="(?!data:)', written)


def test_takes_as_long_as_the_run(recording):
    # the last picture is shown as long as the others
    assert recording['durationSeconds'] == pytest.approx(2.0 + 1.0 / 30.0)


def test_moves_as_the_run_did(recording, bag):
    shown = [(time, message['position']) for time, message in recording['messages']
             if message['type'] == 'SetPositionMessage' and message['name'] == '/world/sphere']
    moments = {round(time, 9) for time, _ in shown}
    assert len(moments) == 61  # 30 a second
    for time, position in shown[-60:]:
        assert np.allclose(position, row(bag, 'sphere/pose', time)[:3], atol=1e-12), time


def test_everything_is_in_it(recording):
    names = {message.get('name') for _, message in recording['messages']}
    assert {f'/world/{name}' for name in (
        'floor', 'axes', 'sphere/light', 'sphere/dark', 'hand', 'spring', 'sphere_trail',
        'forces/sphere/spring', 'forces/sphere/gravity')} <= names


@pytest.mark.parametrize('output, reason', [
    ('run.txt', 'is no name of an HTML page; let it end in .html'),
    ('no/folder/run.html', 'is no folder that can be written to; choose another one')])
def test_refused_outputs(bag, tmp_path, capsys, output, reason):
    assert main([str(bag), '-o', str(tmp_path / output)]) == 2
    error = capsys.readouterr().err
    assert error.startswith('error: --output: ') and error.endswith(f'{reason}\n')
    assert error.count('\n') == 1
