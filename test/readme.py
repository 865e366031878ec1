# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""README.md, taken apart."""

from itertools import takewhile
import re

from tree import ROOT

README = (ROOT / 'README.md').read_text(encoding='utf-8')
PROGRAMS = ('sim_node', 'simulate', 'replay')


def table(first, which=0):
    """Return the rows, lists of cells, of the first (or a later) table with this first heading."""
    lines = README.split(f'\n| {first} |')[1 + which].splitlines()[2:]
    return [[cell.strip() for cell in line.strip('|').split('|')]
            for line in takewhile(lambda line: line.startswith('|'), lines)]


def quoted(text):
    """Return what stands between backquotes."""
    return re.findall('`([^`]+)`', text)


def column(first, number=1, which=0):
    """Return a dict from the first name in the first cell to another cell of a table."""
    return {quoted(row[0])[0]: row[number] for row in table(first, which)}


def blocks():
    """Return the blocks of code: language, the rest of that line, text."""
    return re.findall(r'^```(\w+) ?(.*)\n((?:.*\n)*?)```$', README, re.MULTILINE)
