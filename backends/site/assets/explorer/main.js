// Puts the explorer together: from the address to a scene, from a scene to the screen, and from clicks and keys back to the address.
"use strict";
(function () {
  const { element, shape, count, grammar } = archgenExplorer;
  const HOVER_DELAY = 120; // ms
  const root = new URL("../..", document.querySelector('script[src$="assets/explorer/data.js"]').src).href;
  const model = archgenExplorer.readModel();
  const select = archgenExplorer.makeSelector(model);
  const colours = archgenExplorer.makeColours(model);
  const levels = new Map();
  const levelOf = (name) => levels.get(name) ?? levels.set(name, archgenExplorer.readLevel(model, name)).get(name);

  // --- what stands on the page ----------------------------------------------------------------------------------
  const layers = Object.fromEntries(["frames", "edges", "boxes", "lit", "labels"].map((name) => [name, shape("g", { class: name })]));
  const map = shape("svg", { class: "map", role: "group", "aria-label": "Map. Arrow keys go from box to box, Enter shows details, question mark lists all keys." },
    layers.frames, layers.edges, layers.boxes, layers.lit, layers.labels);
  const stage = element("div", { className: "stage", tabIndex: -1 }, map);
  let scene = null, bounds = null, level = null, picked = null, pickedArrow = null, lit = null, focus = null, drawnLevel = "", hints = [];

  const store = archgenExplorer.makeState((problems) => render(problems ?? []));
  const { state } = store;
  const actions = { state, colours, level: () => level, change: store.change, step, save, say: (text) => sayOnce(text), toggleAll, toggle, openHome, showAll, focus: focusOn,
    pick, pickBox, pickArrow, pickedName: () => (picked?.id && picked.kind !== "host" ? picked.id : "") };
  const camera = archgenExplorer.makeCamera(stage, map, (view) => minimap.follow(view), ({ x, y, zoom }) => store.moved([x, y, zoom]));
  const minimap = archgenExplorer.makeMinimap(camera, stage);
  const drawing = archgenExplorer.makeDrawing(map, layers);
  const panel = archgenExplorer.makePanel(model, root, actions);
  const tools = archgenExplorer.makeTools(model, actions);
  const legend = archgenExplorer.makeLegend(actions);
  const list = archgenExplorer.makeList(actions);
  const keys = archgenExplorer.makeKeys(actions, camera, { tools, stage, boxes: () => scene.boxes, drawing, unlight: () => light() });
  const status = element("div", { className: "spoken", role: "status" });
  const zoomTools = element("div", { className: "zoom joined floats", role: "group", ariaLabel: "Zoom" }, [["−", 0.8, "Smaller"], ["+", 1.25, "Larger"], ["Fit", 0, "Fit into the window"]].map(([text, factor, name]) => {
    const button = element("button", { type: "button", textContent: text, ariaLabel: name });
    button.addEventListener("click", () => (factor ? camera.zoom(factor) : fitAll()));
    return button;
  }), keys.opener);
  stage.append(legend.box, legend.notes, element("div", { className: "corner floats" }, minimap.svg, zoomTools));
  document.querySelector("main").append(element("div", { className: "explorer" }, tools.bar,
    element("div", { className: "desk" }, stage, list.root, panel.panel), status, keys.dialog));

  // --- from the address to the screen ---------------------------------------------------------------------------
  function render(problems = []) {
    hints = [...problems];
    resolvePage();
    level = levelOf(state.level);
    const isSame = drawnLevel === state.level;
    readPick();
    const selection = state.sel ? select(state.sel) : null;
    readFocus(selection);
    const shows = colours.makeFilter(state.only);
    const makeAsk = { open: listOpen(), lit, picked, shows, full: state.full, sideOf: makeSides(), pickedArrow: state.pick };
    scene = archgenExplorer.makeScene(level, makeAsk);
    scene.boxes.forEach(describe);
    for (const arrow of scene.arrows) arrow.tip = `${arrow.tail.title} → ${arrow.head.title}\n${arrow.flows.slice(0, 8).map(({ label }) => label).join("\n")}`;
    const old = bounds;
    bounds = archgenExplorer.layOut(scene, level);
    const hidden = scene.arrows.filter(({ tail, head }) => tail.hidden || head.hidden);
    scene.arrows = scene.arrows.filter((arrow) => !hidden.includes(arrow));
    archgenExplorer.routeArrows(scene, bounds);
    camera.setBounds(bounds);
    const focused = document.activeElement?.dataset?.box;
    const colouring = colours.colourLevel(level, state.colour);
    drawing.draw(scene, colouring, isSame);
    drawnLevel = state.level;
    pickedArrow = scene.arrows.find(({ id }) => id === state.pick) ?? null;
    showPanel();
    const litBoxes = light();
    minimap.draw(scene, bounds);
    legend.draw(scene, colouring, Boolean(lit || picked));
    legend.say(scene, selection?.problems ?? [], hints);
    list.draw(scene, state.list);
    stage.classList.toggle("gone", state.list);
    tools.update({ state, selection, lit, shownCount: level.members.filter(shows).length, focus, homes: level.homes });
    keys.settle(focused, picked);
    place(old, isSame, litBoxes);
  }

  // Where the window looks: as the address says, else at all, else it moves only as far as what is lit needs.
  function place(old, isSame, litBoxes) {
    if (state.at) return camera.set(...state.at);
    if (!old || !isSame) camera.fit();
    const boxes = [...(litBoxes ?? [])].filter((box) => !box.open);
    if (!boxes.length) return;
    const area = { left: Math.min(...boxes.map((box) => box.x)), right: Math.max(...boxes.map((box) => box.x + box.width)),
      top: Math.min(...boxes.map((box) => box.y)), bottom: Math.max(...boxes.map((box) => box.y + box.height)) };
    const { x, y, zoom } = camera.view;
    const isInside = area.left * zoom + x > 0 && area.right * zoom + x < stage.clientWidth && area.top * zoom + y > 0 && area.bottom * zoom + y < stage.clientHeight;
    if (!isInside || zoom < 0.6) camera.fit(area, 1);
  }

  // `page=components/x.html` of the site's search: the element whose page that is.
  function resolvePage() {
    const address = new URLSearchParams(location.hash.slice(1)).get("page");
    if (address === null) return;
    for (const [name, things] of [["components", [...model.components, ...model.groups]], ["nodes", model.nodes], ["hosts", model.hosts]]) {
      const found = things.find((each) => each.address === address);
      if (found) return void Object.assign(state, { level: name, pick: found.id });
    }
    hints.push("What was chosen has no box on the map.");
  }

  function readPick() {
    picked = null;
    if (!state.pick || state.pick.includes(">")) return;
    picked = level.members.find(({ id }) => id === state.pick) ?? level.homes.find(({ id }) => id === state.pick) ?? null;
    if (picked && !level.opens && !level.homes.includes(picked)) picked = level.homes[level.homeOf(picked)];
    if (!picked) {
      const guess = archgenExplorer.findClosest(state.pick, [...level.members, ...level.homes].map(({ id }) => id));
      hints.push(`${state.pick} is not here${guess ? `; nearest: ${guess}` : ""}.`);
    }
  }

  function listOpen() {
    const open = state.open.includes("*") ? level.homes.map(({ id }) => id) : [...state.open];
    const unknown = open.filter((id) => id && !level.homes.some((home) => home.id === id));
    for (const id of unknown) {
      const guess = archgenExplorer.findClosest(id, level.homes.map((home) => home.id));
      hints.push(`${id} is not here${guess ? `; nearest: ${guess}` : ""}.`);
    }
    if (picked && !level.homes.includes(picked)) open.push(level.homes[level.homeOf(picked)].id);
    return [...new Set(open)];
  }

  const numbersOf = (selection) => (level.members === model.nodes ? selection.nodes : selection.components);

  function readFocus(selection) {
    const isWrong = selection?.problems.some(({ severity }) => severity === "error");
    lit = selection && !isWrong ? numbersOf(selection) : null;
    focus = null;
    const words = state.sel ? grammar.parse(state.sel).words : [];
    if (lit && words.length === 1 && !words[0].negative && !words[0].rangeEnd) {
      const { atom, before, after } = words[0];
      const steps = (number) => (number === grammar.ALL_STEPS ? Infinity : number);
      focus = { atom: state.sel.slice(atom.start, atom.end), before: steps(before), after: steps(after) };
    }
  }

  // Whether a flow leads towards what is focused, comes from it within the steps asked for, or neither.
  function makeSides() {
    const base = focus ? numbersOf(select(focus.atom)) : null;
    if (!base) return () => "plain";
    const steps = level.members === model.nodes ? model.nodeSteps : model.componentSteps;
    const [before, after] = [measure(steps.before, base), measure(steps.after, base)];
    return ({ tail, head }) => {
      const feeds = before.get(head) < focus.before ? before.get(head) : Infinity, fed = after.get(tail) < focus.after ? after.get(tail) : Infinity;
      return Math.min(feeds, fed) === Infinity ? "" : feeds <= fed ? "before" : "after";
    };
  }

  function measure(neighbours, starts) {
    const distances = new Map([...starts].map((at) => [at, 0]));
    for (const [at, distance] of distances) for (const other of neighbours[at]) if (!distances.has(other)) distances.set(other, distance + 1);
    return distances;
  }

  function describe(box) {
    const { element: each } = box;
    const noun = box.members[0]?.kind ?? "element";
    const number = box.shown.length === box.members.length ? String(box.members.length) : `${box.shown.length} of ${box.members.length}`;
    if (box.kind === "fold") box.line = box.homes ? "open one in the panel" : "folded, + shows them";
    else if (box.parent) box.line = each.line;
    else if (box.open) box.line = [each.owners, box.shown.length === box.members.length ? count(box.members.length, noun) : `${number} ${noun}s`].filter(Boolean).join(" · ");
    else box.line = [each.owners || each.line, `${number}${each.owners ? "" : ` ${noun}${box.members.length === 1 ? "" : "s"}`}`].filter(Boolean).join(" · ");
    const severities = box.shown.map((member) => member.severity);
    box.severity = box.open ? "" : ["error", "warning", "note"].find((severity) => severities.includes(severity)) ?? "";
    box.name = [box.title, box.kind, box.line, box.severity && `has ${box.severity}s`, box.opens && !box.parent ? (box.open ? "open" : "closed") : ""].filter(Boolean).join(", ");
    box.tip = [box.title, each?.id, box.line].filter(Boolean).join("\n");
  }

  // --- what is lit ----------------------------------------------------------------------------------------------
  function light() {
    const boxes = new Set(), arrows = new Map();
    if (lit) {
      for (const box of scene.boxes) if (box.lit) boxes.add(box);
      for (const arrow of scene.arrows) if (arrow.lit) arrows.set(arrow, arrow.side);
    } else if (pickedArrow) addArrow(pickedArrow, "plain", boxes, arrows);
    else {
      const box = scene.boxes.find((each) => each.picked);
      if (!box || box.open) return drawing.light(null, null), box ? [box] : null;
      lightAround(box, boxes, arrows);
    }
    if (lit && pickedArrow) arrows.set(pickedArrow, arrows.get(pickedArrow) ?? "plain");
    drawing.light(boxes, arrows);
    return boxes;
  }

  function addArrow(arrow, side, boxes, arrows) {
    arrows.set(arrow, side);
    for (const box of [arrow.tail, arrow.head]) boxes.add(box).add(box.parent ?? box);
  }

  function lightAround(box, boxes, arrows) {
    boxes.add(box).add(box.parent ?? box);
    for (const arrow of scene.arrows) {
      if (arrow.head === box) addArrow(arrow, "before", boxes, arrows);
      else if (arrow.tail === box) addArrow(arrow, "after", boxes, arrows);
    }
  }

  let waiting = 0, hovered = null;
  function hover(target) {
    clearTimeout(waiting);
    if (target === hovered) return;
    waiting = setTimeout(() => {
      hovered = target;
      const [boxes, arrows] = [new Set(), new Map()];
      if (!target || target.open || camera.isDragging()) return void light();
      if (target.tail) addArrow(target, "plain", boxes, arrows);
      else lightAround(target, boxes, arrows);
      drawing.light(boxes, arrows);
    }, target ? HOVER_DELAY : 60);
  }

  const targetOf = (event) => {
    const node = event.target.closest?.("[data-box], [data-arrow]");
    if (!node) return null;
    return node.dataset.box ? scene.boxes.find(({ id }) => id === node.dataset.box) : scene.arrows.find(({ id }) => id === node.dataset.arrow);
  };
  stage.addEventListener("pointerover", (event) => event.pointerType === "mouse" && hover(targetOf(event)));
  stage.addEventListener("pointerleave", () => hover(null));
  stage.addEventListener("focusin", (event) => event.target.matches?.(":focus-visible") && hover(targetOf(event)));
  stage.addEventListener("focusout", () => hover(null));

  // --- from clicks back to the address --------------------------------------------------------------------------
  stage.addEventListener("click", (event) => {
    if (event.target.closest(".floats")) return;
    const target = targetOf(event);
    if (!target) return void (state.pick && store.change({ pick: "" }));
    if (target.tail) pickArrow(target);
    else if (event.target.closest(".sign, .fold-sign") || (event.target.closest("[data-box]") && isAtSign(event, target))) toggle(target);
    else pickBox(target);
  });
  stage.addEventListener("dblclick", (event) => {
    const target = targetOf(event);
    if (target && !target.tail && target.opens) toggle(target);
  });

  // The sign itself is small: the corner round it counts as well.
  function isAtSign(event, box) {
    if (!box.opens || box.parent) return false;
    const at = stage.getBoundingClientRect();
    const x = (event.clientX - at.left - camera.view.x) / camera.view.zoom - box.x, y = (event.clientY - at.top - camera.view.y) / camera.view.zoom - box.y;
    return x > box.width - 42 && (box.open ? y < 44 : y > box.height - 30);
  }

  function showPanel() {
    const box = scene.boxes.find((each) => each.picked || each.id === state.pick);
    if (pickedArrow) panel.showArrow(pickedArrow);
    else if (picked && level.homes.includes(picked)) panel.showHome(picked, level.members.filter((member) => level.homeOf(member) === picked.number));
    else if (picked) panel.showMember(picked);
    else if (box?.kind === "fold") panel.showFold(box);
    else panel.hide();
  }

  // Elements of another kind than the level shows lead to theirs.
  function pick(each) {
    if (!each) return store.change({ pick: "" });
    const levelName = each.kind === "node" ? (state.level === "hosts" ? "hosts" : "nodes") : each.kind === "component" ? "components" : state.level;
    store.change({ pick: each.id, level: levelName, ...(levelName === state.level ? {} : { open: [], at: null }) });
  }

  function pickBox(box) {
    store.change({ pick: box.kind === "fold" ? box.id : box.element.id });
  }

  function pickArrow(arrow) {
    store.change({ pick: arrow.id });
  }

  function toggle(box) {
    if (box.kind === "fold") return pickBox(box);
    const home = box.home;
    if (!level.opens) return;
    const y = box.y * camera.view.zoom + camera.view.y, x = box.x * camera.view.zoom + camera.view.x;
    const open = listOpen();
    const parts = { open: box.open ? open.filter((id) => id !== home.id) : [...open, home.id], at: null };
    if (box.open && picked && !level.homes.includes(picked) && level.homeOf(picked) === home.number) parts.pick = home.id;
    keepView(() => store.change(parts), home, x, y);
  }

  // What was clicked stays under the pointer.
  function keepView(act, home, x, y) {
    state.at = null;
    act();
    const box = scene.boxes.find((each) => each.element === home);
    if (box) camera.set(x - box.x * camera.view.zoom, y - box.y * camera.view.zoom, camera.view.zoom);
    const tooWide = box && box.open && (box.x + box.width) * camera.view.zoom + camera.view.x > stage.clientWidth;
    if (tooWide) camera.show(box);
  }

  function openHome(home) {
    store.change({ open: [...state.open.filter((id) => id !== home.id && id !== "*"), home.id], pick: home.id });
  }

  function toggleAll() {
    store.change({ open: state.open.length ? [] : ["*"], at: null, pick: "" });
    fitAll();
  }

  function showAll() {
    store.change({ full: true });
  }

  function focusOn(name, before, after) {
    const steps = (number) => (number === Infinity ? "" : String(number));
    const home = picked && !level.homes.includes(picked) ? level.homes[level.homeOf(picked)].id : null;
    store.change({ sel: `${before ? steps(before) + "+" : ""}${name}${after ? "+" + steps(after) : ""}`, at: null, open: home && !state.open.includes(home) ? [...state.open, home] : state.open });
  }

  function step(side, by) {
    if (!focus && picked) return focusOn(picked.kind === "host" ? `host:${grammar.quote(picked.id)}` : picked.id, side === "before" ? 1 : 0, side === "after" ? 1 : 0);
    if (!focus) return;
    const next = { ...focus, [side]: focus[side] === Infinity ? (by < 0 ? 5 : Infinity) : Math.max(0, focus[side] + by) };
    focusOn(focus.atom, next.before, next.after);
  }

  function fitAll() {
    camera.fit();
    store.moved(null);
  }

  function save(format) {
    const ground = getComputedStyle(stage).backgroundColor;
    const name = `explorer-${state.level}${state.sel ? "-" + state.sel.replace(/[^\p{L}\p{N}]+/gu, "_") : ""}`;
    archgenExplorer.savePicture(Object.values(layers), bounds, ground, name, format).catch(() => sayOnce("The browser could not draw this picture: it may be too large for it."));
  }

  function sayOnce(text) {
    status.textContent = text;
    const note = element("p", { textContent: text });
    legend.notes.hidden = false;
    legend.notes.append(note);
    setTimeout(() => {
      note.remove();
      legend.notes.hidden = !legend.notes.childElementCount;
    }, 4000);
  }

  new ResizeObserver(() => minimap.follow(camera.view)).observe(stage);
  const start = () => render(store.read());
  // Widths of texts are those of the font that is drawn; where it does not come, those of the next best.
  Promise.race([document.fonts.load("600 13px Inter"), new Promise((done) => setTimeout(done, 400))]).then(start, start);
})();
