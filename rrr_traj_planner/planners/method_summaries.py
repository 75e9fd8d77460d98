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

"""What each planner does, in a line: the first of its module, which is not imported."""

from __future__ import annotations

import ast
from pathlib import Path
import re

METHODS = Path(__file__).parent / 'methods'


def method_summaries() -> dict[str, str]:
    """
    Return what each planner does.

    Returns
    -------
    dict
        A line by the planner's id, sorted; without the reference to its source.

    """
    found = {}
    for file in sorted(METHODS.glob('[!_]*.py')):
        text = ast.get_docstring(ast.parse(file.read_text(encoding='utf-8'))) or ''
        lines = [line for line in text.splitlines() if line]
        summary = lines[0].partition('`: ')[2] if lines else ''
        found[file.stem] = re.sub(r'( \([^()]*\))?\.$', '', summary)
    return found
