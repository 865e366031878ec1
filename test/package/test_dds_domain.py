# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
import os
import socket

from dds_domain import claim_domain


def test_this_process_is_alone_with_itself():
    assert os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] == 'LOCALHOST'
    assert 1 <= int(os.environ['ROS_DOMAIN_ID']) <= 100
    assert 'ROS_STATIC_PEERS' not in os.environ


def test_a_claimed_domain_is_given_to_no_other():
    first, mark = claim_domain()
    second, other_mark = claim_domain()
    with mark, other_mark:
        assert len({first, second, int(os.environ['ROS_DOMAIN_ID'])}) == 3


def test_a_domain_is_free_again_after_its_use():
    domain, mark = claim_domain()
    mark.close()
    again, mark = claim_domain()
    with mark:
        assert again == domain


def test_a_domain_with_a_participant_is_left_alone():
    domain, mark = claim_domain()
    mark.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
        participant.bind(('', 7400 + 250 * domain + 10))
        other, mark = claim_domain()
        mark.close()
    assert other != domain
