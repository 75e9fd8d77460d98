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
Motions that start moving: first iterates, and the motion that stops first where none leads on.

First iterates go straight to the first via point, in a time that exceeds limits least, or, where
none of these leads on, as the motion that stops first. Shifted barriers bring them within limits
(`problem.brought_within`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.cancellation import until_found
from rrr_traj_planner.core.errors import StartStateError
from rrr_traj_planner.core.kinematics.travel_time import ramp_time
from rrr_traj_planner.core.motion_laws.polynomial_piece import PolynomialPiece
from rrr_traj_planner.core.stopping.stop import stop, stop_of_state
from rrr_traj_planner.core.stopping.task import from_state
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.core.trajectory.quintic_spline import hermite, polynomial
from rrr_traj_planner.planners.joint_timing.braking import braking, stops_for
from rrr_traj_planner.planners.joint_timing.constraints import JointConstraints
from rrr_traj_planner.planners.joint_timing.problem import (
    brought_within,
    FIRST_GAP,
    InitialMotion,
    JointProblem,
    Solved,
)
from rrr_traj_planner.planners.joint_timing.start import rest_to_rest
from rrr_traj_planner.planners.sampling_jerk_limit import acceleration_scale
from rrr_traj_planner.planners.solver.interior_point import CentralPathPoint
from rrr_traj_planner.planners.solver.limits import DurationConstraints
from rrr_traj_planner.planners.solver.splines import Mesh, Variables
from rrr_traj_planner.planners.tasks import JointTask

# Chosen values.
HEAD = 20  # segments, at least, in which a longer motion comes to rest
# of the first segment, over that from rest to rest, and over the time to stop where that is longer
DURATIONS = 1.1 ** np.arange(-30.0, 8.0)
WITHOUT_TORQUE = 0.5  # of the acceleration that torque allows
DIRECT = 1e-3         # part of the way by which a direct motion may overshoot
STOP_ROOM = 2e-4      # part of its limits that a stop leaves, for it is checked at samples


def from_motion(durations: DurationConstraints) -> InitialMotion:
    """
    Return how motions that start moving are found.

    Parameters
    ----------
    durations : DurationConstraints
        Of the problem.

    Returns
    -------
    callable
        Returns the fastest motion within constraints that the first iterates lead to; None where
        none does.

    """
    def found(task: JointTask, constraints: JointConstraints) -> Variables | None:
        head = max(HEAD, *stops_for(task))
        if len(task.points) - 1 > 2 * head:
            return _with_rest_to_rest(task, constraints, durations, head)
        # where planning ends early the arm may stop first; after that there is no other way
        goes_on = until_found(task.should_stop) if task.should_stop() else task.should_stop
        best = None
        for motion in straight_on(task, constraints.mesh):
            within = brought_within(constraints, motion, durations, goes_on)
            if within and (best is None or durations.cost(within.T) < durations.cost(best.T)):
                best = within
            if best and task.should_stop():
                break
        if best or not constraints.with_torque:
            return best
        without = _without_torque(task, constraints.mesh, durations)
        return without and brought_within(constraints, without, durations, goes_on)

    return found


def _with_rest_to_rest(task: JointTask, constraints: JointConstraints,
                       durations: DurationConstraints, head: int) -> Variables | None:
    """Return a motion that rests after some segments, and at all later via points."""
    first = from_motion(durations._replace(
        free=durations.free[:head], proportions=durations.proportions[:head],
        weights=durations.weights[:head], fixed=np.concatenate(
            (durations.fixed[:head], durations.fixed[-1:]))))(
        replace(task, points=task.points[:head + 1]), constraints.of_first(head))
    if first is None:
        return None
    m = _rest_to_rest(task, constraints.mesh)
    return brought_within(constraints, Variables(*(np.concatenate((own, f[len(own):]))
                                                   for own, f in zip(first, m))),
                          durations, until_found(task.should_stop))


def _without_torque(task: JointTask, mesh: Mesh,
                    durations: DurationConstraints) -> Variables | None:
    """Return a motion within limits on acceleration in place of those on torque."""
    scale = WITHOUT_TORQUE * acceleration_scale(task.model, task.limits, task.points)
    limits = replace(task.limits, max_effort=np.full(3, np.inf), max_acceleration=np.maximum(
        scale, 2.0 * np.abs(task.rates_at_start.acceleration)))
    problem = JointProblem(replace(task, limits=limits), mesh, durations)
    first = from_motion(durations)(problem.task, problem.without_margins)
    return None if first is None else problem.minimised(
        problem.without_margins, CentralPathPoint(first, None), FIRST_GAP).motion


def straight_on(task: JointTask, mesh: Mesh) -> Iterator[Variables]:
    """
    Give motions straight to the first via point, which stop at later ones; they exceed limits.

    One family stops there too, by quintics; the other passes it with the velocity and acceleration
    of cubics. Each with the duration that exceeds limits and overshoots least, and the longest
    without an overshoot.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.
    mesh : Mesh
        Of the motions.

    Yields
    ------
    Variables
        The motions.

    """
    (v, a), D, N = task.rates_at_start, task.points[1] - task.points[0], len(task.points) - 1
    m = _rest_to_rest(task, mesh)
    longest = max(m.T[0], _time_to_stop(task))
    T = np.sort(np.outer(np.unique([m.T[0], longest]), DURATIONS), axis=None)[:, np.newaxis]
    zero = np.zeros(3)
    families = [hermite(T, (zero, v, a), (D, zero, zero)),
                [zero, v, 0.5 * a, (D - T * (v + 0.5 * T * a)) / T ** 3]]
    s = mesh.starts[0][:, np.newaxis, np.newaxis]
    for family in families[:N]:
        c = np.stack(np.broadcast_arrays(*family))
        for i in _durations(task, c, s * T, float((np.abs(D) + np.abs(v) * longest).max())):
            rates = [polynomial(c[:, i], s[:, 0] * T[i], k) for k in (1, 2, 3)]
            inner, via = m.inner.copy(), (m.v.copy(), m.a.copy(), m.j.copy())
            inner[0] = rates[2][1:-1]
            for own, f in zip(via, rates):
                own[0] = f[0]
                if N > 1:
                    own[1] = f[-1]
            yield mesh.restored(task.points, Variables(
                inner, *via, T=np.concatenate((T[i], m.T[1:]))))
    yield from braking(task, mesh, m)


def _rest_to_rest(task: JointTask, mesh: Mesh) -> Variables:
    """Return a motion with stops at all points, without torque limits where these forbid it."""
    N = len(task.points) - 1
    for max_effort in (task.limits.max_effort, np.full(3, np.inf)):
        problem = JointProblem(
            replace(task, limits=replace(task.limits, max_effort=max_effort), start_rates=None),
            mesh, DurationConstraints.all_free(N, 3))
        m = rest_to_rest(problem.task, problem.without_margins)
        if m is not None:
            break
    assert m is not None
    return m


def _time_to_stop(task: JointTask) -> float:
    """Return how long the joints would take to stop if they did not accelerate yet [s]."""
    v, limits = np.abs(task.rates_at_start.velocity), task.limits
    a = acceleration_scale(task.model, limits, task.points)
    return float(ramp_time(v, a, limits.max_jerk).max())


def _durations(task: JointTask, c: Array, t: Array, way: float) -> set[int]:
    """Return the first segment's durations, of K: of least excess, the longest that is direct."""
    limits, D = task.limits, task.points[1] - task.points[0]
    q, qd, qdd, jerk = (polynomial(c, t, k) for k in range(4))
    factor = np.max([np.abs(qd) / limits.max_velocity,
                     np.sqrt(np.abs(qdd) / limits.max_acceleration),
                     np.cbrt(np.abs(jerk) / limits.max_jerk)], axis=(0, 1, 3))
    over = np.maximum(q - np.maximum(D, 0.0), np.minimum(D, 0.0) - q).max(axis=(0, 2))
    found = {int((factor + over / max(way, np.finfo(float).tiny)).argmin())}
    direct = np.flatnonzero(over <= DIRECT * way)
    return found | set(direct[-1:].tolist())


def as_with_a_stop(stopping: PiecewiseTrajectory,
                   durations: DurationConstraints) -> InitialMotion:
    """
    Return how a motion is found that begins like one that stops first.

    Parameters
    ----------
    stopping : PiecewiseTrajectory
        The motion that stops first; without its steps of jerk it may exceed limits.
    durations : DurationConstraints
        Of the problem.

    Returns
    -------
    callable
        Returns a motion within constraints near that one; None where none is found.

    """
    def found(task: JointTask, constraints: JointConstraints) -> Variables | None:
        mesh, at, T = constraints.mesh, stopping.via_times, np.diff(stopping.via_times)
        inside = at[:-1, np.newaxis] + mesh.starts[:, 1:-1] * T[:, np.newaxis]
        inner = stopping(inside.ravel())[3].reshape(*inside.shape, 3)
        v, a, j = via = np.stack(stopping(at)[1:])
        via[:2, 0], via[:, -1] = task.rates_at_start, 0.0
        motion = mesh.restored(task.points, Variables(inner, v, a, j, T))
        return brought_within(constraints, motion, durations, task.should_stop)

    return found


def after_a_stop(task: JointTask, fastest: Callable[[JointTask], Solved | None]) -> Solved | None:
    """
    Return a motion that stops first, as fast as the arm's `hold`, then goes on from rest.

    While it stops jerk is constant piece by piece: it has steps, as that of `hold`.

    Parameters
    ----------
    task : JointTask
        The arm, its limits, the via points and how the joints move at the start.
    fastest : callable
        Returns the fastest motion of a task that starts at rest.

    Returns
    -------
    Solved or None
        Its note says that it stops. None where there is no motion from rest.

    Raises
    ------
    StartStateError
        If no stop within its limits is found.

    """
    kept = replace(task.limits, **{name: (1.0 - STOP_ROOM) * getattr(task.limits, name)
                                   for name in ('max_velocity', 'max_effort')})
    state = np.concatenate((task.points[0], *task.rates_at_start))
    moving = from_state(tuple(state.tolist()), 0)
    stopping = stop_of_state(moving, kept, task.model)
    if stopping is None:
        reasons = ': '.join(('', *stop(moving, 0.0, kept, task.model).warnings[:1]))
        raise StartStateError(
            f'start state: no way on was found, nor a stop within the limits{reasons}')
    h, c = np.diff(stopping.knots), np.moveaxis(stopping.coefficients, 1, 0)
    solved = fastest(replace(
        task, points=np.vstack((stopping.final, task.points[1:])), start_rates=None))
    if solved is None:
        return None
    profiles = []
    at_rest = float(h.sum())
    for own, profile in zip(c, solved.trajectory.profiles):
        braking = h, own[:, 0], own[:, 1], 2.0 * own[:, 2], 6.0 * own[:, 3], 24.0 * own[:, 4]
        going = profile.pieces.parameters().values()
        profiles.append(JointProfile(PolynomialPiece(*map(np.concatenate, zip(braking, going)))))
    via_times = np.concatenate(([0.0], solved.trajectory.via_times[1:] + at_rest))
    note = f'the arm stops first, in {at_rest:.3g} s: no motion was found that goes straight on'
    return solved._replace(
        trajectory=PiecewiseTrajectory(profiles, via_times, note, stopping.knots),
        cost=float(via_times[-1]))
