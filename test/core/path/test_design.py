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

"""Lines, arcs and polynomial zones through every via point."""

from functools import cache

from helpers.path_cases import distance_to_polyline, inside_pieces, random_tasks
import numpy as np
import pytest
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.path.design import line_arc, line_polynomial

FAMILIES = (line_arc, line_polynomial)
ON_POINT = 1e-12     # m
ROUNDING = 1e-12
TASKS = random_tasks(61, 25)
# A right angle in the plane z = 0, legs of 1 m.
CORNER = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])


@cache
def paths(family):
    return [family(points, radii) for points, radii in TASKS]


@pytest.mark.parametrize('family', FAMILIES)
def test_path_contains_every_via_point(family):
    for path, (points, _) in zip(paths(family), TASKS):
        assert np.abs(path(path.via_s)[0] - points).max() <= ON_POINT
        assert path.via_s[0] == 0.0
        assert path.via_s[-1] == path.length
        assert (np.diff(path.via_s) > 0.0).all()


@pytest.mark.parametrize('family', FAMILIES)
def test_position_and_tangent_are_continuous_at_the_joins(family):
    joins = 0
    for path in paths(family):
        before, after = path(path.joins, left=True), path(path.joins)
        assert before[0] == pytest.approx(after[0], abs=ON_POINT)
        assert before[1] == pytest.approx(after[1], abs=ROUNDING)
        joins += len(path.joins)
    assert joins > 150


@pytest.mark.parametrize('family', FAMILIES)
def test_parameter_is_arc_length(family):
    for path in paths(family):
        tangent = path(np.linspace(0.0, path.length, 500))[1]
        assert np.linalg.norm(tangent, axis=1) == pytest.approx(1.0, abs=ROUNDING)


@pytest.mark.parametrize('family', FAMILIES)
@pytest.mark.parametrize('order', [0, 1, 2])
def test_each_derivative_is_that_of_the_one_before(family, order):
    for path in paths(family):
        s = inside_pieces(path, 9, margin=0.05)
        widths = np.diff(np.concatenate(([0.0], path.joins, [path.length])))
        h = np.repeat(2e-3 * widths, 9)[:, np.newaxis]
        at = [path(s + k * h[:, 0])[order] for k in (-2, -1, 1, 2)]
        slope = (8.0 * (at[2] - at[1]) - (at[3] - at[0])) / (12.0 * h)
        # The polynomial zone bends within a twentieth of itself: differences feel (h / it)^4.
        unit = path.radii.min() ** -(order * 1.0)
        noise = 1e-15 * unit / h.min() + 1e-6 * path.radii.min() ** -float(order)
        assert path(s)[order + 1] == pytest.approx(slope, abs=100 * noise, rel=1e-5)


def test_arcs_are_circles_of_their_radius_in_the_plane_of_their_lines():
    for path in paths(line_arc):
        for j, rho in enumerate(path.radii):
            s = np.linspace(*path.zone_ends[j], 50)[1:-1]
            p, dp, ddp, _ = path(s)
            centre = path.points[j + 1] + rho * path.normal[j]
            assert np.linalg.norm(p - centre, axis=1) == pytest.approx(rho, abs=1e-12)
            assert np.linalg.norm(ddp, axis=1) == pytest.approx(1.0 / rho, rel=1e-12)
            plane = np.cross(path.tangent[j], path.normal[j])
            assert (p - centre) @ plane == pytest.approx(0.0, abs=1e-12)
            assert dp @ plane == pytest.approx(0.0, abs=1e-12)


def test_curvature_of_polynomial_zones_is_zero_at_both_ends_and_greatest_at_the_via_point():
    for path in paths(line_polynomial):
        for j, rho in enumerate(path.radii):
            s = np.linspace(*path.zone_ends[j], 301)
            curvature = rho * np.linalg.norm(path(s)[2], axis=1)
            at_ends = [path(path.zone_ends[j, 0]), path(path.zone_ends[j, 1], left=True)]
            assert [rho * np.linalg.norm(e[2]) for e in at_ends] == pytest.approx(
                [0.0, 0.0], abs=1e-9)
            assert rho * np.linalg.norm(path(path.via_s[j + 1])[2]) == pytest.approx(
                1.0, abs=1e-9)
            assert curvature.max() <= 1.0 + 1e-9


def thesis_path(points, rho):
    """Return touching points and centre of 5.63-5.68, by intersecting circles in the plane."""
    P0, P1, P2 = points
    u1, u2 = (P1 - P0) / np.linalg.norm(P1 - P0), (P2 - P1) / np.linalg.norm(P2 - P1)
    N = (u2 - u1) / np.linalg.norm(u2 - u1)
    O = P1 + rho * N  # noqa: E741  the thesis's name
    touching = []
    for P in (P0, P2):
        # 5.67: on the circle, and at a right angle to the radius; of both the one nearer P1.
        d = np.linalg.norm(P - O)
        e = (P - O) / d
        across = np.cross(np.cross(u1, u2), e)
        across /= np.linalg.norm(across)
        x = rho ** 2 / d
        both = [O + x * e + side * np.sqrt(rho ** 2 - x ** 2) * across for side in (-1.0, 1.0)]
        touching.append(min(both, key=lambda p: np.linalg.norm(p - P1)))
    return O, touching


