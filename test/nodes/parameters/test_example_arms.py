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

"""The arms of config/arms: installed, read without a fault, and strong enough for their limits."""

from __future__ import annotations

from helpers.places import CONFIG, ROOT
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits, UNITS
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.urdf_arm import read_urdf
from rrr_traj_planner.core.dynamics.rigid_body import inverse_dynamics
from rrr_traj_planner.nodes.parameters.configuration_files import shipped_folder
from rrr_traj_planner.nodes.parameters.joint_limits_file import read_joint_limits

ARMS = sorted(path.stem for path in (CONFIG / 'arms').glob('*.urdf'))
STATES = 500


def limits_of(name):
    """Return an arm and its limits: of the URDF, and over them those of the other file."""
    arm = read_urdf(CONFIG / f'arms/{name}.urdf', 'base', 'tip')
    given = read_joint_limits(CONFIG / f'arms/{name}_limits.yaml', arm.joint_names).values
    return arm, JointLimits(**{
        kind: [given.get(f'joint_limits.{joint}.{kind}', getattr(arm, kind, [np.inf] * 3)[i])
               for i, joint in enumerate(arm.joint_names)] for kind in UNITS})


def test_all_are_installed():
    files = {path.name for path in (CONFIG / 'arms').iterdir()}
    assert files == {f'{name}{end}' for name in ARMS for end in (
        '.urdf', '.yaml', '_arm.yaml', '_limits.yaml')}
    assert files <= {path.name for path in (shipped_folder() / 'arms').iterdir()}
    assert len(ARMS) == 6


@pytest.mark.parametrize('name', ARMS)
def test_each_is_the_arm_of_the_public_description(name):
    ours, public = (read_urdf(folder / f'{name}.urdf') for folder in (
        CONFIG / 'arms', ROOT / 'test/data/arms'))
    for field in ('axis', 'point', 'tip', 'mass', 'centre', 'inertia'):
        assert getattr(ours.chain, field).tolist() == getattr(public.chain, field).tolist()


@pytest.mark.parametrize('name', ARMS)
def test_every_limit_is_there(name):
    arm, limits = limits_of(name)
    assert arm.has_masses
    assert all(np.isfinite(getattr(limits, kind)).all() for kind in UNITS)


@pytest.mark.parametrize('name', ARMS)
def test_torque_suffices_for_full_acceleration_at_full_speed_nearly_everywhere(name):
    arm, limits = limits_of(name)
    rng = np.random.default_rng(4)
    q = rng.uniform(limits.min_position, limits.max_position, (STATES, 3))
    qd, qdd = (rng.uniform(-1.0, 1.0, (STATES, 3)) * limit
               for limit in (limits.max_velocity, limits.max_acceleration))
    friction = arm.friction.viscous * qd + arm.friction.coulomb * np.sign(qd)
    still = np.zeros_like(q)
    model = RobotModel(arm.chain)
    tau, holding = inverse_dynamics(model, q, qd, qdd) + friction, inverse_dynamics(
        model, q, still, still)
    assert (np.abs(holding) <= 0.7 * limits.max_effort).all()
    assert (np.abs(tau) <= limits.max_effort).all(axis=-1).mean() > 0.9
