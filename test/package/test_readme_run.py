# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pages: what they say to run, by running it; what they say of the node, by asking it."""

from importlib.machinery import PathFinder
import os
import re
import signal
import subprocess
import sys

from live_node import LiveNode
import pytest
from readme import blocks, column, PAGES, PROGRAMS, quoted, tables
from ros_client import Client
from tree import ROOT

NODE = 'docs/node.md'
DIAGNOSTICS = 'diagnostic_msgs/msg/DiagnosticArray'


@pytest.fixture
def desk(tmp_path):
    """Give a function that starts a shell command in a folder with the files that a page shows."""
    started = []

    def start(page, command, **options):
        if not (tmp_path / 'tools').exists():
            lay_out(tmp_path, page)
        path = f'{tmp_path / "bin"}{os.pathsep}{os.environ["PATH"]}'
        started.append(subprocess.Popen(
            ['sh', '-ec', command], cwd=tmp_path, env=dict(os.environ, PATH=path), text=True,
            start_new_session=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, **options))
        return started[-1]

    yield start
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def lay_out(folder, page):
    """Put into a folder what a reader of a page has: the files of all pages, above all its own."""
    for other in sorted(PAGES, key=lambda other: other == page):
        for _, name, text in blocks(other):
            if '.' in name:
                (folder / name).write_text(text, encoding='utf-8')
    for name in ('config', 'examples', 'scenes'):
        (folder / name).symlink_to(ROOT / name)
    programs = {'python': '', **{name: f'-m dynsim_ros.cli.{name}' for name in PROGRAMS}}
    for name in ('tools', 'bin'):
        (folder / name).mkdir()
    scripts = {folder / 'bin' / name: f'exec "{sys.executable}" {module} "$@"'
               for name, module in programs.items()}
    for path, script in {**scripts, folder / 'tools' / 'in_venv': 'exec "$@"'}.items():
        path.write_text(f'#!/bin/sh\n{script}\n')
        path.chmod(0o755)


@pytest.mark.timeout(300)
@pytest.mark.parametrize('page', PAGES)
def test_what_a_page_says_to_run_runs(desk, page):
    """From the top of a page down; the largest scene takes long to compile on a busy machine."""
    output = ''
    for language, about, text in blocks(page):
        if about != 'run':
            continue
        if language == 'text':
            # what the commands before it have printed
            assert text in output
            continue
        script = {'sh': text, 'python': f"python - <<'END'\n{text}END"}[language]
        process = desk(page, script)
        output, _ = process.communicate(timeout=200)
        assert process.returncode == 0, f'{text}\n{output}'
        assert 'error' not in output and 'warning' not in output, output


def test_error_that_it_shows(desk):
    shown = re.search('`(error: [^`]+)`', PAGES[NODE]).group(1)
    process = desk(NODE, 'tools/in_venv simulate sphere_on_spring --set sphere.mass=-2')
    assert process.communicate(timeout=60)[0] == f'{shown}\n'
    assert process.returncode == 2


@pytest.fixture(scope='module')
def client(tmp_path_factory):
    """Give a client of a node that publishes all that it can."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE',
                     str(ROOT / 'config' / 'fastdds_one_machine.xml'))
        node = LiveNode(tmp_path_factory.mktemp('node'), '-p', 'publish_clock:=true',
                        '-p', 'record.enable:=true')
        client = Client(node.name)
        client.listen({'/diagnostics': DIAGNOSTICS})
        yield client
        client.close()
        node.kill()


def generic(names_and_types):
    """Return a dict from names as in the page to types, of topics or services."""
    pairs = [('/dynsim/sphere/', '~/<body>/'), ('/dynsim/hand/', '~/<anchor>/'),
             ('/dynsim/', '~/')]
    found = {}
    for name, (type_name,) in names_and_types:
        for old, new in pairs:
            name = name.replace(old, new)
        found[name] = f'`{type_name}`'
    return found


def test_topics_commands_and_services(client):
    node = client.node
    client.wait(lambda: '/clock' in dict(
        node.get_publisher_names_and_types_by_node('dynsim', '/')))
    published = generic(node.get_publisher_names_and_types_by_node('dynsim', '/'))
    taken = generic(node.get_subscriber_names_and_types_by_node('dynsim', '/'))
    offered = generic(node.get_service_names_and_types_by_node('dynsim', '/'))
    for unlisted in ('/rosout', '/parameter_events'):
        published.pop(unlisted, None)
    # broadcast where tf2_msgs is installed, which PyPI has not
    published['/tf'] = '`tf2_msgs/msg/TFMessage`'
    topics, commands = tables('topic', NODE)
    (services,) = tables('service', NODE)
    assert column(topics) == published
    assert column(commands) == taken
    # the parameter services are mentioned, not listed
    assert column(services) == {
        name: kind for name, kind in offered.items()
        if 'std_srvs' in kind or 'visualization_msgs' in kind}
    # the standard ones come with their types alone, see test/ros/test_standard_services.py
    (standard,) = tables('standard service', NODE)
    assert {name: kind for name, kind in offered.items() if 'simulation_interfaces' in kind} == (
        column(standard) if PathFinder.find_spec('simulation_interfaces') else {})


def test_diagnostics(client):
    status = client.more('/diagnostics')[-1].status
    (table,) = tables('status in `/diagnostics`', NODE)
    assert {part.name: [value.key for value in part.values] for part in status} == {
        quoted(row[0])[0]: quoted(row[1]) for row in table}


def test_listening_and_steering(client, desk):
    listener = desk('README.md', 'exec tools/in_venv python -u listen.py', bufsize=1)
    for _ in range(3):
        assert re.fullmatch(r'\d+\.\d\d s: [+-]\d\.\d{3} [+-]\d\.\d{3} [+-]\d\.\d{3} m\n',
                            listener.stdout.readline())
    listener.send_signal(signal.SIGINT)
    output, _ = listener.communicate(timeout=30)
    assert (listener.returncode, 'Traceback' in output) == (0, False), output
    steering = desk('README.md', 'tools/in_venv python steer.py')
    output, _ = steering.communicate(timeout=30)
    assert steering.returncode == 0, output
    assert 'successful=True' in output and 'paused at tick' in output
    assert client.get('spring.stiffness', 'gravity') == [200.0, 1.62]


def test_lock_step(client, desk):
    process = desk('docs/rerunning.md', 'tools/in_venv python lock_step.py')
    output, _ = process.communicate(timeout=60)
    assert process.returncode == 0, output
    first, *steps = output.splitlines()
    assert first.startswith('paused at tick ')
    assert steps == ['tick 10, 0.1 s', 'tick 20, 0.2 s', 'tick 30, 0.3 s']
