"""
`cycloid`: transition, cruise, transition in every segment, via velocities free, least total time.

Every transition is a full-period cycloid.
"""

from __future__ import annotations

from rrr_traj_planner.core.cycloid_transitions import CYCLOID
from rrr_traj_planner.planners.free_via_velocities import planner_with
from rrr_traj_planner.planners.registry import register

plan = register('cycloid')(planner_with(CYCLOID))
