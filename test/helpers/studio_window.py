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

"""The studio's page in a browser, seen by a known camera."""

from __future__ import annotations

from io import BytesIO
import json
from pathlib import Path
import re
from time import monotonic

from helpers.browser import DEADLINE
from matplotlib.image import imread
import numpy as np

# Where the page is looked at from [m], and where to; its field of view, from top to bottom [rad].
EYE, CENTRE, VIEW_ANGLE = np.array([2.6, -1.5, 1.9]), np.array([0.9, 0.4, 1.1]), 1.2
UP = np.array([0.0, 0.0, 1.0])

CAMERA = '&'.join(f'initialCamera{name}={",".join(map(str, np.ravel(value).tolist()))}'
                  for name, value in (('Position', EYE), ('LookAt', CENTRE), ('Up', UP),
                                      ('Fov', VIEW_ANGLE)))
PICTURE = 'document.querySelector("canvas").getBoundingClientRect()'
NOTE = '.mantine-Notification-closeButton'  # closes a notification
DURATION = re.compile(r': ([0-9.]+) s, tip')


class StudioWindow:
    """The page in a window of a size."""

    def __init__(self, browser, address):
        self.browser, self._address = browser, address

    def load(self, width, height, dark=False):
        """Load the page, and wait for a plan."""
        self.browser.load(f'{self._address}/?{CAMERA}{"&darkMode" * dark}', width, height, dark)
        self.wait_for('planned in')
        self.wait_for('Software WebGL')
        self.browser.value(f'[...document.querySelectorAll("{NOTE}")].forEach(b => b.click())')

    def text(self):
        """Return all that can be read beside the scene."""
        return self.browser.value('document.body.innerText')

    def wait_for(self, text):
        """Wait until a text is to be read."""
        self.browser.until(f'document.body.innerText.includes({json.dumps(text)})')

    def duration(self):
        """Return the plan's duration that is shown [s]."""
        return float(DURATION.search(self.text())[1])

    def wait_for_drawing(self, place):
        """Wait until the scene is drawn at a place: until there are several colours."""
        self.until(lambda: np.ptp(self.colours_near(place, 10)) > 0.5)

    def until(self, ready):
        """Wait until something holds."""
        deadline = monotonic() + DEADLINE
        while not ready():
            assert monotonic() < deadline, 'never true'

    def save(self, file):
        """Save a picture."""
        Path(file).write_bytes(self.browser.picture())

    def wait_for_another_plan(self, duration):
        """Wait until a plan of another duration is shown."""
        self.browser.until(f'!document.body.innerText.includes(": {duration:.3f} s, tip")')

    def at(self, place):
        """Return where in the window a place in the scene is seen [pixels]."""
        left, top, width, height = self.browser.value(
            f'(r => [r.x, r.y, r.width, r.height])({PICTURE})')
        ahead = (CENTRE - EYE) / np.linalg.norm(CENTRE - EYE)
        right = np.cross(ahead, UP)
        right /= np.linalg.norm(right)
        x, y, z = (float(axis @ (np.asarray(place) - EYE)) for axis in (
            right, np.cross(right, ahead), ahead))
        scale = 0.5 * height / np.tan(0.5 * VIEW_ANGLE)
        return left + 0.5 * width + scale * x / z, top + 0.5 * height - scale * y / z

    def drag(self, begin, end, **options):
        """Drag with the mouse from where a place is seen to where another one is."""
        self.browser.drag(self.at(begin), self.at(end), **options)

    def colours_near(self, place, radius):
        """Return the colours around where a place is seen, shape (n, 3), 0 to 1."""
        picture = imread(BytesIO(self.browser.picture()))
        x, y = (round(value) for value in self.at(place))
        return picture[y - radius:y + radius, x - radius:x + radius, :3].reshape(-1, 3)
