// The panel's head stays on top of what is scrolled: viser gives the elements around it no names by
// which a style could find them. This runs whenever the panel is made.
(function () {
  const head = document.querySelector('.head');
  let element = head && head.parentElement;
  if (!element) {
    return;
  }
  Object.assign(element.style, {
    position: 'sticky', top: 0, zIndex: 2, background: 'var(--mantine-color-body)' });
  // One that hides what is too large would keep the head from staying; one that clips it would be
  // as wide as its content, if that counted.
  for (let level = 0; element && level < 5; level++) {
    if (getComputedStyle(element).overflowY === 'hidden') {
      Object.assign(element.style, { overflow: 'clip', contain: 'inline-size' });
    }
    element = element.parentElement;
  }
})();
