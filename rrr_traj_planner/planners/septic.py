"""
`septic`: as `cycloid`, with transitions of the seventh order (C.1-C.11).

As with the cycloid, jerk is zero where a transition begins and ends.
"""

from __future__ import annotations

from rrr_traj_planner.core.septic import SEPTIC
from rrr_traj_planner.planners.free_via_velocities import planner_with
from rrr_traj_planner.planners.registry import register

plan = register('septic')(planner_with(SEPTIC))
