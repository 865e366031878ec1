# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `plot`: the data that it draws, its files, its options, its errors."""

import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from bag_samples import sample_messages, write_foreign, write_sample
from dynsim_ros.bag import load
from dynsim_ros.cli import plot_figure, simulate
from dynsim_ros.cli.plot import main
from dynsim_ros.cli.plot_comparison import pair
from dynsim_ros.cli.plot_panels import bands, moving_anchors
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.image import imread
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

KINDS = ('spring', 'damper', 'air', 'gravity', 'net')
COMMANDS = '- {time: 0.5, anchor: hand, position: [0.2, 0, 2]}\n'


def simulated(folder, scene, name='run', *options):
    path = folder / f'{name}.mcap'
    assert simulate.main([scene, '-d', '1', '-o', str(path), '-q', *options]) == 0
    return path


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('plots')


@pytest.fixture(scope='module')
def sphere(folder):
    return simulated(folder, 'sphere_on_spring')


@pytest.fixture(scope='module')
def moved(folder):
    (folder / 'commands.yaml').write_text(COMMANDS)
    return simulated(folder, 'sphere_on_spring', 'moved', '-c', str(folder / 'commands.yaml'),
                     '--set', 'rate=50')


@pytest.fixture
def drawn(monkeypatch):
    """Give a function that plots and returns {(label, heading's number): axes} of the figure."""
    figures = []
    draw = plot_figure.draw
    monkeypatch.setattr(plot_figure, 'draw', lambda *given: figures.append(draw(*given)))

    def plotted(*arguments):
        assert main([*map(str, arguments), '-q']) == 0
        return figures[-1]
    return plotted


def axes_of(figure):
    """Return {label: [axes]} in the order in which they were drawn."""
    found = {}
    for axes in figure.axes:
        found.setdefault(axes.get_ylabel().replace('\n', ' '), []).append(axes)
    return found


def curves(axes):
    """Return {name: (time, values)} of the lines that were drawn last under each name."""
    return {line.get_label(): line.get_data() for line in axes.get_lines()}


def assert_drawn(axes, time, values, names='xyz'):
    found = curves(axes)
    assert set(found) == set(names)
    for name, column in zip(names, values.T):
        assert np.array_equal(found[name][0], time) and np.array_equal(found[name][1], column)


def test_everything_that_a_bag_has(drawn, sphere, tmp_path):
    run = load(sphere)
    found = axes_of(drawn(sphere, '-o', tmp_path / 'a.png'))
    time = run.time('sphere/pose')
    for label, values in (('position [m]', run.position('sphere')),
                          ('velocity [m/s]', run.velocity('sphere')),
                          ('angular velocity [rad/s]', run.angular_velocity('sphere'))):
        assert_drawn(found.pop(label)[0], time, values)
    turned = run.quaternion('sphere')
    assert_drawn(found.pop('orientation (quaternion)')[0], time, turned, 'xyzw')
    for kind in KINDS:
        assert_drawn(found.pop(f'{kind} force [N]')[0], time, run.force('sphere', kind))
        unit = 'mN m' if abs(run.torque('sphere', kind)).max() not in (0.0,) and abs(
            run.torque('sphere', kind)).max() < 0.02 else 'N m'
        assert_drawn(found.pop(f'{kind} torque [{unit}]')[0], time, run.torque('sphere', kind))
    energy = curves(found.pop('energy [J]')[0])
    assert set(energy) == {'kinetic', 'gravitational', 'spring', 'total'}
    for name, (_, values) in energy.items():
        assert np.array_equal(values, run.energy(name))
    # The anchor rests and nobody pushes: that work is zero.
    assert set(curves(found.pop('work done [J]')[0])) == {'damper', 'air'}
    (imbalance,) = (label for label in found if label.startswith('imbalance ['))
    assert np.array_equal(curves(found.pop(imbalance)[0])['imbalance'][1], run.energy('imbalance'))
    assert not found


