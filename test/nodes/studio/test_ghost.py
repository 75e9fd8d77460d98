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

"""The arm's ghost: it plays the plan again and again, or stands at a chosen moment."""

from __future__ import annotations

import pytest
from rrr_traj_planner.nodes.studio.ghost import Ghost, PAUSE


def test_no_ghost_at_first():
    assert Ghost().time(5.0, 2.0) is None


def test_plan_is_played_from_its_start_waits_at_its_end_and_begins_again():
    ghost = Ghost()
    ghost.play(True, 100.0)
    assert [ghost.time(100.0 + t, 2.0) for t in (0.0, 0.5, 2.0, 2.0 + 0.5 * PAUSE)] == [
        0.0, 0.5, 2.0, 2.0]
    assert ghost.time(102.0 + PAUSE + 0.25, 2.0) == pytest.approx(0.25)
    ghost.play(False, 103.0)
    assert ghost.time(103.0, 2.0) is None


def test_chosen_moment_ends_the_playing_and_follows_the_duration():
    ghost = Ghost()
    ghost.play(True, 100.0)
    ghost.go_to(0.5)
    assert (ghost.time(101.0, 2.0), ghost.time(200.0, 3.0)) == (1.0, 1.5)
