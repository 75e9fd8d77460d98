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

"""The data behind figures, their files, and their captions."""

from __future__ import annotations

import csv
from dataclasses import replace
from hashlib import sha256
import json
from math import pi, sqrt
from xml.etree import ElementTree

from helpers.other_arms import OTHER_ARMS
from helpers.thesis_arm import ThesisArm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.nodes.parameters.planner_config import planner_config
from rrr_traj_planner.nodes.point_files.reading import read_task
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.report.animation import frames
from rrr_traj_planner.report.attempts import planned
from rrr_traj_planner.report.function_figures import (
    gauss_function,
    subtrajectory,
    transitions_compared,
)
from rrr_traj_planner.report.measures import via_positions
from rrr_traj_planner.report.motion_samples import (
    arm_points,
    limit_use,
    path_lengths,
    sampled,
    tightest,
)
from rrr_traj_planner.report.page import paragraphs, Section, write_page
from rrr_traj_planner.report.path_figures import label_directions, legible, path_in_space
from rrr_traj_planner.report.picture import embedded, Picture
from rrr_traj_planner.report.plan_report import unique_names
from rrr_traj_planner.report.tables import Table
from rrr_traj_planner.report.theme import DARK, LIGHT, themed
from rrr_traj_planner.report.thesis_tasks import table_6_1, table_6_3

PNG = b'\x89PNG\r\n\x1a\n'

# Joint angles at the via points, elbow up [deg], calculated by hand.
ANGLES_6_1 = ((30.0464, 54.0815, 14.2147), (50.0921, 88.8437, 4.4472),
              (40.1792, 96.9387, -2.3015))


def a_picture(name='some', data=None):
    def draw(figure):
        axes = figure.subplots()
        axes.plot([0.0, 1.0], [0.0, 1.0], color=LIGHT['joint-1'])
        axes.set(xlabel='time [s]', ylabel='a & b')

    return Picture(name, 'a "title" & more', 'a caption', draw, data=data or {})


def moved_by(of, model):
    """Return the same motion of the joints, of another arm."""
    points = forward_kinematics(model, of.plan.trajectory(of.plan.via_times)[0])
    task = replace(of.task, model=model, request=PlanningRequest(points))
    return replace(of, task=task, plan=replace(of.plan, model=model))


def test_gauss_function_is_the_thesis_s():
    t = np.linspace(-5.0, 6.0, 20001)
    value, slope = gauss_function(t, 0.5, 0.2)
    assert value.sum() * (t[1] - t[0]) == pytest.approx(1.0, abs=1e-9)  # (3.1) has unit area
    assert value.max() == pytest.approx(1.0 / (sqrt(2.0 * pi) * 0.2))
    assert np.gradient(value, t) == pytest.approx(slope, abs=1e-3)


def test_transitions_last_what_the_thesis_says():
    times = {c.name: c.t[-1] for c in transitions_compared()}
    # 2 |change| / acceleration (4.10), 1.875 (C.11), 1.5 for h (1 - h)
    assert times['cycloid'] == pytest.approx(2.0)
    assert times['septic'] == pytest.approx(1.875)
    assert times['quartic'] == pytest.approx(1.5)
    for curve in transitions_compared():
        assert np.abs(curve.qdd).max() == pytest.approx(1.0, abs=1e-4), curve.name
        assert curve.qd[[0, -1]] == pytest.approx([0.0, 1.0]), curve.name


@pytest.mark.parametrize(('displacement', 'velocity', 'pieces'), [(1.8, 0.6, 3), (2.0, 1.0, 2)])
def test_subtrajectory_covers_its_displacement_from_rest_to_rest(displacement, velocity, pieces):
    profile = subtrajectory(displacement, velocity)
    q, qd, qdd, _ = profile(np.array([0.0, profile.duration]))
    assert (q[1], *qd, *qdd) == pytest.approx((displacement, 0.0, 0.0, 0.0, 0.0), abs=1e-12)
    assert profile.duration == pytest.approx(displacement / velocity + 2.0 * velocity)
    assert len(profile.knots) == pieces + 1


def test_via_positions_are_those_calculated_by_hand(plans):
    for planner_id in ('cycloid_approach_a', 'cycloid_approach_b'):
        of = plans.on_table_6_1(planner_id)
        passed = of.plan.trajectory(of.plan.via_times)[0]
        q = via_positions(of.task.model, of.task.via_points, passed)
        assert np.degrees(q) == pytest.approx(np.array(ANGLES_6_1), abs=1e-3)


@pytest.mark.parametrize(('file', 'task'), [
    ('table_6_1.yaml', table_6_1()), ('table_6_3.yaml', table_6_3())])
def test_tasks_are_those_of_the_shipped_files(file, task):
    given = read_task(file)
    config = planner_config(given.arm)
    assert given.via_points.tolist() == task.via_points.tolist()
    for name in ('min_position', 'max_position', 'max_velocity', 'max_acceleration', 'max_jerk',
                 'max_effort'):
        assert getattr(config.limits, name).tolist() == getattr(task.limits, name).tolist(), name
    for name in ('point', 'tip', 'mass', 'centre', 'inertia'):
        assert getattr(config.model.chain, name).tolist() == getattr(
            task.model.chain, name).tolist(), name


