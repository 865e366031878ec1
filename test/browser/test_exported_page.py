# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The HTML file of a recorded run, opened from the disk."""

from dynsim_ros.cli.view import main

SMALL = {'width': 360, 'height': 320}


def test_plays_by_itself(open_page, bag, tmp_path):
    path = tmp_path / 'run.html'
    assert main([str(bag), '-o', str(path), '--quiet']) == 0
    page = open_page(path.as_uri(), SMALL)
    page.locator('canvas[data-engine]').wait_for()
    clock = page.get_by_role('textbox').first
    before = clock.input_value()
    page.wait_for_function('before => document.querySelector("input[inputmode]").value != before',
                           arg=before)
