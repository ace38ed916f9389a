// Moves and zooms the map: wheel, drag, pinch and keys. One transform moves all of it. A layer of its own while it moves
// (`will-change`) was slower where there is no graphics card.
"use strict";
archgenExplorer.makeCamera = function (stage, map, onMove, onRest) {
  const [LEAST, MOST] = [0.08, 3];
  const REST = 160; // ms without moving before the place is told
  const view = { x: 0, y: 0, zoom: 1 };
  let bounds = { left: 0, right: 1, top: 0, bottom: 1 }, frame = 0, resting = 0;

  function apply() {
    frame = 0;
    map.style.transform = `translate(${view.x}px, ${view.y}px) scale(${view.zoom})`;
    stage.classList.toggle("far", view.zoom < 0.6);
    stage.classList.toggle("farther", view.zoom < 0.4);
    stage.classList.toggle("farthest", view.zoom < 0.26);
    onMove(view);
  }

  function move() {
    if (!frame) frame = requestAnimationFrame(apply);
    clearTimeout(resting);
    resting = setTimeout(() => onRest(view), REST);
  }

  // Never so far that nothing of the map is left in the window.
  function clamp() {
    const { clientWidth: width, clientHeight: height } = stage;
    view.x = Math.min(width - 60 - bounds.left * view.zoom, Math.max(60 - bounds.right * view.zoom, view.x));
    view.y = Math.min(height - 60 - bounds.top * view.zoom, Math.max(60 - bounds.bottom * view.zoom, view.y));
  }

  function pan(dx, dy) {
    view.x += dx;
    view.y += dy;
    clamp();
    move();
  }

  function zoom(factor, at = [stage.clientWidth / 2, stage.clientHeight / 2]) {
    const next = Math.min(MOST, Math.max(LEAST, view.zoom * factor));
    view.x = at[0] - ((at[0] - view.x) * next) / view.zoom;
    view.y = at[1] - ((at[1] - view.y) * next) / view.zoom;
    view.zoom = next;
    clamp();
    move();
  }

  function set(x, y, next) {
    Object.assign(view, { x, y, zoom: Math.min(MOST, Math.max(LEAST, next)) });
    clamp();
    apply();
  }

  // The whole of the map, or of some boxes, in the free part of the window.
  function fit(area = bounds, most = 1) {
    const margin = 28;
    // The legend and the mini-map stand at the foot of a large window.
    const foot = stage.clientHeight > 600 ? 60 : 0;
    const width = Math.max(100, stage.clientWidth - 2 * margin), height = Math.max(100, stage.clientHeight - 2 * margin - foot);
    const next = Math.min(most, width / (area.right - area.left || 1), height / (area.bottom - area.top || 1));
    const spare = stage.clientHeight - (area.bottom - area.top) * next;
    const shift = spare / 2 > foot + margin ? 0 : foot;
    set((stage.clientWidth - (area.left + area.right) * next) / 2, (stage.clientHeight - shift - (area.top + area.bottom) * next) / 2, next);
  }

  // Moves only as far as needed to have a box in sight.
  function show(box) {
    const margin = 40;
    const left = box.x * view.zoom + view.x, top = box.y * view.zoom + view.y;
    const right = left + box.width * view.zoom, bottom = top + Math.min(box.height * view.zoom, stage.clientHeight - 2 * margin);
    const dx = left < margin ? margin - left : right > stage.clientWidth - margin ? Math.max(stage.clientWidth - margin - right, margin - left) : 0;
    const dy = top < margin ? margin - top : bottom > stage.clientHeight - margin ? stage.clientHeight - margin - bottom : 0;
    if (dx || dy) set(view.x + dx, view.y + dy, view.zoom);
  }

  // --- wheel and fingers ----------------------------------------------------------------------------------------
  const place = (event) => {
    const box = stage.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 24 : 1;
    // A touchpad moves with two fingers and pinches with Ctrl; a wheel, which only goes up and down in large steps, zooms.
    const isPad = !event.ctrlKey && (event.deltaX !== 0 || (Math.abs(event.deltaY) < 40 && event.deltaMode === 0));
    if (isPad && !event.shiftKey) pan(-event.deltaX, -event.deltaY);
    else if (event.shiftKey) pan(-(event.deltaX || event.deltaY) * lines, 0);
    else zoom(Math.exp((-event.deltaY * lines) / (event.ctrlKey ? 120 : 420)), place(event));
  }, { passive: false });

  const fingers = new Map();
  let dragged = false, spread = 0;
  stage.addEventListener("pointerdown", (event) => {
    if (event.button > 0 || event.target.closest(".floats")) return;
    fingers.set(event.pointerId, place(event));
    if (fingers.size === 1) dragged = false;
    spread = 0;
  });
  stage.addEventListener("pointermove", (event) => {
    const from = fingers.get(event.pointerId);
    if (!from) return;
    if (event.pointerType === "mouse" && !event.buttons) return void fingers.delete(event.pointerId);
    const to = place(event);
    const far = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!dragged && far < 4) return;
    if (!dragged) stage.setPointerCapture(event.pointerId);
    dragged = true;
    fingers.set(event.pointerId, to);
    if (fingers.size === 1) return pan(to[0] - from[0], to[1] - from[1]);
    const [one, two] = [...fingers.values()];
    const next = Math.hypot(one[0] - two[0], one[1] - two[1]);
    pan((to[0] - from[0]) / 2, (to[1] - from[1]) / 2);
    if (spread) zoom(next / spread, [(one[0] + two[0]) / 2, (one[1] + two[1]) / 2]);
    spread = next;
  });
  for (const name of ["pointerup", "pointercancel"]) stage.addEventListener(name, (event) => {
    fingers.delete(event.pointerId);
    spread = 0;
  });
  // The click that ends a drag is no click on what lies below.
  stage.addEventListener("click", (event) => {
    if (dragged) event.stopPropagation();
    dragged = false;
  }, true);

  return { view, pan, zoom, set, fit, show, setBounds: (next) => (bounds = next), isDragging: () => dragged && fingers.size > 0 };
};
