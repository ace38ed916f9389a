// The map as a list: each box with what it takes from and gives to others, for screen readers and whoever likes lists better.
"use strict";
archgenExplorer.makeList = function (actions) {
  const { element, count } = archgenExplorer;
  const root = element("section", { className: "as-list", ariaLabel: "The map as a list", hidden: true, tabIndex: -1 });

  function name(box, text = box.title) {
    const button = element("button", { type: "button", className: "name", textContent: text });
    button.addEventListener("click", () => actions.pickBox(box));
    return button;
  }

  function flows(arrows, side, word) {
    if (!arrows.length) return "";
    return element("li", {}, word + " ", arrows.flatMap((arrow, at) => {
      const button = element("button", { type: "button", className: "name muted", textContent: count(arrow.flows.length, "flow") });
      button.ariaLabel = `${count(arrow.flows.length, "flow")}, ${arrow.tailTitle} to ${arrow.headTitle}`;
      button.addEventListener("click", () => actions.pickArrow(arrow));
      return [at ? ", " : "", name(arrow[side], arrow[side + "Title"]), " (", button, ")"];
    }));
  }

  function item(box, scene) {
    const into = scene.arrows.filter(({ head }) => head === box), out = scene.arrows.filter(({ tail }) => tail === box);
    const toggle = box.element && box.opens ? element("button", { type: "button", textContent: box.open ? "Close" : "Open", ariaLabel: `${box.open ? "Close" : "Open"} ${box.title}` }) : "";
    if (toggle) toggle.addEventListener("click", () => actions.toggle(box));
    const inner = scene.boxes.filter(({ parent, hidden }) => parent === box && !hidden);
    return element("li", {}, element("span", { className: box.lit ? "lit" : "" }, name(box), " ", element("span", { className: "muted", textContent: [box.line, box.lit ? "lit" : ""].filter(Boolean).join(" · ") }), " ", toggle),
      element("ul", {}, flows(into, "tail", "takes from"), flows(out, "head", "gives to"), inner.map((each) => item(each, scene))));
  }

  function draw(scene, isShown) {
    root.hidden = !isShown;
    if (!isShown) return void root.replaceChildren();
    const outer = scene.boxes.filter(({ parent, hidden }) => !parent && !hidden);
    root.replaceChildren(element("p", { className: "muted", textContent: `${count(outer.length, scene.boxes[0]?.kind ?? "box")}, ${count(scene.arrows.length, "arrow")}. The same as on the map.` }),
      element("ul", {}, outer.map((box) => item(box, scene))));
  }

  return { root, draw };
};