def test_samples_show_both_sides_of_a_step(plans):
    of = plans.on_table_6_1('poly_414')
    s = sampled(of.task.model, of.plan.trajectory)
    jump = np.abs(np.diff(s.qddd, axis=0)).max(axis=1)
    assert (jump > 1.0).sum() == 2  # where the middle quartic begins and ends
    assert np.diff(s.t)[jump > 1.0].max() < 1e-4
    assert (np.diff(s.t) > 0.0).all()


def test_shares_reach_one_where_limits_are_used_to_the_full(plans):
    for of in planned(plans.table_6_1):
        s = sampled(of.task.model, of.plan.trajectory)
        shares = limit_use(s, of.task.limits)
        most = tightest(shares)
        assert 0.9 < most.max() <= 1.0 + 1e-6, of.planner_id
        assert most.max() == max(x.max() for x in shares.values())


def test_a_limit_that_is_none_is_not_used():
    limits = JointLimits(max_jerk=np.full(3, np.inf))
    found = plan(RobotModel(), limits, PlanningRequest(table_6_1().via_points))
    assert limit_use(sampled(RobotModel(), found.trajectory), limits)['jerk'].max() == 0.0


def test_path_lengths_rise_to_the_whole_path(plans):
    trajectory = plans.on_table_6_3('line_arc').plan.trajectory
    t = np.linspace(0.0, trajectory.duration, 200)
    s = path_lengths(trajectory, t)
    assert (np.diff(s) >= 0.0).all()
    assert s[[0, -1]] == pytest.approx([0.0, trajectory.arm_path.path.length], abs=1e-9)


def test_arm_points_are_the_links_lengths_apart():
    model, q = ThesisArm(), np.random.default_rng(3).uniform(-3.0, 3.0, (50, 3))
    base, shoulder, elbow, tip = np.moveaxis(arm_points(model, q), 1, 0)
    for one, other, length in ((base, shoulder, model.d1), (shoulder, elbow, model.a2),
                               (elbow, tip, model.d4)):
        assert np.linalg.norm(other - one, axis=1) == pytest.approx(length)
    assert tip == pytest.approx(forward_kinematics(model, q))


def test_frames_go_from_the_first_via_point_to_the_last(plans):
    found = frames([plans.on_table_6_1('cycloid'), plans.on_table_6_1('time_optimal')])
    assert len(found['motions']) == 2
    for motion in found['motions']:
        assert motion['tip'][0] == pytest.approx(found['via_points'][0], abs=1e-4)
        assert motion['tip'][-1] == pytest.approx(found['via_points'][-1], abs=1e-4)
        assert len(motion['tip']) == len(motion['joints'][0]) == len(motion['use'])
        assert max(motion['use']) <= 1.001


@pytest.mark.parametrize(('name', 'moving'), [('kr16', 2), ('leg', 2), ('finger', 1)])
def test_frames_of_other_arms_are_their_joints(plans, name, moving):
    of = moved_by(plans.on_table_6_1('cycloid'), OTHER_ARMS[name])
    found, chain = frames([of]), of.task.model.chain
    motion, = found['motions']
    assert found['resting'] == chain.point[0].tolist()
    assert len(motion['joints']) == moving
    t = np.linspace(0.0, of.plan.trajectory.duration, len(motion['tip']))
    points = arm_points(of.task.model, of.plan.trajectory(t)[0])
    assert points[:, 1] == pytest.approx(np.tile(chain.point[0], (len(t), 1)))
    for i, joint in enumerate([*motion['joints'], motion['tip']]):
        assert np.array(joint) == pytest.approx(points[:, 2 + i], abs=1e-4)
    assert points[:, -1] == pytest.approx(
        forward_kinematics(of.task.model, of.plan.trajectory(t)[0]), abs=1e-12)


@pytest.mark.parametrize('name', OTHER_ARMS)
def test_path_of_other_arms_is_drawn(plans, tmp_path, name):
    of = moved_by(plans.on_table_6_1('cycloid'), OTHER_ARMS[name])
    path_in_space(of, 'path', 'Path', '').written(tmp_path)
    assert (tmp_path / 'path.png').read_bytes().startswith(PNG)


def test_picture_writes_png_and_csv_and_an_svg_without_fixed_colours(tmp_path):
    svg = a_picture(data={'time [s]': np.arange(3.0), 'x': np.ones(3)}).written(tmp_path)
    assert (tmp_path / 'some.png').read_bytes().startswith(PNG)
    rows = list(csv.reader((tmp_path / 'some.csv').open()))
    assert rows == [['time [s]', 'x'], ['0', '1'], ['1', '1'], ['2', '1']]
    assert ElementTree.fromstring(svg).tag.endswith('svg')
    assert 'aria-label="a &quot;title&quot; &amp; more"' in svg
    assert 'var(--joint-1)' in svg and 'var(--ink)' in svg
    assert not [c for c in LIGHT.values() if f': {c}' in svg]
    assert sorted(f.name for f in tmp_path.iterdir()) == ['some.csv', 'some.png']


