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

import numpy as np
from rrr_traj_planner.nodes.studio.figures import (
    GREY,
    plan_html,
    SPEED_COLOURS,
    speed_colours,
    status_html,
)
from rrr_traj_planner.nodes.studio.planned import Planned
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
    assert 'refused' not in text and 'opacity' not in text


def test_refusal_stands_above_the_last_plan_which_is_grey():
    text = plan_html(PLAN, Refusal('via point 1: out of reach', 1), NAMES)
    assert text.index('out of reach') < text.index('opacity') < text.index('last plan')


def test_messages_are_text_and_no_markup():
    text = plan_html(None, Refusal("frame '<b>' {x} & y"), NAMES)
    assert '&lt;b&gt;' in text and '&amp; y' in text
    assert '&lt;i&gt;' in status_html('<i>')


def test_only_errors_are_red():
    assert 'color' not in status_html('reached')
    assert 'color' in status_html('canceled', is_error=True)


def test_path_has_the_first_colour_at_rest_and_the_last_at_the_highest_speed():
    colours = speed_colours(np.array([0.0, 0.2, 0.4]), is_current=True)
    assert colours.shape == (3, 2, 3)
    assert tuple(colours[0, 0]) == SPEED_COLOURS[0]
    assert tuple(colours[2, 1]) == SPEED_COLOURS[-1]
    assert np.array_equal(colours, speed_colours(np.array([0.0, 2.0, 4.0]), is_current=True))


def test_path_of_an_older_plan_is_grey():
    assert np.array_equal(np.unique(speed_colours(np.array([0.1, 0.4]), False)), [GREY[0]])


def test_path_of_an_arm_that_rests_has_a_colour():
    assert tuple(speed_colours(np.zeros(2), is_current=True)[0, 0]) == SPEED_COLOURS[0]
