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

"""Errors of poses that a motor cannot hold, or through which it cannot move its joint."""

from __future__ import annotations

from rrr_traj_planner.core.errors import format_distinct, LimitViolationError


def holding_error(where: str, joint: str, torque: float, limit: float,
                  via_point: int = -1) -> LimitViolationError:
    """
    Return the error of a pose that a motor cannot hold, or can only hold.

    In the latter gravity leaves it no torque for motion.

    Parameters
    ----------
    where : str
        The position, for the message.
    joint : str
        Name of the joint.
    torque, limit : float
        The torque of gravity and its limit [N m].
    via_point : int
        Index of the via point, -1 where it is none.

    Returns
    -------
    LimitViolationError
        To be raised.

    """
    return _error(where, joint, torque, limit, via_point, 'to hold', 'motion')


def moving_error(where: str, joint: str, torque: float, limit: float,
                 via_point: int = -1) -> LimitViolationError:
    """
    Return the error of a pose through which a motor cannot move its joint, however slowly.

    Parameters
    ----------
    where : str
        The position, for the message.
    joint : str
        Name of the joint.
    torque, limit : float
        The torque of gravity and Coulomb friction, and its limit [N m].
    via_point : int
        Index of the via point, -1 where it is none.

    Returns
    -------
    LimitViolationError
        To be raised.

    """
    return _error(where, joint, torque, limit, via_point, 'to move against gravity and friction',
                  'acceleration')


def _error(where: str, joint: str, torque: float, limit: float, via_point: int, purpose: str,
           lacking: str) -> LimitViolationError:
    needed, most = torque_texts(torque, limit)
    left = '' if torque > limit else f', which leaves no torque for {lacking}'
    return LimitViolationError(
        f'{where} {joint} needs {needed} N m {purpose}, limit {most} N m{left}', joint, torque,
        limit, via_point)


def torque_texts(torque: float, limit: float) -> tuple[str, ...]:
    """
    Return a torque and its limit for a message, to a tenth where that distinguishes them.

    Parameters
    ----------
    torque, limit : float
        [N m].

    Returns
    -------
    tuple of str
        Both.

    """
    return format_distinct(torque, limit, digits=len(f'{torque:.1f}') - 1)
