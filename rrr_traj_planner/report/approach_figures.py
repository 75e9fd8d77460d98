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

"""The thesis's figures of the approaches to via points: 4.3 and 4.4."""

from __future__ import annotations

from typing import Any

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.piecewise import PiecewiseTrajectory
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.function_figures import shade
from rrr_traj_planner.report.measures import via_errors, via_positions
from rrr_traj_planner.report.motion_samples import drawing_times
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.theme import JOINTS, LIGHT

JOINT = 1  # index of joint 2, which moves furthest on table 6.1


def figure_4_3(of: Planned) -> Picture:
    """
    Return the figure of approach (a).

    Parameters
    ----------
    of : Planned
        A motion by `cycloid_approach_a`.

    Returns
    -------
    Picture
        One joint's position and velocity.

    """
    return _approach(
        of, 'figure_4_3', 'Figure 4.3: path transition for approach "a"',
        'Joint 2 on the task of table 6.1: in each subtrajectory a transition, then constant '
        'velocity, through the via point; a last transition to rest.', corners=False)


def figure_4_4(of: Planned) -> Picture:
    """
    Return the figure of approach (b).

    Parameters
    ----------
    of : Planned
        A motion by `cycloid_approach_b`.

    Returns
    -------
    Picture
        One joint's position and velocity.

    """
    errors, distances = via_errors(of)
    return _approach(
        of, 'figure_4_4', 'Figure 4.4: path transition for approach "b", after Paul',
        'Joint 2 on the task of table 6.1: the via point, where the two '
        f'lines meet, is blended around. It is missed: by {errors[1]:.3f} rad, the tip by '
        f'{1e3 * distances[1]:.0f} mm.', corners=True)


def _approach(of: Planned, name: str, title: str, caption: str, corners: bool) -> Picture:
    trajectory = of.plan.trajectory
    assert isinstance(trajectory, PiecewiseTrajectory)
    t = drawing_times(trajectory)
    q, qd = (values[:, JOINT] for values in trajectory(t)[:2])
    via = _via_positions(of)[:, JOINT]
    profile: JointProfile = trajectory.profiles[JOINT]

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [drawing.POSITION, drawing.VELOCITY])
        for one, values in zip(axes, (q, qd)):
            shade(one, profile)
            one.plot(t, values, color=JOINTS[JOINT])
        if corners:
            _corner_lines(axes[0], of, profile)
        axes[0].plot(of.plan.via_times, via, 'o', color=LIGHT['via'], clip_on=False,
                     markeredgecolor=LIGHT['ink'], markersize=5)
        drawing.via_lines(axes, of.plan.via_times)
        handle = drawing.joint_handles(of.task.model.joint_names)[JOINT]
        handle.set_linestyle('-')
        drawing.legend(figure, [handle, drawing.shade_handle('transition'),
                                drawing.via_handle()])

    return Picture(name, title, caption, draw, drawing.height_of(2) + 0.6,
                   {'time [s]': t, drawing.POSITION: q, drawing.VELOCITY: qd})


def _corner_lines(axes: Any, of: Planned, profile: JointProfile) -> None:
    """Draw the straight lines between the via points, which the transitions round off."""
    first, last = np.diff(profile.knots)[[0, -1]]
    t = of.plan.via_times.copy()
    t[0] += 0.5 * first
    t[-1] -= 0.5 * last
    axes.plot(t, _via_positions(of)[:, JOINT], color=LIGHT['limit'], linestyle='--',
              linewidth=0.9)


def _via_positions(of: Planned) -> Array:
    """Return the joint positions of the via points, on the branch of a motion [rad]."""
    return via_positions(
        of.task.model, of.task.via_points, of.plan.trajectory(of.plan.via_times)[0])
