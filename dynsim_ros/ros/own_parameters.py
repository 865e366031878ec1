# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node itself, beside those of the scene and the settings of the run."""

from dataclasses import dataclass

from .publish_rates import PUBLISH_RATES
from ..bag.writer import COMPRESSIONS
from ..scene import did_you_mean, Quantity, SceneError


@dataclass(frozen=True)
class Own:
    """
    A parameter of the node itself.

    choices: the strings allowed, None for any; least: smallest number beside 0; whole: whether a
    number has to be a whole one.
    """

    default: object
    description: str
    quantity: Quantity | None = None
    read_only: bool = False
    choices: tuple | None = None
    least: float = 0.0
    whole: bool = False


OWN = {
    'scene': Own('sphere_on_spring', 'name of a scene, or the path of a YAML file',
                 read_only=True),
    'real_time_factor': Own(1.0, 'simulated seconds per second, 0 = as fast as possible',
                            Quantity('', 'real-time factor', minimum=0.0, maximum=1000.0)),
    'publish_clock': Own(False, 'publish simulated time on /clock'),
    'duration': Own(0.0, 'simulated time after which the node ends [s], 0 = never',
                    Quantity('s', 'duration', minimum=0.0, maximum=1e9)),
    **{name: Own(0.0, f'how often {what} are published [Hz], an integer divisor of rate; '
                      '0 = every tick',
                 Quantity('Hz', 'publish rate', minimum=0.0, maximum=1e4))
       for name, what in PUBLISH_RATES.items()},
    'publish_wrenches': Own(True, 'publish and record the wrenches'),
    'publish_tf': Own(True, 'publish and record the frames of bodies and anchors on /tf'),
    'step_count': Own(1.0, 'how many ticks ~/step takes, a whole number',
                      Quantity('', 'number of ticks', minimum=1.0, maximum=1e9), whole=True),
    'step_until': Own(0.0, 'simulated time to which ~/step_until goes [s]',
                      Quantity('s', 'simulated time', minimum=0.0, maximum=1e9)),
    'state.file': Own('state.json', 'file for ~/save_state and ~/load_state; the latter takes a '
                      'bag, too'),
    'state.time': Own(0.0, 'simulated time to which ~/rewind goes back, and of the state that '
                      '~/load_state takes out of a bag [s]',
                      Quantity('s', 'simulated time', minimum=0.0, maximum=1e9)),
    'real_time.spin': Own(0.0, 'how long before each deadline to wait busily [s]',
                          Quantity('s', 'busy wait', minimum=0.0, maximum=0.01), read_only=True),
    'real_time.priority': Own(-1.0, 'priority of the ticking thread in SCHED_FIFO, 0 = none, -1 = '
                              '1 while it mostly sleeps, where that is permitted',
                              Quantity('', 'priority', minimum=-1.0, maximum=99.0),
                              read_only=True),
    'real_time.cpu': Own(-1.0, 'number of the processor for the ticking thread, -1 = any',
                         Quantity('', 'processor', minimum=-1.0, maximum=1023.0),
                         read_only=True),
    'real_time.lock_memory': Own(False, 'keep all memory from being paged out', read_only=True),
    'record.enable': Own(False, 'record from the start (later: service ~/record)',
                         read_only=True),
    'record.directory': Own('runs', 'folder for bags; a change holds for the next one'),
    'record.compression': Own('zstd', 'compression of bags: ' + ', '.join(COMPRESSIONS)
                              + '; a change holds for the next one', choices=tuple(COMPRESSIONS)),
    'record.max_size': Own(0.0, 'size of a file beyond which a bag goes on in another one [MB], '
                                '0 = any; a change holds for the next bag',
                           Quantity('MB', 'size', minimum=0.0, maximum=1e9), least=1.0),
    'record.max_duration': Own(0.0, 'simulated time after which a bag goes on in another file '
                                    '[s], 0 = any; a change holds for the next bag',
                               Quantity('s', 'duration', minimum=0.0, maximum=1e9), least=1.0),
    'record.sync': Own(1.0, 'how often a bag is brought to the disk [s], 0 = when the operating '
                            'system chooses to; a change holds for the next bag',
                       Quantity('s', 'period', minimum=0.0, maximum=1e6), least=0.01),
}


def check_own(name, value):
    """Return the value for one of the node's own parameters; raise SceneError."""
    own = OWN[name]
    if own.quantity is not None:
        number = own.quantity.check(name, value)
        if 0.0 < number < own.least:
            raise SceneError(f'{name}: {own.quantity.with_unit(number)} is too little: give 0, or '
                             f'{own.quantity.with_unit(own.least)} at least')
        if own.whole and number != int(number):
            raise SceneError(f'{name}: {number:g} is no whole number')
        return number
    if not isinstance(value, type(own.default)):
        kind = {bool: 'true or false', str: 'a text'}[type(own.default)]
        raise SceneError(f'{name}: {value!r} is not {kind}')
    if own.choices and value not in own.choices:
        raise SceneError(f"{name}: '{value}' is not known; " + did_you_mean(value, own.choices))
    return value
