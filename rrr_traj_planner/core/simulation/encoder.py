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

"""The joints' encoders: quantised, noisy positions, and velocities from a tracking loop."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp
from random import Random

from rrr_traj_planner.core.scalars import not_negative, positive, whole_number
from rrr_traj_planner.core.states import State

UNITS = {'resolution': 'rad', 'noise': 'rad', 'bandwidth': 'rad/s'}


@dataclass(frozen=True)
class EncoderSettings:
    """
    Encoders of all joints, ideal without resolution and noise.

    Parameters
    ----------
    resolution : float
        Quantisation step of positions [rad]; 0: none.
    noise : float
        Standard deviation of the noise added before quantisation [rad].
    seed : int
        Of the noise.
    bandwidth : float
        Of the velocity estimate [rad/s], positive.

    Raises
    ------
    InvalidInputError
        If a value is negative or not finite.

    """

    resolution: float = 0.0
    noise: float = 0.0
    seed: int = 0
    bandwidth: float = 250.0

    def __post_init__(self) -> None:
        """Check the values."""
        for name, unit in UNITS.items():
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))
        positive('bandwidth', self.bandwidth, UNITS['bandwidth'])
        object.__setattr__(self, 'seed', whole_number('seed', self.seed))

    @property
    def is_ideal(self) -> bool:
        """Whether the encoders are ideal."""
        return self.resolution == 0.0 and self.noise == 0.0


class Encoder:
    """
    Encoders read once a step.

    Velocities are estimated by a tracking loop (alpha-beta filter) over the positions read:
    critically damped, without error at constant velocity; at constant acceleration a the estimate
    lags by 2 a / bandwidth.

    Parameters
    ----------
    settings : EncoderSettings
        Resolution, noise, bandwidth.
    step : float
        Time between two readings [s].
    state : tuple of 6 floats
        Positions [rad] and velocities [rad/s] at first.

    Attributes
    ----------
    measured : tuple of 6 floats
        Positions as last measured, velocities as estimated.

    """

    def __init__(self, settings: EncoderSettings, step: float, state: State) -> None:
        self._resolution, self._noise = settings.resolution, settings.noise
        self._random = Random(settings.seed)
        self._step = step
        pole = exp(-settings.bandwidth * step)
        self._position_gain = 1.0 - pole * pole
        self._velocity_gain = (1.0 - pole) ** 2 / step
        self.restart(state)

    def restart(self, state: State) -> None:
        """
        Restart at a state.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].

        """
        q1, q2, q3 = (self._reading(q) for q in state[:3])
        self.measured: State = (q1, q2, q3, *state[3:])
        self._tracked = [q1, q2, q3]

    def read(self, state: State) -> State:
        """
        Return the reading one step later.

        Parameters
        ----------
        state : tuple of 6 floats
            Positions [rad] and velocities [rad/s].

        Returns
        -------
        tuple of 6 floats
            Positions as measured, velocities as estimated.

        """
        readings, velocities = [], list(self.measured[3:])
        for i in range(3):
            reading = self._reading(state[i])
            expected = self._tracked[i] + self._step * velocities[i]
            residual = reading - expected
            self._tracked[i] = expected + self._position_gain * residual
            velocities[i] += self._velocity_gain * residual
            readings.append(reading)
        (q1, q2, q3), (qd1, qd2, qd3) = readings, velocities
        self.measured = (q1, q2, q3, qd1, qd2, qd3)
        return self.measured

    def _reading(self, q: float) -> float:
        """Return one encoder's reading [rad]."""
        if self._noise:
            q += self._random.gauss(0.0, self._noise)
        return round(q / self._resolution) * self._resolution if self._resolution else q
