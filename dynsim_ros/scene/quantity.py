# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What is known of each number of a scene: unit, bounds, meaning.

The fields of the scene's dataclasses carry a Quantity each. Validation, the scene file, the ROS
parameters with their descriptors and the command line all read it from there.
"""

from dataclasses import dataclass, field, fields, MISSING
import math
import re

from .errors import SceneError, shown
from .orientation import unit

# YAML 1.1 reads 1e6 (no point) as a string; people mean the number.
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?')


@dataclass(frozen=True)
class Quantity:
    """
    One physical quantity of a scene.

    unit: as text, '' for none; description: one clause; kind: 'number', 'vector' (3 numbers),
    'direction' (3 numbers, made a unit vector), 'orientation' (unit quaternion) or 'inertia'
    (number, 3 or 3 x 3 numbers); minimum, maximum: inclusive bounds of each number;
    initial: an initial condition, fixed once the run has begun.
    """

    unit: str
    description: str
    kind: str = 'number'
    minimum: float = -1e9
    maximum: float = 1e9
    initial: bool = False

    def with_unit(self, value):
        """Return the value as text with the unit."""
        text = f'{value:.9g}' if isinstance(value, float) else str(value)
        return f'{text} {self.unit}' if self.unit else text

    @property
    def bounds(self):
        """Return the bounds as text with the unit."""
        unit = f' {self.unit}' if self.unit else ''
        return f'{self.minimum:g} to {self.maximum:g}{unit}'

    def check(self, name, value):
        """
        Return the value in its canonical form: a float, or a tuple of floats.

        name: what the value is for, for the error. Raises SceneError.
        """
        if self.kind == 'number':
            return self._number(name, value)
        if self.kind == 'inertia':
            return self._inertia(name, value)
        numbers = self._numbers(name, value, 4 if self.kind == 'orientation' else 3)
        if self.kind == 'direction':
            x, y, z = numbers
            length = math.sqrt(x * x + y * y + z * z)
            if length < 1e-9:
                raise SceneError(f'{name}: {list(numbers)} has no direction; give a vector that '
                                 'is not zero')
            # Already a unit vector to the last bit or two: dividing again would move it.
            return numbers if abs(length - 1.0) < 4e-16 else tuple(a / length for a in numbers)
        if self.kind == 'orientation':
            try:
                return unit(numbers)
            except ValueError as error:
                w, *xyz = numbers
                raise SceneError(f'{name}: x, y, z, w {[*xyz, w]} is no orientation: '
                                 f'{error}') from None
        return numbers

    def _number(self, name, value):
        if isinstance(value, str) and _NUMBER.fullmatch(value.strip()):
            value = float(value)
        if isinstance(value, bool) or not hasattr(value, '__float__'):
            raise SceneError(f'{name}: {shown(value)} is not a number; give a number'
                             + (f' in {self.unit}' if self.unit else ''))
        try:
            number = float(value)
        except OverflowError:
            number = math.inf if value > 0 else -math.inf
        except (TypeError, ValueError):
            raise SceneError(f'{name}: {shown(value)} is not one number; give a number'
                             + (f' in {self.unit}' if self.unit else '')) from None
        if not math.isfinite(number):
            raise SceneError(f'{name}: {number} is not finite; give a number'
                             + (f' in {self.unit}' if self.unit else ''))
        if not self.minimum <= number <= self.maximum:
            raise SceneError(f'{name}: {self.with_unit(number)} is out of range: '
                             f'{self.bounds}')
        return number

    def _numbers(self, name, value, count):
        if not _is_list(value) or len(value) != count:
            raise SceneError(f'{name}: {shown(value)} is not a list of {count} numbers'
                             + (f' in {self.unit}' if self.unit else ''))
        # Nearly all are as they should be, which takes less to see than what is wrong with others.
        if all(type(element) is float and self.minimum <= element <= self.maximum
               for element in value):
            return tuple(value)
        # The order of a quaternion depends on who gave it, its letters do not.
        labels = [f'.{letter}' for letter in 'wxyz'] if count == 4 else ['[0]', '[1]', '[2]']
        return tuple(self._number(name + label, element)
                     for label, element in zip(labels, value))

    def _inertia(self, name, value):
        if not _is_list(value):
            return self._number(name, value)
        if len(value) != 3:
            raise SceneError(f'{name}: {shown(value)} is no inertia; give one number, three '
                             f'principal moments or a symmetric 3 x 3 matrix in {self.unit}')
        if not _is_list(value[0]):
            return self._numbers(name, value, 3)
        rows = (self._numbers_signed(f'{name}[{i}]', row) for i, row in enumerate(value))
        return tuple(rows)

    def _numbers_signed(self, name, row):
        # Products of inertia, unlike moments, may be negative.
        signed = Quantity(self.unit, self.description, 'vector', -self.maximum, self.maximum)
        return signed.check(name, row)


def _is_list(value):
    # Lists, tuples, arrays; a set has no order.
    return (hasattr(value, '__len__') and hasattr(value, '__getitem__')
            and not isinstance(value, (str, bytes, dict)))


def quantity(unit_, description, *, default=MISSING, **more):
    """Return a dataclass field that carries a Quantity."""
    metadata = {'quantity': Quantity(unit_, description, **more)}
    if default is MISSING:
        return field(metadata=metadata)
    return field(default=default, metadata=metadata)


def quantities_of(instance):
    """Return {field name: Quantity} of the quantities that the dataclass instance has."""
    found = {f.name: f.metadata['quantity'] for f in fields(instance) if 'quantity' in f.metadata}
    return {name: q for name, q in found.items() if getattr(instance, name) is not None}


def check_quantities(instance, prefix):
    """Put every quantity of a frozen dataclass into canonical form; raise SceneError."""
    for f in fields(instance):
        value = getattr(instance, f.name)
        # None stands for what is absent, where something may be absent.
        if 'quantity' in f.metadata and not (value is None and f.default is None):
            value = f.metadata['quantity'].check(f'{prefix}{f.name}', value)
            object.__setattr__(instance, f.name, value)
