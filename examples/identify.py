# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Finds stiffness and damping of the spring from the positions in a bag, as if they were unknown.

Usage: python identify.py BAG [--noise METRES]. BAG is a recording of the default scene, perhaps
with other values for the spring. Positions are read from it, made worse by noise, and compared
with those of simulations, whose stiffness and damping are changed until they fit best. At first
only the beginning has to fit: a motion over many swings fits by chance in many wrong places.

Needs scipy and mcap-ros2-support.
"""

import argparse

from dynsim_ros.scene import get_value, parse_scene, with_values
from dynsim_ros.simulation import Propagator
from dynsim_ros.simulation.layout import Layout
from mcap.reader import make_reader
from mcap_ros2.reader import read_ros2_messages
import numpy as np
from scipy.optimize import least_squares

NAMES = {'spring.stiffness': 'N/m', 'spring.damping': 'N s/m'}
GUESS = (60.0, 2.0)
PARTS = (0.5, 2.0, 10.0)             # s: how much has to fit, at first and then


def read_positions(path):
    """Return times (n,) [s] and positions of the sphere (n, 3) [m] in a bag."""
    poses = [message.ros_msg for message in read_ros2_messages(
        path, topics=['/dynsim/sphere/pose'])]
    times = [pose.header.stamp.sec + 1e-9 * pose.header.stamp.nanosec for pose in poses]
    places = [pose.pose.position for pose in poses]
    return np.array(times), np.array([(place.x, place.y, place.z) for place in places])


def read_scene(path):
    """Return the scene that a bag was recorded with: where the sphere began is known."""
    with open(path, 'rb') as stream:
        text = next(item.data for item in make_reader(stream).iter_attachments()
                    if item.name == 'scene.yaml')
    return parse_scene(text.decode())


def identify(scene, times, positions):
    """Return the values of NAMES that fit the positions best, and their standard deviations."""
    rate = round(1.0 / (times[1] - times[0]))
    place = Layout(scene).position('sphere')

    def misfit(logarithms, count):
        values = dict(zip(NAMES, np.exp(logarithms).tolist()))
        # Where one method took over from another, the misfit would not be smooth in the values.
        motion = Propagator(with_values(scene, values), integrator='extrapolation')
        return (motion.samples(times[count - 1], rate)[:count, place] - positions[:count]).ravel()

    found = np.log(GUESS)
    for seconds in PARTS:
        count = min(round(seconds * rate) + 1, len(times))
        fit = least_squares(misfit, found, args=(count,), x_scale=0.1)
        found = fit.x
    values = np.exp(found)
    variance = 2.0 * fit.cost / (len(fit.fun) - len(found))
    spread = np.sqrt(variance * np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
    return values, values * spread


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('bag', metavar='BAG')
    parser.add_argument('--noise', type=float, default=0.001, metavar='METRES',
                        help='standard deviation of what is added (default 0.001)')
    options = parser.parse_args()
    scene = read_scene(options.bag)
    times, positions = read_positions(options.bag)
    positions += np.random.default_rng(1).normal(0.0, options.noise, positions.shape)
    print(f'{len(times)} positions in {times[-1] - times[0]:g} s, noise of '
          f'{1e3 * options.noise:g} mm; first guess {GUESS[0]:g} N/m, {GUESS[1]:g} N s/m')
    for (name, unit), value, spread in zip(NAMES.items(), *identify(scene, times, positions)):
        print(f'{name}: {value:.5g} +- {spread:.2g} {unit}, recorded with '
              f'{get_value(scene, name):g} {unit}')


if __name__ == '__main__':
    main()
