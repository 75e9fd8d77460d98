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

"""Headless Chromium, controlled over its debugging pipe without further packages."""

from __future__ import annotations

import base64
import json
import os
from pathlib import Path
import select
import shutil
import subprocess
import time

NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable', 'chrome')
DEADLINE = 60.0  # s, for every wait here

OPTIONS = (
    '--headless=new', '--remote-debugging-pipe', '--no-sandbox', '--disable-gpu',
    '--disable-dev-shm-usage', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-default-apps', '--disable-extensions',
    '--disable-sync', '--hide-scrollbars=false', '--mute-audio',
    # draw hidden pages as often as visible ones
    '--disable-background-timer-throttling', '--disable-backgrounding-occluded-windows',
    '--disable-renderer-backgrounding')

# of pages with WebGL, drawn by software: SwiftShader
WEBGL = (*(option for option in OPTIONS if option != '--disable-gpu'),
         '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader')
MISSING = ('no Chromium or Chrome to look at pages with: apt install chromium, or say where one '
           'is in $CHROMIUM')

BUTTON = ('text => [...document.querySelectorAll("button")].find(b => b.innerText.trim() === '
          'text)')


def found():
    """Return the browser's path ($CHROMIUM, or the first one installed), None if there is none."""
    given = os.environ.get('CHROMIUM')
    return next((path for path in map(shutil.which, [given] if given else NAMES) if path), None)


class Browser:
    """A browser with one page; a context manager that ends it."""

    def __init__(self, folder, options=OPTIONS):
        command_read, self._out = os.pipe()
        self._in, answer_write = os.pipe()
        # the browser reads from descriptor 3 and writes to 4
        shell = f'exec "$@" 3<&{command_read} 4>&{answer_write}'
        self._process = subprocess.Popen(
            ['bash', '-c', shell, 'bash', found(), *options, f'--user-data-dir={folder}',
             'about:blank'], pass_fds=(command_read, answer_write), stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_read)
        os.close(answer_write)
        self._number, self._rest, self._session, self.events = 0, b'', None, []

    def __enter__(self):
        targets = self.ask('Target.getTargets')['targetInfos']
        target = next(t['targetId'] for t in targets if t['type'] == 'page')
        self._session = self.ask('Target.attachToTarget', targetId=target,
                                 flatten=True)['sessionId']
        for domain in ('Page', 'Runtime', 'Log', 'Network'):
            self.ask(f'{domain}.enable')
        self.ask('Page.bringToFront')
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._out)
        os.close(self._in)

    def ask(self, method, **parameters):
        """Return the browser's answer to a command."""
        self.tell(method, **parameters)
        deadline = time.monotonic() + DEADLINE
        while True:
            answer = self._next(deadline)
            if answer.get('id') == self._number:
                assert 'error' not in answer, answer
                return answer['result']
            self.events.append(answer)

    def tell(self, method, **parameters):
        """Give the browser a command, without waiting until it is done."""
        self._number += 1
        message = {'id': self._number, 'method': method, 'params': parameters}
        if self._session:
            message['sessionId'] = self._session
        os.write(self._out, json.dumps(message).encode() + b'\0')

    def _next(self, deadline):
        while b'\0' not in self._rest:
            ready, _, _ = select.select([self._in], [], [], max(deadline - time.monotonic(), 0.0))
            assert ready, 'the browser does not answer'
            data = os.read(self._in, 1 << 16)
            assert data, 'the browser has ended'
            self._rest += data
        message, self._rest = self._rest.split(b'\0', 1)
        return json.loads(message)

    def show(self, page, width, height, dark):
        """Load a page from a file in a window of a size, with a dark or light theme."""
        self.load(Path(page).resolve().as_uri(), width, height, dark)

    def load(self, url, width, height, dark=False):
        """Load a page in a window of a size, with a dark or light theme."""
        self.events.clear()
        self.resize(width, height)
        self.ask('Emulation.setEmulatedMedia', features=[
            {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}])
        self.ask('Page.navigate', url=url)
        deadline = time.monotonic() + DEADLINE
        while not any(e.get('method') == 'Page.loadEventFired' for e in self.events):
            self.events.append(self._next(deadline))

    def resize(self, width, height):
        """Give the window a size; a small one is a phone's."""
        self.ask('Emulation.setDeviceMetricsOverride', width=width, height=height,
                 deviceScaleFactor=2 if width < 600 else 1, mobile=width < 600)

    def value(self, expression):
        """Evaluate a JavaScript expression in the page."""
        answer = self.ask('Runtime.evaluate', expression=expression, returnByValue=True,
                          awaitPromise=True)
        assert 'exceptionDetails' not in answer, answer['exceptionDetails']
        return answer['result'].get('value')

    def until(self, expression):
        """Wait until an expression is true in the page."""
        deadline = time.monotonic() + DEADLINE
        while not self.value(expression):
            assert time.monotonic() < deadline, f'never true: {expression}'
            time.sleep(0.02)

    def click(self, text):
        """Click the button with a text, as a user does."""
        self.until(f'({BUTTON})({json.dumps(text)}) !== undefined')
        x, y = self.value(
            f'(() => {{ const b = ({BUTTON})({json.dumps(text)}); b.scrollIntoView({{block: '
            '"center"}); const r = b.getBoundingClientRect(); return [r.x + r.width / 2, r.y + '
            'r.height / 2]; })()')
        self.mouse('mouseMoved', x, y)
        self.mouse('mousePressed', x, y)
        self.mouse('mouseReleased', x, y)

    def mouse(self, what, x, y, waits=True, **more):
        """Do something with the mouse's left button at a place in the window."""
        button = {} if what == 'mouseMoved' and not more else {'button': 'left', 'clickCount': 1}
        (self.ask if waits else self.tell)(
            'Input.dispatchMouseEvent', type=what, x=x, y=y, **{**button, **more})

    def drag(self, begin, end, steps=10):
        """Drag with the mouse from one place to another."""
        self.mouse('mouseMoved', *begin)
        self.mouse('mousePressed', *begin)
        for k in range(1, steps + 1):
            self.mouse('mouseMoved', *(a + (b - a) * k / steps for a, b in zip(begin, end)),
                       buttons=1)
        self.mouse('mouseReleased', *end)

    def complaints(self):
        """Return the page's errors, warnings and exceptions."""
        self.value('1')  # events before this answer have been received
        faults = ('Runtime.exceptionThrown', 'Log.entryAdded')
        return [e['params'] for e in self.events if e.get('method') in faults
                or e.get('method') == 'Runtime.consoleAPICalled'
                and e['params']['type'] in ('error', 'warning')]

    def requests(self):
        """Return every address that the page has given."""
        return [e['params']['request']['url'] for e in self.events
                if e.get('method') == 'Network.requestWillBeSent']

    def picture(self):
        """Return a picture of the window, as PNG."""
        return base64.b64decode(self.ask('Page.captureScreenshot', format='png')['data'])

    def screenshot(self, file, selector=None):
        """Save a picture of the whole page, or of an element."""
        box = self.value(
            '(() => { const r = document.querySelector(' + json.dumps(selector or 'html')
            + ').getBoundingClientRect(); return [r.x + scrollX, r.y + scrollY, r.width, '
            'r.height]; })()')
        clip = dict(zip(('x', 'y', 'width', 'height'), box), scale=1)
        data = self.ask('Page.captureScreenshot', format='png', clip=clip,
                        captureBeyondViewport=True)['data']
        Path(file).write_bytes(base64.b64decode(data))
