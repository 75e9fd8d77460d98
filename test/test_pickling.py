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

"""Results, settings and errors of the library come out of pickles and copies as they went in."""

from concurrent.futures import ProcessPoolExecutor
import copy
from dataclasses import fields, is_dataclass, replace
from functools import cache
from importlib import import_module
import inspect
from multiprocessing import get_context
import pickle
from pkgutil import walk_packages
from types import MethodType
from typing import get_type_hints

import numpy as np
import pytest
from rrr_traj_planner import core, planners
from rrr_traj_planner.core.arm.friction import Friction
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.takeover import Takeover
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import RrrPlannerError, UnreachableError
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.core.read_only import ReadOnlyArrays
from rrr_traj_planner.core.simulation.arm_settings import ArmSettings
from rrr_traj_planner.core.trajectory.trajectory_points import TrajectoryPoints
from rrr_traj_planner.planners.planning import plan
from rrr_traj_planner.planners.registry import planner_ids
from rrr_traj_planner.planners.request import PlanningRequest
from rrr_traj_planner.planners.tasks import CartesianTask, JointTask
from rrr_traj_planner.planners.transitions.via_problem import via_problem_of

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)
COPIES = {
    **{f'protocol {p}': lambda value, p=p: pickle.loads(pickle.dumps(value, p))
       for p in PROTOCOLS},
    'copy': copy.copy, 'deepcopy': copy.deepcopy}

# Values of error fields by their types.
SAMPLES = {str: 'joint_2', int: 3, float: 0.1 + 0.2, tuple[float, ...]: (0.1, 1.0 / 3.0),
           tuple[int, ...]: (1, 2)}

POINTS = [(1.02, 0.59, 0.97), (0.46, 0.55, 1.44), (0.45, 0.38, 1.45)]


def modules():
    """Return every module of the core and of the planners."""
    return [import_module(found.name) for package in (core, planners)
            for found in walk_packages(package.__path__, f'{package.__name__}.')]


def kinds_of(kind):
    """Return a class and all that are derived from it."""
    return [kind, *(k for sub in kind.__subclasses__() for k in kinds_of(sub))]


def error_kinds():
    modules()
    return [k for k in kinds_of(RrrPlannerError) if k.__module__.startswith(core.__name__)]


@cache
def plan_with(planner_id, **request):
    return plan(RobotModel(), JointLimits(), PlanningRequest(
        POINTS, planner_id=planner_id, **request))


@cache
def values():
    """Return one value of every kind that a caller makes, and all plans."""
    model, limits, q = RobotModel(), JointLimits(), np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    zeros, flags = np.zeros((2, 3)), [True, False]
    task = JointTask(model, limits, q, None, 0.01)
    return (
        ArmSettings(replace(model, friction=Friction(np.ones(3), np.ones(3))), limits,
                    ControllerGains(), tolerances=Tolerances(np.ones(3), np.ones(3))),
        PlanningRequest(POINTS, np.ones(3), 'septic', [1.0, np.nan, 2.0], elbow='up'),
        task, via_problem_of(task, SEPTIC),
        TrajectoryPoints([0, 1], q, zeros, zeros, flags, flags),
        CartesianTask(model, limits, q, q[0], 'up', 0.05, np.inf, False, 0.01),
        Takeover(0.5, (0.1,) * 9, limits, model),
        *(plan_with(planner_id) for planner_id in planner_ids()),
        *(plan_with(planner_id, stop_at=(True, True, True), dwell=(0.0, 0.5, 0.0))
          for planner_id in ('cycloid', 'line_arc')))


def fields_of(value):
    """Return what a value is made of; a trajectory's cache is what can be computed again."""
    return {name: field for name, field in vars(value).items() if name != '_cache'}


