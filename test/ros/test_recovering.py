# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node that was killed while it recorded, and the next one, which makes the bag whole."""

import fcntl
import re

from bag_samples import write_sample
from dynsim_ros.bag.reader import open_bag
from mcap.writer import Writer
from scene_topics import POSE


def test_the_next_start_recovers_what_the_last_one_left(start, connect):
    node = start('-p', 'record.enable:=true')
    client = connect(node)
    client.listen({'sphere/pose': POSE})
    client.more('sphere/pose', 50)
    node.kill()
    (killed,) = node.bags
    with open_bag(killed) as bag:
        assert not bag.complete
        before = list(bag.messages())
    assert sum(topic == '/dynsim/sphere/pose' for topic, _, _ in before) > 40
    runs = killed.parent
    # what is not the node's own, or is being written, stays as it is
    with open(runs / 'other.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start('ros2', 'another program')
    write_sample(runs / 'busy.mcap')
    busy = (runs / 'busy.mcap').read_bytes()[:-50]
    (runs / 'busy.mcap').write_bytes(busy)
    other = (runs / 'other.mcap').read_bytes()
    with open(runs / 'busy.mcap', 'rb') as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        following = start('-p', 'record.enable:=true', folder=node.folder)
        client = connect(following)
        client.wait(lambda: re.search(
            rf'{killed.name}: recovered, {len(before)} messages from 0.000 s', following.output))
        following.stop()
    assert '1 bag(s) in runs were interrupted: recovering' in following.output
    assert '[ERROR]' not in following.output
    with open_bag(killed) as bag:
        assert bag.complete and list(bag.messages()) == before
        assert bag.metadata['recovered']['missing'] == '0'
    assert (runs / 'other.mcap').read_bytes() == other
    assert (runs / 'busy.mcap').read_bytes() == busy
