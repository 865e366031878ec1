# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""YAML texts from users: nothing in them is executed, and every fault is one SceneError."""

import yaml

from .errors import SceneError, shown


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader, which also refuses a key that stands twice."""

    def compose_mapping_node(self, anchor):
        """Return the node of a mapping; raise SceneError for a repeated key."""
        node = super().compose_mapping_node(anchor)
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in seen:
                    raise SceneError(f'line {key.start_mark.line + 1}: {shown(key.value)} stands '
                                     'more than once')
                seen.add(key.value)
        return node


def load_yaml(text):
    """Return what a YAML text holds; raise SceneError if it is none."""
    try:
        return yaml.load(text, Loader=_Loader)
    except SceneError:
        raise
    except RecursionError:
        raise SceneError('is nested too deeply') from None
    except yaml.YAMLError as error:
        mark = getattr(error, 'problem_mark', None)
        where = f'line {mark.line + 1}: ' if mark else ''
        problem = getattr(error, 'problem', None) or str(error).splitlines()[0]
        raise SceneError(f'{where}is not valid YAML: {problem}') from None
    except Exception as error:
        # Of a scalar that does not suit its tag, such as !!int x, PyYAML makes any error at all.
        raise SceneError(f'is not valid YAML: {error}') from None