def differences(a, b, name='value'):
    """Return where two values differ: in type, in a bit, or by an array that can be written to."""
    if type(a) is not type(b):
        return [f'{name}: {type(a)} became {type(b)}']
    if isinstance(a, np.ndarray):
        same = a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
        return [] if same and b.flags.writeable <= a.flags.writeable else [name]
    if isinstance(a, MethodType):
        return differences((a.__func__, a.__self__), (b.__func__, b.__self__), name)
    if isinstance(a, tuple):
        return [d for i, (x, y) in enumerate(zip(a, b, strict=True))
                for d in differences(x, y, f'{name}[{i}]')]
    if type(a).__module__.startswith('rrr_traj_planner') and hasattr(a, '__dict__'):
        a, b = fields_of(a), fields_of(b)
        kept = [] if a.keys() == b.keys() else [f'{name}: {a} became {b}']
        return kept + [d for key in a.keys() & b.keys()
                       for d in differences(a[key], b[key], f'{name}.{key}')]
    return [] if a == b else [f'{name}: {a} became {b}']


@pytest.mark.parametrize('method', COPIES)
@pytest.mark.parametrize('kind', error_kinds(), ids=lambda kind: kind.__name__)
def test_errors_keep_their_kind_message_and_every_field(kind, method):
    parameters = inspect.signature(kind.__init__).parameters
    hints = get_type_hints(kind.__init__)
    fields = {name: SAMPLES[hints[name]] for name in parameters if name != 'self'}
    error = kind(**fields)
    error.further = (1, 2)
    found = COPIES[method](error)
    assert type(found) is kind
    assert str(found) == fields.pop('message', str(error)) != ''
    assert found.args == error.args
    assert vars(found) == vars(error) and vars(found).items() >= {
        **{name: fields[name] for name in fields if hasattr(error, name)},
        'further': (1, 2)}.items()


@pytest.mark.parametrize('method', COPIES)
def test_values_and_plans_keep_every_bit_and_stay_read_only(method):
    for value in values():
        assert differences(value, COPIES[method](value)) == []


@pytest.mark.parametrize('planner_id', planner_ids())
def test_trajectories_evaluate_to_the_same_bits(planner_id):
    motion = plan_with(planner_id).trajectory
    times = np.linspace(-0.1, motion.duration + 0.1, 301)
    for copied in COPIES.values():
        assert differences(copied(motion)(times), motion(times)) == []


def arrays_of(value):
    """Return all arrays that a value is made of, by name."""
    if isinstance(value, np.ndarray):
        return {'': value}
    inner = (dict(enumerate(value)) if isinstance(value, tuple) else vars(value)
             if type(value).__module__.startswith('rrr_traj_planner')
             and hasattr(value, '__dict__') else {})
    return {f'.{key}{rest}': array for key, part in inner.items()
            for rest, array in arrays_of(part).items()}


def test_nobody_can_write_to_the_arrays_of_a_plan():
    for planner_id in planner_ids():
        found = plan_with(planner_id)
        for name in ('via_times', 'effort', 'points', 'peaks'):
            arrays = arrays_of(getattr(found, name))
            assert arrays and not any(array.flags.writeable for array in arrays.values()), name
        assert not found.trajectory.via_times.flags.writeable


def test_every_dataclass_with_arrays_keeps_them_read_only():
    kinds = {kind for module in modules() for _, kind in inspect.getmembers(module, is_dataclass)
             if inspect.isclass(kind) and kind.__dataclass_params__.frozen}
    assert len(kinds) > 10
    bare = [kind.__name__ for kind in kinds if not issubclass(kind, ReadOnlyArrays)
            and any('Array' in str(field.type) for field in fields(kind))]
    assert bare == []


def test_a_pool_of_processes_returns_plans_and_the_error_of_a_point_out_of_reach():
    far = [POINTS[0], (2.0, 0.0, 0.5)]  # 2 m of 1.6 m from the shoulder
    with ProcessPoolExecutor(1, mp_context=get_context('spawn')) as pool:
        plans = [pool.submit(plan, RobotModel(), JointLimits(),
                             PlanningRequest(points, planner_id=planner_id))
                 for points, planner_id in ((POINTS, 'gauss'), (far, 'cycloid'),
                                            (POINTS, 'cycloid'))]
        with pytest.raises(UnreachableError, match='via point 1') as caught:
            plans[1].result(timeout=60.0)
        assert caught.value.via_point == 1
        assert caught.value.distance == pytest.approx(0.4)
        for future, planner_id in ((plans[0], 'gauss'), (plans[2], 'cycloid')):
            assert differences(future.result(timeout=60.0).points,
                               plan_with(planner_id).points) == []
