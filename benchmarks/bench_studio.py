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
How long the studio's page takes from a drag of a via point to its plan, and to the picture of it.

    python benchmarks/bench_studio.py [--drags N] [--size WIDTHxHEIGHT]

The middle via point of table 6.1 is dragged, by the mouse's events, in headless Chromium that
draws by software. The next drag follows as soon as the path of the one before is in the picture,
as while a user drags: the page draws all the time.
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path
import sys
from tempfile import TemporaryDirectory
from time import monotonic, sleep

from measuring import compared, Row, setting, table
import numpy as np
from ros_processes import MISSING
from tasks import TIPS

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers import browser  # noqa: E402, I100

POINTS = TIPS['6.1']
PLANNERS = 'cycloid', 'time_optimal'
DRAGS, FIRST = 60, 5  # of which the first do not count
SIZE = 800, 700       # pixels of the window
ARROW = 0.16          # m, from a via point up to a place on its arrow
STEPS = 4, 10, 20, 14, 8  # pixels down from there, one after another
TARGET = 150.0        # ms
REST = 2.0            # s, for the page to settle
DEADLINE = 20.0       # s, for one drag
LEFT_OUT = 'rows of the studio are left out'

# Times [ms] from a mouse's event to the message with the path, and to the frame that follows the
# one in which the path was given to WebGL and WebGL has drawn.
HOOK = """(() => {
  let event = 0, message = 0, length = 0;
  const found = window.benchTimes = [];
  addEventListener('pointermove', (e) => { event = e.timeStamp; }, true);
  const pathOf = (m) => m.name === '/plan' && (m.props || m.updates || {}).points;
  window.Worker = class extends Worker {
    constructor(...given) {
      super(...given);
      this.addEventListener('message', ({data}) => {
        const last = ((data && data.messages) || []).map(pathOf).filter(Boolean).pop();
        if (last) {
          message = performance.now();
          length = last.byteLength / 4;
        }
      });
    }
  };
  const drawn = (gl) => {
    const took = [message - event], begun = event;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED) {
        found.push([...took, performance.now() - begun]);
      } else {
        requestAnimationFrame(look);
      }
    };
    requestAnimationFrame(look);
  };
  for (const name of ['bufferData', 'bufferSubData']) {
    const given = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...all) {
      if (length && all.some((a) => a instanceof Float32Array && a.length === length)) {
        length = 0;
        queueMicrotask(() => drawn(this));
      }
      return given.apply(this, all);
    };
  }
})()"""


def missing() -> str:
    """Return what is missing, else an empty text."""
    if MISSING:
        return MISSING
    if not all(map(find_spec, ('viser', 'matplotlib'))):
        return f'viser (make studio installs it) or matplotlib is missing: {LEFT_OUT}'
    return '' if browser.found() else f'{browser.MISSING}: {LEFT_OUT}'


def rows(drags: int = DRAGS, size: tuple[int, int] = SIZE) -> list[Row]:
    """Return times to the plan and to the picture over what is allowed."""
    if missing():
        print(missing(), flush=True)
        return []
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder, browser.Browser(
            Path(folder, 'profile'), browser.WEBGL) as opened:
        opened.ask('Page.addScriptToEvaluateOnNewDocument', source=HOOK)
        return [row for planner_id in PLANNERS for row in _rows_of(
            planner_id, _times(opened, Path(folder), planner_id, drags, size))]


def _rows_of(planner_id: str, times: np.ndarray) -> list[Row]:
    found = []
    for what, of_it in zip(('the plan', 'the picture'), times.T):
        for share in (50, 95):
            is_asked = (what, share) == ('the picture', 95)
            found.append(compared(
                f'studio, {planner_id}: from drag to {what}, p{share} / {TARGET:.0f} ms',
                1.0 if is_asked else None, float(np.percentile(of_it, share)), TARGET, 'ms',
                len(of_it)))
    return found


def _times(opened: browser.Browser, folder: Path, planner_id: str, drags: int,
           size: tuple[int, int]) -> np.ndarray:
    """Return times to the plan and to the picture [ms], shape (drags, 2)."""
    from helpers.scripts import Script, script
    from helpers.studio_window import StudioWindow
    task = folder / f'{planner_id}.yaml'
    task.write_text(f'planner_id: {planner_id}\nvia_points: {[list(tip) for tip in POINTS]}\n')
    with Script(script('studio'), task, '--port', 0, cwd=folder) as studio:
        window = StudioWindow(opened, studio.read_until('studio: http')[-1].split()[1])
        window.load(*size)
        window.wait_for_drawing(POINTS[1])
        sleep(REST)
        x, y = window.at(np.array(POINTS[1]) + (0.0, 0.0, ARROW))
        opened.mouse('mouseMoved', x, y)
        opened.mouse('mousePressed', x, y)
        opened.value('benchTimes.length = 0')
        for k in range(FIRST + drags):
            opened.mouse('mouseMoved', x, y + STEPS[k % len(STEPS)], buttons=1)
            _wait(opened, k + 1)
        opened.mouse('mouseReleased', x, y)
        return np.array(opened.value('benchTimes'))[FIRST:]


def _wait(opened: browser.Browser, count: int) -> None:
    """Wait until so many drags are in the picture."""
    deadline = monotonic() + DEADLINE
    while opened.value('benchTimes.length') < count:
        if monotonic() > deadline:
            raise TimeoutError(f'drag {count} is not in the picture')
        sleep(0.01)


def main() -> None:
    """Print every time over what is allowed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--drags', type=int, default=DRAGS)
    parser.add_argument('--size', type=lambda text: tuple(map(int, text.split('x'))), default=SIZE)
    options = parser.parse_args()
    found = rows(options.drags, options.size)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
