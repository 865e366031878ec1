# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The notebook on accuracy: run again, cell by cell, it prints what it was committed with."""

from contextlib import redirect_stdout
from io import StringIO
import json

import matplotlib
import pytest
from tree import ROOT

NOTEBOOK = json.loads((ROOT / 'examples' / 'accuracy.ipynb').read_text(encoding='utf-8'))


@pytest.mark.filterwarnings('ignore:FigureCanvasAgg is non-interactive')
def test_every_cell_prints_what_it_did():
    matplotlib.use('Agg')
    namespace, pictures = {}, 0
    for number, cell in enumerate(NOTEBOOK['cells']):
        if cell['cell_type'] != 'code':
            continue
        expected = ''.join(''.join(output['text']) for output in cell['outputs']
                           if output['output_type'] == 'stream')
        pictures += sum('image/png' in output.get('data', ()) for output in cell['outputs'])
        code = compile(''.join(cell['source']), f'cell {number}', 'exec')
        with redirect_stdout(StringIO()) as printed:
            exec(code, namespace)
        assert printed.getvalue() == expected, f'cell {number}'
    assert pictures == 1
