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

"""The page's texts and colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rrr_traj_planner.nodes.studio.figures import (
    GREY,
    legend_html,
    LIMIT_COLOURS,
    path_colours,
    plan_html,
    refusal_html,
    SPEED,
    SPEED_COLOURS,
    status_html,
    TIGHTEST,
    UNUSED,
)
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned
from rrr_traj_planner.nodes.studio.session import Refusal

NAMES = ('joint_1', 'joint_2', 'joint_3')
PLAN = Planned(
    'cycloid', 2.85, 0.012, '', np.zeros((3, 3)), np.array([0.0, 0.784]), np.arange(3.0),
    np.zeros((3, 3)), np.zeros((2, 3)),
    (('velocity [rad/s]', np.array([0.5, 0.25, 0.125]), np.array([1.0, 2.0, np.inf])),))


def test_figures_of_a_plan_stand_beside_their_limits():
    text = plan_html(PLAN, None, NAMES)
    for part in ('cycloid', '2.850 s', '0.78 m/s', '12 ms', 'velocity [rad/s]', 'joint_3',
                 '0.5 / 1<', '0.25 / 2<', '0.125 / none<'):
        assert part in text
    assert 'opacity' not in text


def test_last_plan_is_grey_after_a_refusal():
    text = plan_html(PLAN, Refusal('via point 1: out of reach', 1), NAMES)
    assert text.index('opacity') < text.index('last plan')


def test_messages_are_text_and_no_markup():
    text = refusal_html(Refusal("frame '<b>' {x} & y"))
    assert refusal_html(None) == ''
    assert '&lt;b&gt;' in text and '&amp; y' in text
    assert '&lt;i&gt;' in status_html('<i>')


def test_only_errors_are_red():
    assert 'color' not in status_html('reached')
    assert 'color' in status_html('canceled', is_error=True)


def moving(*speed, **shares):
    """Return a plan with tip speeds, or with shares of limits that joint 2 uses, over a second."""
    count = len(speed) + 1 if speed else len(next(iter(shares.values())))
    curves = {name: np.zeros((count, 3)) for name in LIMITED}
    for name, values in shares.items():
        curves[name][:, 1] = values
    return replace(
        PLAN, duration=1.0, path=np.zeros((count, 3)), times=np.linspace(0.0, 1.0, count),
        speed=np.array(speed or [0.0] * (count - 1)), curves=curves)


def test_path_has_the_first_colour_at_rest_and_the_last_at_the_highest_speed():
    colours = path_colours(moving(0.0, 0.2, 0.4), SPEED, is_current=True)
    assert colours.shape == (3, 2, 3)
    assert tuple(colours[0, 0]) == SPEED_COLOURS[0]
    assert tuple(colours[2, 1]) == SPEED_COLOURS[-1]
    assert np.array_equal(colours, path_colours(moving(0.0, 2.0, 4.0), SPEED, is_current=True))


@pytest.mark.parametrize('meaning', [SPEED, TIGHTEST])
def test_path_of_an_older_plan_is_grey(meaning):
    colours = path_colours(moving(0.1, 0.4), meaning, is_current=False)
    assert colours.shape == (2, 2, 3) and np.array_equal(np.unique(colours), [GREY[0]])


def test_path_of_an_arm_that_rests_has_a_colour():
    still = moving(0.0, 0.0)
    assert tuple(path_colours(still, SPEED, is_current=True)[0, 0]) == SPEED_COLOURS[0]
    assert tuple(path_colours(still, TIGHTEST, is_current=True)[0, 0]) == UNUSED


@pytest.mark.parametrize('name', LIMITED)
def test_path_has_the_colour_of_the_limit_that_is_reached(name):
    plan = moving(**{name: (0.0, -1.0, 1.0), 'velocity' if name == 'torque' else 'torque': (
        0.0, 0.9, -0.2)})
    colours = path_colours(plan, TIGHTEST, is_current=True)
    at_limit = LIMIT_COLOURS[LIMITED.index(name)]
    assert [tuple(end) for end in colours.reshape(-1, 3)] == [UNUSED, at_limit, at_limit, at_limit]


def test_path_is_paler_where_less_of_the_limit_is_used():
    colours = path_colours(moving(jerk=(0.5, 0.5)), TIGHTEST, is_current=True)
    np.testing.assert_allclose(
        colours[0, 0], 0.5 * (np.array(UNUSED) + LIMIT_COLOURS[2]), atol=0.51)


def test_legend_says_what_the_colours_mean():
    assert '4.00 m/s' in legend_html(moving(0.0, 2.0, 4.0), SPEED)
    text = legend_html(moving(acceleration=(1.0,) * 3 + (0.0,) * 2, torque=(0.5,) * 5), TIGHTEST)
    assert all(name in text and f'rgb{colour}' in text
               for name, colour in zip(LIMITED, LIMIT_COLOURS))
    assert '>75 %<' in text and '>25 %<' in text  # of the time
    assert legend_html(None, SPEED) == ''