def test_through_three_points_the_path_is_the_thesis_s_construction():
    rng = np.random.default_rng(62)
    for _ in range(100):
        points = rng.uniform(-1.0, 1.0, (3, 3))
        path = line_arc(points, 10.0 ** rng.uniform(-3.0, -1.0))
        if len(path.shrunk):
            continue
        centre, touching = thesis_path(points, path.radii[0])
        assert path.points[1] + path.radii[0] * path.normal[0] == pytest.approx(
            centre, abs=1e-12)
        assert path(path.joins)[0] == pytest.approx(np.array(touching), abs=1e-11)


def test_path_through_a_right_angle_is_what_a_drawing_gives():
    path = line_arc(CORNER, 0.2)
    half = np.sqrt(0.5)
    assert path.tangent[0] == pytest.approx([half, half, 0.0], abs=1e-15)
    assert path.normal[0] == pytest.approx([-half, half, 0.0], abs=1e-15)
    # Tangent from (0, 0) to the circle about (1 - 0.2 half, 0.2 half).
    tangent = np.sqrt((1.0 - 0.2 * half) ** 2 + (0.2 * half) ** 2 - 0.2 ** 2)
    assert path.joins[0] == pytest.approx(tangent, abs=1e-14)
    assert path.length == pytest.approx(2.0 * path.via_s[1], abs=1e-14)
    # Farthest from a leg where the arc runs along it: rho (1 - cos 45 deg).
    assert path.deviation[0] == pytest.approx(0.2 * (1.0 - half), rel=1e-9)


@pytest.mark.parametrize('family', FAMILIES)
def test_collinear_points_need_no_zone(family):
    points = np.outer([0.0, 0.3, 0.5, 2.0], [0.6, 0.0, 0.8])
    path = family(points, 0.1)
    assert len(path.joins) == 0
    assert path.length == pytest.approx(2.0, abs=1e-14)
    assert path.via_s == pytest.approx([0.0, 0.3, 0.5, 2.0], abs=1e-14)
    p, dp, ddp, _ = path(np.linspace(0.0, path.length, 50))
    assert dp == pytest.approx(np.tile([0.6, 0.0, 0.8], (50, 1)), abs=1e-14)
    assert not ddp.any()
    assert path.deviation == pytest.approx([0.0, 0.0], abs=1e-14)


@pytest.mark.parametrize('family', FAMILIES)
def test_two_points_are_joined_by_a_line(family):
    path = family([[0.0, 0.0, 0.0], [0.0, 3.0, 4.0]], [])
    assert path.length == 5.0
    assert path(2.5)[0] == pytest.approx([0.0, 1.5, 2.0], abs=1e-15)


@pytest.mark.parametrize('family', FAMILIES)
def test_deviation_is_the_largest_distance_from_the_polyline(family):
    for path in paths(family):
        between = 0.5 * (path.via_s[:-1] + path.via_s[1:])
        s = np.linspace(0.0, path.length, 2001)
        s = np.sort(np.concatenate((s, inside_pieces(path, 500))))
        distance = distance_to_polyline(path.points, path(s)[0])
        assert distance.max() <= path.deviation.max() * (1.0 + 1e-9) + 1e-14
        for j, deviation in enumerate(path.deviation):
            zone = (s >= path.zone_ends[j, 0]) & (s <= path.zone_ends[j, 1])
            assert between[j] < path.zone_ends[j, 1]
            # Another leg may pass nearer by than the two that meet here.
            assert distance[zone].max() <= deviation * (1.0 + 1e-9) + 1e-14
            own = distance_to_polyline(path.points[j:j + 3], path(s[zone])[0])
            assert own.max() == pytest.approx(deviation, rel=1e-2)


@pytest.mark.parametrize('family', FAMILIES)
def test_radii_that_fit_are_kept_and_others_shrunk_and_reported(family):
    shrunk = kept = 0
    for path, (_, radii) in zip(paths(family), TASKS):
        assert path.requested_radii.tolist() == radii.tolist()
        assert (path.radii <= radii).all()
        assert path.shrunk.tolist() == [j + 1 for j in range(len(radii))
                                        if path.radii[j] != radii[j]]
        assert (path.zone_ends[1:, 0] >= path.zone_ends[:-1, 1]).all()
        assert path.zone_ends[0, 0] >= 0.0
        shrunk, kept = shrunk + len(path.shrunk), kept + len(radii) - len(path.shrunk)
    assert shrunk > 10
    assert kept > 30


