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

"""The motion through points, against SciPy's own Hermite interpolation."""

import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.trajectory.quintic_spline import hermite, spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from scipy.interpolate import BPoly, CubicHermiteSpline

# Relative to values that grow with the inverse square of segments of a tenth of a second.
ROUNDING = 1e-9


def random_points(seed, n=12):
    """Return times and three random states at each."""
    rng = np.random.default_rng(seed)
    times = rng.uniform(-1.0, 1.0) + np.cumsum(rng.uniform(0.1, 1.0, n))
    return times, *rng.normal(0.0, 2.0, (3, n, 3))


def times_over(times, n=500):
    """Return times of the motion, its points among them but for the last."""
    even = np.linspace(times[0], times[-1], n, endpoint=False)
    return np.sort(np.concatenate((even, times[:-1])))


@pytest.mark.parametrize('seed', range(5))
def test_positions_alone_are_joined_by_lines(seed):
    times, positions, _, _ = random_points(seed)
    t = times_over(times)
    q, qd, qdd, _ = spline_through(TrajectoryPoints(times, positions)).at(t)
    slopes = np.diff(positions, axis=0) / np.diff(times)[:, np.newaxis]
    for j in range(3):
        assert q[:, j] == pytest.approx(np.interp(t, times, positions[:, j]), abs=1e-12)
    segment = np.searchsorted(times, t, side='right') - 1
    assert qd == pytest.approx(slopes[segment], abs=1e-12)
    assert (qdd == 0.0).all()


@pytest.mark.parametrize('seed', range(5))
def test_positions_and_velocities_are_joined_by_cubics(seed):
    times, positions, velocities, _ = random_points(seed)
    t = times_over(times)
    spline = CubicHermiteSpline(times, positions, velocities)
    points = TrajectoryPoints(times, positions, velocities)
    for order, values in enumerate(spline_through(points).at(t)):
        assert values == pytest.approx(spline(t, order), rel=ROUNDING, abs=ROUNDING)


@pytest.mark.parametrize('seed', range(5))
def test_positions_velocities_and_accelerations_are_joined_by_quintics(seed):
    times, *states = random_points(seed)
    t = times_over(times)
    quintic = BPoly.from_derivatives(times, np.stack(states, axis=1))
    for order, values in enumerate(spline_through(TrajectoryPoints(times, *states)).at(t)):
        assert values == pytest.approx(quintic(t, order), rel=ROUNDING, abs=ROUNDING * 10)


def test_quintic_meets_every_state_at_the_points():
    times, *states = random_points(7)
    spline = spline_through(TrajectoryPoints(times, *states))
    for values, expected in zip(spline.at(times), states):
        assert values == pytest.approx(expected, abs=1e-9)


def test_accelerations_without_velocities_are_of_no_use():
    times, positions, _, accelerations = random_points(8)
    t = times_over(times)
    with_them = spline_through(TrajectoryPoints(times, positions, None, accelerations)).at(t)
    without = spline_through(TrajectoryPoints(times, positions)).at(t)
    for a, b in zip(with_them, without):
        assert (a == b).all()


def test_the_end_states_apply_outside_the_motion():
    times, *states = random_points(9)
    outside = np.array([times[0] - 5.0, times[0] - 1e-9, times[-1] + 1e-9, times[-1] + 5.0])
    q, qd, qdd, _ = spline_through(TrajectoryPoints(times, *states)).at(outside)
    assert q == pytest.approx(states[0][[0, 0, -1, -1]], abs=1e-9)
    assert qd == pytest.approx(states[1][[0, 0, -1, -1]], abs=1e-9)
    assert qdd == pytest.approx(states[2][[0, 0, -1, -1]], abs=1e-8)


@pytest.mark.parametrize('states', [1, 2, 3])
def test_a_single_point_is_a_place_to_rest(states):
    values = [np.array([[1.0, 2.0, 3.0]])] * states
    still = spline_through(TrajectoryPoints([0.5], *values))
    q, qd, qdd, qddd = still.at(np.array([0.0, 0.5, 1.0]))
    assert q.tolist() == [[1.0, 2.0, 3.0]] * 3
    assert (qd == 0.0).all()
    assert (qdd == 0.0).all()
    assert (qddd == 0.0).all()


@pytest.mark.parametrize('degree', [1, 3, 5])
def test_hermite_gives_back_the_polynomial_that_the_states_are_taken_from(degree):
    rng = np.random.default_rng(90)
    for _ in range(50):
        T = rng.uniform(0.1, 3.0)
        exact = np.polynomial.Polynomial(rng.normal(size=degree + 1))
        states = [exact.deriv(k) if k else exact for k in range((degree + 1) // 2)]
        start, end = (tuple(np.array(f(x)) for f in states) for x in (0.0, T))
        assert hermite(T, start, end) == pytest.approx(exact.coef, rel=1e-9, abs=1e-7)


def test_points_are_read_only_copies_and_know_their_duration():
    positions = np.zeros((2, 3))
    points = TrajectoryPoints([0.0, 1.5], positions)
    positions[0] = 7.0
    assert points.positions[0].tolist() == [0.0, 0.0, 0.0]
    assert points.duration == 1.5
    with pytest.raises(ValueError, match='read-only'):
        points.times[0] = 1.0


@pytest.mark.parametrize('times', [[], [0.0, 0.0], [0.0, 2.0, 1.0]])
def test_times_that_do_not_increase_are_refused(times):
    with pytest.raises(InvalidInputError, match='^times must be strictly increasing, and at'):
        TrajectoryPoints(times, np.zeros((len(times), 3)))


@pytest.mark.parametrize('name', ['positions', 'velocities', 'accelerations'])
def test_states_that_do_not_fit_the_times_are_refused_by_name(name):
    states = {'positions': np.zeros((2, 3)), name: np.zeros((3, 3))}
    with pytest.raises(InvalidInputError, match=(
            rf'^{name} has shape \(3, 3\), must have \(2, 3\)$')):
        TrajectoryPoints([0.0, 1.0], **states)
    states[name] = np.full((2, 3), np.nan)
    with pytest.raises(InvalidInputError, match=rf'^{name}\[0\]\[0\] is nan, must be finite$'):
        TrajectoryPoints([0.0, 1.0], **states)
