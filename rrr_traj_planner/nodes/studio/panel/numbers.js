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

// A slider's field of a number that is left empty, or with half a number, has the last number again:
// viser tells nobody of it. This runs once for each page.
(function () {
  if (window.rrrNumbers) {
    return;
  }
  window.rrrNumbers = true;
  const setValue = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set;
  let last = '';

  function isField(element) {
    return element.matches && element.matches('.mantine-NumberInput-input');
  }

  function isNumber(text) {
    return text.trim() !== '' && Number.isFinite(Number(text));
  }

  for (const kind of ['focusin', 'input']) {
    document.addEventListener(kind, (event) => {
      if (isField(event.target) && isNumber(event.target.value)) {
        last = event.target.value;
      }
    }, true);
  }
  document.addEventListener('focusout', (event) => {
    if (isField(event.target) && !isNumber(event.target.value)) {
      setValue.call(event.target, last);
      event.target.dispatchEvent(new Event('input', { bubbles: true }));
    }
  }, true);
})();
