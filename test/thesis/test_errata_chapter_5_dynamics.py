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

"""Section 5.3.2 as printed and as corrected, against Pinocchio on arms of many geometries."""

from math import cos, sin
from typing import NamedTuple

from helpers.comparison import differ
from helpers.pinocchio_arm import PinocchioArm
from helpers.random_cases import ARMS, random_states
import numpy as np
import pytest
from rrr_traj_planner.core.dynamics.rigid_body import (
    coriolis_torque,
    gravity_torque,
    inertia_matrix,
    kinetic_energy,
    potential_energy,
)

# What the package promises against Pinocchio; values reach some thousand.
AGREEMENT = 1e-10

# In the thesis's arm l2 = l3 and I2y = I3y: slips that exchange these need another one.
OTHER_ARMS = ARMS[1:]


def states(seed, n=20):
    return list(zip(*random_states(np.random.default_rng(seed), n)))


class Pose(NamedTuple):
    """Sines and cosines as the thesis abbreviates them, and the distance of link 3's centre."""

    s2: float
    c2: float
    s3: float
    c3: float
    s23: float
    c23: float
    r3: float  # l3 s23 + a2 c2
    slope: float  # l3 c23 - a2 s2


def pose(arm, q):
    """Return what the equations are made of."""
    s23, c23 = sin(q[1] + q[2]), cos(q[1] + q[2])
    s2, c2 = sin(q[1]), cos(q[1])
    return Pose(s2, c2, sin(q[2]), cos(q[2]), s23, c23, arm.l3 * s23 + arm.a2 * c2,
                arm.l3 * c23 - arm.a2 * s2)


def energy(arm, q, qd, power=2, cross_length=None, inertia=None):
    """Return 5.36, corrected but for what is given otherwise."""
    p, (w1, w2, w3), (I1, I2, I3) = pose(arm, q), qd, arm.inertia
    cross_length = arm.l3 if cross_length is None else cross_length
    inertia = I3[1] if inertia is None else inertia
    upper = 0.5 * arm.mass[1] * arm.l2 ** 2 * (p.c2 ** 2 * w1 ** 2 + w2 ** 2)
    fore = 0.5 * arm.mass[2] * (
        arm.l3 ** 2 * w3 ** 2 + (arm.a2 ** 2 + arm.l3 ** 2 + 2 * arm.l3 * arm.a2 * p.s3) * w2 ** 2
        + p.r3 ** power * w1 ** 2 + 2 * (arm.l3 ** 2 + arm.a2 * cross_length * p.s3) * w2 * w3)
    turning = 0.5 * (
        (I1[1] + I2[0] * p.s2 ** 2 + I2[1] * p.c2 ** 2 + I3[0] * p.s23 ** 2
         + I3[2] * p.c23 ** 2) * w1 ** 2
        + (I2[2] + inertia) * w2 ** 2 + I3[1] * w3 ** 2 + 2 * I3[1] * w2 * w3)
    return upper + fore + turning


