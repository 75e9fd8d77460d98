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

"""The solutions chosen at via points, beside trial of all chains."""

from itertools import product

from helpers.random_chains import random_arm
import numpy as np
import pytest
from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.kinematics.forward import forward_kinematics
from rrr_traj_planner.core.kinematics.least_time_chain import least_time_chain
from rrr_traj_planner.core.kinematics.solutions import all_solutions
from rrr_traj_planner.core.kinematics.travel_time import THROUGH, travel_time, ViaPointBehaviour

STILL = np.zeros(3, dtype=bool)  # no joint is given up to whole turns
TIE = 1e-4  # s: what the tie-breakers of travel add
PASSINGS = [THROUGH, ViaPointBehaviour('stop', 2.0 / 3.0), ViaPointBehaviour('blend')]


def random_case(seed):
    """Return limits and the solutions at 2 to 5 points."""
    rng, arm = np.random.default_rng(seed), random_arm(seed)
    q = rng.uniform(-np.pi, np.pi, (int(rng.integers(2, 6)), 3))
    found, count = all_solutions(arm, forward_kinematics(arm, q))
    return JointLimits(max_velocity=rng.uniform(0.3, 2.0, 3),
                       max_acceleration=rng.uniform(0.3, 4.0, 3)), [
        x[:n] for x, n in zip(found, count)]


def all_times(limits, options, passing):
    """Return every chain with its time."""
    return {chain: travel_time(limits, np.array([q[k] for q, k in zip(options, chain)]), passing)
            for chain in product(*(range(len(q)) for q in options))}


@pytest.mark.parametrize('passing', PASSINGS)
def test_chain_is_that_of_least_time_of_all(passing):
    for seed in range(80):
        limits, options = random_case(seed)
        times = all_times(limits, options, passing)
        found = times[tuple(least_time_chain(limits, options, passing, STILL))]
        assert found <= min(times.values()) + TIE


def test_of_equal_options_the_first_is_chosen():
    same = [np.zeros((2, 3)), np.ones((2, 3)), np.zeros((2, 3))]
    assert least_time_chain(JointLimits(), same[:1], THROUGH, STILL) == [0]
    assert least_time_chain(JointLimits(), same, THROUGH, STILL) == [0, 0, 0]


def test_an_arbitrary_position_takes_no_time():
    limits = JointLimits(max_velocity=[1.0] * 3, max_acceleration=[1.0] * 3)
    # At the middle point joint 1 is arbitrary; joint 2 decides.
    middle = np.array([(np.nan, 2.0, 0.0), (np.nan, 0.6, 0.0)])
    options = [np.zeros((1, 3)), middle, np.array([(3.0, 1.0, 0.0)])]
    assert least_time_chain(limits, options, THROUGH, STILL) == [0, 1, 0]


def test_a_joint_given_up_to_whole_turns_takes_the_shorter_way():
    limits = JointLimits(max_velocity=[1.0] * 3, max_acceleration=[1.0] * 3)
    options = [np.array([(3.1, 0.0, 0.0)]), np.array([(2.0, 0.0, 0.0), (-3.1, 0.0, 0.0)])]
    assert least_time_chain(limits, options, THROUGH, STILL) == [0, 0]
    assert least_time_chain(limits, options, THROUGH, np.array([True, False, False])) == [0, 1]
