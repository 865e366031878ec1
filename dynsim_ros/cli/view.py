# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `view`: shows a run in the browser, recorded or live."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
import ipaddress
import os
from pathlib import Path
import sys
import webbrowser

from .command_line import CommandLine
from .ros_arguments import split
from .signals import Signals

_DESCRIPTION = """\
Show a run in the browser: its motion in 3-D, its numbers as plots.

A recorded one (FILE, an MCAP file) is played; one that goes on in a simulation node (--live) is
steered from the page: drag anchors and bodies, move sliders, press buttons."""

_EPILOG = """\
examples:
  view runs/run.mcap
  view runs/run.mcap --output run.html
  view --live --node /lab/dynsim
  view --live --simulate --ros-args -p scene:=two_anchors -p rate:=500.0"""

# How long to wait for the simulation node to answer [s]; one that is started compiles, perhaps.
_PATIENCE, _PATIENCE_WITH_START = 10.0, 180.0


def main(args=None) -> int:
    """Show a run; return 0, also when stopped by a signal, or 2 with an error on stderr."""
    signals = Signals()
    try:
        return signals.run(lambda: _view(sys.argv[1:] if args is None else args, signals))
    except ImportError as error:
        print(f'error: {error}: {_remedy(error)}', file=sys.stderr)
    except ValueError as error:
        print(f'error: {error}', file=sys.stderr)
    except OSError as error:
        print(f'error: {error.filename or "the output"}: {error.strerror}', file=sys.stderr)
    finally:
        if args is None:
            signals.ignore()
    return 2


def _view(args, signals) -> int:
    own, ros_args = split(args)
    options = _parser().parse_args(own)
    _check(options, ros_args)
    if options.newest:
        options.file = _newest()
    return _show_live(options, ros_args, signals) if options.live else _show_recorded(
        options, signals)


def _show_recorded(options, signals) -> int:
    # Imported here so that --help is quick.
    from ..scene import load_scene
    from ..view.recorded_run import check_run, read_run
    from ..view.server import serving

    scene = load_scene(options.scene) if options.scene else None
    if options.output:
        return _export(options, scene)
    with serving(options.host, options.port, os.path.basename(options.file)) as server:
        check_run(options.file, scene)
        # A browser takes longer to begin than the run to be read: it can do so meanwhile.
        _tell(server, options)
        run = read_run(options.file, scene)
        _warn(run.problem)
        from ..view.recorded import RecordedPage

        # Whole, to browsers that are there already; and only the first camera moves theirs.
        with server.atomic():
            page = RecordedPage(server, run)
        signals.hold()
        page.run(signals.is_requested, page.frame)
    return 0


def _export(options, scene) -> int:
    from ..view.export import export
    from ..view.recorded_run import read_run

    run = read_run(options.file, scene)
    size = export(run, options.output)
    _warn(run.problem)
    if not options.quiet:
        print(f'{options.output}: {size / 1e6:.1f} MB')
    return 0


def _show_live(options, ros_args, signals) -> int:
    from .child import child
    from ..ros.context import ros_context, spinning
    from ..ros.remote import new_remote, RemoteError
    from ..view.live import LivePage, remote_scene
    from ..view.server import serving

    simulation = child('sim_node', [*(['--quiet'] if options.quiet else []), *ros_args]) \
        if options.simulate else nullcontext()
    with simulation as process, ros_context('view', [] if process else ros_args):
        def has_ended():
            return process is not None and process.poll() is not None

        def stopped():
            return signals.requested or has_ended()

        with new_remote(options.node) as (remote, node), spinning(node) as serve:
            patience = _PATIENCE_WITH_START if process else _PATIENCE
            try:
                remote.find(serve, patience, has_ended)
            except RemoteError:
                if has_ended():
                    # It has said why.
                    return _status(process.returncode)
                raise
            scene = remote_scene(remote, options.scene)
            with serving(options.host, options.port, options.node) as server:
                page = LivePage(server, remote, scene)
                signals.hold()
                _tell(server, options)
                page.run(stopped, page.frame, serve)
        return _status(process.returncode) if has_ended() else 0


