"""Least-time problems on chains of ramps, solved and mended until nothing breaks a limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array, BoolArray
from rrr_traj_planner.core.dynamics import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.limit_check import POSITION_TOLERANCE
from rrr_traj_planner.core.limits import JointLimits
from rrr_traj_planner.core.motion_torque import peak_torque
from rrr_traj_planner.core.piecewise import PiecewiseTrajectory
from rrr_traj_planner.planners.interior_point import minimise, Outcome
from rrr_traj_planner.planners.motion_law import torque_stretch
from rrr_traj_planner.planners.ramp_chain import Grid, Motion
from rrr_traj_planner.planners.ramp_constraints import Constraints
from rrr_traj_planner.planners.ramp_newton import Freedom
from rrr_traj_planner.planners.ramp_start import rest_to_rest
from rrr_traj_planner.planners.request import JointTask

REPAIRS = 6              # rounds of mending what happens between the points that are looked at
REPAIR_ROOM = 1.2
ROUNDING = 1e-7         # relative
LOOKS = 6                # at the torque between two points, to mend it
ROOM_PARTS = (1.0, 0.3, 0.1, 0.0)
WARM_ROOM = 3e-3         # by which a motion is slowed to begin again with less room
WARM_NEARNESS = 0.02
STRETCH_WORTH_IT = 1e-3  # a longer stretch than this is better mended by planning again


Begin = Callable[[JointTask, Constraints], Motion | None]


class Solved(NamedTuple):
    """A motion that keeps every limit."""

    trajectory: PiecewiseTrajectory
    outcome: Outcome


def fastest(task: JointTask, grid: Grid, floor: Array | None = None) -> Solved | None:
    """
    Return the fastest motion.

    Where joints have acceleration limits they are first planned without regard to torque, each
    for itself but for time; torque then often has nothing to say.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        The family of motions.
    floor : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Returns
    -------
    Solved or None
        None where no way is found along which the motors can hold the arm.

    """
    segments = len(task.points) - 1
    freedom = Freedom(np.ones(segments, bool), np.zeros(segments), np.ones(segments),
                      np.zeros((segments - 1, 3), bool))
    if np.isfinite(task.limits.max_acceleration).all():
        free = replace(task.limits, max_effort=np.full(3, np.inf))
        found = mended(replace(task, limits=free), grid, freedom, rest_to_rest, floor)
        if found is not None and _torque_fits(task, found.trajectory):
            return found
    return mended(task, grid, freedom, rest_to_rest, floor)


def mended(task: JointTask, grid: Grid, freedom: Freedom, begin: Begin,
           floor: Array | None = None) -> Solved | None:
    """
    Solve, and solve again with more room where the motion breaks a limit between points.

    Parameters
    ----------
    task : JointTask
        The via points, the arm and its limits.
    grid : Grid
        The family of motions.
    freedom : Freedom
        Which durations may change.
    begin : callable
        Gives a motion to start from, strictly within the constraints, or None.
    floor : ndarray, shape (N,), optional
        Least durations of the segments [s].

    Returns
    -------
    Solved or None
        The best that was found; None where there is nothing to start from.

    """
    room, start, nearness = _Room.none(task, grid, freedom), None, 1.0
    first: Motion | None = None
    found: list[Solved] = []
    for _ in range(REPAIRS):
        for part in ROOM_PARTS:  # with less room where a start would not find any
            constraints = room.constraints(task, grid, part, floor)
            if start is None or not _strictly_within(constraints, start):
                start, nearness = begin(replace(task, limits=room.limits), constraints), 1.0
            if start is None or _strictly_within(constraints, start):
                break
        if start is None or not _strictly_within(constraints, start):
            break
        first = first or start  # slow: what ranges and gravity leave there can be kept free
        outcome = minimise(constraints, start, freedom._replace(still=room.still),
                           task.should_stop, nearness)
        trajectory = grid.trajectory(task.points, outcome.motion)
        beyond, stretch = _beyond_range(task, trajectory), stretch_to_fit(task, trajectory)
        if not beyond.any() and np.isfinite(stretch):
            slowed = _stretched(trajectory, stretch)
            # slowing can ask for more torque where the motion hurries past what it cannot hold;
            # and durations that are fixed must not be stretched
            if slowed is trajectory or stretch <= 1.0 + ROUNDING or (
                    _may_stretch(freedom) and stretch_to_fit(task, slowed) <= 1.0 + ROUNDING):
                found.append(Solved(slowed, outcome))
                if stretch <= 1.0 + STRETCH_WORTH_IT:
                    break
        if not found:
            found += _unimproved(task, grid, start)
        room = room.grown(task, grid, first, outcome.motion, trajectory, beyond)
        start, nearness = None, 1.0
        if np.isfinite(stretch) and not beyond.any() and freedom.free.all():
            start = grid.stretched(outcome.motion, stretch * (1.0 + WARM_ROOM))
            nearness = WARM_NEARNESS
    return min(found, default=None,
               key=lambda s: float(freedom.weights @ np.diff(s.trajectory.via_times)))


def _unimproved(task: JointTask, grid: Grid, start: Motion) -> list[Solved]:
    """Return the motion that the method starts from, if it can be had."""
    trajectory = grid.trajectory(task.points, start)
    stretch = stretch_to_fit(task, trajectory)
    if _beyond_range(task, trajectory).any() or np.isinf(stretch):
        return []
    return [Solved(_stretched(trajectory, stretch), Outcome(start, trajectory.duration, False))]


def _beyond_range(task: JointTask, trajectory: PiecewiseTrajectory) -> Array:
    """Return how far each joint leaves its range in each segment, above and below, (2, N, 3)."""
    beyond = np.zeros((2, len(task.points) - 1, 3))
    starts = trajectory.via_times[1:-1] - 1e-12
    for j, profile in enumerate(trajectory.profiles):
        least, most = profile.piece_ranges()
        segment = np.searchsorted(starts, profile.knots[:-1], side='right')
        np.maximum.at(beyond[0, :, j], segment, most - task.limits.max_position[j])
        np.maximum.at(beyond[1, :, j], segment, task.limits.min_position[j] - least)
    return np.where(beyond > POSITION_TOLERANCE, beyond, 0.0)


class _Room(NamedTuple):
    """What is kept free of limits, for what happens between the points that are looked at."""

    limits: JointLimits
    margins: Array         # of positions, (2, N, 2 n + 1, 3)
    effort_margins: Array  # (N, 2 n + 1, 3)
    still: BoolArray       # via velocities that stay zero, (N - 1, 3)

    @classmethod
    def none(cls, task: JointTask, grid: Grid, freedom: Freedom) -> _Room:
        """Return no room at all."""
        segments = len(freedom.free)
        points = (segments, 2 * grid.n + 1, 3)
        return cls(task.limits, np.zeros((2, *points)), np.zeros(points), freedom.still)

    def constraints(self, task: JointTask, grid: Grid, part: float,
                    floor: Array | None) -> Constraints:
        """Return the constraints with a part of the room."""
        return Constraints(task.model, self.limits, grid, task.points, part * self.margins,
                           part * self.effort_margins, floor)

    def grown(self, task: JointTask, grid: Grid, first: Motion, m: Motion,
              trajectory: PiecewiseTrajectory, beyond: Array) -> _Room:
        """Return more room where a motion breaks limits, as far as the first one leaves it."""
        q = grid.states(task.points, first).q
        velocity = trajectory.peaks().velocity / task.limits.max_velocity
        margins, still = self._positions(task, q, beyond)
        spare = task.limits.max_effort - np.abs(gravity_torque(task.model, q))
        return _Room(
            replace(self.limits, max_velocity=self.limits.max_velocity / np.maximum(
                1.0, 1.0 + REPAIR_ROOM * (velocity - 1.0))),
            margins, np.minimum(
                self.effort_margins + REPAIR_ROOM * _excess_torque(task, grid, m, trajectory),
                np.maximum(0.5 * spare, self.effort_margins)), still)

    def _positions(self, task: JointTask, q: Array, beyond: Array) -> tuple[Array, BoolArray]:
        """Keep joints further inside their range; at via points too near its end, at rest."""
        room = np.stack((task.limits.max_position - q, q - task.limits.min_position))
        most = self.margins.max(axis=2) + REPAIR_ROOM * beyond
        wanted = np.where((beyond > 0.0)[:, :, np.newaxis], most[:, :, np.newaxis], self.margins)
        margins = np.minimum(wanted, np.maximum(0.5 * room, 0.0))
        ends = np.stack((task.points[:-1], task.points[1:]))
        room = np.stack((task.limits.max_position - ends, ends - task.limits.min_position))
        at_start, at_end = ((beyond > 0.0) & (room[:, k] <= 2.0 * most) for k in (0, 1))
        return margins, self.still | (at_end[:, :-1] | at_start[:, 1:]).any(axis=0)


def _excess_torque(task: JointTask, grid: Grid, m: Motion,
                   trajectory: PiecewiseTrajectory) -> Array:
    """Return by how much torques next to each point exceed their limits, (N, 2 n + 1, 3)."""
    n, steps = grid.n, 2 * LOOKS
    starts = np.concatenate(([0.0], np.cumsum(m.T)[:-1]))
    t = starts[:, np.newaxis] + m.T[:, np.newaxis] * np.linspace(0.0, 1.0, n * steps + 1)
    q, qd, qdd, _ = trajectory(t.ravel())
    tau = np.abs(inverse_dynamics(task.model, q, qd, qdd)).reshape(*t.shape, 3)
    # within half a half-ramp to both sides of every point, in the order of time
    half = np.pad(tau, ((0, 0), (LOOKS // 2, LOOKS // 2), (0, 0)), mode='edge')
    by_point = np.stack([half[:, k:k + 2 * n * LOOKS + 1:LOOKS] for k in range(LOOKS + 1)])
    excess = np.maximum(by_point.max(axis=0) - task.limits.max_effort, 0.0)
    return np.concatenate((excess[:, ::2], excess[:, 1::2]), axis=1)


def _strictly_within(constraints: Constraints, m: Motion) -> bool:
    return min(float(s.min()) for s in constraints.slacks(m)) > 0.0


def stretch_to_fit(task: JointTask, trajectory: PiecewiseTrajectory) -> float:
    """
    Return by how much a motion must be slowed for every limit but the positions'.

    Parameters
    ----------
    task : JointTask
        The arm and its limits.
    trajectory : PiecewiseTrajectory
        The motion.

    Returns
    -------
    float
        At most 1 where it fits as it is; infinite where no slowing helps.

    """
    peaks, limits = trajectory.peaks(), task.limits
    kinematic = max((peaks.velocity / limits.max_velocity).max(),
                    np.sqrt((peaks.acceleration / limits.max_acceleration).max()),
                    np.cbrt((peaks.jerk / limits.max_jerk).max()))
    # a motion may pass, but not slowly, where gravity alone would be too much
    if _torque_fits(task, trajectory):
        return float(kinematic)
    return float(max(kinematic, torque_stretch(task, trajectory)))


def _may_stretch(freedom: Freedom) -> bool:
    """Return whether no duration is fixed."""
    return bool((freedom.free | (freedom.tie > 0.0)).all())


def _torque_fits(task: JointTask, trajectory: PiecewiseTrajectory) -> bool:
    effort = task.limits.max_effort
    return bool(np.isinf(effort).all() or (peak_torque(
        task.model, trajectory).value <= effort * (1.0 + ROUNDING)).all())


def _stretched(trajectory: PiecewiseTrajectory, factor: float) -> PiecewiseTrajectory:
    return trajectory.stretched(factor) if factor > 1.0 else trajectory
