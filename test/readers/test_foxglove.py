# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The readers that Foxglove publishes decode every message by the definitions in the bag."""

from mcap.reader import make_reader
import pytest
from viewers import by_foxglove


@pytest.fixture(scope='module', params=['indexed', 'streamed'])
def found(request, bag):
    return by_foxglove(bag, request.param)


def test_every_message(found, written):
    assert len(found['messages']) == len(written)
    for theirs, message in zip(found['messages'], written):
        assert theirs == message


def test_metadata_and_attachments(found, bag):
    with open(bag, 'rb') as stream:
        reader = make_reader(stream)
        metadata = {item.name: item.metadata for item in reader.iter_metadata()}
        attachments = {item.name: item.data.decode() for item in reader.iter_attachments()}
    assert found['metadata'] == metadata and metadata.keys() >= {'dynsim_ros', 'parameters'}
    assert found['attachments'] == attachments and 'scene.yaml' in attachments
