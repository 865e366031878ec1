# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the bag of a run is told by: names of its attachments and of its metadata records."""

SCENE_ATTACHMENT = 'scene.yaml'
# From which the run goes on as it did: how it stood when the bag was begun.
CHECKPOINT_ATTACHMENT = 'checkpoint.json'
RUN_METADATA = 'dynsim_ros'
PARAMETER_METADATA = 'parameters'
# {topic relative to the node: its full name}.
TOPIC_METADATA = 'topics'
