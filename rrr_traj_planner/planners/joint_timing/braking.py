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

"""Motions that brake over several segments, for arms that move fast through close via points."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rrr_traj_planner.core.arm.limits import kinematic_time_scale
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.kinematics.travel_time import ramp_time
from rrr_traj_planner.core.trajectory.quintic_spline import hermite, polynomial
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.tasks import JointTask, StartRates

# Chosen values.
LONGER = (1.0, 2.0)  # braking distances, over the shortest by the limits
FURTHER = (0.5, *LONGER, 4.0, 8.0, 16.0)  # those of which the best are tried,
TRIED = 2                                 # so many
SHORT = 0.3          # duration of a first segment over the second's, in which jerk is zero


def stops_for(task: JointTask, longer: tuple[float, ...] = LONGER) -> list[int]:
    """
    Return the via points at which a moving arm can come to rest on its way.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.
    longer : tuple of float
        Braking distances, over the shortest by the limits.

    Returns
    -------
    list of int
        One for each braking distance, the last one where the way is shorter; 0 is the start.

    """
    speed, way = float(np.linalg.norm(task.rates_at_start.velocity)), _way(task)
    if speed == 0.0:
        return [0]
    least = 0.5 * speed * float(ramp_time(np.asarray(speed), *_along(task)))
    last = len(task.points) - 1
    return [min(int(np.searchsorted(way, part * least)), last) for part in longer]


def braking(task: JointTask, mesh: Mesh, rests: Variables) -> Iterator[Variables]:
    """
    Give motions that brake evenly through the via points, and rest at later ones.

    Of several braking distances, those by which the motions exceed limits least.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.
    mesh : Mesh
        Of the motions.
    rests : Variables
        A motion with stops at all via points.

    Yields
    ------
    Variables
        The motions, which may exceed limits; none where the arm comes to rest in one segment.

    """
    if stops_for(task)[0] > 1:
        stops = {stop for stop in stops_for(task, FURTHER) if stop > 1}
        found = [_to(task, mesh, rests, stop) for stop in sorted(stops)]
        for _, motion in sorted(found, key=lambda m: m[0])[:TRIED]:
            yield motion


def _to(task: JointTask, mesh: Mesh, rests: Variables, stop: int) -> tuple[float, Variables]:
    """Return the motion to rest at a via point, by quintics, and its excess over limits."""
    rates, way = task.rates_at_start, _way(task)[:stop + 1]
    D = np.diff(task.points[:stop + 1], axis=0)
    speeds = np.linalg.norm(rates.velocity) * np.sqrt(1.0 - way / way[-1])
    most = _along(task)[1]  # jerk limits the end, where speed falls with the square of time
    speeds = np.minimum(speeds, 0.5 * most * np.cbrt(6.0 * (way[-1] - way) / most) ** 2)
    T = (2.0 * np.diff(way) / (speeds[:-1] + speeds[1:]))[:, np.newaxis]
    T[0] = _with_acceleration(rates, D[0], T[0])
    chords, both = D / T, T[:-1] + T[1:]
    v, a = np.zeros((2, stop + 1, 3))
    v[0], a[0] = rates
    v[1:-1] = (T[1:] * chords[:-1] + T[:-1] * chords[1:]) / both  # of the parabola through three
    a[1:-1] = 2.0 * (chords[1:] - chords[:-1]) / both
    if T[0] < SHORT * T[1]:  # else little is known of the state at the first via point
        v[1], a[1] = v[0] + T[0] * a[0], a[0]
    c = hermite(T, (np.zeros_like(D), v[:-1], a[:-1]), (D, v[1:], a[1:]))
    t = mesh.starts[:stop, :, np.newaxis] * T[:, np.newaxis]
    qd, qdd, jerk = (polynomial(np.stack(c)[:, :, np.newaxis], t, k) for k in (1, 2, 3))
    excess = kinematic_time_scale(
        np.abs(qd) / task.limits.max_velocity,
        np.abs(qdd) / acceleration_scale(task.model, task.limits, task.points),
        np.abs(jerk) / task.limits.max_jerk)
    j = np.concatenate((jerk[:, 0], np.zeros((1, 3))))
    return excess, mesh.restored(task.points, rests._replace(
        inner=np.concatenate((jerk[:, 1:-1], rests.inner[stop:])),
        T=np.concatenate((T[:, 0], rests.T[stop:])),
        **{name: np.concatenate((own, getattr(rests, name)[stop + 1:]))
           for name, own in (('v', v), ('a', a), ('j', j))}))


def _along(task: JointTask) -> tuple[Array, Array]:
    """Return the largest acceleration and jerk in the direction of motion."""
    speeds = np.abs(task.rates_at_start.velocity)
    with np.errstate(divide='ignore'):
        a, j = ((limit * np.linalg.norm(speeds) / speeds).min() for limit in (
            acceleration_scale(task.model, task.limits, task.points), task.limits.max_jerk))
    return a, j


def _with_acceleration(rates: StartRates, D: Array, T: Array) -> Array:
    """Return in which time the arm goes a way with its acceleration, T where it does not."""
    speed = float(np.linalg.norm(rates.velocity))
    way, along = (float(x @ rates.velocity) / speed for x in (D, rates.acceleration))
    squared = speed ** 2 + 2.0 * along * way
    return np.array([2.0 * way / (speed + np.sqrt(squared))]) if way > 0.0 < squared else T


def _way(task: JointTask) -> Array:
    """Return the distances along straight segments, in joint space [rad], shape (N + 1,)."""
    return np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(task.points, axis=0), axis=1))))
