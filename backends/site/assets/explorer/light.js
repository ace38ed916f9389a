// What is lit: what the selector means, else the chosen box or arrow, and for a moment what the pointer or the focus is on.
"use strict";
archgenExplorer.makeLight = function (drawing, camera, stage) {
  const HOVER_DELAY = 120; // ms
  const LEAVE_DELAY = 60;
  let scene = null, lit = null, pickedArrow = null, waiting = 0, hovered = null;

  // A box with the frames around it.
  function addBox(box, boxes) {
    for (let each = box; each; each = each.parent) boxes.add(each);
  }

  function addArrow(arrow, side, boxes, arrows) {
    arrows.set(arrow, side);
    for (const box of [arrow.tail, arrow.head]) addBox(box, boxes);
  }

  function addAround(box, boxes, arrows) {
    addBox(box, boxes);
    for (const arrow of scene.arrows) {
      if (arrow.head === box) addArrow(arrow, "before", boxes, arrows);
      else if (arrow.tail === box) addArrow(arrow, "after", boxes, arrows);
    }
  }

  // Returns the boxes that the window should show, null where nothing is chosen.
  function settle() {
    const boxes = new Set(), arrows = new Map();
    if (lit) {
      for (const box of scene.boxes) if (box.lit) boxes.add(box);
      for (const arrow of scene.arrows) if (arrow.lit) arrows.set(arrow, arrow.side);
      if (pickedArrow) arrows.set(pickedArrow, arrows.get(pickedArrow) ?? "plain");
    } else if (pickedArrow) addArrow(pickedArrow, "plain", boxes, arrows);
    else {
      const box = scene.boxes.find((each) => each.picked);
      if (!box || box.open) {
        drawing.light(null, null);
        return box ? new Set([box]) : null;
      }
      addAround(box, boxes, arrows);
    }
    drawing.light(boxes, arrows);
    return boxes;
  }

  function show(next) {
    ({ scene, lit, pickedArrow } = next);
    clearTimeout(waiting);
    hovered = null;
    return settle();
  }

  function hover(target) {
    clearTimeout(waiting);
    if (target === hovered) return;
    waiting = setTimeout(() => {
      hovered = target;
      if (!target || target.open || camera.isDragging()) return void settle();
      const [boxes, arrows] = [new Set(), new Map()];
      if (target.tail) addArrow(target, "plain", boxes, arrows);
      else addAround(target, boxes, arrows);
      drawing.light(boxes, arrows);
    }, target ? HOVER_DELAY : LEAVE_DELAY);
  }

  // The box or the arrow that an event is on.
  function targetOf(event) {
    const node = event.target.closest?.("[data-box], [data-arrow]");
    if (!node) return null;
    const { box, arrow } = node.dataset;
    return (box ? scene.boxes.find(({ id }) => id === box) : scene.arrows.find(({ id }) => id === arrow)) ?? null;
  }
  stage.addEventListener("pointerover", (event) => event.pointerType === "mouse" && hover(targetOf(event)));
  stage.addEventListener("pointerleave", () => hover(null));
  stage.addEventListener("focusin", (event) => event.target.matches?.(":focus-visible") && hover(targetOf(event)));
  stage.addEventListener("focusout", () => hover(null));

  return { show, settle, targetOf };
};