def test_shrunk_radius_at_a_right_angle_is_the_largest_circle_that_leaves_the_end_outside():
    # The circle through (1, 0) and (0, 0) with its centre on the bisector.
    path = line_arc(CORNER, 5.0)
    assert path.radii == pytest.approx([np.sqrt(0.5)], abs=1e-14)
    assert path.shrunk.tolist() == [1]


@pytest.mark.parametrize('family', FAMILIES)
@pytest.mark.parametrize('count', [3, 4])
@pytest.mark.parametrize('turn_deg', [175.0, 179.0, 179.9])
def test_nearly_full_reversal_is_passed_on_the_point_and_within_the_radius(
        family, count, turn_deg):
    turn = np.radians(turn_deg)
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0],
                       [1.0 + np.cos(turn), np.sin(turn), 0.0], [-0.5, 1.0, 0.7]])[:count]
    path = family(points, 0.02)
    assert np.abs(path(path.via_s)[0] - points).max() <= ON_POINT
    assert path.deviation[0] <= 1.25 * path.radii[0]
    assert path.length <= np.linalg.norm(np.diff(points, axis=0), axis=1).sum() + 0.1


@pytest.mark.parametrize('family', FAMILIES)
def test_zone_beside_a_corner_of_almost_half_a_turn_grows_to_the_requested_radius(family):
    points = [[0.7794743641589122, 0.8632306487515912, 0.8213042287894232],
              [0.7321822735716236, 0.8659692339829653, 0.8863694952876264],
              [0.7880689650609531, 0.8630932249962123, 0.8097325180481959],
              [0.8583505911700888, 0.8195505842180001, 0.8378904659912324]]
    path = family(points, [0.0069452136692425386, 0.03205771333828819])
    assert path.shrunk.tolist() == [1]
    assert path.radii[1] == 0.03205771333828819
    assert path.lines.angle[0] == pytest.approx(0.5 * np.pi, abs=1e-3)  # there it cannot grow
    assert (path.lines.length > 0.0).all()


@pytest.mark.parametrize('family', FAMILIES)
def test_full_reversal_is_refused_by_number(family):
    points = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [1.0, 0.5, 0.0], [0.2, 0.5, 0.0]]
    with pytest.raises(InvalidInputError, match='^via point 2: the path reverses') as caught:
        family(points, 0.01)
    assert caught.value.via_point == 2


@pytest.mark.parametrize('family', FAMILIES)
@pytest.mark.parametrize(('points', 'radii', 'text'), [
    ([[0, 0, 0], [1, 0, 0], [1, 0, 0]], 0.1, '^via point 2 repeats via point 1: 0 m apart$'),
    ([[0, 0, 0]], 0.1, '^a path needs at least 2 points, not 1$'),
    ([[0, 0, 0], [1, 0, 0], [1, np.nan, 0]], 0.1, r'^points\[2\]\[1\] is nan'),
    (CORNER, 0.0, '^via point 1: radius is 0 m, must be positive$'),
    (CORNER, np.inf, r'^radii\[0\] is inf, must be finite$'),
    (CORNER, [0.1, 0.1], r'^radii has shape \(2,\), must have \(1\)$')])
def test_malformed_path_is_refused(family, points, radii, text):
    with pytest.raises(InvalidInputError, match=text):
        family(points, radii)


def test_place_outside_the_path_is_refused():
    path = line_arc(CORNER, 0.1)
    with pytest.raises(InvalidInputError, match=r'^s is -0\.1 m, must be on the path, 0 to 2\.'):
        path([0.2, -0.1])
    assert path(-1e-15)[0].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize('family', FAMILIES)
def test_same_points_give_the_same_path_bit_for_bit_and_read_only(family):
    points, radii = TASKS[0]
    first, second = family(points, radii), family(points, radii)
    s = np.linspace(0.0, first.length, 99)
    assert np.array_equal(first(s), second(s))
    with pytest.raises(ValueError, match='read-only'):
        first.radii[0] = 1.0


@pytest.mark.parametrize('family', [line_arc, line_polynomial])
def test_a_zone_at_one_side_of_its_via_point_leaves_the_leg_on_the_other_as_it_is(family):
    rng = np.random.default_rng(9)
    for _ in range(20):
        points = np.cumsum(rng.normal(size=(4, 3)), axis=0)
        for side, leg in (((-1, 1), 1), ((1, 0), 0), ((0, -1), 2)):
            path = family(points, rng.uniform(0.01, 0.1), side=side)
            assert path(path.via_s)[0] == pytest.approx(points, abs=1e-12)
            s = np.linspace(path.via_s[leg], path.via_s[leg + 1], 50)
            share = np.linspace(0.0, 1.0, 50)[:, np.newaxis]
            straight = points[leg] + share * (points[leg + 1] - points[leg])
            assert path(s)[0] == pytest.approx(straight, abs=1e-12)
            before, after = path(path.joins, left=True), path(path.joins)
            assert before[0] == pytest.approx(after[0], abs=1e-12)
            assert before[1] == pytest.approx(after[1], abs=1e-10)
