// Puts the explorer together: from the address to a scene, from a scene to the screen, and from clicks and keys back to the address.
"use strict";
(function () {
  const { element, shape, grammar } = archgenExplorer;
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
  let scene = null, bounds = null, level = null, choice = null, pickedArrow = null, drawnLevel = "", closedWay = "", fitView = "", fitWidth = 0;

  const store = archgenExplorer.makeState((problems) => render(problems ?? []), begin);
  const { state } = store;
  const actions = { state, colours, level: () => level, change: store.change, step, save, say: (text) => sayOnce(text), toggleAll, toggle, openHome, showAll, showLonger, showWays, focus: focusOn,
    pick, pickBox, pickArrow, pickedName: () => (choice.picked?.kind === "host" ? "" : choice.picked?.id ?? "") };
  const camera = archgenExplorer.makeCamera(stage, map, (view) => minimap.follow(view), ({ x, y, zoom }) => store.moved([x, y, zoom]));
  const minimap = archgenExplorer.makeMinimap(camera, stage);
  const drawing = archgenExplorer.makeDrawing(map, layers);
  const durations = archgenExplorer.makeDurations(model);
  const panel = archgenExplorer.makePanel(model, root, actions, durations);
  const tools = archgenExplorer.makeTools(model, actions);
  const legend = archgenExplorer.makeLegend(actions);
  const list = archgenExplorer.makeList(actions);
  const keys = archgenExplorer.makeKeys(actions, camera, { tools, stage, boxes: () => scene.boxes, drawing, unlight: () => light.settle() });
  const light = archgenExplorer.makeLight(drawing, camera, stage);
  const status = element("div", { className: "spoken", role: "status" });
  const zoomTools = element("div", { className: "zoom joined floats", role: "group", ariaLabel: "Zoom" }, [["−", 0.8, "Smaller"], ["+", 1.25, "Larger"], ["Fit", 0, "Fit into the window"]].map(([text, factor, name]) => {
    const button = element("button", { type: "button", textContent: text, ariaLabel: name });
    button.addEventListener("click", () => (factor ? camera.zoom(factor) : fitAll()));
    return button;
  }), keys.opener);
  stage.append(legend.box, legend.notes, element("div", { className: "corner floats" }, minimap.svg, zoomTools));
  document.querySelector("main").append(element("div", { className: "explorer" }, tools.bar,
    element("div", { className: "desk" }, stage, list.root, panel.panel), status, keys.dialog));

  // Without an address: what is readable with its groups open needs no click to show what is inside; what no telephone shows
  // in a readable size begins as a list.
  const MANY_BOXES = 30, MANY_HOMES = 20, NARROW = 720; // px
  function begin(first) {
    if (!model.components.length) first.level = "nodes";
    const { homes, children } = levelOf(first.level);
    const count = homes.reduce((sum, home) => sum + children.get(home).length, 0);
    if (count <= MANY_BOXES && innerWidth > NARROW) first.open = ["*"];
    first.list = homes.length > MANY_HOMES && innerWidth <= NARROW;
  }

  // --- from the address to the screen ---------------------------------------------------------------------------
  function render(problems = []) {
    const hints = [...problems, ...resolvePage()];
    level = levelOf(state.level);
    const isSame = drawnLevel === state.level, old = bounds;
    choice = archgenExplorer.readChoice(model, select, state, level);
    const shows = colours.makeFilter(state.only);
    scene = archgenExplorer.makeScene(level, { ...choice, shows, full: state.full, pickedArrow: state.pick });
    archgenExplorer.describeScene(scene, level);
    bounds = archgenExplorer.layOut(scene, level);
    scene.arrows = scene.arrows.filter(({ tail, head }) => !tail.hidden && !head.hidden);
    archgenExplorer.routeArrows(scene, bounds);
    camera.setBounds(bounds);
    pickedArrow = scene.arrows.find(({ id }) => id === state.pick) ?? null;
    show(isSame, [...hints, ...choice.hints], level.members.filter(shows).length, old);
  }

  function show(isSame, hints, shownCount, old) {
    const focused = document.activeElement?.dataset?.box;
    const colouring = colours.colourLevel(level, state.colour);
    drawing.draw(scene, colouring, isSame);
    drawnLevel = state.level;
    showPanel();
    const litBoxes = light.show({ scene, lit: choice.lit, pickedArrow });
    minimap.draw(scene, bounds);
    legend.draw(scene, colouring, Boolean(choice.lit || choice.picked));
    legend.say(scene, choice, hints);
    list.draw(scene, state.list);
    stage.classList.toggle("gone", state.list);
    tools.update({ state, ...choice, shownCount, homes: level.homes });
    keys.settle(focused, choice.picked);
    place(old, isSame, litBoxes);
  }

  // Where the window looks: as the address says, else at all, else it moves only as far as what is lit needs.
  function place(old, isSame, litBoxes) {
    if (state.at) return camera.set(...state.at);
    // Where all was in sight, it stays so when the panel comes or goes.
    const { x, y, zoom } = camera.view;
    const wasFit = `${x} ${y} ${zoom}` === fitView;
    if (!old || !isSame || (wasFit && stage.clientWidth !== fitWidth)) {
      camera.fit();
      fitWidth = stage.clientWidth;
      fitView = `${camera.view.x} ${camera.view.y} ${camera.view.zoom}`;
    }
    showLit(litBoxes);
  }

  function showLit(litBoxes) {
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
    if (address === null) return [];
    for (const [name, things] of [["components", [...model.shells, ...model.components, ...model.groups]], ["nodes", model.nodes], ["hosts", model.hosts]]) {
      const found = things.find((each) => each.address === address);
      if (found) {
        Object.assign(state, { level: name, pick: found.id });
        return [];
      }
    }
    return ["What was chosen has no box on the map."];
  }

  // --- from clicks back to the address --------------------------------------------------------------------------
  stage.addEventListener("click", (event) => {
    if (event.target.closest(".floats")) return;
    const target = light.targetOf(event);
    if (!target) return void (state.pick && store.change({ pick: "" }));
    if (target.tail) pickArrow(target);
    else if (event.target.closest(".sign, .fold-sign") || (event.target.closest("[data-box]") && isAtSign(event, target))) toggle(target);
    else pickBox(target);
  });
  stage.addEventListener("dblclick", (event) => {
    const target = light.targetOf(event);
    if (target && !target.tail && target.opens) toggle(target);
  });

  // The sign itself is small: the corner round it counts as well.
  function isAtSign(event, box) {
    if (!box.opens) return false;
    const at = stage.getBoundingClientRect();
    const x = (event.clientX - at.left - camera.view.x) / camera.view.zoom - box.x, y = (event.clientY - at.top - camera.view.y) / camera.view.zoom - box.y;
    return x > box.width - 42 && (box.open ? y < 44 : y > box.height - 30);
  }

  function showPanel() {
    const { picked } = choice;
    const box = scene.boxes.find((each) => each.id === state.pick);
    if (pickedArrow) panel.showArrow(pickedArrow);
    else if (picked?.isComposed) panel.showShell(picked, level);
    else if (picked && level.isHome(picked)) panel.showHome(picked, level.children.get(picked));
    else if (picked) panel.showMember(picked);
    else if (box?.kind === "fold") panel.showFold(box);
    else if (!showDuration()) panel.hide();
  }

  // Of a selector that is a way (`a..b`), until it is closed: how long that takes.
  function showDuration() {
    const { ends } = choice.selection ?? {};
    const way = ends && choice.lit && closedWay !== state.sel ? durations.measure(ends) : null;
    if (way) panel.showWay(way, state.sel);
    return Boolean(way);
  }

  // What the way that the panel tells goes through is open on the map.
  function showWays(sel) {
    const { ends } = select(sel);
    const rows = (ends && durations.measure(ends)?.rows) ?? [];
    const passed = rows.flatMap(({ activity }) => (level.members === model.nodes ? [model.nodes[activity.node]] : activity.components.map((at) => model.components[at])));
    const around = passed.flatMap((each) => level.aroundOf(each)).map(({ id }) => id);
    store.change({ sel, at: null, open: archgenExplorer.unique([...state.open, ...around]) });
  }

  // Elements of another kind than the level shows lead to theirs.
  function pick(each) {
    if (!each) {
      if (!state.pick) closedWay = state.sel;
      return store.change({ pick: "" });
    }
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
    const each = box.element;
    if (!each || !level.opens) return;
    const y = box.y * camera.view.zoom + camera.view.y, x = box.x * camera.view.zoom + camera.view.x;
    const { open, picked } = choice;
    // With a box all closes that is open inside.
    const inside = new Set(level.shells.filter((shell) => level.aroundOf(shell).includes(each)).map(({ id }) => id).concat(each.id));
    const parts = { open: box.open ? open.filter((id) => !inside.has(id)) : [...open, each.id], at: null };
    if (box.open && picked && level.aroundOf(picked).includes(each)) parts.pick = each.id;
    keepView(() => store.change(parts), each, x, y);
  }

  // What was clicked stays under the pointer.
  function keepView(act, each, x, y) {
    state.at = null;
    act();
    const box = scene.boxes.find(({ element: shown }) => shown === each);
    if (box) camera.set(x - box.x * camera.view.zoom, y - box.y * camera.view.zoom, camera.view.zoom);
    const tooWide = box && box.open && (box.x + box.width) * camera.view.zoom + camera.view.x > stage.clientWidth;
    if (tooWide) camera.show(box);
  }

  function openHome(home) {
    store.change({ open: [...choice.open.filter((id) => id !== home.id), home.id], pick: home.id });
  }

  function toggleAll() {
    store.change({ open: choice.open.length ? [] : [level.shells.length ? "**" : "*"], at: null, pick: "" });
    fitAll();
  }

  function showAll() {
    store.change({ full: true });
  }

  function showLonger() {
    store.change({ ways: !state.ways, at: null });
  }

  function focusOn(name, before, after) {
    const steps = (number) => (number === Infinity ? "" : String(number));
    const { picked } = choice;
    const around = picked ? level.aroundOf(picked).map(({ id }) => id) : [];
    store.change({ sel: `${before ? steps(before) + "+" : ""}${name}${after ? "+" + steps(after) : ""}`, at: null, open: archgenExplorer.unique([...state.open, ...around]) });
  }

  function step(side, by) {
    const { focus, picked } = choice;
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
    const MARGIN = 24;
    const room = { left: bounds.left - MARGIN, top: bounds.top - MARGIN, right: bounds.right + MARGIN, bottom: bounds.bottom + MARGIN };
    archgenSavePicture(Object.values(layers), room, ground, name, format).catch(() => sayOnce("The browser could not draw this picture: it may be too large for it."));
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
  function start() {
    const hints = store.read();
    render(hints);
    leavePage();
  }
  // What the page is without a script is not shown: it is there on paper alone.
  function leavePage() {
    const held = [...document.querySelectorAll("main > :not(.explorer, h1)")];
    const paper = matchMedia("print");
    const settle = () => (paper.matches ? document.querySelector("main").append(...held) : held.forEach((part) => part.remove()));
    paper.addEventListener("change", settle);
    settle();
  }
  // Widths of texts are those of the font that is drawn; where it does not come, those of the next best.
  Promise.race([document.fonts.load("600 13px Inter"), new Promise((done) => setTimeout(done, 400))]).then(start, start);
})();
