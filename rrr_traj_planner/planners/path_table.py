"""What a path asks of the joints, tabulated along it as smooth pieces with derivatives."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.dynamics import gravity_torque, inverse_dynamics
from rrr_traj_planner.core.path_trajectory import ArmPath
from scipy.interpolate import CubicSpline

INTERVALS = 48  # of each piece


class Demand(NamedTuple):
    """
    What each joint must do along the path, shape (..., 3) each.

    Velocity is dq sd; acceleration ddq sd^2 + dq sdd; jerk dddq sd^3 + 3 ddq sd sdd + dq sddd;
    torque m sdd + c sd^2 + g.
    """

    dq: Array    # [rad/m]
    ddq: Array   # [rad/m^2]
    dddq: Array  # [rad/m^3]
    m: Array     # [N m s^2/m]
    c: Array     # [N m s^2/m^2]
    g: Array     # [N m]


class PathTable:
    """
    A path in pieces, on each of which everything is smooth.

    Parameters
    ----------
    arm_path : ArmPath
        The path in joint space.

    Attributes
    ----------
    ends : ndarray, shape (N + 1,)
        Places where the pieces meet [m]: via points and joins.
    vias : ndarray of int, shape (n,)
        Which of these are the via points.
    places : ndarray, shape (N, INTERVALS + 1)
        Where the table has its values [m].
    holding : ndarray, shape (N, INTERVALS + 1, 3)
        Gravity's torques there [N m].
    steps : ndarray, shape (N, 3)
        By how much ddq steps at each piece's end.

    """

    def __init__(self, arm_path: ArmPath) -> None:
        path = arm_path.path
        self.ends = np.unique(np.concatenate((path.via_s, path.joins)))
        self.vias = np.searchsorted(self.ends, path.via_s)
        self._lengths = np.diff(self.ends)
        u = np.linspace(0.0, 1.0, INTERVALS + 1)
        self.places = self.ends[:-1, np.newaxis] + self._lengths[:, np.newaxis] * u
        self.places[:, -1] = self.ends[1:]
        values = self._demanded(arm_path)
        self.holding = values[..., 15:]
        ddq = values[..., 3:6]
        self.steps = np.concatenate((ddq[1:, 0] - ddq[:-1, -1], np.zeros((1, 3))))
        spline = CubicSpline(u, np.moveaxis(values, 1, 0))
        self._c = np.moveaxis(spline.c, 2, 0)  # (N, 4, INTERVALS, 18)

    def _demanded(self, arm_path: ArmPath) -> Array:
        """Return all columns at the table's places, one-sided at the pieces' ends, (N, u, 18)."""
        s, model = self.places.ravel(), arm_path.model
        right, left = (np.concatenate(arm_path(s, side), axis=1) for side in (False, True))
        joints = right.reshape(*self.places.shape, 12).copy()
        joints[:, -1] = left.reshape(*self.places.shape, 12)[:, -1]
        q, dq, ddq, dddq = np.split(joints, 4, axis=-1)
        g = gravity_torque(model, q)
        still = np.zeros_like(q)
        m = inverse_dynamics(model, q, still, dq) - g
        c = inverse_dynamics(model, q, dq, ddq) - g
        return np.concatenate((dq, ddq, dddq, m, c, g), axis=-1)

    def __call__(self, s: Array, order: int = 0) -> list[Demand]:
        """
        Return what is demanded, and its derivatives by arc length.

        Parameters
        ----------
        s : ndarray, shape (N, p)
            Places [m]; row k is on piece k.
        order : int
            The highest derivative, at most 2.

        Returns
        -------
        list of Demand
            Values, first derivatives, ...; of shape (N, p, 3) each.

        """
        u = (s - self.ends[:-1, np.newaxis]) / self._lengths[:, np.newaxis] * INTERVALS
        index = np.clip(u.astype(int), 0, INTERVALS - 1)
        x = ((u - index) / INTERVALS)[..., np.newaxis]
        rows = np.arange(len(s))[:, np.newaxis]
        c3, c2, c1, c0 = (self._c[rows, k, index] for k in range(4))
        L = self._lengths[:, np.newaxis, np.newaxis]
        found = [((c3 * x + c2) * x + c1) * x + c0]
        if order > 0:
            found.append(((3.0 * c3 * x + 2.0 * c2) * x + c1) / L)
        if order > 1:
            found.append((6.0 * c3 * x + 2.0 * c2) / L ** 2)
        return [Demand(*np.split(f, 6, axis=-1)) for f in found]
