// Copyright 2026 rrr_traj_planner developers
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

// Clicking in the chart, or dragging there, moves the slider of the moment, as its number field
// would. This runs once for each page; the labels are those of chart.py and plan.py.
(function () {
  if (window.rrrMoment) {
    return;
  }
  window.rrrMoment = true;
  const setValue = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set;
  let held = null;

  function field() {
    const label = Array.from(document.querySelectorAll('label[for]')).find(
      (element) => element.textContent === 'moment / duration');
    const slider = label && document.getElementById(label.htmlFor);
    return slider && slider.parentElement.querySelector('input:not([type=hidden])');
  }

  function go(event) {
    const box = held.getBoundingClientRect();
    const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
    const input = field();
    if (input) {
      setValue.call(input, share.toFixed(3));
      input.dispatchEvent(new Event('input', { bubbles: true }));
    }
  }

  document.addEventListener('pointerdown', (event) => {
    const area = event.button === 0 && event.target.closest && event.target.closest('.u-over');
    const title = area && area.closest('.uplot').querySelector('.u-title');
    if (title && title.textContent === 'shares of the limits') {
      held = area;
      go(event);
    }
  }, true);
  document.addEventListener('pointermove', (event) => held && go(event), true);
  for (const end of ['pointerup', 'pointercancel']) {
    document.addEventListener(end, () => { held = null; }, true);
  }
})();
