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

"""Errors of a plan and of the arm at the via points."""

from __future__ import annotations

import numpy as np
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.sampling import NANOSECOND
from rrr_traj_planner.nodes.runs.run import Run
from rrr_traj_planner.report.measures import joint_errors, tip_errors

DURING_REST = 101  # times at which the arm's error is looked at while it rests at a via point


def planned_errors(run: Run) -> list[float]:
    """
    Return the plan's joint position errors at the via points, while the arm rests there [rad].

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    list of float
        The largest of the three joints' errors for each via point.

    """
    given, errors, times = run.joint_via_points, [], run.planned.times
    for i, (begin, end) in enumerate(_while_there(run)):
        here = np.flatnonzero((times >= begin - NANOSECOND) & (times <= end + NANOSECOND))
        q = run.planned.positions[here if len(here) else [np.abs(times - begin).argmin()]]
        error = (joint_errors(run.config.model, np.tile(run.tips[i], (len(q), 1)), q)
                 if given is None else np.abs(q - given[i]))
        errors.append(float(error.max()))
    return errors


def executed_errors(run: Run) -> list[float]:
    """
    Return the distances of the arm's tip from the via points, while it is there [m].

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    list of float
        The largest distance for each via point: at its time, and while the arm rests there.

    """
    spline, errors = spline_through(run.recorded), []
    for tip, (begin, end) in zip(run.tips, _while_there(run)):
        q = spline.at(np.linspace(begin, end, DURING_REST if end > begin else 1))[0]
        errors.append(float(tip_errors(run.config.model, np.tile(tip, (len(q), 1)), q).max()))
    return errors


def final_error(run: Run) -> float:
    """
    Return the distance of the arm's final position from the last via point [m].

    Parameters
    ----------
    run : Run
        The run.

    Returns
    -------
    float
        The distance.

    """
    tip = forward_kinematics(run.config.model, run.recorded.positions[-1])
    return float(np.linalg.norm(tip - run.tips[-1]))


def _while_there(run: Run) -> list[tuple[float, float]]:
    """Return from when until when the arm is at each via point [s]."""
    return [(t, t + dwell) for t, dwell in zip(run.response.via_times, run.rests.dwell.tolist())]
