'use strict';
/// Keys, wheel and pointers on the view.
function listenToView(viewer, canvas) {
  const scene = viewer.scene;
  canvas.addEventListener('keydown', event => {
    const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (way && event.shiftKey) scene.move(.05 * way[0], .05 * way[1]);
    else if (way) scene.turn(.1 * way[0], .1 * way[1]);
    else if (event.key === '+' || event.key === '=') scene.zoom(1 / 1.15);
    else if (event.key === '-') scene.zoom(1.15);
    else if (event.key === '0' || event.key === 'Home') scene.resetView();
    else if (event.key === 'PageUp') viewer.changeLevel(1);
    else if (event.key === 'PageDown') viewer.changeLevel(-1);
    else if (event.key === ' ') viewer.play(!viewer.playing);
    else return;
    event.preventDefault();
  });
  canvas.addEventListener('wheel', event => {
    if (document.activeElement !== canvas && !event.ctrlKey) return;  // the page scrolls
    event.preventDefault();
    scene.zoom(Math.exp(event.deltaY * (event.deltaMode ? .05 : .0015)));
  }, {passive: false});

  // One pointer rotates, or pans with Shift or another button; two pan and zoom.
  const down = new Map();
  const middle = () => [...down.values()].reduce((m, p) => [m[0] + p[0] / down.size, m[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, event => down.delete(event.pointerId));
  canvas.addEventListener('pointermove', event => {
    if (!down.has(event.pointerId)) return;
    const before = middle(), apart = down.size === 2 && spread();
    down.set(event.pointerId, [event.clientX, event.clientY]);
    const after = middle(), right = after[0] - before[0], up = before[1] - after[1], height = scene.panel.height;
    if (down.size > 1 || event.shiftKey || event.buttons > 1) scene.move(right / height, up / height);
    else scene.turn(right * 3 / height, -up * 3 / height);
    if (apart) scene.zoom(apart / Math.max(spread(), 1));
  });
}
