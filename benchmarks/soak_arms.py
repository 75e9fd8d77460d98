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

"""
Whether any planner fails or breaks a promise on any arm: public descriptions and random chains.

Torque, friction included, and the tip are judged by Pinocchio. Prints for each arm and planner how
many tasks were planned, and of how many; the others were refused for a reason.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
import os
from pathlib import Path
import sys
import time

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # before numpy; one process a core

from measuring import setting  # noqa: E402
import numpy as np  # noqa: E402
import pinocchio  # noqa: E402
from rrr_traj_planner.core.arm.chain import Chain  # noqa: E402
from rrr_traj_planner.core.arm.friction import Friction  # noqa: E402
from rrr_traj_planner.core.arm.limits import JointLimits  # noqa: E402
from rrr_traj_planner.core.arm.model import RobotModel  # noqa: E402
from rrr_traj_planner.core.arm.urdf_arm import read_urdf  # noqa: E402
from rrr_traj_planner.core.dynamics.rigid_body import gravity_torque, inertia_matrix  # noqa: E402
from rrr_traj_planner.core.errors import ConvergenceError, RrrPlannerError  # noqa: E402
from rrr_traj_planner.core.kinematics.forward import jacobian  # noqa: E402
from rrr_traj_planner.planners.planning import plan  # noqa: E402
from rrr_traj_planner.planners.registry import planner, planner_ids  # noqa: E402
from rrr_traj_planner.planners.request import PlanningRequest  # noqa: E402

DESCRIPTIONS = Path(__file__).parents[1] / 'test' / 'data' / 'arms'
RANDOM_CHAINS = 8
RANGE = 2.5              # rad to either side, where a joint has no range
SINGULAR = 0.03          # of the arm's size: least singular value at via points
HELD = 0.7               # of an effort limit, that gravity may take at via points
PATH_STEP = 0.3          # of the arm's size, between via points of a path
PER_PERIOD = 20          # checked states between two points of the answer
LIMIT_TOLERANCE = 1e-6   # relative
ANGLE_TOLERANCE = 1e-9   # rad
PLACE_TOLERANCE = 1e-8   # of the arm's size
PATHS = ('line_arc', 'line_polynomial')


class Arm:
    """An arm with limits for all that is missing, and what Pinocchio makes of it."""

    def __init__(self, name: str, model: RobotModel, limits: JointLimits) -> None:
        self.name, self.model, self.limits = name, model, limits
        self.pinocchio = _in_pinocchio(model)
        self.data = self.pinocchio.createData()

    def torque(self, q, qd, qdd) -> np.ndarray:
        """Return the motors' torque by Newton-Euler, with friction."""
        friction = self.model.friction
        rigid = np.array([pinocchio.rnea(self.pinocchio, self.data, *state)
                          for state in zip(q, qd, qdd)])
        return rigid + friction.viscous * qd + friction.coulomb * np.sign(qd)

    def tip(self, q) -> np.ndarray:
        """Return the tip's position [m]."""
        pinocchio.framesForwardKinematics(self.pinocchio, self.data, q)
        return self.data.oMf[self.pinocchio.getFrameId('tip')].translation.copy()


def _in_pinocchio(arm: RobotModel) -> pinocchio.Model:
    """Return a chain whose joint frames have the base's axes with all joints at zero."""
    chain, model, joint, at = arm.chain, pinocchio.Model(), 0, np.zeros(3)
    model.gravity.linear = arm.gravity
    for i in range(3):
        joint = model.addJoint(joint, pinocchio.JointModelRevoluteUnaligned(chain.axis[i]),
                               pinocchio.SE3(np.eye(3), chain.point[i] - at), f'joint_{i + 1}')
        at = chain.point[i]
        model.appendBodyToJoint(joint, pinocchio.Inertia(
            chain.mass[i], chain.centre[i] - at, chain.inertia[i]), pinocchio.SE3.Identity())
    model.addFrame(pinocchio.Frame('tip', joint, pinocchio.SE3(np.eye(3), chain.tip - at),
                                   pinocchio.FrameType.OP_FRAME))
    model.armature = arm.rotor_inertia
    return model


