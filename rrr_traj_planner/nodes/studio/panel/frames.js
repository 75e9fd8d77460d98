// A new path soon in the picture, also where a processor draws it, beside the planner. This runs
// once for each page.
(function () {
  if (window.rrrFrames) {
    return;
  }
  window.rrrFrames = true;
  const SLOW = 30;     // ms that a frame takes to be drawn; no graphics card does
  const PAUSE = 100;   // ms between slow frames in which nothing is new
  const LONGEST = 1000;  // ms that a frame is waited for
  const request = window.requestAnimationFrame.bind(window);
  const cancel = window.cancelAnimationFrame.bind(window);
  const numbers = new Map();  // of requests: the browser's, by the page's
  let begun = 0;       // when the last frame was begun [ms]
  let took = 0;        // until the one before it was drawn [ms]
  let fence = null;    // behind what the last frame draws, until it is drawn
  let isNew = true;    // whether anything has come since

  // viser takes messages in its next frame, and shows them in the one after that. Those for a
  // hidden page, which has no frames, it takes as they come, and asks for nothing else whether the
  // page is hidden.
  Object.defineProperty(document, 'hidden', { get: () => (isNew = true) });
  for (const kind of ['pointerdown', 'pointermove', 'pointerup', 'wheel', 'keydown']) {
    document.addEventListener(kind, () => { isNew = true; }, true);
  }

  function context() {
    const canvas = document.querySelector('canvas[data-engine]');  // that of three.js
    return canvas && canvas.getContext('webgl2');
  }

  function isDrawn(time) {
    const gl = fence && time - begun < LONGEST && context();
    if (gl && gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.UNSIGNALED) {
      return false;
    }
    if (gl) {
      gl.deleteSync(fence);
      took = time - begun;
    }
    fence = null;
    return true;
  }

  function end() {
    const gl = context();
    if (gl) {
      gl.deleteSync(fence);
      fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
    }
  }

  // No frame is begun before the last one is drawn: else the browser has three of them wait, and a
  // new path behind them. After every change viser draws for a quarter of a second, in case that
  // more comes; slow frames of this kind leave the processor to the planner for a while.
  function mayBegin(time) {
    return time === begun || (
      isDrawn(time) && (isNew || took < SLOW || time - begun > PAUSE));
  }

  window.requestAnimationFrame = (act) => {
    function frame(time) {
      if (!mayBegin(time)) {
        numbers.set(number, request(frame));
        return;
      }
      numbers.delete(number);
      begun = time;
      isNew = false;
      act(time);
      end();
    }
    const number = request(frame);
    numbers.set(number, number);
    return number;
  };
  window.cancelAnimationFrame = (number) => {
    cancel(numbers.get(number));
    numbers.delete(number);
  };
})();
