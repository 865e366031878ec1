# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of benchmarks/node.py that are kept: table and page say what the figures say."""

import json

import pytest
from readme import PAGES, tables
from tree import ROOT

BENCHMARKS = ROOT / 'benchmarks'
RESULTS = json.loads((BENCHMARKS / 'node.json').read_text(encoding='utf-8'))


@pytest.fixture
def node_tables(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import node_tables
    return node_tables


def test_table(node_tables):
    kept = (BENCHMARKS / 'node.md').read_text(encoding='utf-8')
    assert kept == node_tables.markdown(RESULTS)


def test_rows_come_from_the_runs(node_tables):
    for again, kept in zip(node_tables.rows(RESULTS), RESULTS['rows'], strict=True):
        assert again['what'] == kept['what']
        # differences of figures that were rounded are known less well
        for name in ('naive', 'ours'):
            assert again[name] == pytest.approx(kept[name], rel=1e-3, abs=1e-3)


def test_page(node_tables):
    made = [line.strip('| ').split(' | ') for line in node_tables.table(RESULTS['rows'])[2:]]
    page = 'docs/performance.md'
    assert tables('what the node costs', page) == [made]
    about = RESULTS['about']
    assert f'on {about["date"]}' in PAGES[page].split('| what the node costs |')[0][-900:]
