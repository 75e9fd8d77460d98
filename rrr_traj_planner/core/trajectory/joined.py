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

"""Motions one after another, each from where the one before comes to rest."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike
from rrr_traj_planner.core.arrays import Array, parameter_values
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.read_only import make_read_only
from rrr_traj_planner.core.rounding import JOINT_ROUNDING, TIME_ROUNDING
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.trajectory import (
    ending_at_duration,
    Peaks,
    time_factor,
    Trajectory,
)


def joined(parts: Sequence[Trajectory], note: str = '') -> Trajectory:
    """
    Return motions joined to one.

    Parameters
    ----------
    parts : sequence of Trajectory
        At least one. Each ends at rest, and each but the first begins at rest, where the one
        before ends.
    note : str
        See `Trajectory`.

    Returns
    -------
    Trajectory
        Piecewise, if all of them are, of pieces of one function. Its via times are those of all
        motions; the end of one and the beginning of the next are one via point.

    Raises
    ------
    InvalidInputError
        If there is no motion, or one begins elsewhere than the one before ends.

    """
    _check(parts)
    if len(parts) == 1:
        return parts[0].noted(note)
    piecewise = [part for part in parts if isinstance(part, PiecewiseTrajectory)]
    kinds = {_kind(part) for part in piecewise}
    if len(piecewise) < len(parts) or len(kinds) > 1:
        return JoinedTrajectory(parts, note)
    profiles = [_joined_profile([part.profiles[j] for part in piecewise])
                for j in range(len(piecewise[0].profiles))]
    via_times = np.minimum(_via_times(parts), profiles[0].duration)
    return PiecewiseTrajectory(profiles, via_times, note)


class JoinedTrajectory(Trajectory):
    """
    Motions of any kind, one after another; made by `joined`.

    Parameters
    ----------
    parts : sequence of Trajectory
        The motions.
    note : str
        See `Trajectory`.

    """

    def __init__(self, parts: Sequence[Trajectory], note: str = '') -> None:
        self.parts, self.note = tuple(parts), note
        self.bounds = _bounds(parts)
        self.duration = float(self.bounds[-1])
        self.via_times = ending_at_duration(_via_times(parts), self.duration)
        make_read_only((self.bounds,))

    def __call__(self, t: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Return position, velocity, acceleration and jerk; see `Trajectory`."""
        times = parameter_values('t', t)
        flat = np.atleast_1d(times)
        found = tuple(np.empty((len(flat), 3)) for _ in range(4))
        of_part = np.searchsorted(self.bounds[1:-1], flat, side='right')
        for k in np.unique(of_part).tolist():
            of_this = of_part == k
            local = flat[of_this] - self.bounds[k]
            if k == len(self.parts) - 1:  # despite rounding, at the end exactly
                local = np.where(flat[of_this] >= self.duration, self.parts[k].duration, local)
            for whole, value in zip(found, self.parts[k](local)):
                whole[of_this] = value
        q, qd, qdd, qddd = found
        return (q[0], qd[0], qdd[0], qddd[0]) if times.ndim == 0 else (q, qd, qdd, qddd)

    @property
    def knots(self) -> Array:
        """Return the knots of all motions; see `Trajectory`."""
        knots = np.unique(np.append(self._of_all(lambda part: part.knots), self.bounds))
        apart = np.diff(knots) > TIME_ROUNDING * max(1.0, self.duration)
        knots = np.concatenate((knots[:1], knots[1:][apart]))
        knots[-1] = self.duration
        return knots

    @property
    def step_times(self) -> Array:
        """Return when acceleration steps in one of the motions; see `Trajectory`."""
        return self._of_all(lambda part: part.step_times)

    @property
    def jerk_step_times(self) -> Array:
        """Return when jerk steps in one of the motions; see `Trajectory`."""
        return self._of_all(lambda part: part.jerk_step_times)

    def _of_all(self, times: Callable[[Trajectory], Array]) -> Array:
        """Return times of all motions, counted from the beginning of the first."""
        return np.concatenate([
            begin + times(part) for begin, part in zip(self.bounds, self.parts)])

    def peaks(self) -> Peaks:
        """Return the exact extremes over the continuous motion."""
        found = [part.peaks() for part in self.parts]
        return Peaks(
            velocity=np.max([p.velocity for p in found], axis=0),
            acceleration=np.max([p.acceleration for p in found], axis=0),
            jerk=np.max([p.jerk for p in found], axis=0),
            min_position=np.min([p.min_position for p in found], axis=0),
            max_position=np.max([p.max_position for p in found], axis=0))

    def time_scaled(self, factor: float) -> JoinedTrajectory:
        """Return the same path with time scaled by a factor; see `Trajectory`."""
        factor = time_factor(factor)
        slower = JoinedTrajectory([part.time_scaled(factor) for part in self.parts], self.note)
        self.pass_cache(slower, factor)
        return slower


def _check(parts: Sequence[Trajectory]) -> None:
    """Refuse motions that do not begin where the one before ends, and none."""
    if not parts:
        raise InvalidInputError('no motion is given, at least one is needed')
    for k, (before, after) in enumerate(zip(parts, parts[1:]), 1):
        gap = float(np.abs(before(before.duration)[0] - after(0.0)[0]).max())
        if gap > JOINT_ROUNDING:
            raise InvalidInputError(
                f'motion {k} begins {gap:.3g} rad from where motion {k - 1} ends, at most '
                f'{JOINT_ROUNDING:g} rad are allowed')


def _bounds(parts: Sequence[Trajectory]) -> Array:
    """Return when each motion begins, and when the last one ends [s]."""
    return np.concatenate(([0.0], np.cumsum([part.duration for part in parts])))


def _via_times(parts: Sequence[Trajectory]) -> Array:
    """Return the via times of all motions [s]."""
    later = [begin + part.via_times[1:] for begin, part in zip(_bounds(parts)[1:], parts[1:])]
    return np.concatenate((parts[0].via_times, *later))


def _kind(part: PiecewiseTrajectory) -> tuple[type, int]:
    """Return of which function a motion's pieces are."""
    pieces = part.profiles[0].pieces
    return type(pieces), id(getattr(pieces, 'shape', None))


def _joined_profile(profiles: Sequence[JointProfile]) -> JointProfile:
    """Return the pieces of one joint one after another."""
    fields = np.concatenate([
        np.array(list(profile.pieces.parameters().values())) for profile in profiles], axis=1)
    return JointProfile(profiles[0].pieces.with_parameters(fields))
