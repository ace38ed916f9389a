// The tools above the map: level, selector, steps, colour, filters, ways from A to B, link, saving.
"use strict";
archgenExplorer.makeTools = function (model, actions) {
  const { element, grammar } = archgenExplorer;
  const LEVELS = { groups: "Groups", components: "Components", nodes: "Nodes", hosts: "Hosts" };
  const button = (text, act, properties = {}) => {
    const made = element("button", { type: "button", textContent: text, ...properties });
    made.addEventListener("click", act);
    return made;
  };

  // --- level ----------------------------------------------------------------------------------------------------
  const levelButtons = Object.entries(LEVELS).map(([name, title]) => {
    const made = button(title, () => actions.change({ level: name, pick: "", open: [], at: null }));
    made.hidden = (name === "nodes" && !model.nodes.length) || (name === "hosts" && !model.hosts.length);
    made.dataset.level = name;
    return made;
  });
  const levels = element("div", { className: "joined", role: "group", ariaLabel: "Level" }, levelButtons);

  // --- the selector, and the steps of a focus -------------------------------------------------------------------
  const field = element("input", { type: "text", id: "selector", placeholder: "2+name+1  owner:…  a..b", autocomplete: "off", spellcheck: false, ariaLabel: "Selector",
    maxLength: 500 });
  field.setAttribute("autocapitalize", "none");
  field.setAttribute("aria-describedby", "selector-says");
  field.setAttribute("list", "selector-names");
  const names = element("datalist", { id: "selector-names" });
  const says = element("output", { id: "selector-says", className: "muted" });
  const clear = button("×", () => actions.change({ sel: "" }), { ariaLabel: "Clear the selector", className: "bare" });
  const form = element("form", { className: "selector", role: "search" }, field, names, says, clear);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    actions.change({ sel: field.value.trim(), at: null });
  });
  field.addEventListener("change", () => field.value.trim() !== actions.state.sel && actions.change({ sel: field.value.trim(), at: null }));
  // Names are offered from the first key on: thousands of them would hold up the page while it opens.
  field.addEventListener("focus", () => {
    if (names.childElementCount) return;
    const ids = [...model.groups, ...model.shells, ...model.components, ...model.nodes].slice(0, 2000).map(({ id }) => id);
    const keys = model.keys.filter(([key]) => ["owner", "tag", "host", "status", "role"].includes(key)).map(([key, value]) => `${key}:${grammar.quote(value)}`);
    names.append(...[...ids, ...new Set(keys)].map((value) => element("option", { value })));
  });

  const steppers = ["before", "after"].map((side) => {
    const value = element("output");
    const less = button("−", () => actions.step(side, -1), { ariaLabel: `Fewer steps ${side}` });
    const more = button("+", () => actions.step(side, 1), { ariaLabel: `More steps ${side}` });
    const title = side === "before" ? "Before " : "After ";
    return { side, value, less, box: element("div", { className: "joined stepper", role: "group", ariaLabel: title.trim() }, less, element("span", {}, title, value), more) };
  });

  // --- colour and filters ---------------------------------------------------------------------------------------
  const colour = element("select", { id: "colour" }, Object.entries(actions.colours.TITLES).map(([value, title]) => element("option", { value, textContent: title })));
  colour.addEventListener("change", () => actions.change({ colour: colour.value }));
  const colourBox = element("label", { className: "choice" }, "Colour: ", colour);

  const filterKeys = Object.entries(actions.colours.TITLES).filter(([key]) => key !== "group");
  const filterPanel = element("div", { id: "filters", className: "pop", popover: "auto" });
  filterPanel.setAttribute("aria-label", "Filter");
  filterPanel.setAttribute("role", "dialog");
  const filterButton = button("Filter", () => {}, {});
  filterButton.setAttribute("popovertarget", "filters");
  filterPanel.addEventListener("beforetoggle", (event) => event.newState === "open" && fillFilters());

  function fillFilters() {
    const rows = filterKeys.map(([key, title]) => {
      const name = title[0].toUpperCase() + title.slice(1);
      const select = element("select", { ariaLabel: name }, element("option", { value: "", textContent: "all" }),
        actions.colours.listValues(actions.level(), key).map(({ value, title: words, count }) => element("option", { value, textContent: `${words} (${count})` })));
      select.value = actions.state.only.find(([each]) => each === key)?.[1] ?? "";
      select.disabled = select.options.length === 1;
      select.addEventListener("change", () => {
        const rest = actions.state.only.filter(([each]) => each !== key);
        actions.change({ only: select.value ? [...rest, [key, select.value]] : rest });
      });
      return element("label", {}, name, select);
    });
    filterPanel.replaceChildren(...rows, button("Show everything", () => {
      actions.change({ only: [] });
      filterPanel.hidePopover();
    }));
  }

  // --- ways from A to B -----------------------------------------------------------------------------------------
  const [fromField, toField] = ["From", "To"].map((title) => {
    const made = element("input", { type: "text", autocomplete: "off", spellcheck: false, required: true, maxLength: 250 });
    made.setAttribute("list", "selector-names");
    return element("label", {}, title, made);
  });
  const wayForm = element("form", {}, fromField, toField, element("button", { type: "submit", textContent: "Show the ways" }));
  const wayPanel = element("div", { id: "ways", className: "pop", popover: "auto" }, wayForm);
  wayPanel.setAttribute("aria-label", "Ways from A to B");
  wayPanel.setAttribute("role", "dialog");
  const wayButton = button("A → B", () => {}, { ariaLabel: "A → B: the ways" });
  wayButton.setAttribute("popovertarget", "ways");
  wayPanel.addEventListener("beforetoggle", (event) => {
    if (event.newState !== "open") return;
    field.dispatchEvent(new Event("focus"));
    const picked = actions.pickedName();
    if (picked) fromField.lastChild.value = picked;
  });
  wayForm.addEventListener("submit", (event) => {
    event.preventDefault();
    wayPanel.hidePopover();
    actions.showWays(`${fromField.lastChild.value.trim()}..${toField.lastChild.value.trim()}`);
  });

  // --- link, saving, list ---------------------------------------------------------------------------------------
  const copy = button("Copy link", async () => {
    savePanel.hidePopover();
    try {
      await navigator.clipboard.writeText(location.href);
      actions.say("The link is in the clipboard.");
    } catch (refused) {
      actions.say("The browser does not give its clipboard to this page: the link is in its address bar.");
    }
  });
  const savePanel = element("div", { id: "saving", className: "pop menu", popover: "auto" });
  savePanel.append(copy);
  for (const [format, title] of [["svg", "Save as SVG"], ["png", "Save as PNG"]]) {
    savePanel.append(button(title, () => {
      savePanel.hidePopover();
      actions.save(format);
    }));
  }
  const save = button("Share", () => {});
  save.setAttribute("popovertarget", "saving");
  const list = button("List", () => actions.change({ list: !actions.state.list }));
  const openAll = button("Open all", () => actions.toggleAll());
  for (const [opener, popup] of [[filterButton, filterPanel], [wayButton, wayPanel], [save, savePanel]]) {
    popup.addEventListener("beforetoggle", () => {
      const box = opener.getBoundingClientRect();
      popup.style.top = `${box.bottom + 6}px`;
      popup.style.left = `${Math.max(8, Math.min(box.left, innerWidth - 260))}px`;
    });
  }

  const bar = element("div", { className: "explorer-tools", role: "toolbar", ariaLabel: "Map" }, levels, form, steppers.map(({ box }) => box),
    element("span", { className: "gap" }), openAll, colourBox, filterButton, wayButton, list, save, filterPanel, wayPanel, savePanel);

  // `focus`: { before, after } where the selector is one element with steps, else null.
  function update({ state, selection, lit, shownCount, focus, homes, open }) {
    for (const made of levelButtons) made.ariaPressed = String(made.dataset.level === state.level);
    if (document.activeElement !== field || !form.contains(document.activeElement)) field.value = state.sel;
    clear.hidden = !state.sel;
    const errors = (selection?.problems ?? []);
    says.textContent = errors.length ? "" : lit ? `${lit.size} of ${shownCount} lit` : "";
    field.setAttribute("aria-invalid", String(errors.some(({ severity }) => severity === "error")));
    const steps = (number) => (number === Infinity ? "all" : number);
    for (const { side, value, less, box } of steppers) {
      box.hidden = !focus;
      value.textContent = focus ? steps(focus[side]) : "";
      less.disabled = !focus || focus[side] === 0;
    }
    colour.value = state.colour in actions.colours.TITLES ? state.colour : "group";
    filterButton.textContent = state.only.length ? `Filter: ${state.only.length}` : "Filter";
    filterButton.classList.toggle("active", state.only.length > 0);
    list.ariaPressed = String(state.list);
    openAll.hidden = state.level === "groups";
    openAll.textContent = homes.some((home) => open.includes(home.id)) ? "Close all" : "Open all";
  }

  return { bar, update, field };
};
