# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find a scene by the name it has in the package's scenes folder, or by its path."""

from pathlib import Path

from .errors import did_you_mean, SceneError
from .yaml_file import read_scene
from ..share import share_directory


def scene_names():
    """Return the names of the scenes that come with the package, sorted."""
    return sorted(path.stem for path in (share_directory() / 'scenes').glob('*.yaml'))


def load_scene(name_or_path):
    """
    Return a Scene.

    name_or_path: a name such as 'sphere_on_spring', or the path of a YAML file (anything with a
    slash or an ending). Raises SceneError.
    """
    text = str(name_or_path)
    if '/' in text or text.endswith(('.yaml', '.yml')):
        try:
            return read_scene(Path(text).expanduser())
        except RuntimeError:
            raise SceneError(f'{text}: there is no such home folder') from None
    if text in scene_names():
        return read_scene(share_directory() / 'scenes' / f'{text}.yaml')
    raise SceneError(f"scene '{text}' is not known; " + did_you_mean(text, scene_names())
                     + ' (or give the path of a .yaml file)')
