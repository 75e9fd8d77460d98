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

"""The demonstration's figures, table and plot, for runs that are known."""

from __future__ import annotations

from dataclasses import replace

from helpers.other_arms import OTHER_ARMS
from matplotlib.image import imread
import numpy as np
import pytest
from rrr_traj_planner.core.arm.model import JOINT_NAMES
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.nodes.demo.client import Run
from rrr_traj_planner.nodes.demo.plot import draw
from rrr_traj_planner.nodes.demo.table import checked_values, table
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.table import PLANNER, rows_of
from rrr_traj_planner.nodes.planner_node.planning_answer import success
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.nodes.point_files.task import given
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

BEFORE, AFTER, STATES = 0.5, 0.5, 800


def executed(task, off=0.0, **parameters):
    """Return a run on an arm that follows its plan but for an angle by which joint 1 is off."""
    config = PlannerConfig.from_values({
        **{name: row.default for name, row in rows_of(PLANNER, JOINT_NAMES).items()},
        **parameters})
    joints = task.joint_via_points(JOINT_NAMES)
    found = plan(config.model, config.limits, PlanningRequest(
        task.via_points if joints is None else None, joint_via_points=joints,
        stop_at=given(task.stop_at), dwell=given(task.dwell)))
    t = np.linspace(-BEFORE, found.points.duration + AFTER, STATES)
    q, qd, qdd, _ = spline_through(found.points).at(t)
    torque = inverse_dynamics(config.model, q, qd, qdd)
    q = q + (off, 0.0, 0.0)
    return Run(task, config, success(found, config), found.points,
               TrajectoryPoints(t, q, qd), torque)


@pytest.fixture(scope='module')
def task():
    return read_task('table_6_1.yaml')


def broken(run):
    return [value.name for value in checked_values(run) if not value.within_bound]


def test_perfect_run_is_within_every_bound(task):
    assert broken(executed(task)) == []


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


def test_table_shows_every_via_point_joint_and_limit(task):
    run = executed(task, **{'joint_limits.joint_1.has_jerk_limits': False})
    lines = table(run, checked_values(run)).splitlines()
    assert [line.split()[0] for line in lines if line[:1].isdigit()] == ['0', '1', '2', '22']
    jerk, = (line for line in lines if line.startswith('jerk'))
    assert ' / none' in jerk and ' / 10' in jerk
    assert max(map(len, lines)) <= 99


def test_table_shows_the_residual_vibration_of_the_planned_motion(task):
    run = executed(task)
    line, = (x for x in table(run, checked_values(run)).splitlines() if 'vibration' in x)
    label, values = line.split(' Hz: ')
    assert label == 'residual vibration [rad/s^2] at 16 / 32 / 64'
    assert [float(x) for x in values.split(' / ')] == pytest.approx(
        (0.057, 0.005, 0.002), abs=6e-4)  # the cycloid's, by a program of its own


def stopping(task, **changes):
    """Return a task with rests, of 0.5 s at the second via point."""
    return replace(task, stop_at=np.array([False, True, True]), dwell=np.array([0.1, 0.5, 0.2]),
                   **changes)


def test_run_with_stops_is_within_every_bound_and_its_table_shows_them(task):
    run = executed(stopping(task))
    assert broken(run) == []
    rows = [line.split() for line in table(run, checked_values(run)).splitlines()
            if line[:1].isdigit()]
    assert [row[-3] for row in rows[:3]] == ['0.1', '0.5', '0.2']
    assert float(rows[0][-4]) == 0.0
    plain = executed(task)  # which rests nowhere before the end
    assert [line.split()[-3] for line in table(plain, checked_values(plain)).splitlines()
            if line[:1].isdigit()][:3] == ['0', '1.680', '0']


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
    lines = table(run, checked_values(run)).splitlines()
    assert any(line.startswith('1  (0.87, 1.35, -0.4) rad ') for line in lines)
    assert max(map(len, lines)) <= 99
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
