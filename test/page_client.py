# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A page of the viewer as a program sees it that speaks with its server as a browser does."""

import socket
import time
from urllib.parse import urlsplit

import msgspec
import numpy as np
import viser
from websockets.sync.client import connect
import zstandard


class PageClient:
    """
    A browser without a screen.

    nodes: {name of a part of the 3-D view: what is told of it}; notes: texts of notifications;
    messages: how many have come.
    """

    def __init__(self, url, receive_buffer=None):
        """Open the page of a URL; to be closed. receive_buffer: of its socket [bytes]."""
        port = urlsplit(url).port
        channel = socket.socket()
        if receive_buffer:
            channel.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        channel.connect(('127.0.0.1', port))
        self._socket = connect(url.replace('http', 'ws'), sock=channel, max_size=None,
                               compression=None, ping_interval=None, close_timeout=0.2,
                               subprotocols=[f'viser-v{viser.__version__}'])
        self._unpack = zstandard.ZstdDecompressor().decompress
        self._controls = {}
        self.nodes, self.notes = {}, []
        self.messages = 0
        self.is_complete = False
        # A page that is opened while the run is read is empty at first.
        self.wait(lambda: self.is_complete and self._controls)
        self.send('ViewerCameraMessage', wxyz=(1.0, 0.0, 0.0, 0.0), position=(0.0, -3.0, 2.0),
                  fov=0.6, near=0.01, far=100.0, image_height=600, image_width=800,
                  look_at=(0.0, 0.0, 1.5), up_direction=(0.0, 0.0, 1.0))

    def close(self):
        """Leave the page."""
        self._socket.close()

    @property
    def controls(self):
        """Return {label, or name, or title of a control: what is told of it}."""
        return {next(filter(None, map(props.get, ('label', 'name', 'title', 'uuid')))): props
                for props in self._controls.values()}

    @property
    def text(self):
        """Return the line of text on the page."""
        return next(props['_markdown'] for props in self._controls.values()
                    if props['type'] == 'GuiMarkdownMessage')

    def wait(self, condition, timeout=30.0):
        """Take in what comes until condition() returns something true; return it."""
        limit = time.monotonic() + timeout
        while not (result := condition()):
            assert time.monotonic() < limit, f'waited {timeout} s in vain'
            try:
                self._take(self._socket.recv(timeout=0.1))
            except TimeoutError:
                pass
        return result

    def send(self, kind, **fields):
        """Send a message."""
        self._socket.send(msgspec.msgpack.encode({'type': kind, **fields}))

    def enter(self, label, value):
        """Set the control with a label, as a user does; press it if it is a button."""
        self.send('GuiUpdateMessage', uuid=self.controls[label]['uuid'],
                  updates={'value': value})

    def drag(self, name, position, phase=None):
        """Drag the gizmo with a name to a position; phase: 'Start', 'End' or between both."""
        if phase:
            self.send(f'TransformControlsDrag{phase}Message', name=name, owner='')
        else:
            self.send('TransformControlsUpdateMessage', name=name, wxyz=(1.0, 0.0, 0.0, 0.0),
                      position=tuple(position), owner='')

    def _take(self, data):
        packed = int.from_bytes(data[8:16], 'little')
        window = msgspec.msgpack.decode(self._unpack(data[16:16 + packed]))
        arrays, end = [], 16 + packed
        for size in window['binaryBufferLengths']:
            start = -(-end // 8) * 8
            end = start + size
            arrays.append(data[start:end])
        for message in window['messages']:
            self.messages += 1
            self._take_one(_with_arrays(message, arrays))

    def _take_one(self, message):
        kind, props = message['type'], message.get('props')
        if kind == 'ReplayDoneMessage':
            self.is_complete = True
        elif kind.startswith('Notification'):
            self.notes.append(props['body'])
        elif kind == 'GuiUpdateMessage':
            self._controls[message['uuid']].update(message['updates'])
        elif 'uuid' in message and isinstance(props, dict):
            self._controls[message['uuid']] = {**props, **message}
        elif kind == 'SceneNodeUpdateMessage':
            self.nodes[message['name']].update(message['updates'])
        elif 'name' in message and isinstance(props, dict):
            self.nodes[message['name']] = {'type': kind, **props}
        elif message.get('name') in self.nodes:
            self.nodes[message['name']].update(message, type=self.nodes[message['name']]['type'])


def _with_arrays(value, arrays):
    """Return a message with numpy arrays in place of what stands for them."""
    if isinstance(value, dict):
        if '__binary_index' in value:
            return np.frombuffer(arrays[value['__binary_index']], value['dtype'])
        return {key: _with_arrays(part, arrays) for key, part in value.items()}
    if isinstance(value, list):
        return [_with_arrays(part, arrays) for part in value]
    return value
