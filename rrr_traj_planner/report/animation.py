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

"""An animation of one or several motions of the arm, with play, pause and a time slider."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
import json
from pathlib import Path
from typing import Any

import numpy as np
from rrr_traj_planner.report.attempts import Planned
from rrr_traj_planner.report.motion_samples import arm_points, limit_use, sampled
from rrr_traj_planner.report.page import resource

FRAME_RATE = 60.0  # Hz, of a motion at its own speed: the refresh rate of common screens
MIN_FRAMES = 30    # of one motion, for motions shorter than half a second
MAX_FRAMES = 1500  # of one motion, to bound the size of the page
DIGITS = 4         # decimals of positions in metres: 0.1 mm

CONTROLS = """<div class="controls"><button type="button" class="play">Play</button>
<input type="range" class="time" min="0" max="1000" value="0" aria-label="time">
<output>0.00 s</output>
<select class="rate" aria-label="speed"><option value="0.25">× ¼</option>
<option value="0.5">× ½</option><option value="1" selected>× 1</option></select></div>"""


@dataclass(frozen=True, eq=False)
class Animation:
    """
    An animation that shows several motions side by side, at the same instants.

    Parameters
    ----------
    name, title, caption : str
        As in `Picture`.
    plans : sequence of Planned
        The motions, all for one task.

    """

    name: str
    title: str
    caption: str
    plans: Sequence[Planned]
    files: tuple[str, ...] = ()

    def written(self, folder: Path) -> str:
        """
        Return the animation as HTML; it has no files.

        Parameters
        ----------
        folder : Path
            Not used.

        Returns
        -------
        str
            Controls, a canvas for each motion, their data and the script.

        """
        arms = ''.join(
            f'<div><h4>{escape(p.planner_id)}, {p.plan.trajectory.duration:.3f} s in all</h4>'
            f'<canvas role="img" aria-label="the arm moved by {escape(p.planner_id)}"></canvas>'
            '<p></p></div>' for p in self.plans)
        # JSON inside a script ends at the first "</"
        data = json.dumps(frames(self.plans), separators=(',', ':')).replace('<', '\\u003c')
        return (f'{CONTROLS}<div class="arms">{arms}</div>'
                f'<script type="application/json" class="frames">{data}</script>'
                f'<script>{resource("animation.js")}</script>')


def frames(plans: Sequence[Planned]) -> dict[str, Any]:
    """
    Return the data that `animation.js` draws.

    Parameters
    ----------
    plans : sequence of Planned
        The motions.

    Returns
    -------
    dict
        Via points and the resting joint's position; for each motion its duration and, at equal
        time steps, positions of the joints that move and of the tip [m], the index of the limit
        that is used most, and its use, magnitude / limit.

    """
    return {'resting': plans[0].task.model.chain.point[0].round(DIGITS).tolist(),
            'via_points': plans[0].task.via_points.tolist(),
            'motions': [_motion(p) for p in plans]}


def _motion(of: Planned) -> dict[str, Any]:
    trajectory, model = of.plan.trajectory, of.task.model
    count = int(np.clip(trajectory.duration * FRAME_RATE, MIN_FRAMES, MAX_FRAMES))
    t = np.linspace(0.0, trajectory.duration, count + 1)
    points = arm_points(model, trajectory(t)[0])
    s = sampled(model, trajectory)
    used = {kind: np.stack([np.interp(t, s.t, use[:, joint]) for joint in range(3)], axis=1)
            for kind, use in limit_use(s, of.task.limits).items()}
    names = [f"{joint}'s {kind}" for kind in used for joint in model.joint_names]
    all_used = np.concatenate(list(used.values()), axis=1)
    return {'duration': float(trajectory.duration), 'via_times': of.plan.via_times.tolist(),
            'joints': np.moveaxis(points[:, 2:-1], 1, 0).round(DIGITS).tolist(),
            'tip': points[:, -1].round(DIGITS).tolist(), 'limits': names,
            'tightest': all_used.argmax(axis=1).tolist(),
            'use': all_used.max(axis=1).round(3).tolist()}
