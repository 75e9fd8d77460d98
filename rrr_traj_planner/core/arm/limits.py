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

"""Joint limits on position, velocity, acceleration, jerk and effort; infinite for none."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from rrr_traj_planner.core.arrays import Array, bound_array
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.scalars import positive_fraction

# URDFs must have values where a joint has no limit, and so do parameters of ranges: from these on,
# they stand for none. No joint's motor turns at 1e3 rad/s (9,500 revolutions a minute, after the
# gear), nor do an arm's cables allow 160 turns; the strongest industrial arms, for a ton at 3 m,
# hold some 4e4 N m.
NO_RANGE = 1e3      # rad
NO_VELOCITY = 1e3   # rad/s
NO_EFFORT = 1e5     # N m

UNITS = {
    'min_position': 'rad', 'max_position': 'rad', 'max_velocity': 'rad/s',
    'max_acceleration': 'rad/s^2', 'max_jerk': 'rad/s^3', 'max_effort': 'N m'}


def _default(*values: float) -> Array:
    return field(default_factory=lambda: np.array(values))


@dataclass(frozen=True, eq=False)
class JointLimits(ReadOnlyArrays):
    """
    Limits of the three joints, symmetric but for position.

    The defaults are the thesis's (table 6.2 and appendix B.3, joint 2 mirrored: with the printed
    range, the thesis's tasks have no inverse solution).

    Parameters
    ----------
    min_position, max_position : array_like, shape (3,)
        Range of each joint [rad].
    max_velocity, max_acceleration, max_jerk : array_like, shape (3,)
        Bounds on the magnitude [rad/s, rad/s^2, rad/s^3]; infinite: none.
    max_effort : array_like, shape (3,)
        Bound on the motor's torque [N m]; infinite: none.

    Raises
    ------
    InvalidInputError
        If a range is empty or a bound is not positive.

    """

    min_position: Array = _default(0.0, 0.0, -np.pi)
    max_position: Array = _default(np.pi / 2, np.pi, 2 * np.pi)
    max_velocity: Array = _default(1.0, 1.0, 1.0)
    max_acceleration: Array = _default(1.0, 1.0, 1.0)
    max_jerk: Array = _default(10.0, 10.0, 10.0)
    max_effort: Array = _default(150.0, 200.0, 200.0)

    def __post_init__(self) -> None:
        """Check every bound and make the arrays read-only."""
        for name, unit in UNITS.items():
            array = bound_array(name, getattr(self, name), (3,))
            object.__setattr__(self, name, array)
            if not name.endswith('position') and not (array > 0.0).all():
                raise InvalidInputError(f'{name} is {array.tolist()} {unit}, must be positive')
        if not (self.min_position < self.max_position).all():
            raise InvalidInputError(
                f'min_position {self.min_position.tolist()} rad is not below max_position '
                f'{self.max_position.tolist()} rad')

    def scaled(self, velocity: float = 1.0, acceleration: float = 1.0) -> JointLimits:
        """
        Return limits with velocity and acceleration scaled down.

        Parameters
        ----------
        velocity, acceleration : float
            Factors in (0, 1].

        Returns
        -------
        JointLimits
            The scaled limits; position, jerk and effort are kept.

        Raises
        ------
        InvalidInputError
            If a factor is outside (0, 1].

        """
        return replace(
            self, max_velocity=self.max_velocity * positive_fraction('velocity', velocity),
            max_acceleration=(
                self.max_acceleration * positive_fraction('acceleration', acceleration)))

    def time_scale(self, velocity: Array, acceleration: Array, jerk: Array) -> float:
        """
        Return the least factor on all times with which a motion satisfies these limits.

        See `kinematic_time_scale`.

        Parameters
        ----------
        velocity, acceleration, jerk : ndarray, shape (..., 3)
            Magnitudes [rad/s, rad/s^2, rad/s^3].

        Returns
        -------
        float
            At most 1 if the motion itself satisfies them.

        """
        return kinematic_time_scale(
            velocity / self.max_velocity, acceleration / self.max_acceleration,
            jerk / self.max_jerk)


def kinematic_time_scale(velocity: Array, acceleration: Array, jerk: Array) -> float:
    """
    Return the least factor on all times with which a motion satisfies kinematic limits.

    Velocity falls with the factor, acceleration with its square, jerk with its cube
    (Hollerbach, Dynamic scaling of manipulator trajectories, 1984).

    Parameters
    ----------
    velocity, acceleration, jerk : ndarray
        Ratios of magnitudes to their limits, without unit.

    Returns
    -------
    float
        At most 1 if the motion itself satisfies them.

    """
    return float(max(velocity.max(), np.sqrt(acceleration.max()), np.cbrt(jerk.max())))
