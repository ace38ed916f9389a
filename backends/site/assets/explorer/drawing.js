// Draws the scene as SVG: homes, boxes, arrows and labels. What is dimmed turns muted, never transparent.
"use strict";
archgenExplorer.makeDrawing = function (map, layers) {
  const { shape, layOut } = archgenExplorer;
  const MAX_LABELS = 30;
  const MOVE = { duration: 160, easing: "ease-out" };
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  let scene = null, nodes = new Map(), arrowNodes = new Map(), places = new Map();

  function draw(next, colouring, isSameLevel) {
    scene = next;
    const before = isSameLevel ? places : new Map();
    nodes = new Map();
    arrowNodes = new Map();
    places = new Map();
    const shown = scene.boxes.filter((box) => !box.hidden);
    layers.frames.replaceChildren(...shown.filter((box) => box.open).map((box) => drawFrame(box, colouring)));
    layers.boxes.replaceChildren(...shown.filter((box) => !box.open).map((box) => drawBox(box, colouring)));
    layers.edges.replaceChildren(...scene.arrows.map(drawArrow));
    layers.lit.replaceChildren();
    for (const box of shown) places.set(box.id, [box.x, box.y]);
    if (before.size && !calm.matches) glide(before);
  }

  // Boxes that were there before move to their places; arrows come when they have arrived.
  function glide(before) {
    let moved = false;
    for (const [id, [x, y]] of places) {
      const old = before.get(id);
      if (!old || (old[0] === x && old[1] === y)) continue;
      moved = true;
      nodes.get(id).animate([{ transform: `translate(${old[0]}px, ${old[1]}px)` }, { transform: `translate(${x}px, ${y}px)` }], MOVE);
    }
    if (moved) layers.edges.animate([{ visibility: "hidden" }, { visibility: "visible" }], MOVE);
  }

  function drawTexts(lines, name, x, y, step) {
    return lines.map((line, at) => {
      const text = shape("text", { class: name, x, y: y + at * step, "aria-hidden": "true" });
      text.textContent = line;
      return text;
    });
  }

  function makeNode(box, colouring, ...children) {
    const hue = box.element && box.kind !== "fold" ? hueOf(box, colouring) : "hue-none";
    const inner = box.element?.isComposed ? ` composed${countFrames(box) % 2 ? " odd" : ""}` : "";
    const node = shape("g", { class: `box ${box.kind} ${hue}${inner}${box.picked ? " picked" : ""}`, transform: `translate(${box.x} ${box.y})`, role: "button", tabindex: -1,
      "data-box": box.id }, ...children);
    const title = shape("title"); // the tooltip, and the name that is read aloud
    title.textContent = box.tip;
    node.prepend(title);
    nodes.set(box.id, node);
    return node;
  }

  const countFrames = (box) => (box.parent ? 1 + countFrames(box.parent) : 0);

  // A closed home has the colour of its members where they agree.
  function hueOf(box, colouring) {
    const classes = new Set((box.shown.length ? box.shown : box.members).map(colouring.classOf));
    return classes.size === 1 ? [...classes][0] : colouring.key === "group" && box.element ? `hue-${box.home.number % 10}` : "hue-none";
  }

  // The bar at the left: a piece for each colour, as long as its share.
  function drawBars(box, colouring) {
    const members = box.shown.length ? box.shown : box.members;
    const counts = new Map();
    for (const member of members) counts.set(colouring.classOf(member), (counts.get(colouring.classOf(member)) ?? 0) + 1);
    if (!counts.size) counts.set("hue-none", 1);
    const total = Math.max(1, members.length), height = box.height - 14;
    let y = 7;
    return [...counts].sort(([a], [b]) => (a < b ? -1 : 1)).map(([name, count]) => {
      const bar = shape("rect", { class: `stripe ${name}`, x: 3.5, y, width: 3.5, height: Math.max(1, (height * count) / total), rx: 1 });
      y += (height * count) / total;
      return bar;
    });
  }

  function drawBox(box, colouring) {
    const { width, height } = box;
    const parts = [];
    if (box.opens || box.kind === "fold") parts.push(shape("rect", { class: "under", x: 3, y: -4, width: width - 6, height: 20, rx: 8 }));
    parts.push(shape("rect", { class: "shell", width, height, rx: 8 }), ...drawBars(box, colouring));
    const far = layOut.wrap(box.title, width - 18, 2, "600 20px Inter, system-ui, sans-serif");
    parts.push(...drawTexts(box.lines, "title near", 14, 20, 16), ...drawTexts(far, "title far", 12, far.length > 1 ? 20 : 31, 21));
    parts.push(...drawTexts([layOut.cut(box.line, width - (box.opens ? 44 : 26), "400 12px Inter, system-ui, sans-serif")], "line", 14, height - 11, 0));
    if (box.severity) parts.push(drawBadge(box));
    if (box.opens || box.kind === "fold") parts.push(shape("path", { class: "sign", d: `M${width - 22} ${height - 15}h10m-5 -5v10` }));
    parts.push(shape("rect", { class: "ring", x: -4, y: -4, width: width + 8, height: height + 8, rx: 11 }));
    return makeNode(box, colouring, ...parts);
  }

  function drawBadge({ width, severity }) {
    const sign = { error: "M-3 -3L3 3M3 -3L-3 3", warning: "M0 -5L5 4H-5ZM0 -2v3", note: "M0 -1v4M0 -4v1" }[severity];
    return shape("path", { class: `badge ${severity}`, transform: `translate(${width - 12} 13)`, d: sign });
  }

  function drawFrame(box, colouring) {
    const { width, height } = box;
    const sign = shape("g", { class: "fold-sign" }, shape("rect", { x: width - 38, y: 12, width: 24, height: 24, rx: 6 }),
      shape("path", { d: `M${width - 31} 24h10` }));
    return makeNode(box, colouring, shape("rect", { class: "shell open", width, height, rx: 12 }),
      ...drawTexts(box.lines, "title near", 20, 27, 18), ...drawTexts([layOut.cut(box.line, width - 40, "400 12px Inter, system-ui, sans-serif")], "line", 20, 45, 0),
      ...drawTexts([layOut.cut(box.title, width - 30, "600 28px Inter, system-ui, sans-serif")], "title farthest", 16, 40, 0), sign,
      shape("rect", { class: "ring", x: -4, y: -4, width: width + 8, height: height + 8, rx: 15 }));
  }

  function drawArrow(arrow) {
    const count = arrow.flows.length + (arrow.way && arrow.twin ? arrow.twin.flows.length : 0);
    const weight = count > 3 ? "many" : count > 1 ? "some" : "one";
    const [x, y] = arrow.stop, back = -arrow.direction;
    const feedback = arrow.way && arrow.turn !== "loop" && back > 0 ? " feedback" : "";
    const node = shape("g", { class: `arrow ${weight} ${arrow.style}${arrow.optional ? " optional" : ""}${arrow.made ? " made" : ""}${feedback}`, "data-arrow": arrow.id },
      shape("path", { class: "hit", d: arrow.path }), shape("path", { class: "way", d: arrow.path }),
      ...(arrow.style === "physical" ? [shape("path", { class: "core", d: arrow.path })] : []),
      shape("path", { class: "head", d: arrow.isUpright ? `M${x} ${y}l-4 ${back * 8}h8z` : `M${x} ${y}l${back * 8} -4v8z${arrow.medium ? `m${back * 9} -4v8h${back * 7}v-8z` : ""}` }),
      ...(arrow.way && arrow.flows.length > 1 ? drawTexts([arrow.flows.length], `number ${back > 0 ? "right" : "left"}`, ...(arrow.isUpright ? [x + back * 7, y + back * 9 + 4] : [x + back * 11, y + 4]), 0) : []));
    const title = shape("title");
    title.textContent = arrow.tip;
    node.prepend(title);
    arrowNodes.set(arrow.id, node);
    return node;
  }

  // --- what is lit: a Set of boxes and a Map of arrows to their side, or null for everything --------------------------
  function light(boxes, arrows) {
    map.classList.toggle("dims", Boolean(boxes));
    for (const box of scene.boxes) nodes.get(box.id)?.classList.toggle("lit", Boolean(boxes?.has(box)));
    const labels = [];
    const raised = [], plain = [];
    for (const arrow of scene.arrows) {
      const node = arrowNodes.get(arrow.id);
      const side = arrows?.get(arrow);
      node.classList.toggle("lit", side !== undefined);
      for (const name of ["before", "after"]) node.classList.toggle(name, side === name);
      (side === undefined ? plain : raised).push(node);
      if (side !== undefined) labels.push(arrow);
    }
    layers.edges.replaceChildren(...plain);
    layers.lit.replaceChildren(...raised);
    layers.labels.replaceChildren(...(labels.length <= MAX_LABELS ? placeLabels(labels) : []));
  }

  // Labels that would cover one another are moved down; what finds no place is left to the panel and the tooltip.
  function placeLabels(arrows) {
    const taken = scene.boxes.filter((box) => !box.open && !box.hidden).map(({ x, y, width, height }) => [x, y, x + width, y + height]);
    const placed = [];
    for (const arrow of arrows) {
      const lines = [...nameFlows(arrow.shownFlows), ...nameMedia(arrow.shownFlows)].map((name) => layOut.cut(name, 150, "500 12px Inter, system-ui, sans-serif"));
      const width = Math.max(...lines.map((line) => layOut.measure(line, "500 12px Inter, system-ui, sans-serif"))) + 10;
      const height = lines.length * 15 + 4;
      const [x, y] = arrow.labelAt;
      const shift = [0, 16, -16, 32, -32, 48, -48].find((down) => {
        const own = [x - width / 2, y - height / 2 + down, x + width / 2, y + height / 2 + down];
        return taken.every(([left, top, right, bottom]) => own[2] < left || own[0] > right || own[3] < top || own[1] > bottom);
      });
      if (shift === undefined) continue;
      const top = y - height / 2 + shift;
      taken.push([x - width / 2, top, x + width / 2, top + height]);
      placed.push(shape("g", { class: "label" }, shape("rect", { x: x - width / 2, y: top, width, height, rx: 4 }),
        ...drawTexts(lines, "name", x, top + 14, 15)));
    }
    return placed;
  }

  function nameFlows(flows) {
    const names = [...new Set(flows.flatMap((flow) => (flow.types.length ? flow.types : [flow.label])))];
    const warnings = [...new Set(flows.map((flow) => flow.warning).filter(Boolean))].map((warning) => `(${warning})`);
    const lines = names.length <= 2 ? names.map((name, at) => (at < names.length - 1 ? name + "," : name)) : [archgenExplorer.count(flows.length, "flow")];
    return [...lines, ...warnings];
  }

  // As in the pictures: what is no ROS, in brackets.
  function nameMedia(flows) {
    const media = [...new Set(flows.map(({ medium }) => medium).filter(Boolean))];
    return media.length ? [`(${media.join(", ")})`] : [];
  }

  function mark(box, name, isOn) {
    nodes.get(box?.id)?.classList.toggle(name, isOn);
  }

  return { draw, light, mark, nodeOf: (box) => nodes.get(box.id), arrowNodeOf: (arrow) => arrowNodes.get(arrow.id) };
};
