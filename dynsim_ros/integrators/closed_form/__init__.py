# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Motions that have a closed form: exact to rounding, at a cost that does not depend on the time.

Each is a function of the time t and of the state at time 0. What `exact` leaves is some units of
2^-52 of the size of the result. Phases that grow with the time are carried with twice the digits
(phase.py), so that this holds after thousands of turns as well; those of what fades, and the
motions without such phases, do not need it.

===================  ===========================================================  ==============
function             motion                                                       source
===================  ===========================================================  ==============
flight               centre of mass under a constant force, in uniform wind with  Landau 25;
                     linear drag, or none                                         phi functions
free_spin            rotation with scalar inertia, without moment                 sheet 3.2
spin_up              the same under a constant moment along omega                 sheet 3.2
spin_down            the same with rotational drag, in air that is still or       sheet 3.2;
                     whirls along omega (keeps_axis), and a moment along it       phi functions
whirled              the same in air that whirls about any axis, where it stops   DLMF 2.7(i)
                     the spin soon (reaches); constants from whirl_series and
                     constant_of_whirl
torque_free          rotation with any inertia, without moment; constants from    Jacobi 1850;
                     torque_free_in_full, and that from principal_axes            Landau 37;
                                                                                  van Zon 2007
on_centred_springs   particle on springs of natural length 0 without dampers,     Landau 25, 26
                     to anchors that rest or move uniformly, with gravity, drag
                     and wind
along_spring         particle on the line of its only spring, with damper, drag   Landau 25, 26
                     and what else acts along it, as long as L > 0
                     (least_length, is_along); constants from spring_line
cancels              none, where forces cancel to rounding and velocities are zero
===================  ===========================================================  ==============

Landau: L. D. Landau and E. M. Lifshitz, Mechanics (1976), by section; sheet: the formula sheet.
The others are named where they are used.
"""

from .centred_springs import centre_of_springs, on_centred_springs
from .flight import flight
from .phase import seconds
from .principal_axes import principal_axes
from .rest import cancels, spring_size
from .spin import free_spin, keeps_axis, spin_down, spin_up, turn_and_spin
from .spring_line import along_spring, is_along, least_length, spring_line, SpringLine
from .torque_free import torque_free, TorqueFree
from .torque_free_rates import torque_free_in_full
from .whirl import constant_of_whirl, reaches, whirl_series, whirled
from ...physics.fused import QUICKLY
from ...physics.jit import plain

# What kernels do not call.
cancels, is_along, keeps_axis, least_length, reaches, spring_line, spring_size = (
    plain(each, **QUICKLY) for each in (
        cancels, is_along, keeps_axis, least_length, reaches, spring_line, spring_size))

__all__ = [
    'SpringLine', 'TorqueFree', 'along_spring', 'cancels', 'centre_of_springs',
    'constant_of_whirl', 'flight', 'free_spin', 'is_along', 'keeps_axis',
    'least_length', 'on_centred_springs', 'principal_axes', 'reaches', 'seconds', 'spin_down',
    'spin_up', 'spring_line', 'spring_size', 'torque_free', 'torque_free_in_full',
    'turn_and_spin', 'whirl_series', 'whirled',
]
