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
How long the studio's page takes from the drop of a via point to its plan, and to the picture.

    python benchmarks/bench_studio.py [--drops N] [--size WIDTHxHEIGHT]

The middle via point of table 6.1 is dragged in headless Chromium that draws by software: the
mouse moves at 30 Hz, and its button is released at once with the last move, so that no place is
known to the page before its drop. Then nothing is done until all is drawn.
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path
import sys
from tempfile import TemporaryDirectory
from time import sleep

from measuring import compared, Row, setting, table
import numpy as np
from ros_processes import MISSING
from tasks import TIPS

sys.path.insert(0, str(Path(__file__).parents[1] / 'test'))
from helpers import browser  # noqa: E402, I100

POINTS = TIPS['6.1']
PLANNERS = 'cycloid', 'time_optimal'
DROPS, FIRST = 40, 3  # of which the first do not count
SIZE = 800, 700       # pixels of the window
ARROW = 0.16          # m, from a via point up to a place on its arrow
MOVES, STEP = 8, 3    # of a drag, and pixels of each; every second drag leads back
PERIOD = 1.0 / 30     # s between two moves
TARGET = 150.0        # ms
REST = 2.0            # s, for the page to settle
STILL = 0.6           # s, in which no other path comes after the last one
LEFT_OUT = 'rows of the studio are left out'

# Times [ms] of the drop, and for each path: of the message with it, and when WebGL has finished
# the frame to which it was given first. It is asked for that again and again, but in tasks of
# their own: the next frame need not be waited for.
HOOK = """(() => {
  const found = window.bench = {drop: 0, paths: []};
  let given = null;
  addEventListener('pointerup', (e) => { found.drop = e.timeStamp; }, true);
  const pathOf = (m) => m.name === '/plan' && (m.props || m.updates || {}).points;
  window.Worker = class extends Worker {
    constructor(...all) {
      super(...all);
      this.addEventListener('message', ({data}) => {
        const last = ((data && data.messages) || []).map(pathOf).filter(Boolean).pop();
        if (last) {
          given = {message: performance.now(), length: last.byteLength / 4, picture: 0};
          found.paths.push(given);
        }
      });
    }
  };
  const finished = (gl, path) => {
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const {port1, port2} = new MessageChannel();
    port1.onmessage = () => {
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED) {
        path.picture = performance.now();
      } else {
        setTimeout(() => port2.postMessage(0), 1);
      }
    };
    port2.postMessage(0);
  };
  for (const name of ['bufferData', 'bufferSubData']) {
    const original = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...all) {
      const path = given;
      if (path && all.some((a) => a instanceof Float32Array && a.length === path.length)) {
        given = null;
        queueMicrotask(() => finished(this, path));
      }
      return original.apply(this, all);
    };
  }
})()"""
# All is still: the last path, which is that of the drop, is in the picture.
IS_STILL = f"""(({{drop, paths}}) => drop && paths.length && paths.at(-1).picture
  && performance.now() - Math.max(drop, paths.at(-1).picture) > {1e3 * STILL})(bench)"""
TIMES = '(({drop, paths}) => [paths.at(-1).message - drop, paths.at(-1).picture - drop])(bench)'


def missing() -> str:
    """Return what is missing, else an empty text."""
    if MISSING:
        return MISSING
    if not all(map(find_spec, ('viser', 'matplotlib'))):
        return f'viser (make studio installs it) or matplotlib is missing: {LEFT_OUT}'
    return '' if browser.found() else f'{browser.MISSING}: {LEFT_OUT}'


def rows(drops: int = DROPS, size: tuple[int, int] = SIZE) -> list[Row]:
    """Return times to the plan and to the picture over what is allowed."""
    if missing():
        print(missing(), flush=True)
        return []
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder, browser.Browser(
            Path(folder, 'profile'), browser.WEBGL) as opened:
        opened.ask('Page.addScriptToEvaluateOnNewDocument', source=HOOK)
        return [row for planner_id in PLANNERS for row in _rows_of(
            planner_id, _times(opened, Path(folder), planner_id, drops, size))]


def _rows_of(planner_id: str, times: np.ndarray) -> list[Row]:
    found = []
    for what, of_it in zip(('the plan', 'the picture'), times.T):
        for share in (50, 95):
            is_asked = (what, share) == ('the picture', 95)
            found.append(compared(
                f'studio, {planner_id}: from drop to {what}, p{share} / {TARGET:.0f} ms',
                1.0 if is_asked else None, float(np.percentile(of_it, share)), TARGET, 'ms',
                len(of_it)))
    return found


def _times(opened: browser.Browser, folder: Path, planner_id: str, drops: int,
           size: tuple[int, int]) -> np.ndarray:
    """Return times to the plan and to the picture [ms], shape (drops, 2)."""
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
        found = []
        for k in range(FIRST + drops):
            begin, end = (y, y + MOVES * STEP)[::1 - 2 * (k % 2)]
            _drag(opened, x, np.linspace(begin, end, MOVES + 1))
            opened.until(IS_STILL)
            found.append(opened.value(TIMES))
        return np.array(found)[FIRST:]


def _drag(opened: browser.Browser, x: float, ys: np.ndarray) -> None:
    """Drag as a hand does, which does not wait until the page has taken a move."""
    opened.mouse('mouseMoved', x, ys[0])
    opened.mouse('mousePressed', x, ys[0])
    opened.value('Object.assign(bench, {drop: 0, paths: []})')
    for y in ys[1:]:
        sleep(PERIOD)
        opened.mouse('mouseMoved', x, y, waits=False, buttons=1)
    opened.mouse('mouseReleased', x, ys[-1])


def main() -> None:
    """Print every time over what is allowed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--drops', type=int, default=DROPS)
    parser.add_argument('--size', type=lambda text: tuple(map(int, text.split('x'))), default=SIZE)
    options = parser.parse_args()
    found = rows(options.drops, options.size)
    print(setting())
    print(table(found))


if __name__ == '__main__':
    main()
