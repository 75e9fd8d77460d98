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

"""What the browser does for the page beside what viser has it do: scripts and styles."""

from __future__ import annotations

from html import escape
from importlib.resources import files

SCRIPTS = ('frames.js', 'head.js', 'numbers.js',
           'moment.js')  # knows the title of the chart and the label of the slider

# The chart's legend tells of the joints alone; the chart can be clicked.
STYLE = """<style>
.head { min-height: 2.5em; padding: .5em 0; }
.head p { margin: 0; }
.uplot:has(> .u-title) .u-legend .u-series:nth-child(n+5) { display: none; }
.uplot:has(> .u-title) .u-over { cursor: ew-resize; touch-action: none; }
</style>"""


def scripts_html() -> str:
    """
    Return styles and scripts.

    viser takes no script; the handler of an image that cannot be loaded is one.

    Returns
    -------
    str
        HTML of which nothing is to be seen.

    """
    codes = (files(__package__).joinpath(name).read_text(encoding='utf-8') for name in SCRIPTS)
    return STYLE + ''.join(
        f'<img hidden alt="" src="data:," onerror="{escape(code)}">' for code in codes)
