# Copyright 2026 rrr_traj_planner developers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Excitation of a flexible structure by a motion: amplitude spectrum, energy, a line of text."""

from __future__ import annotations

from math import pi

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.residual_vibration import Motion, residual_vibration
from rrr_traj_planner.core.trajectory.trajectory import Trajectory

POINTS = 4001   # of the quadrature over a motion: some hundred per period of the frequencies here
BELOW = 400     # frequencies of the quadrature of a spectrum
IN_TEXT = (16.0, 32.0, 64.0)  # Hz, of the modes in a line of text


def amplitude_spectrum(t: Array, acceleration: Array, frequencies: Array) -> Array:
    """
    Return the magnitude of an acceleration's Fourier transform.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Equally spaced times [s]; before and after them the acceleration is zero.
    acceleration : ndarray, shape (n,)
        Acceleration [rad/s^2].
    frequencies : ndarray, shape (m,)
        Frequencies [Hz].

    Returns
    -------
    ndarray, shape (m,)
        Magnitude [rad/s].

    """
    phase = np.exp(-2j * pi * np.outer(frequencies, t))
    return np.abs(_integral(phase * acceleration, t))


def fraction_above(t: Array, acceleration: Array, frequency: float) -> float:
    """
    Return the fraction of an acceleration's energy above a frequency.

    Parameters
    ----------
    t, acceleration
        As in `amplitude_spectrum`.
    frequency : float
        The frequency [Hz].

    Returns
    -------
    float
        From 0 to 1; by Parseval's theorem, 1 minus the fraction below.

    """
    below = np.linspace(0.0, frequency, BELOW)
    power = amplitude_spectrum(t, acceleration, below) ** 2
    whole = float(_integral(acceleration ** 2, t))
    return float(1.0 - 2.0 * _integral(power, below) / whole)


def vibration_text(motion: Motion, knots: Array) -> str:
    """
    Return the residual vibration after a motion as a line.

    Parameters
    ----------
    motion, knots
        As in `residual_vibration`.

    Returns
    -------
    str
        At a few frequencies, the largest of all joints.

    """
    found = residual_vibration(motion, knots, IN_TEXT).max(axis=1)
    return (f'residual vibration [rad/s^2] at {" / ".join(f"{f:g}" for f in IN_TEXT)} Hz: '
            + ' / '.join(f'{value:.3g}' for value in found))


def joint_acceleration(trajectory: Trajectory, joint: int) -> tuple[Array, Array]:
    """
    Return a joint's acceleration at equally spaced times.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    joint : int
        The joint's index.

    Returns
    -------
    tuple of ndarray
        Times [s] and accelerations [rad/s^2].

    """
    t = np.linspace(0.0, trajectory.duration, POINTS)
    return t, trajectory(t)[2][:, joint]


def _integral(values: Array, x: Array) -> Array:
    """Return the integral over the last axis, by trapezoids of equal width."""
    inner = values.sum(axis=-1) - 0.5 * (values[..., 0] + values[..., -1])
    return np.asarray(inner * (x[1] - x[0]))
