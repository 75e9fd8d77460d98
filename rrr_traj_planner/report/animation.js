'use strict';
// Draws the arms of one figure at a common time; drag turns the view, all views together.
(function (figure) {
  const data = JSON.parse(figure.querySelector('.frames').textContent);
  const play = figure.querySelector('.play'), slider = figure.querySelector('.time');
  const output = figure.querySelector('output'), rate = figure.querySelector('.rate');
  const canvases = [...figure.querySelectorAll('canvas')];
  const longest = Math.max(...data.motions.map((m) => m.duration));
  const view = {azimuth: -1.08, elevation: 0.42};
  let time = 0, running = false, last = 0;

  const every = data.motions.flatMap((m) => [...m.joints.flat(), ...m.tip]);
  every.push([0, 0, 0], data.resting, ...data.via_points);
  const middle = [0, 1, 2].map((i) => 0.5 * (Math.min(...every.map((p) => p[i]))
    + Math.max(...every.map((p) => p[i]))));
  const reach = Math.max(...every.map((p) => Math.hypot(...p.map((x, i) => x - middle[i]))));
  const tens = 10 ** Math.floor(Math.log10(reach / 1.6));  // of the floor's squares: 0.5 m, say
  const square = [5 * tens, 2 * tens].find((length) => length <= reach / 1.6) || tens;

  function colour(role) {
    return getComputedStyle(document.documentElement).getPropertyValue('--' + role).trim();
  }

  function projector(width, height) {
    const ca = Math.cos(view.azimuth), sa = Math.sin(view.azimuth);
    const ce = Math.cos(view.elevation), se = Math.sin(view.elevation);
    const scale = 0.46 * Math.min(width, height) / reach;
    return (p) => {
      const x = p[0] - middle[0], y = p[1] - middle[1], z = p[2] - middle[2];
      const forward = ca * x + sa * y;
      return [0.5 * width + scale * (ca * y - sa * x),
        0.5 * height - scale * (ce * z - se * forward)];
    };
  }

  function line(pen, points, stroke, width) {
    pen.beginPath();
    points.forEach((p, i) => (i ? pen.lineTo(...p) : pen.moveTo(...p)));
    pen.strokeStyle = stroke;
    pen.lineWidth = width;
    pen.stroke();
  }

  function dot(pen, p, radius, fill, stroke) {
    pen.beginPath();
    pen.arc(p[0], p[1], radius, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
    if (stroke) { pen.strokeStyle = stroke; pen.lineWidth = 1; pen.stroke(); }
  }

  function between(list, place) {
    const i = Math.min(Math.floor(place), list.length - 2), f = place - i;
    const mix = (a, b) => a + f * (b - a);
    return typeof list[i] === 'number' ? mix(list[i], list[i + 1])
      : list[i].map((x, k) => mix(x, list[i + 1][k]));
  }

  function label(points, i) {  // beside a point, away from its nearest neighbour
    const [x, y] = points[i];
    let near = null, far = Infinity;
    points.forEach((p, k) => {
      const distance = Math.hypot(x - p[0], y - p[1]);
      if (k !== i && distance < far) [near, far] = [p, distance];
    });
    return near && far > 0 ? [x + 13 * (x - near[0]) / far, y + 13 * (y - near[1]) / far]
      : [x + 9, y - 9];
  }

  function labels(points) {  // both ends, and between them at equal steps those that are legible
    const stride = Math.ceil(points.length / 24), taken = [];
    const others = [...points.keys()].filter((i) => i % stride === 0);
    [...new Set([0, points.length - 1, ...others])].forEach((i) => {
      const [x, y] = label(points, i);
      if (taken.every(([p]) => Math.abs(p[0] - x) > 18 || Math.abs(p[1] - y) > 13)) {
        taken.push([[x, y], i]);
      }
    });
    return taken;
  }

  function floor(pen, at) {
    const most = Math.ceil(reach / square), far = most * square;
    for (let i = -most; i <= most; i += 1) {
      const k = i * square;
      line(pen, [at([k, -far, 0]), at([k, far, 0])], colour('grid'), 1);
      line(pen, [at([-far, k, 0]), at([far, k, 0])], colour('grid'), 1);
    }
    pen.font = '12px sans-serif';
    [['x', [1.1 * square, 0, 0]], ['y', [0, 1.1 * square, 0]]].forEach(([name, p]) => {
      line(pen, [at([0, 0, 0]), at(p.map((v) => v / 1.1))], colour('muted'), 1.5);
      pen.fillStyle = colour('muted');
      pen.fillText(name, ...at(p));
    });
  }

  function drawArm(canvas, motion) {
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth;
    const height = Math.round(Math.min(0.85 * width, 0.6 * window.innerHeight));
    canvas.style.height = height + 'px';
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const pen = canvas.getContext('2d'), at = projector(width, height);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = pen.lineCap = 'round';
    floor(pen, at);
    const place = Math.min(time / motion.duration, 1) * (motion.tip.length - 1);
    const path = motion.tip.map(at), passed = Math.floor(place) + 1;
    line(pen, path, colour('grid'), 3);
    const tip = at(between(motion.tip, place));
    line(pen, [...path.slice(0, passed), tip], colour('tip'), 3);
    const vias = data.via_points.map(at), size = vias.length > 60 ? 2 : vias.length > 20 ? 3 : 5;
    vias.forEach((seen) => dot(pen, seen, size, colour('via'), size > 2 && colour('ink')));
    pen.fillStyle = colour('ink');
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    labels(vias).forEach(([place, i]) => pen.fillText(String(i), ...place));
    const joints = [at(data.resting), ...motion.joints.map((joint) => at(between(joint, place)))];
    line(pen, [at([0, 0, 0]), ...joints, tip], colour('ink'), 5);
    joints.forEach((p) => dot(pen, p, 5, colour('paper'), colour('ink')));
    dot(pen, tip, 4, colour('tip'));
    const frame = Math.min(Math.round(place), motion.use.length - 1);
    canvas.nextElementSibling.textContent = time >= motion.duration ? 'at rest' : 'now '
      + motion.limits[motion.tightest[frame]] + ' at ' + Math.round(100 * motion.use[frame])
      + ' % of its limit';
  }

  function draw() {
    slider.value = String(Math.round(1000 * time / longest));
    output.textContent = time.toFixed(2) + ' of ' + longest.toFixed(2) + ' s';
    canvases.forEach((canvas, i) => drawArm(canvas, data.motions[i]));
  }

  function step(now) {
    if (!running) return;
    // the first frame's time may be before the click's
    time = Math.min(time + 1e-3 * Math.max(now - last, 0) * Number(rate.value), longest);
    last = now;
    if (time >= longest) run(false);
    draw();
    if (running) requestAnimationFrame(step);
  }

  function run(on) {
    running = on;
    play.textContent = on ? 'Pause' : 'Play';
    if (!on) return;
    if (time >= longest) time = 0;
    last = performance.now();
    requestAnimationFrame(step);
  }

  play.addEventListener('click', () => run(!running));
  slider.addEventListener('input', () => {
    run(false);
    time = longest * Number(slider.value) / 1000;
    draw();
  });
  canvases.forEach((canvas) => {
    canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      if (!event.buttons) return;
      view.azimuth -= 0.01 * event.movementX;
      view.elevation = Math.min(1.55, Math.max(-0.2, view.elevation + 0.01 * event.movementY));
      draw();
    });
  });
  window.addEventListener('resize', draw);
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  draw();
}(document.currentScript.closest('figure')));
