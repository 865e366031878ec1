# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `recover`: what it says, its options, its errors."""

import fcntl

from bag_samples import write_sample
from dynsim_ros.cli.recover import main
from other_readers import by_mcap
import pytest


@pytest.fixture
def cut(tmp_path):
    """Give the path of a bag that is cut off in its last chunk, and the messages before that."""
    path = tmp_path / 'run.mcap'
    messages = write_sample(path, 100, chunk_size=3000)
    content = path.read_bytes()
    path.write_bytes(content[:len(content) * 2 // 3])
    return path, messages


def test_it_tells_what_came_back_and_what_did_not(cut, capsys):
    path, messages = cut
    assert main([str(path)]) == 0
    first, missing = capsys.readouterr().out.splitlines()
    read, count = by_mcap(path)
    assert 0 < count < len(messages) and read == messages[:count]
    assert first == (f'{path}: recovered, {count} messages from 0.000 s to '
                     f'{read[-1][1] * 1e-9:.3f} s')
    assert missing.startswith(f'{path}: messages from ')
    assert 'are missing: the file ends in the middle of a chunk' in missing
    assert main([str(path)]) == 0
    assert capsys.readouterr().out.startswith(f'{path}: is whole, {count} messages from ')


def test_another_file_and_quiet(cut, tmp_path, capsys):
    path, _ = cut
    content, output = path.read_bytes(), tmp_path / 'whole.mcap'
    assert main([str(path), '-o', str(output), '-q']) == 0
    assert capsys.readouterr() == ('', '')
    assert path.read_bytes() == content and by_mcap(output)[1] > 0
    before = output.read_bytes()
    assert main([str(path), '--output', str(output)]) == 2
    assert capsys.readouterr().err == f'error: {output}: File exists\n'
    assert output.read_bytes() == before


def test_errors_are_a_line_each_and_the_others_are_recovered(cut, tmp_path, capsys):
    path, _ = cut
    (tmp_path / 'text.mcap').write_text('no bag at all ' * 100)
    (tmp_path / 'empty.mcap').write_bytes(b'')
    busy = tmp_path / 'busy.mcap'
    busy.write_bytes(path.read_bytes())
    with open(busy, 'rb') as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        assert main([str(tmp_path / name) for name in (
            'text.mcap', 'empty.mcap', 'busy.mcap', 'nowhere.mcap', '', 'run.mcap')]) == 2
    out, err = capsys.readouterr()
    assert out.startswith(f'{path}: recovered, ')
    assert err.splitlines() == [
        f'error: {tmp_path}/text.mcap is not an MCAP file',
        f'error: {tmp_path}/empty.mcap is empty',
        f'error: {busy} is being written, or recovered, by another process',
        f'error: {tmp_path}/nowhere.mcap: No such file or directory',
        f'error: {tmp_path}: Is a directory']
    assert (tmp_path / 'text.mcap').read_text() == 'no bag at all ' * 100


def test_one_output_for_one_file(cut, capsys):
    path, _ = cut
    with pytest.raises(SystemExit):
        main([str(path), str(path), '--output', 'a'])
    assert '--output is for one FILE' in capsys.readouterr().err
