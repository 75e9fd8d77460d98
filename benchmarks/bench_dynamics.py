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

"""How long the arm's dynamics take, beside Pinocchio's."""

from __future__ import annotations

import argparse

from measuring import in_turns, REPETITIONS, Row, setting, table, timed
import numpy as np
import pinocchio
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.urdf import urdf
from rrr_traj_planner.core.dynamics.arm_dynamics import accelerations, ArmDynamics
from rrr_traj_planner.core.dynamics.rigid_body import forward_dynamics, inverse_dynamics
from tasks import ARM

SEED = 11
SAMPLES = 1000
CALLS = 1000        # of the dynamics of one state, in one measurement
AGREEMENT = 1e-9    # N m and rad/s^2, of values up to a thousand
INVERSE, FORWARD = 0.1, 2.0


def rows(repetitions: int = REPETITIONS) -> list[Row]:
    """Return inverse dynamics of many states and forward dynamics of one, over Pinocchio's."""
    rng = np.random.default_rng(SEED)
    q, qd, x = (rng.uniform(-scale, scale, (SAMPLES, 3)) for scale in (np.pi, 1.0, 10.0))
    return _inverse(q, qd, x, repetitions) + _forward(q[0], qd[0], 10.0 * x[0], repetitions)


def _inverse(q: np.ndarray, qd: np.ndarray, qdd: np.ndarray, repetitions: int) -> list[Row]:
    model, data = _in_pinocchio()

    def theirs() -> np.ndarray:
        out = np.empty_like(q)
        for i in range(SAMPLES):
            out[i] = pinocchio.rnea(model, data, q[i], qd[i], qdd[i])
        return out

    def ours() -> np.ndarray:
        return inverse_dynamics(ARM, q, qd, qdd)

    _agree(ours(), theirs())
    return [timed(f'inverse dynamics, {SAMPLES:,} samples / Pinocchio: rnea in a loop', INVERSE,
                  in_turns(ours, theirs, repetitions=repetitions))]


def _forward(q: np.ndarray, qd: np.ndarray, tau: np.ndarray, repetitions: int) -> list[Row]:
    """Return the function for arrays and the dynamics in floats, over `pinocchio.aba`."""
    model, data = _in_pinocchio()
    dynamics, state, torque = ArmDynamics(ARM), (*q.tolist(), *qd.tolist()), tau.tolist()

    def in_floats() -> tuple[float, float, float]:
        return accelerations(dynamics(state), *torque)

    def theirs() -> np.ndarray:
        return pinocchio.aba(model, data, q, qd, tau)

    def ours() -> np.ndarray:
        return forward_dynamics(ARM, q, qd, tau)

    _agree(in_floats(), theirs())
    _agree(ours(), theirs())
    medians = in_turns(*(_repeated(f) for f in (in_floats, theirs, ours)),
                       repetitions=repetitions)
    per_call = medians._replace(times=tuple(t / CALLS for t in medians.times))
    return [timed('forward dynamics, one state, floats (as the arm has it) / Pinocchio: aba',
                  FORWARD, per_call),
            timed('forward dynamics, one state, forward_dynamics() / Pinocchio: aba',
                  FORWARD, per_call, ours=2)]


def _repeated(function):
    def run() -> None:
        for _ in range(CALLS):
            function()

    return run


def _in_pinocchio() -> tuple[pinocchio.Model, pinocchio.Data]:
    model = pinocchio.buildModelFromXML(urdf(ARM, JointLimits()))
    model.gravity.linear = ARM.gravity
    return model, model.createData()


def _agree(ours: object, theirs: object) -> None:
    """Raise AssertionError unless both compute the same."""
    np.testing.assert_allclose(ours, theirs, rtol=AGREEMENT, atol=AGREEMENT)


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--repetitions', type=int, default=REPETITIONS)
    found = rows(parser.parse_args().repetitions)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
