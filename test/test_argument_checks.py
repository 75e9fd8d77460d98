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

"""Arguments of the library that are no such value are refused, by the argument's name."""

from dataclasses import fields
from decimal import Decimal
from fractions import Fraction
from math import inf, nan
import warnings

import numpy as np
import pytest
from rrr_traj_planner.core.arm.chain import Chain
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.lengths import ArmLengths
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload, with_payload
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.dynamics import rigid_body as dynamics
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.kinematics import forward as kinematics
from rrr_traj_planner.core.kinematics.inverse import inverse_kinematics, nearest_solution
from rrr_traj_planner.core.motion_laws.gauss import gauss
from rrr_traj_planner.core.path.design import line_arc, line_polynomial
from rrr_traj_planner.core.path.least_radius import largest_speed, least_radius
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.simulation.controlled_arm import ControlledArm
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.trajectory.quintic_spline import spline_through
from rrr_traj_planner.core.trajectory.sampling import sample
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.request import PlanningRequest

MODEL, LIMITS = RobotModel(), JointLimits()
POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)]
Q, X, Z = np.array([0.1, 1.0, 0.3]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
MOTION = plan(MODEL, LIMITS, PlanningRequest(POINTS))
ALONG = plan(MODEL, LIMITS, PlanningRequest(POINTS, planner_id='line_arc')).trajectory

# What is called, and with which sound arguments: numbers and arrays of them are varied.
CALLS = {
    'Chain': (Chain, {f.name: getattr(MODEL.chain, f.name) for f in fields(Chain)}),
    'ArmLengths': (ArmLengths, vars(ArmLengths())),
    'RobotModel': (RobotModel, {'gravity': [0.0, 0.0, -9.81], 'rotor_inertia': [0.1, 0.2, 0.3]}),
    'from_lengths': (lambda gravity: RobotModel.from_lengths(ArmLengths(), gravity),
                     {'gravity': 9.81}),
    'JointLimits': (JointLimits, {
        name: getattr(LIMITS, name) for name in (
            'min_position', 'max_position', 'max_velocity', 'max_acceleration', 'max_jerk',
            'max_effort')}),
    'scaled': (LIMITS.scaled, {'velocity': 0.5, 'acceleration': 0.5}),
    'PlanningRequest': (PlanningRequest, {
        'via_points': POINTS, 'start': Q, 'segment_durations': [3.0, 3.0, 3.0],
        'velocity_scaling': 0.5, 'acceleration_scaling': 0.5, 'sample_period': 0.01,
        'max_deviation': 0.05, 'max_tip_speed': 1.0, 'half_transition': 0.5, 'max_points': 1000,
        'start_state_tolerance': 0.01, 'dwell': [0.0, 0.0, 0.5]}),
    'PlanningRequest of joints': (PlanningRequest, {'joint_via_points': [Q, Q]}),
    'ControllerGains': (ControllerGains, {'natural_frequency': 30.0, 'damping_ratio': 1.0}),
    'EncoderSettings': (EncoderSettings, {
        'resolution': 0.1, 'noise': 0.1, 'seed': 3, 'bandwidth': 300.0}),
    'Friction': (Friction, {'viscous': [1.0, 1.0, 1.0], 'coulomb': [1.0, 1.0, 1.0]}),
    'Payload': (Payload, {'mass': 1.0}),
    'with_payload': (lambda mass: with_payload(MODEL, mass), {'mass': 1.0}),
    'SoftStops': (SoftStops, {'width': 0.1, 'stiffness': 1.0, 'damping': 0.1}),
    'Tolerances': (Tolerances, {
        'trajectory': [0.1] * 3, 'goal': [0.1] * 3, 'stopped_velocity': [0.01] * 3,
        'goal_time': 0.1, 'cmd_timeout': 0.2, 'trajectory_velocity': [0.1] * 3}),
    'ArmSettings': (lambda step: ArmSettings(MODEL, LIMITS, ControllerGains(), step),
                    {'step': 0.001}),
    'ControlledArm': (lambda q: ControlledArm(ArmSettings(MODEL, LIMITS, ControllerGains()), q),
                      {'q': Q}),
    **{function.__name__: (
        lambda function=function, **values: function(MODEL, **values),
        dict.fromkeys(names.split(), Q)) for function, names in (
            (dynamics.inertia_matrix, 'q'), (dynamics.coriolis_torque, 'q qd'),
            (dynamics.gravity_torque, 'q'), (dynamics.inverse_dynamics, 'q qd qdd'),
            (dynamics.forward_dynamics, 'q qd tau'), (dynamics.kinetic_energy, 'q qd'),
            (dynamics.potential_energy, 'q'), (kinematics.forward_kinematics, 'q'),
            (kinematics.jacobian, 'q'), (kinematics.jacobian_rate, 'q qd'))},
    'inverse_kinematics': (lambda **values: inverse_kinematics(MODEL, **values),
                           {'position': POINTS[0], 'previous': Q}),
    'nearest_solution': (lambda **values: nearest_solution(MODEL, **values),
                         {'position': POINTS[0], 'q': Q}),
    'trajectory': (MOTION.trajectory, {'t': [0.0, 1.0]}),
    'trajectory at a time': (MOTION.trajectory, {'t': 1.0}),
    'trajectory along a path': (ALONG, {'t': 1.0}),
    'stretched': (MOTION.trajectory.time_scaled, {'factor': 2.0}),
    'stretched along a path': (ALONG.time_scaled, {'factor': 2.0}),
    'path': (ALONG.arm_path.path, {'s': 0.1}),
    'sample': (lambda **values: sample(MOTION.trajectory, **values),
               {'period': 0.01, 'most_points': 1000}),
    'spline': (spline_through(MOTION.points).at, {'t': [0.0, 1.0]}),
    'TrajectoryPoints': (TrajectoryPoints, {
        'times': [0.0, 1.0], 'positions': [Q, Q], 'velocities': [Q, Q],
        'accelerations': [Q, Q]}),
    'line_arc': (line_arc, {'points': POINTS, 'radii': 0.1}),
    'line_polynomial': (line_polynomial, {'points': POINTS, 'radii': [0.1]}),
    'least_radius': (lambda **values: least_radius(MODEL, LIMITS, **values),
                     {'q': Q, 'tangent': Z, 'normal': X, 'speed': 0.1}),
    'largest_speed': (lambda **values: largest_speed(MODEL, LIMITS, **values),
                      {'q': Q, 'tangent': Z, 'normal': X, 'radius': 0.1}),
    'gauss': (gauss, {'half_width': 2.0}),
}
ARGUMENTS = [(call, name) for call, (_, values) in CALLS.items() for name in values]

# Nowhere a number, nor an array of numbers.
NEVER = ['x', '0.01', '', b'1', 1j, 0.5 + 0j, {}, {1.0}, object(), (x for x in ()), True, nan,
         np.str_('1'), np.timedelta64(1, 's'), np.datetime64('2020-01-01'), np.complex128(1.0),
         [[1.0, 2.0], [3.0]], ['1', '2', '3'], [None] * 3, [True] * 3, [1j] * 3, np.ones(7),
         np.ones((1, 1, 1, 1)), np.zeros(3, dtype=[('a', float)]), 10 ** 400, 10 ** 5000,
         np.ma.array([1.0, 2.0, 3.0], mask=[False, True, False])]
ANY_LENGTH = {'t', 's'}
ANY_SHAPE = {'spline'}  # calls
NONE_WILL_DO = {
    'start', 'segment_durations', 'dwell', 'previous', 'velocities', 'accelerations'}
INFINITE_WILL_DO = {
    't', 'max_tip_speed', 'radius', 'min_position', 'max_position', 'max_velocity',
    'max_acceleration', 'max_jerk', 'max_effort'}
ANY_INTEGER = {'seed', 'most_points', 'max_points'}


def with_one(value, part):
    """Return an array of objects, one of whose parts is another."""
    array = np.array(value, dtype=object)
    array.flat[array.size // 2] = part
    return array


def wrong_values(name, sound):
    """Return what an argument may not be: alone, or as a part of a sound one."""
    wrong = [value for value in NEVER if not (
        (name in ANY_LENGTH and isinstance(value, np.ndarray) and value.shape == (7,))
        or (name in ANY_INTEGER and type(value) is int))]
    wrong += [] if name in NONE_WILL_DO else [None]
    wrong += [] if name in INFINITE_WILL_DO else [inf, -inf]
    if np.ndim(sound):
        floats = np.array(sound, dtype=float)
        wrong += [floats + 0j, floats.astype(str),
                  np.ma.array(floats, mask=floats == floats.max())]
        wrong += [with_one(sound, part) for part in (
            '1.0', 1j, True, 10 ** 400, object(),
            *([] if name == 'segment_durations' else [nan]))]
        wrong += [with_one(sound, part).tolist() for part in ('1.0', None, True, [1.0])]
    return wrong


def called(call, **changes):
    function, values = CALLS[call]
    return function(**{**values, **changes})


@pytest.mark.parametrize(('call', 'name'), ARGUMENTS)
def test_anything_but_a_number_is_refused_by_the_argument_s_name(call, name):
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        for value in wrong_values(name, CALLS[call][1][name]):
            if call in ANY_SHAPE and isinstance(value, np.ndarray) and value.dtype == float:
                continue
            with pytest.raises(InvalidInputError, match=rf'(?s)\A[^\n]*\b{name}\b[^\n]*\Z'):
                called(call, **{name: value})


@pytest.mark.parametrize(('call', 'name'), ARGUMENTS)
def test_every_form_of_a_number_is_accepted(call, name):
    sound = CALLS[call][1][name]
    if isinstance(sound, int):
        forms = [np.int32(sound), np.uint64(sound)]
    else:
        floats = np.array(sound, dtype=float)
        forms = [floats, floats.astype(object), floats.astype(np.longdouble), np.ma.array(floats),
                 floats.tolist()]
        forms += [np.asfortranarray(floats)] if floats.ndim else [
            np.float64(sound), Fraction(sound), Decimal(sound)]
    for form in forms:
        called(call, **{name: form})


@pytest.mark.parametrize(('call', 'name', 'wrong'), [
    ('PlanningRequest', 'steady_zones', 'no'), ('PlanningRequest', 'steady_zones', 1),
    ('PlanningRequest', 'steady_zones', None), ('PlanningRequest', 'max_points', '10'),
    ('PlanningRequest', 'max_points', 10.0), ('PlanningRequest', 'planner_id', 3),
    ('PlanningRequest', 'planner_id', ['cycloid']), ('PlanningRequest', 'elbow', ''),
    ('PlanningRequest', 'elbow', ['up']), ('PlanningRequest', 'should_stop', True),
    ('PlanningRequest', 'segment_durations', [1e-12, 1.0, 1.0]),
    ('PlanningRequest', 'stop_at', [1, 0, 1]), ('PlanningRequest', 'stop_at', 'yes'),
    ('PlanningRequest', 'stop_at', True), ('PlanningRequest', 'stop_at', [[True]] * 3),
    ('PlanningRequest', 'half_transition', 1e-300), ('PlanningRequest', 'velocity_scaling', 2.0),
    ('inverse_kinematics', 'elbow', None), ('inverse_kinematics', 'shoulder', 'left'),
    ('Payload', 'known_to_controller', 1), ('EncoderSettings', 'seed', 0.5),
    ('RobotModel', 'joint_names', 'abc'), ('RobotModel', 'joint_names', [1, 2, 3]),
    ('RobotModel', 'joint_names', None), ('ArmLengths', 'l2', 1e300)])
def test_flags_choices_and_texts_are_checked_too(call, name, wrong):
    with pytest.raises(InvalidInputError, match=rf'^{name}\b'):
        called(call, **{name: wrong})


@pytest.mark.parametrize('flag', [True, np.True_])
def test_numpy_s_truth_values_are_taken(flag):
    assert called('PlanningRequest', steady_zones=flag).steady_zones is True


def test_rows_of_different_lengths_are_reported():
    with pytest.raises(InvalidInputError, match='^via_points has rows of 3, 2, 3 .*one length$'):
        called('PlanningRequest', via_points=[POINTS[0], POINTS[1][:2], POINTS[2]])


@pytest.mark.parametrize('name', ['model', 'limits', 'request'])
def test_plan_takes_values_of_its_own_classes_alone(name):
    arguments = {'model': MODEL, 'limits': LIMITS, 'request': PlanningRequest(POINTS)}
    with pytest.raises(InvalidInputError, match=rf'^{name} is .*, must be of '):
        plan(**{**arguments, name: POINTS})
