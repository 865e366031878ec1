# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Disks that are full as long as a test wants it."""

import os
from pathlib import Path
import resource
import subprocess

# A disk of its own for runs/, which only the process sees: that takes no rights on most machines.
WITHIN = ('unshare', '--user', '--map-root-user', '--mount', 'sh', '-c',
          'mount -t tmpfs -o size=32m none runs && exec "$@"', 'sh')


def can_mount(folder):
    """Return whether this machine lets a process mount a disk of its own; folder: to try in."""
    (Path(folder) / 'runs').mkdir()
    try:
        tried = subprocess.run([*WITHIN, 'true'], cwd=folder, capture_output=True, check=False)
    except FileNotFoundError:
        return False
    return tried.returncode == 0


class SmallDisk:
    """A tmpfs under the runs/ of a node that was started WITHIN; room: what is left of it [B]."""

    within, reason = WITHIN, 'No space left on device'

    def __init__(self, node):
        # As the process sees it: here the folder is empty.
        self.folder = Path(f'/proc/{node.process.pid}/cwd')
        self._ballast = self.folder / 'runs' / 'ballast'

    def fill(self, path, room):
        with open(self._ballast, 'wb') as stream:
            disk = os.fstatvfs(stream.fileno())
            os.posix_fallocate(stream.fileno(), 0, disk.f_bavail * disk.f_frsize - room)

    def empty(self):
        self._ballast.unlink()


class SizeLimit:
    """A limit to the size of the files of a node, which is as good as a full disk."""

    within, reason = (), 'File too large'

    def __init__(self, node):
        self.folder = node.folder
        self._pid = node.process.pid

    def fill(self, path, room):
        # Shared memory of DDS is there already.
        self._limits = resource.prlimit(self._pid, resource.RLIMIT_FSIZE, (
            max(path.stat().st_size, 1) + room, resource.RLIM_INFINITY))

    def empty(self):
        resource.prlimit(self._pid, resource.RLIMIT_FSIZE, self._limits)