def test_numbers_beside_an_axis_are_in_its_unit(drawn, sphere, tmp_path):
    figure = drawn(sphere, '-o', tmp_path / 'a.png', '--topics', 'wrench/air')
    (axes,) = axes_of(figure)['air torque [mN m]']
    FigureCanvasAgg(figure).draw()
    for tick, label in zip(axes.get_yticks(), axes.get_yticklabels()):
        assert float(label.get_text().replace('−', '-')) == pytest.approx(tick * 1e3)


def test_numbers_beside_an_axis_have_as_many_decimals(drawn, sphere, tmp_path):
    figure = drawn(sphere, '-o', tmp_path / 'a.png', '--topics', 'sphere/pose')
    (axes,) = axes_of(figure)['position [m]']
    numbers = axes.yaxis.get_major_formatter()
    assert numbers.format_ticks([-0.5, 0, 1]) == ['−0.5', '0.0', '1.0']
    assert numbers.format_ticks([0.0, 20.0]) == ['0', '20']


def test_a_curve_by_itself_has_its_name(drawn, folder, tmp_path):
    figure = drawn(simulated(folder, 'falling_in_wind', 'wind'), '-o', tmp_path / 'a.png',
                   '--topics', 'energy')
    (axes,) = axes_of(figure)['work done [J]']
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ['air']
    assert axes_of(figure)['imbalance [J]'][0].get_legend() is None


def test_what_a_particle_has(drawn, folder, tmp_path):
    path = simulated(folder, 'particle_on_spring', 'particle')
    figure = drawn(path, '-o', tmp_path / 'a.png')
    assert set(axes_of(figure)) == {
        'position [m]', 'velocity [m/s]', 'spring force [N]', 'gravity force [N]', 'net force [N]',
        'energy [J]', next(label for label in axes_of(figure) if 'imbalance' in label)}
    assert [text.get_text() for text in figure.texts] == ['particle', 'energy']
    (key,) = figure.legends
    assert [text.get_text() for text in key.get_texts()] == ['x', 'y', 'z']


def test_two_bodies_side_by_side(drawn, folder, tmp_path):
    path = simulated(folder, 'double_pendulum_of_spheres', 'two')
    figure = drawn(path, '-o', tmp_path / 'a.png', '--topics', '?*er/pose', 'energy')
    run = load(path)
    assert [text.get_text() for text in figure.texts] == ['upper', 'lower', 'energy']
    upper, lower = axes_of(figure)['position [m]']
    assert_drawn(upper, run.time('upper/pose'), run.position('upper'))
    assert_drawn(lower, run.time('lower/pose'), run.position('lower'))
    assert upper.get_position().y0 == lower.get_position().y0
    assert upper.get_position().x1 < lower.get_position().x0


def test_nothing_lies_upon_anything_else(drawn, folder, sphere, moved, tmp_path):
    two = simulated(folder, 'double_pendulum_of_spheres', 'two_bodies')
    compared = [sphere, '--compare', moved, '--topics', '*/pose', '*/spring', 'energy']
    for arguments in ([two], compared):
        figure = drawn(*arguments, '-o', tmp_path / 'a.png')
        renderer = FigureCanvasAgg(figure).get_renderer()
        boxes = [part.get_tightbbox(renderer)
                 for part in (*figure.axes, *figure.texts, *figure.legends)]
        for i, one in enumerate(boxes):
            # Numbers at the ends of axes that touch may stand half a digit over.
            assert one.x0 >= 0 and one.x1 <= figure.bbox.x1 and one.y0 >= 0
            for other in boxes[:i]:
                width = min(one.x1, other.x1) - max(one.x0, other.x0)
                height = min(one.y1, other.y1) - max(one.y0, other.y0)
                assert width <= 0 or height <= 5, (arguments, i)


