# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The server that a page comes from."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import errno
import socket

import rich
import viser

PORT = 8080
# How many ports above it to try where nobody chose one.
_TRIES = 100


class ViewError(ValueError):
    """A page that cannot be shown; one line of text."""


@contextmanager
def serving(host: str, port: int | None, label: str) -> Iterator[viser.ViserServer]:
    """
    Give a viser server that listens on a host and a port until the block is left.

    port: None for the first free one from 8080 on; label: title of the page's panel. Raises
    ViewError where it cannot listen.
    """
    port = _free_port(host, port)
    # viser tells about itself by rich.print, in places that have no switch.
    rich.reconfigure(quiet=True)
    server = viser.ViserServer(host=host, port=port, label=label, verbose=False)
    # To share is to send all that is shown to a server on the internet.
    server.gui.configure_theme(show_logo=False, show_share_button=False,
                               brand_color=(18, 74, 140))
    server.scene.world_axes.visible = False
    try:
        yield server
    finally:
        server.stop()


def _free_port(host, port):
    """Return a port that can be listened on; viser itself would try others for ever."""
    candidates = range(PORT, PORT + _TRIES) if port is None else [port]
    for candidate in candidates:
        try:
            family, kind, protocol, _, address = socket.getaddrinfo(
                host, candidate, type=socket.SOCK_STREAM)[0]
            with socket.socket(family, kind, protocol) as trial:
                trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                trial.bind(address)
            return candidate
        except socket.gaierror:
            raise ViewError(f"--host: '{host}' is not known; give a name or an address of this "
                            'machine, such as localhost') from None
        except OSError as error:
            if error.errno == errno.EADDRNOTAVAIL:
                raise ViewError(f"--host: '{host}' is no address of this machine; give one, or "
                                'localhost') from None
            reason = error
    if port is None:
        raise ViewError(f'no port from {PORT} to {PORT + _TRIES - 1} of {host} can be listened '
                        f'on: {reason.strerror}; choose one with --port, or another --host')
    raise ViewError(f'port {port} of {host} cannot be listened on: {reason.strerror}; choose '
                    'another --port')
