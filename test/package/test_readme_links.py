# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where README.md, the pages in docs/ and the other texts of the project point to."""

import re

import pytest
from readme import blocks, commands, PAGES
from tree import ROOT, source_files

TEXTS = [path.relative_to(ROOT).as_posix() for path in source_files() if path.suffix == '.md']


def without_code(path):
    """Return a text without its blocks of code, in which a # begins no heading."""
    return re.sub(r'^```(?:.*\n)*?```$', '', path.read_text(encoding='utf-8'), flags=re.MULTILINE)


def places(path):
    """Return the names that links have for the headings of a text."""
    headings = re.findall(r'^#+ (.+)$', without_code(path), re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


@pytest.mark.parametrize('text', TEXTS)
def test_links_lead_somewhere(text):
    path = ROOT / text
    for link in re.findall(r'\]\(([^)\s]+)\)', without_code(path)):
        if '://' in link:
            continue
        file, _, place = link.partition('#')
        target = (path.parent / file).resolve() if file else path
        assert target.exists(), link
        assert not place or place in places(target), link


def test_every_page_is_linked_from_the_front_page():
    for page in PAGES:
        assert page == 'README.md' or f']({page})' in PAGES['README.md'], page


def test_make_targets_exist():
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8')
    for page, text in PAGES.items():
        for target in re.findall(r'(?:`|^)make (?:[A-Z]+=\S+ )?([a-z][a-z-]*)', text,
                                 re.MULTILINE):
            assert re.search(f'^{target}:', makefile, re.MULTILINE), f'{page}: {target}'


# What needs an installed ROS, or changes the machine or the shell, and what tests run elsewhere:
# make in test_make.py and by who runs this, listen.py and steer.py in test_readme_run.py.
ELSEWHERE = ('ros2 ', 'rosdep ', 'colcon ', '. install/', 'export ', 'make ',
             'tools/in_venv pip install ', 'tools/in_venv python listen.py',
             'tools/in_venv python steer.py')


@pytest.mark.parametrize('page', PAGES)
def test_commands_are_run_here_or_elsewhere(page):
    found = blocks(page)
    assert PAGES[page].count('```') == 2 * len(found)
    for language, about, text in found:
        if language != 'sh' or about == 'run':
            continue
        for command in commands(text):
            example = re.match(r'tools/in_venv python examples/(\w+)\.py', command)
            assert command.startswith(ELSEWHERE) or (
                example and list((ROOT / 'test').rglob(f'test_{example.group(1)}.py'))), command


def test_every_example_is_shown_and_tested():
    page = PAGES['docs/examples.md']
    run = ''.join(text for _, about, text in blocks('docs/examples.md') if about == 'run')
    for path in (ROOT / 'examples').glob('*.*'):
        assert f'](../examples/{path.name})' in page
        assert f'examples/{path.name}' in run or (
            ROOT / 'test' / 'examples' / f'test_{path.stem}.py').exists(), path
