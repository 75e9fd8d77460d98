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

"""Radii that fit: as large as neighbours allow, in steps that do not grow with n."""

import numpy as np
import pytest
from rrr_traj_planner.core.errors import ConvergenceError, TimeLimitError
from rrr_traj_planner.core.path import fitting_radii
from rrr_traj_planner.core.path.arc_zone import ArcZones
from rrr_traj_planner.core.path.fitting_radii import fit_radii
from rrr_traj_planner.core.path.polynomial_zone import PolynomialZones
from rrr_traj_planner.core.path.tangent_lines import tangent_lines
from rrr_traj_planner.core.path.zone_kind import ZoneKind

ENDS = [ZoneKind(ArcZones.ends), ZoneKind(PolynomialZones.ends)]
GROWN = 1.06  # a zone that can grow by this much has not been grown far enough


def circle(n, radius=0.1):
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return radius * np.stack((np.cos(t), np.sin(t), 0.0 * t), axis=1)


def walk(n, seed):
    return np.cumsum(np.random.default_rng(seed).standard_normal((n, 3)), axis=0)


def steps_taken(monkeypatch, points, radii, ends):
    tried, count = fitting_radii._lines_for, [0]

    def counted(*arguments):
        count[0] += 1
        return tried(*arguments)

    monkeypatch.setattr(fitting_radii, '_lines_for', counted)
    fit_radii(points, radii, ends)
    monkeypatch.undo()
    return count[0]


def test_steps_do_not_grow_with_the_number_of_points(monkeypatch):
    # Summed over several walks: of one, rounding decides whether zones wait for one another.
    few, many = (sum(steps_taken(monkeypatch, walk(n, seed), np.full(n - 2, 5.0), ENDS[0])
                     for seed in (0, 5)) for n in (10, 40))
    assert many < 5 * few  # one zone at a time would take 16 times as many


def test_arcs_through_points_on_a_circle_are_nearly_all_of_it():
    # Arcs whose lines have no length left would be the circle itself.
    fitted = fit_radii(circle(40), np.full(38, 0.5), ZoneKind(ArcZones.ends))
    assert np.median(fitted.radii) == pytest.approx(0.1, rel=0.1)
    assert fitted.lines.length.sum() < 0.25 * 2.0 * np.pi * 0.1


@pytest.mark.parametrize('ends', ENDS)
@pytest.mark.parametrize('n', [5, 12])
def test_zones_do_not_overlap_and_none_can_grow_alone(ends, n):
    points, requested = walk(n, n), np.full(n - 2, 2.0)
    fitted = fit_radii(points, requested, ends)
    shortest = fitting_radii.SHORTEST_LINE * np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert (fitted.lines.length >= shortest).all()
    assert (fitted.radii <= requested).all()
    free = 0
    for j in np.flatnonzero(fitted.radii < requested):
        radii = fitted.radii.copy()
        radii[j] = min(GROWN * radii[j], requested[j])
        try:
            lines = tangent_lines(points, radii, ends, fitted.lines.direction)
            free += (lines.length >= shortest).all()
        except ConvergenceError:
            pass
    assert free == 0


def test_stopped_early_it_returns_radii_that_fit():
    points = walk(30, 1)
    fitted = fit_radii(points, np.full(28, 5.0), ZoneKind(ArcZones.ends), lambda: True)
    whole = fit_radii(points, np.full(28, 5.0), ZoneKind(ArcZones.ends))
    assert (fitted.lines.length >= 0.0).all()
    assert (fitted.radii < whole.radii).mean() > 0.9


def test_what_the_question_raises_ends_it():
    def given_up():
        raise TimeLimitError(1.0, 1.3)

    with pytest.raises(TimeLimitError, match=r'^planning_time_limit 1 s: given up after 1.30 s$'):
        fit_radii(walk(30, 1), np.full(28, 5.0), ZoneKind(ArcZones.ends), given_up)
