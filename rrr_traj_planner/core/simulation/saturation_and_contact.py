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

"""Record of saturated motors and of contacts with joint stops."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from rrr_traj_planner.core.arm.limits import JointLimits
from rrr_traj_planner.core.simulation.joint_stops import Contact
from rrr_traj_planner.core.states import Triple

# Commanded torque over the limit from which a motor counts as saturated. Following a motion
# planned at the limit takes up to 1.004 (measured).
SATURATED = 1.01

# Impact speed that is reported [rad/s]; fraction of the motor's torque limit (of its torque if
# unlimited) from which pressing against a stop is reported; chosen. A motion that ends at a stop
# remains below both, also with an encoder noise of 1e-5 rad.
HIT, PRESSED = 0.05, 0.05

# Least torque against a stop that is reported, for any motor [N m]; chosen.
LEAST_PRESSURE = 1e-3

NONE: Triple = (0.0, 0.0, 0.0)


STOP_TEXTS = {'hit': 'hit {} at {:.4g} rad/s', 'pressed': 'is pressed against {} with {:.4g} N m'}


class Finding(NamedTuple):
    """A message about a joint."""

    kind: str
    joint: str
    text: str


class SaturationAndContact(NamedTuple):
    """Saturation and contacts with stops during some steps, for each joint."""

    saturated: tuple[int, int, int] = (0, 0, 0)  # steps with a saturated motor
    wanted: Triple = NONE                        # largest torque commanded then [N m]
    hit: Triple = NONE      # largest speed at which a stop was hit [rad/s]; upper stops: > 0
    pressed: Triple = NONE  # largest torque against a stop [N m]; upper stops: > 0

    def joined(self, other: SaturationAndContact) -> SaturationAndContact:
        """
        Return the record over these steps and others.

        Parameters
        ----------
        other : SaturationAndContact
            Record of the others.

        Returns
        -------
        SaturationAndContact
            Steps added, the larger of each value.

        """
        a, b, c = (m + n for m, n in zip(self.saturated, other.saturated))
        return SaturationAndContact(
            (a, b, c), *(_larger(x, y) for x, y in zip(self[1:], other[1:])))

    def motors(self, joint_names: Sequence[str], limits: JointLimits) -> list[Finding]:
        """
        Return which motors were saturated.

        Parameters
        ----------
        joint_names : sequence of str
            The joints' names.
        limits : JointLimits
            The motors' limits.

        Returns
        -------
        list of Finding
            Joint, commanded torque, limit, unit.

        """
        return [Finding('saturated', name,
                        f'{name} needs {abs(wanted):.4g} N m to follow, its motor is saturated at '
                        f'{limit:.4g} N m')
                for name, wanted, limit in zip(joint_names, self.wanted, limits.max_effort)
                if wanted]

    def stops(self, joint_names: Sequence[str], limits: JointLimits) -> list[Finding]:
        """
        Return which stops were hit or pressed.

        Parameters
        ----------
        joint_names : sequence of str
            The joints' names.
        limits : JointLimits
            The ranges, at whose ends stops or bumpers begin.

        Returns
        -------
        list of Finding
            Joint, stop, speed or torque, unit.

        """
        found = []
        for name, *strains, low, high in zip(joint_names, self.hit, self.pressed,
                                             limits.min_position, limits.max_position):
            for (kind, text), x in zip(STOP_TEXTS.items(), strains):
                if x:
                    side, end = ('upper', high) if x > 0.0 else ('lower', low)
                    stop = f'its {side} stop ({end:.6g} rad)'
                    found.append(Finding(kind, name, f'{name} {text.format(stop, abs(x))}'))
        return found


NONE_RECORDED = SaturationAndContact()


class SaturationAndContactMonitor:
    """
    Accumulates saturation and contacts until they are read.

    Attributes
    ----------
    max_effort : tuple of 3 floats
        The motors' limits [N m]; may be infinite, and may be set at any time.

    """

    def __init__(self) -> None:
        self.max_effort: Triple = (inf, inf, inf)
        self._record = NONE_RECORDED

    def read_and_clear(self) -> SaturationAndContact:
        """
        Return what was recorded since the last call, and clear it.

        Returns
        -------
        SaturationAndContact
            `NONE_RECORDED` itself if nothing was recorded.

        """
        record, self._record = self._record, NONE_RECORDED
        return record

    def record_saturation(self, wanted: Triple) -> None:
        """
        Record a step in which motors saturate.

        Parameters
        ----------
        wanted : tuple of 3 floats
            Torques, at least one beyond its limit [N m].

        """
        over = [abs(x) > SATURATED * limit for x, limit in zip(wanted, self.max_effort)]
        if any(over):
            a, b, c = (int(x) for x in over)
            self._add(SaturationAndContact((a, b, c), wanted=_where(over, wanted)))

    def record_contact(self, at: Contact, before: Contact, velocity: Triple, reaction: Triple,
                       torque: Triple) -> None:
        """
        Record a step at the end of which joints are in contact with their stops.

        Parameters
        ----------
        at, before : tuple of 3 ints
            Contacts after the step and before it: 1 lower stop, -1 upper stop, 0 none.
        velocity : tuple of 3 floats
            Before the step [rad/s].
        reaction : tuple of 3 floats
            The stops' torques, mean over the step [N m].
        torque : tuple of 3 floats
            Other torques on the joints [N m].

        """
        hit = [side and not was and -side * qd > HIT
               for side, was, qd in zip(at, before, velocity)]
        least = [max(PRESSED * (limit if limit < inf else abs(x)), LEAST_PRESSURE)
                 for limit, x in zip(self.max_effort, torque)]
        pressed = [side and was and side * x > y
                   for side, was, x, y in zip(at, before, reaction, least)]
        if any(hit) or any(pressed):
            n1, n2, n3 = reaction
            self._add(SaturationAndContact(
                hit=_where(hit, velocity), pressed=_where(pressed, (-n1, -n2, -n3))))

    def _add(self, record: SaturationAndContact) -> None:
        self._record = self._record.joined(record)


def _where(chosen: Sequence[object], values: Triple) -> Triple:
    """Return the chosen values, and 0 for the others."""
    a, b, c = (x if choice else 0.0 for choice, x in zip(chosen, values))
    return a, b, c


def _larger(x: Triple, y: Triple) -> Triple:
    """Return the value of larger magnitude of each joint."""
    a, b, c = (max(pair, key=abs) for pair in zip(x, y))
    return a, b, c
