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

"""
Excesses of a commanded trajectory over ranges and limits, at its points and between them.

Extremes of the polynomials between points are bounded by their Bernstein coefficients; an interval
whose coefficients exceed the best value found is bisected (de Casteljau) until they agree. See
Farouki, The Bernstein polynomial basis: a centennial retrospective, CAGD 29 (2012), section 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arm.degrees import explained_by_degrees, HINT
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.trajectory.bernstein import bernstein_forms, halved
from rrr_traj_planner.core.trajectory.reference_trajectory import (
    reference_through,
    ReferenceTrajectory,
)
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints, with_start_state

# Excesses up to these are not reported: relative to the larger of the range's end and 1 rad, since
# positions may have been rounded to four digits; and relative to a limit, since quintics through
# samples of a motion at its limit exceed it by up to 0.1 %.
POSITION_TOLERANCE, INTERPOLATION_TOLERANCE = 1e-4, 2e-3

ACCURACY = 1e-6  # of extremes, relative to the bound that they exceed; chosen


class Excess(NamedTuple):
    """An excess of a joint over a range or limit."""

    joint: int
    quantity: str
    value: float
    low: float
    high: float
    in_degrees: bool  # whether the numbers that were sent would be within it, taken as degrees
    leading_in: bool = False  # whether on the way from the command to the first point

    @property
    def kind(self) -> tuple[int, str, bool]:
        """Return what is common to repeated findings: joint, quantity, and where."""
        return self.joint, self.quantity, self.leading_in

    def text(self, joint_names: Sequence[str]) -> str:
        """
        Return the excess as a sentence.

        Parameters
        ----------
        joint_names : sequence of str
            The joints' names.

        Returns
        -------
        str
            Joint, value, range or limit, unit.

        """
        unit = {'position': 'rad', 'velocity': 'rad/s', 'acceleration': 'rad/s^2'}[self.quantity]
        bound = (f'goes to {self.value:.6g} rad, range [{self.low:.6g}, {self.high:.6g}] rad'
                 if self.quantity == 'position' else
                 f'reaches {abs(self.value):.6g} {unit}, limit {self.high:.6g} {unit}')
        return (f'{joint_names[self.joint]} {bound}'
                + (HINT if self.in_degrees else ''))


def excesses(points: TrajectoryPoints, limits: JointLimits, time: float = np.inf,
             command: ArrayLike = ()) -> list[Excess]:
    """
    Return the excesses of a trajectory in position, velocity and acceleration.

    The segment that leads from the command to a first point ahead is checked too, for position
    and velocity: `replacement` does not follow one that exceeds limits. Lines have no
    acceleration, and steps of velocity between them are not checked. Where degrees explain a
    joint's positions, its velocity and acceleration are left out.

    Parameters
    ----------
    points : TrajectoryPoints
        The trajectory as it was received.
    limits : JointLimits
        Ranges and limits.
    time : float
        Time of the take-over, on the points' clock [s].
    command : array_like, shape (9,)
        Positions [rad], velocities [rad/s], accelerations [rad/s^2] commanded then.

    Returns
    -------
    list of Excess
        By quantity, then joint, with the furthest value of each; of the segment that leads in
        where the trajectory itself is within. Empty if there is no excess.

    """
    own = _bernstein_forms(reference_through(points))
    lead_in = _lead_in_forms(points, time, command)
    sent = (points.positions, points.velocities[points.has_velocity],
            points.accelerations[points.has_acceleration])
    found: list[Excess] = []
    for quantity, forms, numbers, low, high in zip(
            ('position', 'velocity', 'acceleration'), zip(own, lead_in), sent,
            (limits.min_position, -limits.max_velocity, -limits.max_acceleration),
            (limits.max_position, limits.max_velocity, limits.max_acceleration)):
        for j, bounds in enumerate(zip(low.tolist(), high.tolist())):
            widened = [float(bound) for bound in _with_tolerance(quantity, *bounds)]
            values = [furthest(form[:, j], *widened) for form in forms]
            value = values[1] if values[0] is None else values[0]
            if value is not None and not any(e.joint == j and e.in_degrees for e in found):
                found.append(Excess(j, quantity, value, *bounds, explained_by_degrees(
                    numbers[:, j], *bounds), leading_in=values[0] is None))
    return found


def outside_ranges(q: Array, limits: JointLimits) -> BoolArray:
    """
    Return which positions are outside their ranges by more than rounding.

    Parameters
    ----------
    q : ndarray, shape (..., 3)
        Positions [rad].
    limits : JointLimits
        The ranges.

    Returns
    -------
    ndarray of bool, shape (..., 3)
        By more than 1e-4 of a range's end, or of 1 rad.

    """
    low, high = _with_tolerance('position', limits.min_position, limits.max_position)
    return np.asarray((q < low) | (q > high))


def _lead_in_forms(points: TrajectoryPoints, time: float, command: ArrayLike) -> list[Array]:
    """Return Bernstein coefficients of position and velocity on the segment that leads in."""
    if not time < points.times[0]:
        return [np.zeros((0, 3, 1))] * 3
    q, qd, qdd = np.reshape(command, (3, 3))
    forms = _bernstein_forms(reference_through(with_start_state(points, time, (q, qd, qdd))))
    return [forms[0][:1], forms[1][:1], np.zeros((0, 3, 1))]


def _bernstein_forms(motion: ReferenceTrajectory) -> tuple[Array, Array, Array]:
    """Return Bernstein coefficients of position, velocity, acceleration, (n, 3, 6 to 4)."""
    q, qd, qdd = bernstein_forms(motion.coefficients, np.diff(motion.knots))
    last = [np.broadcast_to(x[:, np.newaxis], (1, 3, 6 - order))
            for order, x in enumerate((motion.final, motion.final_velocity))]
    return np.concatenate((q, last[0])), np.concatenate((qd, last[1])), qdd


def _with_tolerance(quantity: str, low: ArrayLike, high: ArrayLike) -> tuple[Array, Array]:
    """Return bounds widened by the reporting tolerance."""
    low, high = np.asarray(low), np.asarray(high)
    if quantity != 'position':
        return low * (1.0 + INTERPOLATION_TOLERANCE), high * (1.0 + INTERPOLATION_TOLERANCE)
    return (low - POSITION_TOLERANCE * np.maximum(1.0, np.abs(low)),
            high + POSITION_TOLERANCE * np.maximum(1.0, np.abs(high)))


def furthest(form: Array, low: float, high: float) -> float | None:
    """
    Return the value of some polynomials furthest beyond a bound.

    Parameters
    ----------
    form : ndarray, shape (n, m + 1)
        Bernstein coefficients.
    low, high : float
        The bounds.

    Returns
    -------
    float or None
        None where all values are within.

    """
    above, below = _largest(form, high), -_largest(-form, -low)
    if above <= high and below >= low:
        return None
    return above if not below < low or above - high >= low - below else below


def _largest(form: Array, least: float) -> float:
    """Return the largest value on [0, 1] of polynomials (n, m + 1), if it is above a least one."""
    best = least
    while True:
        best = max(best, float(form[:, [0, -1]].max(initial=best)))
        form = form[form.max(axis=1, initial=-np.inf) > best + ACCURACY * abs(best)]
        if len(form) == 0:
            return best
        form = halved(form)
