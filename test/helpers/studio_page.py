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

"""A page of the studio for tests, which keeps what it is to show, and its studio."""

from __future__ import annotations

from dataclasses import replace
from threading import Condition

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.link_positions import link_positions
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import wanted_of

ARM = RobotModel()
DEADLINE = 20.0  # s


class Page:
    """Keeps what is shown, to be waited for."""

    def __init__(self):
        self.refusal, self.is_current, self.figures, self.statuses = None, False, '', []
        self.rows, self.waits_for, self.time = [], '', None
        self.ghost, self.places, self.driven, self._shown = None, (), [], Condition()

    def show_points(self, points, refusal):
        self._show(points=points, refusal=refusal)

    def show_wanted(self, editor):
        self._show(wanted=editor.wanted, chosen=editor.chosen)

    def show_plan(self, plan, is_current, text):
        self._show(plan=plan, is_current=is_current, figures=text)

    def show_arm(self, joints, driven):
        self._show(places=link_positions(ARM, joints), driven=driven)

    def show_ghost(self, joints, time):
        self._show(ghost=() if joints is None else link_positions(ARM, joints), time=time)

    def show_comparison(self, comparison):
        self._show(rows=list(comparison.rows), waits_for=comparison.waits_for)

    def show_status(self, text, share):
        self._show(statuses=[*self.statuses, (text, share)])

    def show_tracking(self, times, errors):
        self._show(times=times, errors=errors)

    def _show(self, **shown):
        with self._shown:
            vars(self).update(shown)
            self._shown.notify_all()

    def wait(self, ready):
        with self._shown:
            assert self._shown.wait_for(lambda: ready(self), DEADLINE), (
                self.figures, self.statuses[-3:])


def studio_of(ros, client, page):
    """Return the studio of a client, for table 6.1, with its first plan."""
    config = client.connect(lambda: None)
    wanted = wanted_of(read_task('table_6_1.yaml'), config.model, config.base_frame, 'cycloid')
    studio = Studio(client, config, replace(wanted, payload=client.payload), page)
    ros.run(studio.start)
    page.wait(lambda *_: studio.session.is_current)
    ros.run(lambda: client.create_timer(0.02, studio.tick))
    return studio