def test_another_run_over_it(drawn, sphere, moved, tmp_path):
    """The other run has half the rate: it is interpolated at the times of this one."""
    figure = drawn(sphere, '--compare', moved, '-o', tmp_path / 'a.png', '--topics', '*/pose',
                   'energy')
    first, second = load(sphere), load(moved)
    (axes,) = axes_of(figure)['position [m]']
    lines = axes.get_lines()
    assert len(lines) == 6
    for i in range(3):
        assert np.array_equal(lines[i].get_ydata(), first.position('sphere')[:, i])
        assert np.array_equal(lines[3 + i].get_ydata(), second.position('sphere')[:, i])
        assert lines[i].get_color() == lines[3 + i].get_color()
        assert lines[i].get_linewidth() > lines[3 + i].get_linewidth()
    time = first.time('sphere/pose')
    (differs,) = [axes for label, found in axes_of(figure).items() for axes in found
                  if label.startswith('Δ') and label.endswith('m]') and 'x' in curves(axes)
                  and axes.get_position().y1 < lines[0].axes.get_position().y0
                  and axes.get_position().x0 == lines[0].axes.get_position().x0][:1]
    for i, name in enumerate('xyz'):
        there = np.interp(time, second.time('sphere/pose'), second.position('sphere')[:, i])
        assert np.array_equal(curves(differs)[name][1], there - first.position('sphere')[:, i])
    # The anchor moves in one of the two: it is drawn of both.
    (anchor,) = axes_of(figure)['hand position [m]']
    assert np.ptp(anchor.get_lines()[3].get_ydata()) == 0.2
    assert 'anchor' in curves(axes_of(figure)['work done [J]'][0])
    texts = [text.get_text() for key in figure.legends for text in key.get_texts()]
    assert texts[-3:] == ['run.mcap', 'moved.mcap', 'Δ: thin − broad']


def test_both_quaternions_are_one_orientation(sphere):
    run, other = load(sphere, 'sphere/pose'), load(sphere, 'sphere/pose')
    values = other['sphere/pose']['pose']['orientation']
    for axis in 'xyzw':
        values[axis] *= -1.0
    here, there = bands(run), bands(other)
    assert pair(here, there) == []
    panel = here[0][0].rows[0][1]
    for axis in 'xyzw':
        assert np.array_equal(panel.curves[axis], panel.other.curves[axis])


def test_a_quaternion_does_not_jump_to_its_opposite(sphere):
    run = load(sphere, 'sphere/pose')
    orientation = run['sphere/pose']['pose']['orientation']
    before = Rotation.from_quat(run.quaternion('sphere')).as_matrix()
    for axis in 'xyzw':
        orientation[axis][30:60] *= -1.0
    curves = bands(run)[0][0].rows[0][1].curves
    drawn = np.array([curves[axis] for axis in 'xyzw']).T
    assert np.allclose(Rotation.from_quat(drawn).as_matrix(), before, atol=1e-14)
    assert (np.sum(drawn[1:] * drawn[:-1], axis=1) > 0.5).all()


def test_anchors_that_move(drawn, moved, sphere, tmp_path):
    assert moving_anchors(load(moved)) == {'hand'} and moving_anchors(load(sphere)) == set()
    for path, anchors in ((moved, ['anchors']), (sphere, [])):
        run = load(path)
        found = bands(run, moving_anchors(run))
        assert [block.heading for band in found for block in band] == [
            'sphere', *anchors, 'energy']
    asked = drawn(sphere, '-o', tmp_path / 'a.png', '--topics', 'hand/pose')
    assert set(axes_of(asked)) == {'hand position [m]'}


def test_topics_and_times(drawn, sphere, tmp_path):
    figure = drawn(sphere, '-o', tmp_path / 'a.png', '--start', '0.25', '--end', '0.75',
                   '--topics', 'sphere/p*', '/dynsim/sphere/twist')
    assert set(axes_of(figure)) == {'position [m]', 'orientation (quaternion)', 'velocity [m/s]',
                                    'angular velocity [rad/s]'}
    for axes in figure.axes:
        assert axes.get_xlim() == (0.25, 0.75)
    assert {axes.get_xlabel() for axes in figure.axes} == {'', 'simulated time [s]'}


