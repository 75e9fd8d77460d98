"""
`gauss`: as `cycloid`, with Gauss's function for the acceleration of transitions (3.1, A.1-A.9).

Acceleration is continuous, jerk is not: it steps where a transition begins or ends.
"""

from __future__ import annotations

from rrr_traj_planner.core.gauss import GAUSS
from rrr_traj_planner.planners.free_via_velocities import planner_with
from rrr_traj_planner.planners.registry import register

plan = register('gauss')(planner_with(GAUSS))
