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

"""Masses and inertias of a URDF's links: without negative ones, and of composite bodies."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arm.urdf_document import Link, UrdfWarning
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.errors import quoted

# Part of the largest principal moment by which the triangle inequality may be broken, or a moment
# be negative: rounding of descriptions with two digits. Chosen.
ROUNDING = 1e-2

# Radius of gyration over the arm's size from which on an inertia is said to be impossible: that of
# a rod of the arm's whole length is 0.3. Chosen.
MAX_GYRATION = 3.0


class Body(NamedTuple):
    """A rigid body, in the base frame."""

    mass: float      # [kg]
    centre: Array    # of mass, shape (3,) [m]
    inertia: Array   # about it, shape (3, 3) [kg m^2]


def without_negative_inertia(link: Link, size: float, warnings: list[UrdfWarning]) -> Link:
    """
    Return a link without negative mass and principal moments.

    Parameters
    ----------
    link : Link
        As a URDF has it.
    size : float
        The arm's size [m], with which radii of gyration are compared.
    warnings : list of UrdfWarning
        Gets one for each value that no body has.

    Returns
    -------
    Link
        With zeros for negative values; else what was given.

    """
    if link.mass < 0.0:
        warnings.append(UrdfWarning(
            f'link {quoted(link.name)} has a mass of {link.mass:g} kg; taken for 0'))
        link = link._replace(mass=0.0)
    moments, axes = np.linalg.eigh(link.inertia)
    faults = _faults(moments, link.mass, size)
    if faults:
        done = 'used as it is' if moments[0] >= 0.0 else 'negative moments are taken for 0'
        warnings.append(UrdfWarning(f'link {quoted(link.name)} has an impossible inertia: '
                                    f'{" and ".join(faults)}; {done}'))
    if moments[0] < 0.0:
        link = link._replace(inertia=(axes * moments.clip(0.0)) @ axes.T)
    return link


def _faults(moments: Array, mass: float, size: float) -> list[str]:
    """Return what is impossible about a link's principal moments, in ascending order."""
    low, middle, high = moments.tolist()
    shown = f'principal moments {", ".join(f"{moment:.3g}" for moment in moments)} kg m^2'
    faults = []
    if low + middle < high - ROUNDING * max(high, -low):
        faults.append(f'{shown} break the triangle inequality')
    if high > 0.0 and mass == 0.0:
        faults.append(f'{shown} without mass')
    elif high > 0.0 and sqrt(high / mass) > MAX_GYRATION * size:
        faults.append(f'a radius of gyration of {sqrt(high / mass):.3g} m, in an arm of '
                      f'{size:.3g} m')
    return faults


def body_in_base(link: Link, pose: Array) -> Body:
    """
    Return a link as a body in the base frame.

    Parameters
    ----------
    link : Link
        In its own frame.
    pose : ndarray, shape (4, 4)
        Of that frame in the base frame.

    Returns
    -------
    Body
        The same link.

    """
    R = pose[:3, :3]
    return Body(link.mass, R @ link.centre + pose[:3, 3], R @ link.inertia @ R.T)


def composite_body(bodies: Sequence[Body], at: Array) -> Body:
    """
    Return the composite of bodies that are fixed to one another (parallel-axis theorem).

    Parameters
    ----------
    bodies : sequence of Body
        At least one.
    at : ndarray, shape (3,)
        Where the centre of mass is said to be if there is no mass [m].

    Returns
    -------
    Body
        Sum of masses, their common centre, sum of inertias about it.

    """
    mass = sum(body.mass for body in bodies)
    if mass == 0.0:
        return Body(0.0, at, np.sum([body.inertia for body in bodies], axis=0))
    centre = np.sum([body.mass * body.centre for body in bodies], axis=0) / mass
    inertia = np.zeros((3, 3))
    for body in bodies:
        r = body.centre - centre
        inertia += body.inertia + body.mass * (r @ r * np.eye(3) - np.outer(r, r))
    return Body(mass, centre, 0.5 * (inertia + inertia.T))