def test_bags_of_others(drawn, tmp_path):
    write_foreign(tmp_path / 'a.mcap', [(topic, stamp + 1_700_000_000_123_456_789, data)
                                        for topic, stamp, data in sample_messages(50)])
    figure = drawn(tmp_path / 'a.mcap', '-o', tmp_path / 'a.png')
    run = load(tmp_path / 'a.mcap')
    assert_drawn(axes_of(figure)['position [m]'][0], np.arange(50) / 100, run.position('sample'))
    assert {axes.get_xlabel() for axes in figure.axes} == {
        '', 'time since the first message [s]'}


def test_a_file_of_others_that_has_the_name_of_a_scene(tmp_path):
    write_sample(tmp_path / 'a.mcap', count=9)
    assert main([str(tmp_path / 'a.mcap'), '-o', str(tmp_path / 'a.png'), '-q']) == 0


def test_one_message(drawn, sphere, tmp_path):
    figure = drawn(sphere, '-o', tmp_path / 'a.png', '--start', '0.5', '--end', '0.5')
    assert all(line.get_marker() == '.' for axes in figure.axes for line in axes.get_lines())


def test_files(sphere, tmp_path):
    for ending in ('png', 'pdf', 'svg'):
        paths = [tmp_path / 'deep' / f'{name}.{ending}' for name in ('a', 'b')]
        for path in paths:
            assert main([str(sphere), '-o', str(path), '-q', '--topics', 'energy']) == 0
        assert paths[0].read_bytes() == paths[1].read_bytes()
    assert imread(tmp_path / 'deep' / 'a.png').shape[1] == 1440
    assert (tmp_path / 'deep' / 'a.pdf').read_bytes().startswith(b'%PDF-')
    assert (tmp_path / 'deep' / 'a.pdf').read_bytes().rstrip().endswith(b'%%EOF')
    root = ElementTree.parse(tmp_path / 'deep' / 'a.svg').getroot()
    assert root.tag == '{http://www.w3.org/2000/svg}svg'


def test_a_name_for_the_figure(sphere, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main([str(sphere), '--topics', 'energy']) == 0
    assert capsys.readouterr().out == 'run.png\n' and (tmp_path / 'run.png').is_file()


def test_what_only_one_of_two_has(folder, sphere, tmp_path, capsys):
    particle = simulated(folder, 'particle_on_spring', 'other')
    assert main([str(sphere), '--compare', str(particle), '-o', str(tmp_path / 'a.png'), '-q',
                 '--topics', '*/pose', 'energy']) == 0
    assert capsys.readouterr().err == (
        'warning: only in one of the two: sphere position, sphere orientation, energy work done, '
        'particle position\n')


def test_a_file_that_is_cut_off(sphere, tmp_path, capsys):
    (tmp_path / 'cut.mcap').write_bytes(sphere.read_bytes()[:-400])
    assert main([str(tmp_path / 'cut.mcap'), '-o', str(tmp_path / 'a.png'), '-q', '--topics',
                 'energy']) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('warning: the file ends in the middle of a record: ')


@pytest.mark.parametrize(('arguments', 'said'), [
    (['-o', 'a.jpg'], "--output a.jpg: its ending is '.jpg', a figure can be .png, .pdf, .svg"),
    (['--topics', 'sphere/puse'], "no topic 'sphere/puse' in "),
    (['--topics', 'epoch'], 'holds nothing to plot: there is no pose, twist, wrench or energy '
     'among what is asked for'),
    (['--start', '7'], 'holds nothing to plot'),
    (['--start', '2', '--end', '1'], '--start 2 s lies behind --end 1 s'),
    (['--compare', 'nothing.mcap'], 'nothing.mcap: No such file or directory'),
    (['-o', '/dev/null/a.png'], '/dev/null: File exists; choose another --output')])
def test_wrong_arguments(sphere, tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    assert main([str(sphere), *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('error: ') and said in line
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib(sphere):
    script = ('import sys; sys.modules["matplotlib"] = None\n'
              f'from dynsim_ros.cli.plot import main; sys.exit(main([{str(sphere)!r}]))')
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True,
                          check=False, timeout=100)
    assert (done.returncode, done.stdout, done.stderr) == (
        2, '', 'error: plot needs matplotlib: pip install matplotlib\n')