def described(path: Path) -> Arm:
    """Return the arm of a URDF, with accelerations and jerks of our own."""
    found = read_urdf(path, 'base', 'tip')
    model = RobotModel(found.chain, friction=found.friction, joint_names=found.joint_names)
    low = np.where(np.isfinite(found.min_position), found.min_position, -RANGE)
    high = np.where(np.isfinite(found.max_position), found.max_position, RANGE)
    velocity = np.where(np.isfinite(found.max_velocity), found.max_velocity, 3.0)
    return Arm(path.stem, model, JointLimits(
        low, high, velocity, 5.0 * velocity, 100.0 * velocity, found.max_effort))


def random_chain(seed: int) -> Arm:
    """Return a random chain under tilted gravity, with friction and limits that hold it."""
    rng = np.random.default_rng(seed)
    axis, mass = rng.normal(size=(3, 3)), rng.uniform(0.5, 20.0, 3)
    point = np.cumsum(rng.uniform(-0.6, 0.6, (3, 3)), axis=0)
    bodies = rng.uniform(-0.2, 0.2, (3, 3, 3))
    inertia = [m / 3.0 * sum(p @ p * np.eye(3) - np.outer(p, p) for p in body)
               for m, body in zip(mass, bodies)]
    chain = Chain(axis, point, point[2] + rng.uniform(-0.6, 0.6, 3), mass,
                  point + rng.uniform(-0.3, 0.3, (3, 3)), np.array(inertia))
    friction = Friction(rng.uniform(0.0, 3.0, 3), rng.uniform(0.0, 5.0, 3))
    model = RobotModel(chain, rng.uniform(-10.0, 10.0, 3), rng.uniform(0.0, 0.5, 3), friction)
    q = rng.uniform(-np.pi, np.pi, (500, 3))
    effort = 1.6 * (np.abs(gravity_torque(model, q)).max(axis=0) + friction.coulomb) + 2.0 * (
        np.abs(inertia_matrix(model, q)).sum(axis=2).max(axis=0))
    middle, half = rng.uniform(-1.0, 1.0, 3), rng.uniform(1.0, 3.5, 3)
    return Arm(f'chain {seed}', model, JointLimits(
        middle - half, middle + half, rng.uniform(0.5, 3.0, 3), rng.uniform(1.0, 10.0, 3),
        rng.uniform(20.0, 300.0, 3), effort))


def task(arm: Arm, planner_id: str, rng: np.random.Generator) -> PlanningRequest:
    """Return a random request: of poses that the arm can hold, away from singular ones."""
    while True:
        q = [_pose(arm, rng)]
        for _ in range(int(rng.integers(1, 6))):
            q.append(_pose(arm, rng, q[-1] if planner_id in PATHS else None))
        tips = np.array([arm.tip(x) for x in q])
        if np.linalg.norm(np.diff(tips, axis=0), axis=1).min() > 1e-3 * arm.model.chain.size:
            break
    start = q[0] if rng.random() < 0.3 else None
    return PlanningRequest(tips if start is None else tips[1:], start=start,
                           planner_id=planner_id, max_deviation=0.02 * arm.model.chain.size)


def _pose(arm: Arm, rng: np.random.Generator, near: np.ndarray | None = None) -> np.ndarray:
    """Return a random pose, not far from another one if that is given."""
    limits, size = arm.limits, arm.model.chain.size
    reach = 0.4
    for attempt in range(20_000):
        if near is None:
            q = rng.uniform(limits.min_position, limits.max_position)
        else:
            q = np.clip(near + rng.uniform(-reach, reach, 3), limits.min_position,
                        limits.max_position)
        held = arm.model.lacking_inertia or (
            np.abs(gravity_torque(arm.model, q)) + arm.model.friction.coulomb
            <= HELD * limits.max_effort).all()
        least = np.linalg.svd(jacobian(arm.model, q), compute_uv=False)[2]
        if held and least > SINGULAR * size * (0.5 if attempt > 2000 else 1.0):
            return q
    raise LookupError(f'{arm.name}: no pose')


