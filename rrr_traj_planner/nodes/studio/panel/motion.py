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

"""The folder of the motion: its planner, how much of the limits it may use, and its options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.kinematics.branch_factors import has_named_postures
from rrr_traj_planner.core.kinematics.postures import ELBOWS, SHOULDERS
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.panel.controls import enable, given, Post, TYPED
from rrr_traj_planner.nodes.studio.panel.typed import Number
from rrr_traj_planner.nodes.studio.studio import Studio
from rrr_traj_planner.nodes.studio.wanted import Wanted
from rrr_traj_planner.planners.registry import planner
import viser

LEAST_SCALING = 0.05
FREE = 'free'


class MotionFolder:
    """
    Planner, scalings, posture, deviation and payload.

    Parameters
    ----------
    gui : viser.GuiApi
        Where to put it.
    planner_ids : sequence of str
        To choose from.
    wanted : Wanted
        What is chosen at the beginning.
    model : RobotModel
        The arm; only one whose postures have names can be asked for one.

    """

    def __init__(self, gui: viser.GuiApi, planner_ids: Sequence[str], wanted: Wanted,
                 model: RobotModel) -> None:
        with gui.add_folder('Motion'):
            self._planner = gui.add_dropdown(
                'planner', planner_ids, initial_value=wanted.task.planner_id)
            self._scalings = [gui.add_slider(
                f'max {name}', LEAST_SCALING, 1.0, LEAST_SCALING, 1.0,
                hint=f'fraction of the {name} limits') for name in ('velocity', 'acceleration')]
            with gui.add_folder('Options', expand_by_default=False):
                named = has_named_postures(model)
                self._posture = [gui.add_dropdown(
                    name, (FREE, *names), visible=named, hint=f'at all via points; {FREE}: '
                    'the planner chooses') for name, names in (
                        ('elbow', ELBOWS), ('shoulder', SHOULDERS))]
                self._joints = gui.add_checkbox(
                    'keep joints', False, hint='plan through the joint positions of the plan '
                    'shown, in place of positions of the tip: no other posture is chosen')
                self._deviation = Number(
                    gui, 'deviation [m]', 'at most, of the path of line_arc and line_polynomial '
                    "from straight lines; empty: the planner's parameter")
                self._mass = Number(gui, 'payload [kg]', 'at the tip, for planner and arm')
                self._known = gui.add_checkbox(
                    'payload known', False, hint="whether the arm's controller has the payload "
                    'in its model; else it is disturbed by it')

    def connect(self, studio: Studio, post: Post) -> None:
        """Have the controls do something."""
        editor, refuse = studio.editor, studio.tasks.refuse

        def scale(_: float) -> None:
            wanted, shares = editor.wanted, [float(slider.value) for slider in self._scalings]
            if shares != [wanted.velocity_scaling, wanted.acceleration_scaling]:
                editor.change(wanted.with_scalings(
                    *(min(max(value, LEAST_SCALING), 1.0) for value in shares)), 'scalings')

        def pose(_: str) -> None:
            elbow, shoulder = ('' if handle.value == FREE else handle.value
                               for handle in self._posture)
            editor.change(replace(editor.wanted, elbow=elbow, shoulder=shoulder))

        def deviate(most: float) -> None:
            editor.change(replace(editor.wanted, max_deviation=most), 'max deviation')

        def load(mass: float) -> None:
            editor.change(replace(editor.wanted, payload=Payload(
                mass, editor.wanted.payload.known_to_controller)), 'payload')

        def know(known: bool) -> None:
            editor.change(replace(editor.wanted, payload=Payload(
                editor.wanted.payload.mass, known)), 'payload')

        given(self._planner, post, lambda name: editor.change(editor.wanted.with_planner(name)))
        for slider in self._scalings:
            given(slider, post, scale, TYPED)
        for handle in self._posture:
            given(handle, post, pose)
        given(self._joints, post, studio.keep_joints)
        self._deviation.connect(post, deviate, refuse)
        self._mass.connect(post, load, refuse)
        given(self._known, post, know)

    def show_wanted(self, editor: Editor) -> None:
        """
        Show what is wanted.

        Parameters
        ----------
        editor : Editor
            Has it.

        """
        wanted = editor.wanted
        self._planner.value = wanted.task.planner_id
        for slider, value in zip(self._scalings, (
                wanted.velocity_scaling, wanted.acceleration_scaling)):
            slider.value = value
        for handle, value in zip(self._posture, (wanted.elbow, wanted.shoulder)):
            handle.value = value or FREE
            enable(handle, wanted.joints is None)
        self._joints.value = wanted.joints is not None
        self._deviation.show(
            wanted.max_deviation, planner(wanted.task.planner_id).plan_path is not None)
        self._mass.show(wanted.payload.mass)
        self._known.value = wanted.payload.known_to_controller
