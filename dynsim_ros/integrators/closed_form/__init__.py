# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Motions that have a closed form: exact to rounding, at a cost that does not depend on the time.

Each is a function of the time t and of the state at time 0. What `exact` leaves is some units of
2^-52 of the size of the result, and of the angles and phases gone through until t: those are
known no better, because the rates are rounded.

===================  ===========================================================  ==============
function             motion                                                       source
===================  ===========================================================  ==============
flight               centre of mass under a constant force, in uniform wind with  Landau 25;
                     linear drag, or none                                         phi functions
free_spin            rotation with scalar inertia, without moment                 sheet 3.2
spin_down            the same with rotational drag, in air that is still or       sheet 3.2;
                     whirls along omega (keeps_axis)                              phi functions
torque_free          rotation with any inertia, without moment; constants from    Jacobi 1850;
                     torque_free_setup, and that from principal_axes              Landau 37;
                                                                                  van Zon 2007
on_centred_springs   particle on springs of natural length 0 without dampers,     Landau 25, 26
                     to anchors that rest or move uniformly, with gravity, drag
                     and wind
along_spring         particle on the line of its only spring, with damper, drag   Landau 25, 26
                     and what else acts along it, as long as L > 0
                     (least_length, is_along); constants from spring_line
at_rest              forces that cancel to rounding, velocities that are zero
===================  ===========================================================  ==============

Landau: L. D. Landau and E. M. Lifshitz, Mechanics (1976), by section; sheet: the formula sheet.
The others are named where they are used.
"""

from .centred_springs import centre_of_springs, on_centred_springs
from .flight import flight
from .principal_axes import principal_axes
from .rest import at_rest, cancels, spring_size
from .spin import decayed_spin, free_spin, keeps_axis, spin_down
from .spring_line import along_spring, is_along, least_length, spring_line, SpringLine
from .torque_free import torque_free, TorqueFree
from .torque_free_setup import torque_free_setup

__all__ = [
    'SpringLine', 'TorqueFree', 'along_spring', 'at_rest', 'cancels', 'centre_of_springs',
    'decayed_spin', 'flight', 'free_spin', 'is_along', 'keeps_axis', 'least_length',
    'on_centred_springs', 'principal_axes', 'spin_down', 'spring_line', 'spring_size',
    'torque_free', 'torque_free_setup',
]
