# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What axe finds wrong with a page for those who see little, or use no mouse."""

from axe_playwright_python.sync_playwright import Axe

# The success criteria of WCAG 2.2 on the levels A and AA.
RULES = {'runOnly': ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa']}
# Parts of viser that have no name and cannot be given one, see docs/viewing.md: sliders, the
# fields beside them, all fields of a vector but the first, icons.
NAMELESS = {'aria-input-field-name': '.mantine-Slider-thumb',
            'label': ':is(.mantine-Slider-root, .mantine-NumberInput-root) + * input',
            'button-name': '.mantine-ActionIcon-root'}


def faults(page):
    """Return [(rule, HTML of the part, what is wrong)] of a page, without the nameless parts."""
    return [(rule['id'], node['html'], node['failureSummary'])
            for rule in Axe().run(page, options=RULES).response['violations']
            for node in rule['nodes'] if not _is_nameless(page, rule['id'], node['target'][0])]


def _is_nameless(page, rule, part):
    return rule in NAMELESS and page.locator(part).first.evaluate(
        '(part, selector) => part.matches(selector)', NAMELESS[rule])
