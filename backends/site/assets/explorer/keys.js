// Everything by keyboard: from box to box, open and close, focus and steps, zoom; and the list of all keys.
"use strict";
archgenExplorer.makeKeys = function (actions, camera, { tools, stage, boxes, drawing, unlight }) {
  const { element } = archgenExplorer;
  const HELP = [["← ↑ → ↓", "to the nearest box"], ["Enter", "details"], ["o", "open or close a group or composed component"], ["f", "focus: what feeds it and what it feeds"],
    ["[ ]", "fewer or more steps before"], ["{ }", "fewer or more steps after"], ["+ −", "zoom"], ["0", "all of the map"], ["Shift + arrows", "move the map"],
    ["s", "selector"], ["l", "list or map"], ["Esc", "close, clear"], ["/", "search everything"], ["?", "this list"]];
  let current = null;

  const dialog = element("dialog", { className: "keys-help", ariaLabel: "Keys" }, element("h2", { textContent: "Keys" }),
    element("dl", {}, HELP.map(([key, does]) => element("div", {}, element("dt", {}, element("kbd", { textContent: key })), element("dd", { textContent: does })))));
  const close = element("button", { type: "button", textContent: "Close" });
  close.addEventListener("click", () => dialog.close());
  dialog.append(close);
  const opener = element("button", { type: "button", textContent: "?", ariaLabel: "Keys" });
  opener.addEventListener("click", () => dialog.showModal());

  const shown = () => boxes().filter(({ hidden }) => !hidden);
  const middle = (box) => [box.x + box.width / 2, box.y + (box.open ? 24 : box.height / 2)];

  // One box is a stop for the Tab key: the one last chosen, else the first.
  function settle(focused, picked) {
    const all = shown();
    current = all.find(({ id }) => id === focused) ?? all.find(({ element: each }) => each && each === picked) ?? all.find(({ id }) => id === current?.id) ?? all[0] ?? null;
    drawing.nodeOf(current ?? {})?.setAttribute("tabindex", "0");
    if (focused) drawing.nodeOf(current ?? {})?.focus({ preventScroll: true });
  }

  function go(box) {
    if (!box) return;
    drawing.nodeOf(current)?.setAttribute("tabindex", "-1");
    current = box;
    const node = drawing.nodeOf(box);
    node.setAttribute("tabindex", "0");
    node.focus({ preventScroll: true });
    camera.show(box);
  }

  // The nearest box in a direction: what lies aside counts twice.
  function nearest(from, [dx, dy]) {
    const [x, y] = middle(from);
    let best = null, least = Infinity;
    for (const box of shown()) {
      const [toX, toY] = middle(box);
      const along = (toX - x) * dx + (toY - y) * dy, aside = Math.abs((toX - x) * dy) + Math.abs((toY - y) * dx);
      if (box === from || along <= 1) continue;
      const far = along + aside * 2;
      if (far < least) [best, least] = [box, far];
    }
    return best;
  }

  const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

  function onMap(event) {
    const direction = ARROWS[event.key];
    if (direction && event.shiftKey) camera.pan(direction[0] * -80, direction[1] * -80);
    else if (direction && current) go(nearest(current, direction));
    else if (event.key === "Enter" && current) {
      actions.pickBox(current);
      document.querySelector(".panel h2")?.focus();
    } else if (event.key === " " && current) actions.pickBox(current);
    else return false;
    return true;
  }

  const ANYWHERE = {
    o: () => current && actions.toggle(current.opens ? current : current.parent ?? current),
    f: () => current?.element && focusCurrent(),
    "[": () => actions.step("before", -1), "]": () => actions.step("before", 1),
    "{": () => actions.step("after", -1), "}": () => actions.step("after", 1),
    "+": () => camera.zoom(1.25), "=": () => camera.zoom(1.25), "-": () => camera.zoom(0.8), 0: () => camera.fit(),
    s: () => tools.field.focus(), l: () => actions.change({ list: !actions.state.list }), "?": () => dialog.showModal(),
  };

  function focusCurrent() {
    actions.pick(current.element);
    const { element: each } = current;
    actions.focus(each.kind === "host" ? `host:${archgenExplorer.grammar.quote(each.id)}` : each.id, 1, 1);
  }

  function clear() {
    const { state } = actions;
    if (state.pick) actions.change({ pick: "" });
    else if (state.sel) actions.change({ sel: "" });
    else unlight();
  }

  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const writing = event.target.closest?.("input, textarea, select, [contenteditable], [popover]");
    if (event.key === "Escape" && !event.target.closest?.("[popover]")) {
      if (writing) drawing.nodeOf(current ?? {})?.focus({ preventScroll: true });
      else clear();
      return event.preventDefault();
    }
    if (writing) return;
    const isOnMap = stage.contains(event.target) && !event.target.closest("button, summary");
    if (isOnMap && onMap(event)) return event.preventDefault();
    const act = ANYWHERE[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });

  return { dialog, opener, settle };
};
