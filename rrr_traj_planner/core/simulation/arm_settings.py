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

"""Settings of the simulated arm and its controller."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.arm.model import RobotModel
from rrr_traj_planner.core.arm.payload import Payload, with_payload
from rrr_traj_planner.core.control.computed_torque import ControllerGains
from rrr_traj_planner.core.control.tolerances import Tolerances
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.core.nanoseconds import nanoseconds, SECOND
from rrr_traj_planner.core.scalars import kind_of, positive
from rrr_traj_planner.core.simulation.encoder import EncoderSettings
from rrr_traj_planner.core.simulation.soft_stops import SoftStops
from rrr_traj_planner.core.simulation.step_stability import check_step

LONGEST_STEP = 1.0  # s, far beyond what any controller works with

KINDS = {'model': RobotModel, 'limits': JointLimits, 'gains': ControllerGains,
         'payload': Payload, 'soft_stops': SoftStops,
         'encoder': EncoderSettings, 'tolerances': Tolerances}


@dataclass(frozen=True, eq=False)
class ArmSettings:
    """
    Settings of the arm and its controller.

    Parameters
    ----------
    model : RobotModel
        The bare arm, with the friction of its joints.
    limits : JointLimits
        Stops at the position limits, torques saturated at the effort limits; the others apply
        to motions that the arm generates itself (stopping, joining a trajectory).
    gains : ControllerGains
        Of the computed-torque law.
    step : float
        Of the physics and of the controller [s], positive; taken to the nearest nanosecond.
    payload : Payload
        At the tip.
    soft_stops : SoftStops
        Bumpers behind the position limits.
    encoder : EncoderSettings
        Sensors of the controller.
    tolerances : Tolerances
        For following a trajectory.

    Raises
    ------
    InvalidInputError
        If a value is of another class, the step is not positive, or it is too long for the
        friction or the bumpers; or if the arm lacks inertia.

    """

    model: RobotModel
    limits: JointLimits
    gains: ControllerGains
    step: float = 0.001
    payload: Payload = field(default_factory=Payload)
    soft_stops: SoftStops = field(default_factory=SoftStops)
    encoder: EncoderSettings = field(default_factory=EncoderSettings)
    tolerances: Tolerances = field(default_factory=Tolerances)

    def __post_init__(self) -> None:
        """Check the values."""
        for name, kind in KINDS.items():
            kind_of(name, getattr(self, name), kind)
        step = positive('step', self.step, 's')
        if step > LONGEST_STEP:
            raise InvalidInputError(f'step is {step} s, must be at most {LONGEST_STEP} s')
        object.__setattr__(self, 'step', step)
        object.__setattr__(self, 'step', max(self.step_ns, 1) / SECOND)
        if self.loaded_model.singular_inertia_reason:
            raise InvalidInputError(
                f'{self.loaded_model.singular_inertia_reason}: give masses or rotor_inertia')
        check_step(self.loaded_model, self.soft_stops, self.step)

    @property
    def step_ns(self) -> int:
        """Return the step in nanoseconds."""
        return nanoseconds(self.step)

    @cached_property
    def loaded_model(self) -> RobotModel:
        """Return the arm with its payload."""
        return with_payload(self.model, self.payload.mass)

    @property
    def controller_model(self) -> RobotModel:
        """Return the controller's model of the arm."""
        return self.loaded_model if self.payload.known_to_controller else self.model
