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

"""
The panel in a browser: via points, undo, options, files, and tasks with other arms.

One test, since one browser and one start of all nodes are to do.
"""

from __future__ import annotations

import json
from time import monotonic

from helpers import browser
from helpers.scripts import Script, script
import pytest
from rrr_traj_planner.nodes.point_files.reading import read_task

WIDTH, HEIGHT = 640, 480  # pixels: a small scene, which is drawn by software
SEEN = 'input:not([type=hidden])'  # beside them, there are hidden ones with the values in force
FIELDS = f'Array.from(document.querySelectorAll("{SEEN}")).map(e => e.value)'
PLAN = 'document.body.innerText.match(/cycloid: [0-9.]+ s/)?.[0]'
OPTIONS = 'Array.from(document.querySelectorAll("[role=option]")).map(e => e.innerText.trim())'
ELEMENT = 'Array.from(document.querySelectorAll({kind})).find(e => {condition})'


class Form:
    """The page's controls, as a user sees them: by their texts and values."""

    def __init__(self, opened, address):
        self.browser = opened
        opened.ask('Emulation.setDeviceMetricsOverride', width=WIDTH, height=HEIGHT,
                   deviceScaleFactor=1, mobile=False)
        opened.ask('Page.navigate', url=address)
        self.reads('planned in')

    def reads(self, text):
        """Wait until a text is there."""
        self.browser.until(f'document.body && document.body.innerText.includes({quoted(text)})')

    def has(self, *values):
        """Wait until controls have values."""
        self.browser.until(f'{json.dumps(values)}.every(v => {FIELDS}.includes(v))')

    def press(self, text, kind='button'):
        """Click what has a text."""
        condition = f'e.innerText.trim() === {quoted(text)}'
        found = ELEMENT.format(kind=quoted(kind), condition=condition)
        self.browser.until(f'{found} !== undefined')
        self.browser.value(f'{found}.click()')

    def choose(self, value, option):
        """Choose an option of the list that has a value."""
        found = self._field(value)
        self.browser.value(f'{found}.focus(); {found}.click()')
        self.browser.until(f'{OPTIONS}.includes({quoted(option)})')
        self.press(option, '[role=option]')

    def write(self, value, text):
        """Type a text in place of a value."""
        found = self._field(value)
        self.browser.value(f'{found}.focus(); {found}.select()')
        self.browser.ask('Input.insertText', text=text)

    def fold(self, text):
        """Open or close a folder."""
        found = ELEMENT.format(kind='"div"', condition=f'e.innerText.trim() === {quoted(text)}')
        self.browser.value(f'{found}.click()')

    def load(self, file):
        """Load a file."""
        root = self.browser.ask('DOM.getDocument')['root']['nodeId']
        node = self.browser.ask('DOM.querySelector', nodeId=root, selector='input[type=file]')
        self.browser.ask('DOM.setFileInputFiles', nodeId=node['nodeId'], files=[str(file)])

    def _field(self, value):
        found = ELEMENT.format(kind=quoted(SEEN), condition=f'e.value === {quoted(value)}')
        self.browser.until(f'{found} !== undefined')
        return found


def quoted(text):
    return json.dumps(text, ensure_ascii=False)


def test_panel_changes_what_is_planned_and_opens_tasks_with_other_arms(tmp_path):
    pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
    if browser.found() is None:
        pytest.skip('no Chromium or Chrome to look at pages with: apt install chromium, or say '
                    'where one is in $CHROMIUM')
    with Script(script('studio'), '--port', 0, cwd=tmp_path) as studio, browser.Browser(
            tmp_path / 'profile') as opened:
        address = studio.read_until('studio: http')[-1].split()[1]
        opened.ask('Browser.setDownloadBehavior', behavior='allow', downloadPath=str(tmp_path))
        form = Form(opened, address)
        change_points(form)
        change_options(form)
        empty_number(form)
        say_why_nothing_changes(form)
        darken(form)
        saved = tmp_path / 'table_6_1.yaml'
        save(form, saved)
        open_tasks(form, saved)


