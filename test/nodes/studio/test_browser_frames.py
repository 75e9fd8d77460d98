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

"""When the page's frames begin: not before the last one is drawn."""

from __future__ import annotations

from importlib.resources import files

from helpers import browser
import pytest

pytestmark = pytest.mark.skipif(
    browser.found() is None, reason='no Chromium or Chrome: apt install chromium, or $CHROMIUM')

# A page whose canvas says when it has drawn, and which keeps what its frames did.
PAGE = """<canvas data-engine="three.js"></canvas><script>
const gl = {SYNC_STATUS: 1, UNSIGNALED: 2, fenceSync: () => ({}), deleteSync() {}, flush() {},
            getSyncParameter: () => window.isDrawn ? 3 : gl.UNSIGNALED};
document.querySelector('canvas').getContext = () => gl;
const trueFrame = window.requestAnimationFrame.bind(window);
const done = [];
const frames = (count) => new Promise((end) => {
  const next = (left) => left ? trueFrame(() => next(left - 1)) : end(true);
  next(count);
});
</script><script>%s</script>"""
FRAMES = 8  # of the browser, in which the next one would have been begun


@pytest.fixture(scope='module')
def opened(tmp_path_factory):
    folder = tmp_path_factory.mktemp('page')
    script = files('rrr_traj_planner.nodes.studio.panel').joinpath('frames.js').read_text()
    (folder / 'page.html').write_text(PAGE % script)
    with browser.Browser(folder / 'profile') as page:
        yield page, folder / 'page.html'


def ask(page, name):
    """Request a frame, and return its number."""
    return page.value(f'requestAnimationFrame(() => done.push("{name}"))')


def test_a_frame_begins_when_the_last_one_is_drawn(opened):
    page, file = opened
    page.show(file, 300, 200, False)
    ask(page, 'first')
    page.until('done.length === 1')  # nothing is drawn before it
    begun = ask(page, 'second')
    waited = page.value(f'frames({FRAMES}).then(() => done.join())')
    page.value('window.isDrawn = true')
    page.until('done.join() === "first,second"')
    assert waited == 'first' and begun


def test_a_frame_that_waits_can_be_cancelled(opened):
    page, file = opened
    page.show(file, 300, 200, False)
    ask(page, 'first')
    page.until('done.length === 1')
    number = ask(page, 'second')
    page.value(f'frames(2).then(() => cancelAnimationFrame({number}))')
    page.value('window.isDrawn = true')
    ask(page, 'third')
    page.until('done.includes("third")')
    assert page.value('done.join()') == 'first,third'