@pytest.mark.parametrize('arm', OTHER_ARMS)
@pytest.mark.parametrize('slip', ['power', 'cross_length', 'inertia'])
def test_5_36_has_three_slips(arm, slip):
    reference = PinocchioArm(arm)
    printed = {'power': 1, 'cross_length': arm.l2, 'inertia': arm.inertia[1, 1]}[slip]
    cases = states(301)
    true = [reference.kinetic_energy(q, qd) for q, qd, _ in cases]
    assert differ([energy(arm, q, qd, **{slip: printed}) for q, qd, _ in cases], true)
    corrected = [energy(arm, q, qd) for q, qd, _ in cases]
    assert corrected == pytest.approx(true, abs=AGREEMENT)
    ours = [kinetic_energy(arm, q, qd) for q, qd, _ in cases]
    assert ours == pytest.approx(corrected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_5_37_needs_minus_c23(arm):
    reference, cases = PinocchioArm(arm), states(302)
    shift = arm.mass.sum() * arm.g * arm.d1  # 5.37 counts from the shoulder
    true = [reference.potential_energy(q) - shift for q, _, _ in cases]
    printed, corrected = [], []
    for q, _, _ in cases:
        p = pose(arm, q)
        for values, height in ((printed, arm.l3 * p.s23), (corrected, -arm.l3 * p.c23)):
            values.append(arm.g * (arm.mass[1] * arm.l2 * p.s2
                                   + arm.mass[2] * (height + arm.a2 * p.s2)))
    assert differ(printed, true)
    assert corrected == pytest.approx(true, abs=AGREEMENT)
    ours = [potential_energy(arm, q) for q, _, _ in cases]
    assert ours == pytest.approx(corrected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_5_40_has_a_term_too_many(arm):
    reference, (I1, I2, I3) = PinocchioArm(arm), arm.inertia
    for q, _, _ in states(303):
        p, true = pose(arm, q), reference.inertia_matrix(q)[0, 0]
        corrected = (I1[1] + I2[0] * p.s2 ** 2 + I2[1] * p.c2 ** 2 + I3[0] * p.s23 ** 2
                     + I3[2] * p.c23 ** 2 + arm.mass[1] * arm.l2 ** 2 * p.c2 ** 2
                     + arm.mass[2] * p.r3 ** 2)
        assert corrected == pytest.approx(true, abs=AGREEMENT)
        assert abs(p.s23) < 0.1 or differ(corrected + I3[1] * p.s23 ** 2, true)
        assert inertia_matrix(arm, q)[0, 0] == pytest.approx(corrected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_5_44_takes_link_2_s_inertia(arm):
    reference, (_, I2, I3) = PinocchioArm(arm), arm.inertia
    for q, _, _ in states(304):
        true = reference.inertia_matrix(q)[1, 1]
        rest = I3[1] + arm.mass[1] * arm.l2 ** 2 + arm.mass[2] * (
            arm.a2 ** 2 + arm.l3 ** 2 + 2.0 * arm.l3 * arm.a2 * sin(q[2]))
        assert I2[2] + rest == pytest.approx(true, abs=AGREEMENT)
        assert arm is ARMS[0] or differ(I3[2] + rest, true)  # equal in the thesis's arm
        assert inertia_matrix(arm, q)[1, 1] == pytest.approx(I2[2] + rest, abs=AGREEMENT)


def slopes_of_h11(arm, q):
    """Return D2 and D3: the derivatives of the corrected H11 by theta_2 and theta_3."""
    p, (_, I2, I3) = pose(arm, q), arm.inertia
    own = (I3[0] - I3[2]) * p.s23 * p.c23
    upper = (I2[0] - I2[1] - arm.mass[1] * arm.l2 ** 2) * p.s2 * p.c2
    return (2.0 * (upper + own + arm.mass[2] * p.r3 * p.slope),
            2.0 * (own + arm.mass[2] * p.r3 * arm.l3 * p.c23))


def printed_bracket(arm, q, factor):
    """Return the bracket that 5.49 and 5.50 have in common, with the factor of its m3 term."""
    p, (_, I2, I3) = pose(arm, q), arm.inertia
    return (-arm.mass[1] * arm.l2 ** 2 * p.s2 * p.c2 + factor * arm.mass[2] * p.r3 * p.slope
            + (I2[0] - I2[1]) * p.s2 * p.c2 + (I3[0] + I3[1] - I3[2]) * p.s23 * p.c23)


@pytest.mark.parametrize('arm', ARMS)
def test_5_49_lacks_factors_of_2_and_has_a_term_too_many(arm):
    reference, cases = PinocchioArm(arm), states(305)
    true, printed, corrected, ours = [], [], [], []
    for q, (w1, w2, w3), _ in cases:
        p, (D2, D3), I3 = pose(arm, q), slopes_of_h11(arm, q), arm.inertia[2]
        true.append(reference.coriolis_torque(q, np.array([w1, w2, w3]))[0])
        printed.append(printed_bracket(arm, q, 2.0) * w1 * w2 + (
            2.0 * arm.mass[2] * p.r3 * arm.l3 * p.c23
            + I3[0] + I3[1] + I3[2] * p.s23 * p.c23) * w1 * w3)
        corrected.append(D2 * w1 * w2 + D3 * w1 * w3)
        ours.append(coriolis_torque(arm, q, (w1, w2, w3))[0])
    assert corrected == pytest.approx(true, abs=AGREEMENT)
    assert ours == pytest.approx(corrected, abs=AGREEMENT)
    assert differ(printed, true)


@pytest.mark.parametrize('joint', [1, 2])
def test_5_49_is_wrong_in_both_brackets(joint):
    # With one of joints 2 and 3 at rest, each bracket stands alone.
    arm = ARMS[0]
    reference = PinocchioArm(arm)
    for q, qd, _ in states(306):
        w = np.where(np.arange(3) == 3 - joint, 0.0, qd)
        p, I3 = pose(arm, q), arm.inertia[2]
        brackets = (printed_bracket(arm, q, 2.0),
                    2.0 * arm.mass[2] * p.r3 * arm.l3 * p.c23
                    + I3[0] + I3[1] + I3[2] * p.s23 * p.c23)
        true = reference.coriolis_torque(q, w)[0]
        assert slopes_of_h11(arm, q)[joint - 1] * w[0] * w[joint] == pytest.approx(
            true, abs=AGREEMENT)
        assert differ(brackets[joint - 1] * w[0] * w[joint], true)


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('moving', [(1, 0, 0), (1, 0, 1), (0, 1, 1)])
def test_5_50_has_wrong_signs_and_velocities(arm, moving):
    # Joint 1 alone shows the square's sign; joints 1 and 3, or 2 and 3, the mixed term.
    reference, cases = PinocchioArm(arm), states(307)
    true, printed, corrected, ours = [], [], [], []
    for q, qd, _ in cases:
        w = qd * moving
        b = arm.mass[2] * arm.a2 * arm.l3 * cos(q[2])
        true.append(reference.coriolis_torque(q, w)[1])
        printed.append(printed_bracket(arm, q, 1.0) * w[0] ** 2 + b * w[2] ** 2
                       + 2.0 * b * w[0] * w[2])
        corrected.append(-0.5 * slopes_of_h11(arm, q)[0] * w[0] ** 2
                         + b * (w[2] ** 2 + 2.0 * w[1] * w[2]))
        ours.append(coriolis_torque(arm, q, w)[1])
    assert differ(printed, true)
    assert corrected == pytest.approx(true, abs=AGREEMENT)
    assert ours == pytest.approx(corrected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_5_51_has_wrong_signs(arm):
    # Joint 2 alone shows the sign of the last term, which is all that can be read for certain.
    reference = PinocchioArm(arm)
    for q, qd, _ in states(308):
        b = arm.mass[2] * arm.a2 * arm.l3 * cos(q[2])
        still = qd * (0.0, 1.0, 0.0)
        true = reference.coriolis_torque(q, still)[2]
        assert -b * qd[1] ** 2 == pytest.approx(true, abs=AGREEMENT)
        assert abs(b * qd[1] ** 2) < 1e-2 or differ(b * qd[1] ** 2, true)
        corrected = -0.5 * slopes_of_h11(arm, q)[1] * qd[0] ** 2 - b * qd[1] ** 2
        assert corrected == pytest.approx(reference.coriolis_torque(q, qd)[2], abs=AGREEMENT)
        assert coriolis_torque(arm, q, qd)[2] == pytest.approx(corrected, abs=AGREEMENT)


@pytest.mark.parametrize('arm', ARMS)
def test_5_51_s_square_of_joint_1_cannot_be_as_printed(arm):
    # What can be read of its bracket begins with m3 l3 a2 c3 and has I3x - I3z without a minus.
    reference, cases = PinocchioArm(arm), states(309)
    true, readings = [], {'slope complete': [], 'slope cut': []}
    for q, qd, _ in cases:
        p, I3 = pose(arm, q), arm.inertia[2]
        true.append(reference.coriolis_torque(q, qd * (1.0, 0.0, 0.0))[2])
        for name, slope in (('slope complete', p.slope), ('slope cut', arm.l3 * p.c23)):
            readings[name].append(qd[0] ** 2 * (
                arm.mass[2] * arm.l3 * arm.a2 * p.c3 + arm.mass[2] * p.r3 * slope
                + (I3[0] - I3[2]) * p.s23 * p.c23))
    for values in readings.values():
        assert differ(values, true)


@pytest.mark.parametrize('arm', ARMS)
@pytest.mark.parametrize('joint', [1, 2])
def test_5_53_and_5_54_need_s23(arm, joint):
    reference = PinocchioArm(arm)
    for q, _, _ in states(310):
        p, (_, m2, m3) = pose(arm, q), arm.mass
        true = reference.gravity_torque(q)[joint]
        upper = 0.0 if joint == 2 else (m2 * arm.l2 + m3 * arm.a2) * arm.g * p.c2
        corrected = upper + m3 * arm.g * arm.l3 * p.s23
        assert corrected == pytest.approx(true, abs=AGREEMENT)
        assert differ(upper + m3 * arm.g * arm.l3 * p.c23, true)
        assert gravity_torque(arm, q)[joint] == pytest.approx(corrected, abs=AGREEMENT)
