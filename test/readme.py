# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""README.md and the pages in docs/, taken apart."""

from itertools import takewhile
import re

from tree import ROOT

PAGES = {path.relative_to(ROOT).as_posix(): path.read_text(encoding='utf-8')
         for path in (ROOT / 'README.md', *sorted((ROOT / 'docs').glob('*.md')))}
README = PAGES['README.md']
PROGRAMS = re.findall(r"f'(\w+) = \{NAME\}\.cli\.", (ROOT / 'setup.py').read_text('utf-8'))


def tables(first, page=None):
    """Return all tables with this first heading, of a page or of all: lists of rows of cells."""
    text = '\n\n'.join(PAGES.values()) if page is None else PAGES[page]
    return [[[cell.strip() for cell in line.strip('|').split('|')]
             for line in takewhile(lambda line: line.startswith('|'), part.splitlines()[2:])]
            for part in text.split(f'\n| {first} |')[1:]]


def quoted(text):
    """Return what stands between backquotes."""
    return re.findall('`([^`]+)`', text)


def column(table, number=1):
    """Return a dict from the first name in the first cell of a table's rows to another cell."""
    return {quoted(row[0])[0]: row[number] for row in table}


def blocks(page):
    """Return the blocks of code of a page: language, the rest of that line, text."""
    return re.findall(r'^```(\w+) ?(.*)\n((?:.*\n)*?)```$', PAGES[page], re.MULTILINE)


def commands(text):
    """Return the commands in a block of code for a shell, without comments."""
    lines = re.sub(r' *\\\n *', ' ', text).splitlines()
    return [line.partition(' #')[0].strip() for line in lines if line.strip()]
