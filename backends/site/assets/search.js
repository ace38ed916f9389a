// The search box of every page: `/` or Ctrl-K. The library and the index are loaded when it is opened for the first time.
"use strict";
(function () {
  const base = new URL("..", document.currentScript.src).href; // the site's folder: this script is in assets/
  const STORE = "archgen-opened " + base; // all sites on a disk share one storage
  const MAX_OPENED = 5;
  const SLICE = 24; // ms of searching between two chances for the page to draw and to hear keys
  const DRAW_AGAIN = 150; // ms between two drawings of one answer
  const HINTS = { owner: "what a partner owns", tag: "what carries a tag", host: "what runs on a host" };
  const ICONS = {
    find: "M7 2.5a4.5 4.5 0 1 1 0 9a4.5 4.5 0 0 1 0-9M10.4 10.4L14 14",
    component: "M2.5 4h11v8h-11z", group: "M2 5.5h9v7H2zM4.5 5.5V3H14v7h-3", port: "M2 5.5h10l-2.5-2.5M14 10.5H4l2.5 2.5",
    connection: "M2 8h11M9.5 4.5L13 8l-3.5 3.5", node: "M8 3a5 5 0 1 1 0 10a5 5 0 0 1 0-10M8 7v2",
    topic: "M1.5 8.5h3l2-5l3 9l2-4h3", message: "M2 4h12v8.5H2zM2 4.5l6 4.5l6-4.5", requirement: "M3 8.5l3.5 3.5L13.5 4",
    finding: "M8 2.5L14 13.5H2zM8 6.5v3.5", chain: "M2 8h12M4 6v4M8 6v4M12 6v4", chapter: "M3 4h10M3 8h10M3 12h6",
    host: "M2 3h12v8H2zM5.5 13.5h5", partner: "M8 3a2.5 2.5 0 1 1 0 5a2.5 2.5 0 0 1 0-5M3 13.5c1-4 9-4 10 0",
  };
  const LIKE = { service: "topic", action: "topic", field: "message", type: "message", "use case": "requirement", link: "connection",
    container: "host", resource: "host", page: "chapter", view: "chapter" };

  function element(name, properties, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children.filter((child) => child !== null));
    return made;
  }

  function icon(kind) {
    const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    picture.setAttribute("viewBox", "0 0 16 16");
    picture.setAttribute("aria-hidden", "true");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", ICONS[kind] ?? ICONS[LIKE[kind]] ?? ICONS.chapter);
    picture.append(path);
    return picture;
  }

  const plural = (kind, count) => (count === 1 ? kind : /[^aeiou]y$/.test(kind) ? kind.slice(0, -1) + "ies" : kind + "s");
  const capital = (text) => text[0].toUpperCase() + text.slice(1);
  const figure = (count) => count.toLocaleString("en");

  // --- last opened: what a browser remembers may be refused, or be somebody else's ------------------------------
  function readOpened() {
    try {
      const kept = JSON.parse(localStorage.getItem(STORE) ?? "[]");
      return kept.filter((entry) => Array.isArray(entry) && entry.length === 4 && entry.every((part) => typeof part === "string"))
        .filter((entry) => new URL(entry[3], base).href.startsWith(base)).slice(0, MAX_OPENED);
    } catch (refused) {
      return [];
    }
  }

  function keepOpened(entries) {
    try {
      localStorage.setItem(STORE, JSON.stringify(entries.slice(0, MAX_OPENED)));
    } catch (refused) {
      // Then nothing is remembered.
    }
  }

  function remember(entry) {
    keepOpened([entry, ...readOpened().filter((other) => other[3] !== entry[3])]);
  }

  const here = location.href.split(/[?#]/)[0];
  const lead = document.querySelector("main > .lead")?.textContent ?? "";
  if (here.startsWith(base) && document.querySelector(".crumbs")) {
    const [kind, ...rest] = lead.split(" · ");
    remember([document.querySelector("h1").textContent, rest.join(" · "), kind.toLowerCase(), here.slice(base.length)]);
  }

  // --- loading --------------------------------------------------------------------------------------------------
  let loading = false, loaded = 0, failed = false;

  function loadScript(name, then, otherwise = draw) {
    // Not `async`: scripts that are asked for together run in this order.
    const script = element("script", { src: base + "assets/search/" + name + ".js", async: false });
    script.addEventListener("load", then);
    script.addEventListener("error", () => {
      failed = true;
      list.ariaBusy = "false";
      otherwise();
    });
    document.head.append(script);
  }

  function load() {
    if (loading && !(stale && isReady() && isComplete())) return;
    [loading, loaded, stale] = [true, 0, false];
    if (!isReady()) {
      loadScript("ufuzzy", () => {});
      loadScript("match", () => {});
    }
    loadScript("index", () => {
      draw();
      loadPart();
    });
  }

  // Under `archgen serve` the site changes while it is read: the next search begins with the index as it is then.
  let stale = false;
  document.addEventListener("archgen:version", () => {
    stale = loading;
  });

  function loadPart() {
    const { parts } = archgenSearch.settings;
    if (loaded === parts.length) {
      if (stale) load();
      return;
    }
    const goOn = () => {
      loaded += 1;
      // Results while the rest is still being read, but not anew for each of many small parts.
      const due = loaded === parts.length || performance.now() - lastSearch > DRAW_AGAIN;
      if (due && field.value.trim()) search();
      // One after another, so that keys and drawing have their turn between two parts.
      loadPart();
    };
    // Without a part the others are searched all the same.
    loadScript(parts[loaded], goOn, goOn);
  }

  const isReady = () => typeof archgenSearch !== "undefined";
  const isComplete = () => isReady() && loaded === archgenSearch.settings.parts.length;

  // --- the box --------------------------------------------------------------------------------------------------
  const field = element("input", { type: "text", id: "find-field", autocomplete: "off", maxLength: 500, spellcheck: false, enterKeyHint: "go",
    placeholder: "Component, topic, message field, requirement, chapter …", ariaLabel: "Search everything" });
  field.setAttribute("role", "combobox");
  field.setAttribute("aria-controls", "find-list");
  field.setAttribute("aria-autocomplete", "list");
  field.setAttribute("autocapitalize", "none");
  const count = element("span", { className: "muted" });
  const chips = element("div", { className: "chips", hidden: true, role: "group", ariaLabel: "Kinds" });
  const note = element("p", { className: "note", hidden: true });
  const list = element("div", { id: "find-list", role: "listbox", ariaLabel: "Results" });
  const status = element("div", { className: "spoken", role: "status" });
  const close = element("button", { type: "button", className: "close" }, element("kbd", { textContent: "Esc" }), " close");
  const clear = element("button", { type: "button", className: "clear", textContent: "Clear", hidden: true, ariaLabel: "Clear last opened" });
  const keys = element("div", { className: "keys" });
  for (const [key, does] of [["↑ ↓", "choose"], ["Enter", "open"], ["Shift Enter", "show in explorer"], ["Tab", "kind"]]) {
    keys.append(element("span", {}, element("kbd", { textContent: key }), " " + does));
  }
  keys.append(close);
  const dialog = element("dialog", { className: "find-box", ariaLabel: "Search everything" },
    element("div", { className: "field" }, icon("find"), field, count), chips, note,
    element("div", { className: "found" }, clear, list), status, keys);

  let options = [], active = 0, kind = null, answer = null, run = 0, lastSearch = 0, moved = false;

  function open() {
    // Not above a picture that fills the window.
    if (dialog.open || document.querySelector("dialog[open]")) return;
    document.body.append(dialog);
    dialog.showModal();
    field.select();
    load();
    search();
  }

  // Each piece stands by itself: letters that write from right to left turn nothing around but themselves.
  function option(entry, marks) {
    const [title, line, what, place] = entry;
    const name = element("bdi", { className: "title" });
    const pieces = marks.length ? archgenSearch.markTitle(title, marks) : [title];
    pieces.forEach((piece, at) => piece && name.append(at % 2 ? element("mark", { textContent: piece }) : piece));
    const link = element("a", { href: base + place, tabIndex: -1 }, icon(what),
      element("span", {}, name, line ? element("bdi", { className: "line", textContent: line }) : null),
      element("span", { className: "kind", textContent: what }));
    link.addEventListener("click", (event) => {
      remember([title, line, what, place]);
      if (!event.ctrlKey && !event.metaKey && !event.shiftKey) dialog.close();
    });
    return asOption(link);
  }

  function hint(selector) {
    const control = element("button", { type: "button", tabIndex: -1 }, element("code", { textContent: selector }),
      element("span", { className: "kind", textContent: HINTS[selector.split(":")[0]] ?? "" }));
    control.addEventListener("click", () => {
      field.value = selector;
      field.focus();
      search();
    });
    return asOption(control);
  }

  function asOption(control) {
    control.setAttribute("role", "option");
    control.id = "find-" + options.length;
    const at = options.push(control) - 1;
    control.addEventListener("pointermove", () => active !== at && choose(at, false));
    return control;
  }

  function section(title, children) {
    if (!children.length) return null;
    const heading = element("div", { className: "heading", textContent: title });
    heading.setAttribute("role", "presentation");
    return element("div", { role: "group", ariaLabel: title }, heading, ...children);
  }

  function choose(at, scroll = true) {
    options[active]?.setAttribute("aria-selected", "false");
    active = Math.max(0, Math.min(at, options.length - 1));
    options.forEach((control, place) => control.setAttribute("aria-selected", String(place === active)));
    if (options.length) field.setAttribute("aria-activedescendant", options[active].id);
    else field.removeAttribute("aria-activedescendant");
    if (scroll) options[active]?.scrollIntoView({ block: "nearest" });
  }

  function draw() {
    const before = moved ? options[active]?.href : null;
    options = [];
    const query = field.value.trim();
    if (query && answer) drawAnswer(query);
    else drawEmpty(query);
    field.setAttribute("aria-expanded", String(options.length > 0));
    list.hidden = !options.length;
    const again = before ? options.findIndex((control) => control.href === before) : 0;
    choose(Math.max(0, again), false);
    if (!moved) list.parentElement.scrollTop = 0;
  }

  // An empty box teaches: where the reader was, what is open, and what else it understands.
  function drawEmpty(query) {
    const settings = isReady() ? archgenSearch.settings : { open: [], examples: [] };
    const opened = readOpened().filter((entry) => new URL(entry[3], base).href !== here);
    chips.hidden = true;
    note.hidden = !failed;
    note.textContent = failed ? "The index of this site could not be read: its folder assets/search is incomplete." : "";
    clear.hidden = !opened.length || Boolean(query);
    count.textContent = isReady() ? figure(settings.count) + " entries" : "";
    status.textContent = note.textContent;
    const groups = query ? [] : [
      section("Last opened", opened.map((entry) => option(entry, []))),
      section("Open points", settings.open.map((entry) => option(entry, []))),
      section("Also understood", settings.examples.map(hint)),
    ];
    list.replaceChildren(...groups.filter(Boolean));
  }

  function drawAnswer(query) {
    clear.hidden = true;
    list.replaceChildren(...answer.shown.map((row) => option([row.title, row.line, row.kind, row.place], answer.marks)));
    const more = answer.chosen > answer.shown.length ? `, the best ${answer.shown.length} shown` : "";
    const unfinished = isComplete() ? "" : ` so far`;
    count.textContent = figure(answer.total) + " found" + unfinished;
    note.textContent = failed ? "A part of the index could not be read." : answer.total ? answer.note
      : isComplete() ? `Nothing here has all of “${query}”. Try one of its words, or part of a name.` : "";
    note.hidden = !note.textContent;
    const shares = [["", answer.total], ...answer.kinds];
    chips.replaceChildren(...shares.map(([name, share]) => {
      const chip = element("button", { type: "button", tabIndex: -1, ariaPressed: String((kind ?? "") === name) },
        name ? capital(plural(name, 2)) + " " : "All ", element("span", { className: "share", textContent: figure(share) }));
      chip.addEventListener("click", () => setKind(name || null));
      return chip;
    }));
    chips.hidden = !answer.total;
    chips.querySelector("[aria-pressed=true]")?.scrollIntoView({ block: "nearest", inline: "nearest" });
    const all = answer.total ? answer.kinds.map(([name, share]) => `${share} ${plural(name, share)}`).join(", ") : "";
    say([`${answer.total} found${more}`, kind ? `only ${plural(kind, 2)}` : all, note.textContent].filter(Boolean).join(". "));
  }

  // Spoken when typing rests, not at each key.
  let speaking = 0;
  function say(words) {
    clearTimeout(speaking);
    speaking = setTimeout(() => (status.textContent = words), 400);
  }

  function setKind(name) {
    kind = name;
    moved = false;
    search();
    field.focus();
  }

  // --- searching: in slices, the first answer as soon as there is one --------------------------------------------
  function search() {
    run += 1;
    lastSearch = performance.now();
    const query = field.value.trim();
    list.ariaBusy = String(Boolean(query));
    if (!query) {
      kind = null;
      answer = null;
      draw();
      return;
    }
    if (isReady()) proceed(archgenSearch.find(query, kind), run, 0);
  }

  function proceed(finding, own, drawn) {
    if (own !== run) return;
    const began = performance.now();
    let step = finding.next();
    while (!step.done && performance.now() - began < SLICE) step = finding.next();
    const due = step.done || performance.now() - drawn > DRAW_AGAIN;
    const given = step.done ? step.value : due ? step.value() : null;
    if (given) {
      // A kind that has nothing left gives way to all.
      if (step.done && kind && !given.kinds.some(([name]) => name === kind)) kind = null;
      answer = given;
      list.ariaBusy = String(!step.done || !isComplete());
      draw();
      drawn = performance.now();
    }
    if (!step.done) setTimeout(() => proceed(finding, own, drawn));
  }

  field.addEventListener("input", () => {
    moved = false;
    search();
  });

  function nextKind(step) {
    const names = [null, ...answer.kinds.map(([name]) => name)];
    setKind(names[(names.indexOf(kind) + step + names.length) % names.length]);
  }

  // The page of an element that has a box in the explorer; empty for anything else.
  function onMap(control) {
    const place = control?.href?.startsWith(base) ? control.href.slice(base.length).split("#")[0] : "";
    return /^(components|groups|nodes|hosts)\//.test(place) ? place : "";
  }

  dialog.addEventListener("keydown", (event) => {
    const inField = event.target === field;
    if (event.isComposing) return;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      const step = event.key === "ArrowDown" ? 1 : -1;
      moved = true;
      if (options.length) choose((active + step + options.length) % options.length);
    } else if (event.key === "Enter" && event.shiftKey && inField && onMap(options[active])) {
      dialog.close();
      location.href = base + "explorer.html#page=" + encodeURIComponent(onMap(options[active]));
    } else if (event.key === "Enter" && inField) options[active]?.click();
    else if (event.key === "Tab" && inField && answer?.kinds.length) nextKind(event.shiftKey ? -1 : 1);
    else if (event.key === "Escape") dialog.close(); // At once: a browser's own closing comes after the next key.
    else if (isOpener(event)) field.select();
    else return;
    event.preventDefault();
  });
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  close.addEventListener("click", () => dialog.close());
  clear.addEventListener("click", () => {
    keepOpened([]);
    draw();
    field.focus();
  });

  // --- the way in -----------------------------------------------------------------------------------------------
  const isOpener = (event) => (event.ctrlKey || event.metaKey) && !event.altKey && event.key.toLowerCase() === "k";

  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.isComposing || dialog.open) return;
    // A box that was just closed may hold the focus until the page is drawn again.
    const writing = !dialog.contains(event.target) && event.target.closest("input, textarea, select, [contenteditable]");
    const slash = event.key === "/" && !writing && !event.ctrlKey && !event.metaKey && !event.altKey;
    if (!slash && !isOpener(event)) return;
    event.preventDefault();
    open();
  });

  const opener = element("button", { type: "button", className: "find", ariaLabel: "Search everything" }, icon("find"),
    element("span", { textContent: "Search everything" }), element("kbd", { textContent: "/" }));
  opener.setAttribute("aria-keyshortcuts", "/ Control+K");
  opener.addEventListener("click", open);
  document.querySelector(".bar .theme").before(opener);
})();