def test_pictures_of_one_page_share_no_id(tmp_path):
    ids = [{e.get('id') for e in ElementTree.fromstring(a_picture(n).written(tmp_path)).iter()}
           - {None} for n in ('one', 'other')]
    assert ids[0] and not ids[0] & ids[1]


def test_embedded_references_are_unchanged():
    svg = embedded('<?xml?>\n<svg width="1pt" height="2pt" viewBox="0 0 1 2"><g id="a"/>'
                   '<use xlink:href="#a" clip-path="url(#a)"/></svg>', 'n', 't')
    assert svg.startswith('<svg role="img" aria-label="t"')
    assert 'width="1pt"' not in svg and 'height="2pt"' not in svg and 'viewBox="0 0 1 2"' in svg
    assert svg.count('n-a') == 3


def test_colours_have_one_role_each_and_a_dark_counterpart():
    assert len(set(LIGHT.values())) == len(LIGHT)
    assert LIGHT.keys() == DARK.keys()
    assert themed(f'stroke: {LIGHT["tip"]}; fill: #123456') == 'stroke: var(--tip); fill: #123456'


def test_page_is_self_contained_and_escapes_text(tmp_path):
    table = Table('t', 'Peaks <b>', 'c & d', ('a', 'b', 'c'), [['<i>', '1', '2 %']])
    page = write_page(tmp_path / 'new', 'A <title>', 'One.\n\nTwo & three.',
                      [Section('Some', '', [table, a_picture()])])
    text = page.read_text()
    for piece in ('A &lt;title&gt;', '<p>Two &amp; three.</p>', '&lt;i&gt;', '2&nbsp;%',
                  'prefers-color-scheme: dark', 'name="viewport"'):
        assert piece in text
    assert 'http://' not in text.replace('http://www.w3.org', '')
    assert 'https://' not in text
    assert (tmp_path / 'new' / 't.csv').read_text() == 'a,b,c\n<i>,1,2 %\n'
    assert paragraphs('  ') == ''


def test_page_replaces_an_earlier_one_and_touches_nothing_else(tmp_path):
    def written(*names):
        write_page(tmp_path, 'Title', '', [Section('Some', '', [
            Table(name, name, '', ('a',), [[name]]) for name in names])])
        return {f.name for f in tmp_path.iterdir()} - {'index.html'}

    mine = tmp_path / 'mine.csv'
    mine.write_text('of my own')
    assert written('one', 'two', 'three') == {'mine.csv', 'one.csv', 'two.csv', 'three.csv'}
    (tmp_path / 'two.csv').write_text('changed by hand')
    assert written('three', 'four') == {'mine.csv', 'two.csv', 'three.csv', 'four.csv'}
    assert (tmp_path / 'two.csv').read_text() == 'changed by hand'
    assert mine.read_text() == 'of my own'
    assert written('four') == {'mine.csv', 'two.csv', 'four.csv'}


def test_page_that_is_no_report_is_not_overwritten(tmp_path):
    page = tmp_path / 'index.html'
    page.write_text('<h1>My own</h1>')
    with pytest.raises(FileExistsError, match='index.html is not a report of this program'):
        write_page(tmp_path, 'Title', '', [])
    assert page.read_text() == '<h1>My own</h1>'


def test_list_of_files_outside_the_folder_removes_nothing(tmp_path):
    outside = tmp_path / 'outside.csv'
    outside.write_text('x')
    folder = tmp_path / 'report'
    page = write_page(folder, 'Title', '', [])
    digest = sha256(b'x').hexdigest()
    page.write_text(page.read_text().replace('{}', json.dumps({
        '../outside.csv': digest, str(outside): digest, '.': digest, '..': digest})))
    write_page(folder, 'Title', '', [])
    assert outside.read_text() == 'x'


@pytest.mark.parametrize('count', [1, 2, 3, 12, 60, 200, 1000])
def test_labels_of_points_do_not_lie_on_each_other(count):
    angle = 0.3 + np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    places = 40.0 * np.column_stack((np.sin(angle), np.sin(2.0 * angle)))
    shown = legible(places)
    assert {0} <= set(shown) <= set(range(count))
    apart = np.abs(places[shown, np.newaxis] - places[shown])  # points; a number is 14 by 9
    assert ((apart[..., 0] > 14.0) | (apart[..., 1] > 9.0) | np.eye(len(shown), dtype=bool)).all()
    assert len(shown) >= min(count, 2) and len(shown) <= 26


def test_names_of_files_do_not_repeat():
    assert unique_names(['a', 'b', 'a', 'a']) == ['a', 'b', 'a_2', 'a_3']


def test_labels_go_away_from_their_neighbours():
    found = label_directions(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]))
    assert found[0] == pytest.approx([-1.0, 0.0])
    assert found[1:] == pytest.approx(np.full((2, 2), sqrt(0.5)))