def violations(arm: Arm, request: PlanningRequest, found) -> list[str]:
    """Return what a plan breaks, on a dense grid, by Pinocchio."""
    motion, limits = found.trajectory, arm.limits
    steps = np.arange(PER_PERIOD) / PER_PERIOD
    stamps = found.points.times
    t = (stamps[:-1, np.newaxis] + np.diff(stamps)[:, np.newaxis] * steps).ravel()
    q, qd, qdd, jerk = motion(np.append(t, motion.duration))
    broken = [f'{name} {(np.abs(x) / bound).max():.9f} of its limit' for name, x, bound in (
        ('velocity', qd, limits.max_velocity), ('acceleration', qdd, limits.max_acceleration),
        ('jerk', jerk, limits.max_jerk))
        if not (np.abs(x) <= bound * (1.0 + LIMIT_TOLERANCE)).all()]
    if not arm.model.lacking_inertia:
        share = np.abs(arm.torque(q, qd, qdd)) / limits.max_effort
        if share.max() > 1.0 + LIMIT_TOLERANCE:
            broken.append(f'torque {share.max():.9f} of its limit')
    outside = np.maximum(limits.min_position - q, q - limits.max_position).max()
    if outside > ANGLE_TOLERANCE:
        broken.append(f'{outside:.3g} rad outside a range')
    exact = slice(None) if not planner(request.planner_id).misses_via_points else [0, -1]
    if request.start is None or exact == slice(None):
        passed = np.array([arm.tip(x) for x in motion(found.via_times[exact])[0]])
        missed = np.abs(passed - request.via_points[exact]).max()
        if missed > PLACE_TOLERANCE * arm.model.chain.size:
            broken.append(f'via point missed by {missed:.3g} m')
    if request.start is not None and (found.points.positions[0] != request.start).any():
        broken.append('does not begin at the start')
    return broken


def outcome(arm: Arm, request: PlanningRequest) -> tuple[str, str]:
    """Plan a request: what came of it, in a word and in full."""
    try:
        found = plan(arm.model, arm.limits, request)
    except ConvergenceError as error:
        return 'FAULT', f'{type(error).__name__}: {error}'
    except RrrPlannerError as error:
        return type(error).__name__, str(error)
    except Exception as error:  # noqa: BLE001  whatever it is, it is counted
        return 'FAULT', f'{type(error).__name__}: {error}'
    broken = violations(arm, request, found)
    return ('VIOLATION', '; '.join(broken)) if broken else ('planned', found.note)


def arms(pattern: str) -> list[Arm]:
    """Return the public descriptions but the planar one, and random chains."""
    found = [described(p) for p in sorted(DESCRIPTIONS.glob('*.urdf')) if p.stem != 'planar_arm']
    found += [random_chain(seed) for seed in range(RANDOM_CHAINS)]
    return [arm for arm in found if pattern in arm.name]


def main() -> int:
    """Run tasks of every arm and planner in turn, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('tasks', type=int, help='how many for each arm and planner')
    parser.add_argument('seed', type=int, help='of the first; the others follow')
    parser.add_argument('--planner', choices=planner_ids(), help='one alone; else all')
    parser.add_argument('--arm', default='', help='part of the names of arms; else all')
    parser.add_argument('--refusals', action='store_true', help='print their texts')
    options = parser.parse_args()
    ids = [options.planner] if options.planner else planner_ids()
    print(setting(), flush=True)
    totals: Counter[str] = Counter()
    print(f'{"arm":18} ' + ' '.join(f'{x[-10:]:>10}' for x in ids), flush=True)
    for arm in arms(options.arm):
        planned, begin = defaultdict(int), time.perf_counter()
        for k, planner_id in enumerate(ids):
            for i in range(options.tasks):
                seed = (options.seed + i, k)
                request = task(arm, planner_id, np.random.default_rng(seed))
                word, text = outcome(arm, request)
                totals[word] += 1
                planned[planner_id] += word == 'planned'
                if word in ('FAULT', 'VIOLATION') or (options.refusals and word != 'planned'):
                    print(f'{arm.name}, {planner_id}, {seed}: {word} {text}', flush=True)
        row = ' '.join(f'{f"{planned[x]}/{options.tasks}":>10}' for x in ids)
        print(f'{arm.name:18} {row}  {time.perf_counter() - begin:.0f} s', flush=True)
    print(dict(totals))
    return int(totals['FAULT'] + totals['VIOLATION'] > 0)


if __name__ == '__main__':
    sys.exit(main())
