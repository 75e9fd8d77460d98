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

"""The chart in a browser: a click there, or dragging, moves the ghost."""

from __future__ import annotations

from importlib import import_module
from threading import Condition

from helpers import browser
import numpy as np
import pytest
from rrr_traj_planner.nodes.studio.planned import LIMITED, Planned

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
serving = import_module('rrr_traj_planner.nodes.studio.web.server').serving
PlanFolder = import_module('rrr_traj_planner.nodes.studio.panel.plan').PlanFolder
scripts_html = import_module('rrr_traj_planner.nodes.studio.panel.browser').scripts_html

COUNT = 50
DEADLINE = 30.0  # s
AREA = 'document.querySelector(".u-over")'
BOX = (f'(() => {{ const area = {AREA}; area.scrollIntoView({{block: "center"}}); '
       'const box = area.getBoundingClientRect(); return [box.x, box.y, box.width, box.height]; '
       '})()')

pytestmark = pytest.mark.skipif(
    browser.found() is None, reason='no Chromium or Chrome: apt install chromium, or $CHROMIUM')


class Studio:
    """Keeps what the folder asks for, to be waited for."""

    def __init__(self):
        self.moments, self.plays, self._changed = [], [], Condition()

    def go_to(self, share):
        with self._changed:
            self.moments.append(share)
            self._changed.notify_all()

    def play(self, plays):
        self.plays.append(plays)

    def wait(self, share):
        with self._changed:
            assert self._changed.wait_for(
                lambda: self.moments and self.moments[-1] == pytest.approx(share, abs=0.005),
                DEADLINE), self.moments


def plan():
    times = np.linspace(0.0, 2.0, COUNT)
    curves = {name: np.outer(np.sin(times), (0.9, -0.9, 0.1)) for name in LIMITED}
    return Planned('cycloid', 2.0, 0.0, '', np.zeros((COUNT, 3)), np.zeros(COUNT - 1), times,
                   np.zeros((COUNT, 3)), np.zeros((2, 3)), (), tuple, curves)


def test_click_and_drag_in_the_chart_move_the_ghost(tmp_path):
    studio = Studio()
    with serving('127.0.0.1', 8080) as server, browser.Browser(tmp_path) as page:
        folder = PlanFolder(server.gui, ('joint_1', 'joint_2', 'joint_3'))
        server.gui.add_html(scripts_html())
        folder.connect(studio, lambda act: act())
        folder.show(plan(), '')
        folder.show_time(None)
        page.ask('Page.navigate', url=f'http://127.0.0.1:{server.get_port()}')
        page.until(f'{AREA} !== null && {AREA}.getBoundingClientRect().width > 100.0'
                   ' && window.rrrMoment === true')
        page.until(f'Math.abs({BOX}[1] - {BOX}[1]) === 0 && document.fonts.status === "loaded"')
        x, y, width, height = page.value(BOX)

        def mouse(what, share, **more):
            page.ask('Input.dispatchMouseEvent', type=what, x=x + share * width,
                     y=y + 0.5 * height, button='left', **more)

        mouse('mousePressed', 0.25, clickCount=1)
        studio.wait(0.25)
        for share in (0.4, 0.6, 0.75):
            mouse('mouseMoved', share, buttons=1)
        studio.wait(0.75)
        mouse('mouseReleased', 0.75, clickCount=1)
        mouse('mouseMoved', 0.5)  # the button is up: no more
        mouse('mousePressed', 0.9, clickCount=1)
        mouse('mouseReleased', 0.9, clickCount=1)
        studio.wait(0.9)
        assert not any(0.45 < share < 0.55 for share in studio.moments)
        assert studio.plays == []
        # the legend has the time and the joints alone
        assert page.value('[...document.querySelectorAll(".u-series")].filter(row => '
                          'getComputedStyle(row).display !== "none").length') == 4
