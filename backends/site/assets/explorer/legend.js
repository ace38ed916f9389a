// What lines, frames and colours mean, of those that are on the map; and what is folded, with a button that opens it.
"use strict";
archgenExplorer.makeLegend = function (actions) {
  const { element, shape, count } = archgenExplorer;
  const box = element("details", { className: "legend floats", open: innerWidth > 720 });
  const notes = element("div", { className: "notes floats", role: "status" });

  function sample(name, path, head = true) {
    return shape("svg", { width: 34, height: 14, "aria-hidden": "true" }, shape("g", { class: name }, shape("path", { class: "way", d: path ?? "M1 7H25" }),
      ...(name.includes("physical") ? [shape("path", { class: "core", d: path ?? "M1 7H25" })] : []),
      ...(head ? [shape("path", { class: "head", d: `M33 7l-8 -4v8z${name.includes("medium") ? "m-9 -4v8h-7v-8z" : ""}` })] : [])));
  }

  function entry(mark, text) {
    return element("li", {}, mark, text);
  }

  function drawLines(scene, hasLit) {
    const has = (test) => scene.arrows.some(test);
    const rows = [];
    if (hasLit && has(({ side, head }) => side === "before" || (side === "" && head.picked))) rows.push(entry(sample("arrow lit before"), "feeds it"));
    if (hasLit && has(({ side, tail }) => side === "after" || (side === "" && tail.picked))) rows.push(entry(sample("arrow lit after"), "fed by it"));
    if (!hasLit && has(({ flows }) => flows.length > 3)) rows.push(entry(sample("arrow many"), "4 flows or more"));
    if (has(({ way, turn, direction }) => way && turn !== "loop" && direction < 0)) rows.push(entry(sample("arrow one feedback"), "runs back; a number: flows that arrive"));
    if (has(({ optional }) => optional)) rows.push(entry(sample("arrow one optional"), "optional input"));
    if (has(({ made }) => made)) rows.push(entry(sample("arrow one made"), "joined by autoconnect"));
    if (has(({ style }) => style === "physical")) rows.push(entry(sample("arrow one physical"), "physical"));
    if (has(({ medium }) => medium)) rows.push(entry(sample("arrow one medium"), "no ROS, but what stands in brackets"));
    if (has(({ style }) => style === "service" || style === "action")) rows.push(entry(sample("arrow one service"), "service or action"));
    const closed = scene.boxes.filter(({ opens, open }) => opens && !open);
    if (closed.length) {
      const mark = shape("svg", { width: 34, height: 16, "aria-hidden": "true" }, shape("rect", { class: "key", x: 5, y: 1, width: 24, height: 8, rx: 3 }),
        shape("rect", { class: "key", x: 2, y: 4, width: 30, height: 11, rx: 3 }));
      rows.push(entry(mark, closed.some(({ element: each }) => each.isComposed) ? "closed, + opens" : `closed ${scene.boxes[0].kind}, + opens`));
    }
    return rows;
  }

  function draw(scene, colouring, hasLit) {
    const rows = drawLines(scene, hasLit);
    const colours = colouring.legend.map(({ className, title, count: number }) =>
      entry(shape("svg", { width: 14, height: 14, "aria-hidden": "true" }, shape("rect", { class: "swatch " + className, width: 14, height: 14, rx: 3 })), `${title} (${number})`));
    box.hidden = !rows.length && !colours.length;
    box.replaceChildren(element("summary", { textContent: "Legend" }), element("ul", {}, rows), colours.length ? element("ul", { className: "colours" }, colours) : "");
  }

  const act = (text, run) => {
    const button = element("button", { type: "button", textContent: text });
    button.addEventListener("click", run);
    return button;
  };

  // Problems of the selector and of the address, and what is folded.
  function say(scene, { selection, longer }, hints) {
    const rows = [], problems = selection?.problems ?? [];
    if (longer) rows.push(element("p", {}, actions.state.ways ? "Lit are all ways. " : `Lit are the ways of fewest steps; ${longer} more on longer ways. `,
      act(actions.state.ways ? "Only the shortest" : "All ways", () => actions.showLonger())));
    for (const text of hints) rows.push(element("p", { className: "problem", textContent: text }));
    for (const { message, help } of problems) {
      rows.push(element("p", { className: "problem", textContent: (message + (help ? `; ${help}` : "")).replaceAll("`", "") }));
    }
    const folded = [...scene.folded, ...scene.cut];
    const composed = folded.filter(({ element: each, parent }) => each?.isComposed || parent?.element.isComposed).length;
    if (folded.length || scene.rest.length || scene.dropped.length) {
      const words = [];
      const hiddenCount = [...scene.folded, ...scene.cut].reduce((sum, { members }) => sum + members.length, 0);
      const parts = [folded.length - composed && count(folded.length - composed, scene.boxes[0].kind), composed && count(composed, "composed component")].filter(Boolean);
      if (folded.length) words.push(`${parts.join(" and ")} folded, ${count(hiddenCount, scene.boxes[0].members[0]?.kind ?? "element")}`);
      if (scene.rest.length) words.push(`${count(scene.rest.length, scene.rest[0].kind)} in one box`);
      if (scene.dropped.length) words.push(`${count(scene.dropped.length, "thin arrow")} left out`);
      rows.push(element("p", {}, words.join(", ") + ". ", scene.folded.slice(0, innerWidth < 720 ? 3 : composed ? 6 : 12).map(({ element: each }) => act(each.fullTitle ?? each.title, () => actions.openHome(each))),
        act("Show all", () => actions.showAll())));
    }
    notes.replaceChildren(...rows);
    notes.hidden = !rows.length;
  }

  return { box, notes, draw, say };
};