def _status(returncode: int) -> int:
    """Return the exit status of the simulation; a signal that ended it is told."""
    if returncode >= 0:
        return returncode
    print(f'error: the simulation was ended by signal {-returncode}', file=sys.stderr)
    return 2


def _warn(problem: str | None):
    """Say what is wrong, if anything is."""
    if problem:
        print(f'warning: {problem}', file=sys.stderr)


def _tell(server, options):
    """Say where the page is, and open it where there is a screen for that."""
    _warn(warning_of(options.host, options.live))
    host = 'localhost' if options.host in ('localhost', '0.0.0.0', '::') else options.host
    url = f'http://{f"[{host}]" if ":" in host else host}:{server.get_port()}'
    if not options.quiet:
        print(f'open {url} in a browser; Ctrl-C ends', flush=True)
    if sys.stdout.isatty() and (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        webbrowser.open(url)


def warning_of(host: str, live: bool) -> str | None:
    """Return what it means to listen on a host, None where only this machine can reach it."""
    try:
        is_near = ipaddress.ip_address(host).is_loopback
    except ValueError:
        is_near = host == 'localhost'
    if is_near:
        return None
    what = 'see the run and steer it' if live else 'see the run'
    return (f'listening on {host}: everybody who reaches this machine there can {what}; there is '
            'no password and no encryption')


def _check(options, ros_args):
    """Raise ValueError for options that do not go together."""
    if options.simulate and not options.live:
        raise ValueError('--simulate: goes with --live only')
    if options.live and (options.file or options.output):
        what = 'FILE' if options.file else '--output'
        raise ValueError(f'{what} and --live: a live run is not a recorded one; give one of them')
    if options.newest and (options.live or options.file):
        raise ValueError('--newest: goes with neither FILE nor --live')
    if not (options.live or options.file or options.newest):
        raise ValueError('give FILE, the bag of a recorded run, or --newest or --live')
    if not options.live and ros_args:
        raise ValueError('--ros-args: goes with --live only')


def _newest() -> str:
    """Return the path of the bag that was recorded last into the default folder."""
    bags = sorted(Path('runs').glob('*.mcap'), key=lambda path: path.stat().st_mtime)
    if not bags:
        raise ValueError('runs/ holds no bag: record one first (make run), or give FILE')
    return str(bags[-1])


def _remedy(error) -> str:
    """Return what to do about a missing module."""
    if (error.name or '').partition('.')[0] in ('viser', 'rich', 'trimesh'):
        return "install it with: pip install 'dynsim_ros[view]'"
    return 'install or source ROS 2 Jazzy'


def _parser() -> CommandLine:
    """Return the parser of the command line, without the part that belongs to ROS."""
    parser = CommandLine('view', _DESCRIPTION, _EPILOG)
    add = parser.add_argument
    add('file', metavar='FILE', nargs='?', help='the bag of a recorded run')
    add('--newest', action='store_true', help='show the bag in runs/ that was changed last')
    add('-l', '--live', action='store_true', help='show and steer a run that goes on')
    add('--simulate', action='store_true',
        help='with --live: start the simulation node, too, with what stands behind --ros-args, '
             'and end it at the end')
    add('--node', default='/dynsim', metavar='NAME', type=_node_name,
        help='full name of the simulation node of --live (default /dynsim)')
    add('--scene', metavar='SCENE',
        help="name or YAML file of the run's scene, where it is not in the bag, or cannot be read "
             'from here under the name that the node has for it')
    add('--host', default='localhost', metavar='HOST',
        help='name or address to listen on (default localhost: this machine only)')
    add('--port', type=_port, metavar='PORT',
        help='port to listen on (default: the first free one from 8080 on)')
    add('-o', '--output', metavar='FILE',
        help='write the 3-D view of FILE as an HTML page that needs no Python, instead of '
             'showing it')
    add('-q', '--quiet', action='store_true', help='print warnings and errors only')
    return parser


def _node_name(text: str) -> str:
    """Return the full name of a node."""
    return text if text.startswith('/') else f'/{text}'


def _port(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"'{text}' is no port: 1 to 65535")
    return int(text)


if __name__ == '__main__':
    sys.exit(main())
