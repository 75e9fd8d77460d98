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

"""The demonstration's figures and plot, for runs that are known."""

from __future__ import annotations

from dataclasses import replace

from helpers.other_arms import OTHER_ARMS
from helpers.runs import executed, stopping
from matplotlib.image import imread
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.demo.bounds import bounds_text, checked_values
from rrr_traj_planner.nodes.demo.plot import draw
from rrr_traj_planner.nodes.point_files.reading import read_task


@pytest.fixture(scope='module')
def task():
    return read_task('table_6_1.yaml')


def broken(run):
    return [value.name for value in checked_values(run) if not value.within_bound]


def test_perfect_run_is_within_every_bound(task):
    run = executed(task)
    assert broken(run) == []
    assert bounds_text(checked_values(run)) == '22 of 22 figures are inside their bounds'


def test_error_between_the_bounds_breaks_the_final_one_alone(task):
    assert broken(executed(task, off=0.002)) == [  # 1.178 m * 0.002, at rest 0.589 m * 0.002
        'via point 0: tip error', 'final error']


def test_large_error_breaks_every_bound_of_the_executed_motion(task):
    run = executed(task, off=0.005)
    assert broken(run) == [*(f'via point {i}: tip error' for i in range(3)), 'final error']
    texts = [value.text for value in checked_values(run) if not value.within_bound]
    assert texts[0] == 'via point 0: tip error is 0.00589173 m, bound 0.002 m'


def test_saturated_motor_breaks_its_bound(task):
    run = executed(task)
    torque = run.torque.copy()
    torque[100, 1] = -run.config.limits.max_effort[1]
    assert broken(replace(run, torque=torque)) == ['joint_2: executed torque']


@pytest.mark.parametrize(('planned', 'executed_torque', 'is_broken'), [
    (1.0, 1.0, False),             # planned at the limit: the controller saturates the motor
    (1.0 + 9e-7, 1.0, False),      # as far beyond it as a plan may be
    (0.995, 1.0, False),           # what is left is less than the controller adds
    (0.98, 1.0, True), (0.98, 1.0 - 1e-9, False),
    (1.0, 1.0 + 1e-5, True)])      # no motor has so much
def test_motor_may_be_saturated_where_the_plan_takes_its_torque(
        task, planned, executed_torque, is_broken):
    run = executed(task)
    run.response.peak_effort[1] = planned * run.config.limits.max_effort[1]
    torque = run.torque.copy()
    torque[100, 1] = -executed_torque * run.config.limits.max_effort[1]
    assert broken(replace(run, torque=torque)) == (
        ['joint_2: executed torque'] if is_broken else [])


def test_planned_peak_above_its_limit_breaks_its_bound(task):
    run = executed(task)
    run.response.peak_velocity[2] = 1.1
    assert broken(run) == ['joint_3: planned velocity']


def test_plan_that_misses_a_via_point_breaks_its_bound(task):
    run = executed(task)
    q = run.planned.positions.copy()
    q[-1] += (0.0, 1e-8, 0.0)
    missed = replace(run, planned=TrajectoryPoints(
        run.planned.times, q, run.planned.velocities, run.planned.accelerations))
    assert broken(missed) == ['via point 2: planned error']


def test_run_with_stops_is_within_every_bound(task):
    assert broken(executed(stopping(task))) == []


def test_arm_that_does_not_rest_breaks_the_bound_of_its_via_point(task):
    run = executed(stopping(task))
    q = run.recorded.positions.copy()
    middle = run.response.via_times[1] + 0.25
    q[np.abs(run.recorded.times - middle) < 0.05] += (0.0, 0.01, 0.0)
    moved = TrajectoryPoints(run.recorded.times, q, run.recorded.velocities)
    assert broken(replace(run, recorded=moved)) == ['via point 1: tip error']


def test_run_through_joint_positions_is_within_every_bound(task):
    taught = np.array([[0.52, 0.94, 0.25], [0.87, 1.35, -0.4], [0.7, 1.36, -0.8]])
    run = executed(stopping(task, via_points=np.zeros((0, 3)),
                            joint_positions=lambda names: taught))
    assert broken(run) == []
    assert run.tips == pytest.approx(forward_kinematics(run.config.model, taught))
    off = run.planned.positions.copy()
    off[-1] += (0.0, 1e-8, 0.0)
    missed = replace(run, planned=replace(run.planned, positions=off))
    assert broken(missed) == ['via point 2: planned error']


def test_plot_is_a_picture(task, tmp_path):
    for name in ('run.png', 'run.pdf'):
        draw(executed(task), tmp_path / name)
        assert (tmp_path / name).stat().st_size > 20_000
    assert imread(tmp_path / 'run.png').shape[:2] == (1200, 1500)


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('name', OTHER_ARMS)
def test_plot_takes_other_arms(task, tmp_path, name):
    run, model = executed(task), OTHER_ARMS[name]
    points = forward_kinematics(model, spline_through(run.planned).at(
        np.array(run.response.via_times))[0])
    draw(replace(run, task=replace(task, via_points=points),
                 config=replace(run.config, model=model)), tmp_path / 'run.png')
    assert (tmp_path / 'run.png').stat().st_size > 20_000


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('points', [
    [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (1.02, 0.59, 0.97)],   # there and back
    [(1.02, 0.59, 0.97), (1.02, 0.59, 0.97)]])                      # rest
def test_plot_takes_points_that_coincide(task, tmp_path, points):
    run = executed(replace(task, via_points=np.array(points)), **{
        f'joint_limits.{joint}.has_{kind}_limits': False
        for joint in JOINT_NAMES for kind in ('velocity', 'jerk', 'effort')})
    draw(run, tmp_path / 'run.png')
    assert (tmp_path / 'run.png').stat().st_size > 20_000


def test_file_that_cannot_be_written_is_reported(task, tmp_path, capsys):
    from rrr_traj_planner.nodes.scripts.demo import _plot
    (tmp_path / 'file').write_text('')
    for file, text in ((tmp_path / 'file' / 'run.png', 'demo: no plot: '),
                       (tmp_path / 'run.xyz', "demo: no plot: Format 'xyz' is not supported")):
        _plot(executed(task), file)
        assert text in capsys.readouterr().err