def change_points(form):
    """Choose via point 1, type its x, insert one after it, and undo all."""
    form.reads('table_6_1, thesis_arm')
    form.choose('0: 1.02, 0.59, 0.97', '1: 0.46, 0.55, 1.44')
    form.write('0.46, 0.55, 1.44', '0.500001, 0.55, 1.44')
    form.has('1: 0.5, 0.55, 1.44', '0.500001, 0.55, 1.44')
    form.press('insert after')
    form.has('2: 0.475, 0.465, 1.44')
    form.press('move later')
    form.has('3: 0.475, 0.465, 1.44')
    form.press('undo')
    form.has('3: 0.45, 0.38, 1.45')
    form.press('undo')
    form.has('2: 0.45, 0.38, 1.45')  # the chosen one is the last of three
    form.press('undo')
    form.choose('2: 0.45, 0.38, 1.45', '1: 0.46, 0.55, 1.44')
    form.press('redo')
    form.has('1: 0.5, 0.55, 1.44')


def change_options(form):
    """Ask for an elbow that the arm cannot have there, and undo that."""
    form.fold('Options')
    form.choose('free', 'down')
    form.reads('refused: via point')
    form.press('undo')
    form.reads('cycloid: ')
    form.browser.until('!document.body.innerText.includes("refused")')


def empty_number(form):
    """Type a scaling, and empty its field: on leaving it, the field has the number in force."""
    before = form.browser.value(PLAN)
    form.write('1', '0.5')
    form.browser.until('document.activeElement.value === "0.5"')
    form.browser.value('document.activeElement.select()')
    form.browser.ask('Input.dispatchKeyEvent', type='keyDown', key='Delete', code='Delete',
                     windowsVirtualKeyCode=46)
    form.browser.until('document.activeElement.value === ""')
    form.browser.value('document.activeElement.blur()')
    form.has('0.5')
    form.browser.until(f'{PLAN} && {PLAN} !== {quoted(before)}')
    form.press('undo')
    form.browser.until(f'{PLAN} === {quoted(before)}')


def say_why_nothing_changes(form):
    """Remove via points until two are left, and bring the others back."""
    form.press('remove')
    form.browser.until(f'!{FIELDS}.includes("2: 0.45, 0.38, 1.45")')
    form.press('remove')
    form.reads('a motion needs two via points')
    form.press('undo')
    form.browser.until('!document.body.innerText.includes("a motion needs two via points")')
    form.reads('planned in')


def darken(form):
    """Make the page dark, and light again."""
    scheme = 'document.documentElement.getAttribute("data-mantine-color-scheme")'
    for before, after in (('light', 'dark'), ('dark', 'light')):
        form.browser.until(f'{scheme} === "{before}"')
        form.press('dark page', 'label')
        form.browser.until(f'{scheme} === "{after}"')


def save(form, file):
    """Save what is shown, and read it as every script does."""
    form.press('Save')
    deadline = monotonic() + browser.DEADLINE
    while not file.is_file():  # it has another name until it is whole
        assert monotonic() < deadline, 'nothing is saved'
        form.browser.value('1')
    task = read_task(str(file))
    assert task.via_points.tolist() == [
        [1.02, 0.59, 0.97], [0.500001, 0.55, 1.44], [0.45, 0.38, 1.45]]
    assert (task.arm.name, task.planner_id) == ('thesis_arm.yaml', 'cycloid')


def open_tasks(form, saved):
    """Open a task for another arm, and load the file that was saved for the first one."""
    form.choose('choose', 'go1_leg')
    form.reads('starting the nodes anew')
    form.reads('go1_leg, go1_leg_arm')
    form.reads('planned in')
    form.load(saved)
    form.reads('table_6_1, thesis_arm')
    form.has('0: 1.02, 0.59, 0.97')
    form.reads('planned in')
