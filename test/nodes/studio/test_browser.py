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
The page in a browser: a via point is dragged with the mouse, the arm is run, faults are red.

One test, since one browser and one start of all nodes are to do.
"""

from __future__ import annotations

from helpers import browser
from helpers.plan_requests import TABLE_6_1
from helpers.scripts import Script, script
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from sensor_msgs.msg import JointState

ARROW = 0.16     # m, from a via point up to a place on its arrow
DOWN = 0.15      # m, by which a via point is dragged
FAR_UP = 0.85    # m, by which it is out of reach
REACHED = 1e-3   # m
NEAR = 12        # pixels around a via point's ball
SIZES = ((1400, 850), (800, 700))  # pixels; used in the last one, which is drawn faster
RED = 'rgb(198, 40, 40)'
OUTSIDE = """[...document.querySelectorAll('button, table, canvas, input')].filter(e => {
    const r = e.getBoundingClientRect();
    return r.width > 0 && (r.left < 0 || r.right > innerWidth); }).map(e => e.outerHTML)"""


def test_page_is_used_with_the_mouse(ros, tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    pytest.importorskip('matplotlib', reason='matplotlib, which reads pictures, is missing')
    if browser.found() is None:
        pytest.skip(browser.MISSING)
    from helpers.studio_window import StudioWindow
    states = ros.listen(JointState, 'joint_states')
    with Script(script('studio'), '--port', 0, cwd=tmp_path) as studio, browser.Browser(
            tmp_path / 'profile', browser.WEBGL) as opened:
        address = studio.read_until('studio: http')[-1].split()[1]
        window = StudioWindow(opened, address)
        for dark in (True, False):
            window.load(*SIZES[0], dark)
            for size in SIZES:
                opened.resize(*size)
                window.wait_for_drawing(TABLE_6_1[1])
                window.save(tmp_path / f'{size[0]}_{"dark" if dark else "light"}.png')
                assert opened.value(OUTSIDE) == []
        lowered = check_drag(window, np.array(TABLE_6_1[1]))
        check_run(window, states)
        window.save(tmp_path / 'reached.png')
        check_refusal(window, lowered)
        window.save(tmp_path / 'refused.png')
        assert [said for said in opened.complaints() if is_fault(said)] == []


def check_drag(window, place):
    """Drag a via point down by its arrow; return where it is then."""
    before, arrow = window.duration(), place + (0.0, 0.0, ARROW)
    window.drag(arrow, arrow - (0.0, 0.0, DOWN))
    window.wait_for_another_plan(before)
    return place - (0.0, 0.0, DOWN)


def check_run(window, states):
    """Press Run, and see the arm arrive, also by what it publishes."""
    window.browser.click('Run')
    window.wait_for('tracking error')
    window.wait_for('reached the last via point')
    model = RobotModel()
    states.wait_for_next(lambda m: np.linalg.norm(
        forward_kinematics(model, np.array(m.position)) - TABLE_6_1[2]) < REACHED)


def check_refusal(window, place):
    """Drag a via point out of reach: it is red, and a red text says why."""
    assert redness(window.colours_near(place, NEAR)) < 0
    arrow = place + (0.0, 0.0, ARROW)
    window.drag(arrow, arrow + (0.0, 0.0, FAR_UP))
    window.wait_for("out of the arm's reach")
    window.browser.mouse('mouseMoved', 5, 5)  # what it is over is highlighted
    refused = '([...document.querySelectorAll("b")].find(b => b.innerText === "refused"))'
    assert window.browser.value(f'(b => getComputedStyle(b.parentElement).color){refused}') == RED
    assert window.browser.value(  # however far the panel is scrolled
        f'(b => (r => 0 < r.top && r.bottom < innerHeight)(b.getBoundingClientRect())){refused}')
    window.until(lambda: redness(window.colours_near(place + (0.0, 0.0, FAR_UP), NEAR)) > 0)


def redness(colours):
    """Return how many pixels are red more than there are orange or yellow ones."""
    r, g, b = colours.T
    return ((r > 0.4) & (b < 0.45 * r) & np.stack(((g < 0.3 * r), (g > 0.4 * r) & (
        g < 0.9 * r)))).sum(axis=1) @ (1, -1)


def is_fault(said):
    """Return whether a complaint is one: not WebGL's by software, or of a library's age."""
    entry = said.get('entry', {'level': said.get('type', 'error'), 'text': str(said)})
    return entry['level'] in ('error', 'warning') and not any(
        word in entry['text'] for word in ('deprecated', 'GPU', 'GL Driver', 'WebGL'))
