// Only under `archgen serve`: shows what changes in the files, where the reader is, and tries figures out.
// It runs before site.js, so it sees the page as the server wrote it.
"use strict";
(function () {
  const root = document.documentElement;
  const base = new URL("..", document.currentScript.src).href; // the site's folder: this script is in live/

  function element(name, properties, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  // --- the page as the server wrote it, part by part ------------------------------------------------------------
  const PARTS = { main: "main", tree: "#navigation", bar: ".bar .project, .bar .revision" };
  const read = (page, selector) => [...page.querySelectorAll(selector)].map((part) => part.innerHTML).join("\n");
  const readParts = (page) => Object.fromEntries(Object.entries(PARTS).map(([name, selector]) => [name, read(page, selector)]));
  let written = readParts(document);
  let version = root.dataset.version;

  // --- what is wrong --------------------------------------------------------------------------------------------
  const notes = element("div", { className: "live", role: "status" });
  let shown = "";

  function describe(error) {
    const line = element("p", {});
    if (error.place) line.append(element("span", { className: "place", textContent: error.place }), " ");
    // Names stand between backticks.
    const words = (error.message + (error.help ? "; " + error.help : "")).split("`");
    line.append(...words.map((part, at) => (at % 2 ? element("code", { textContent: part }) : part)));
    const note = element("div", { className: "mistake" }, line);
    if (error.line.trim()) {
      const at = error.column - 1;
      const word = error.line.slice(at).match(/^[^\s:,\]}]+/)?.[0] ?? "";
      const code = element("code", {}, error.line.slice(0, at), element("mark", { textContent: word }), error.line.slice(at + word.length));
      note.append(element("pre", { tabIndex: 0 }, code));
    }
    return note;
  }

  function tell(status) {
    // The same words again would be read out again.
    const words = JSON.stringify([status.errors, status.further, status.outdated && status.since]);
    if (words === shown) return;
    shown = words;
    notes.replaceChildren(...status.errors.map(describe));
    const state = [];
    if (status.further) state.push(`${status.further} more: \`archgen check\` lists them.`);
    if (status.errors.length && status.outdated && status.since) state.push(`The page shows the last sound state, of ${status.since}.`);
    if (state.length) notes.append(element("p", { className: "state", textContent: state.join(" ") }));
    document.querySelector("main").prepend(notes);
  }

  // --- exchange what has changed, and leave the reader where he is ----------------------------------------------
  // What is first in sight stays there, whatever grows or shrinks above it.
  function findAnchor() {
    const top = document.querySelector(".bar")?.getBoundingClientRect().bottom ?? 0;
    for (const part of document.querySelectorAll("main [id]")) {
      const { bottom, height } = part.getBoundingClientRect();
      if (height && bottom > top + 1) return { id: part.id, top: part.getBoundingClientRect().top };
    }
    return null;
  }

  function keepPlace(exchange) {
    const { scrollX, scrollY } = window;
    const anchor = scrollY > 0 ? findAnchor() : null;
    const focused = document.activeElement;
    const focusPath = focused && focused !== document.body ? pathOf(focused) : null;
    const selection = focused instanceof HTMLInputElement && focused.type !== "checkbox" ? [focused.selectionStart, focused.selectionEnd] : null;
    const boxes = [...document.querySelectorAll(".scroll")].map((box) => [box.scrollLeft, box.scrollTop]);
    const open = [...document.querySelectorAll("main details")].map((details) => details.open);
    exchange();
    document.querySelectorAll(".scroll").forEach((box, at) => boxes[at] && ([box.scrollLeft, box.scrollTop] = boxes[at]));
    document.querySelectorAll("main details").forEach((details, at) => at in open && (details.open = open[at]));
    const part = anchor && document.getElementById(anchor.id);
    const moved = part ? part.getBoundingClientRect().top - anchor.top : 0;
    window.scrollTo({ left: scrollX, top: (part ? window.scrollY : scrollY) + moved, behavior: "instant" });
    const again = focusPath && !document.contains(focused) ? followPath(focusPath) : null;
    again?.focus({ preventScroll: true });
    if (again && selection && selection[0] !== null) again.setSelectionRange(...selection);
  }

  function pathOf(part) {
    const steps = [];
    for (let at = part; at && at !== document.body; at = at.parentElement) {
      if (at.id) return { id: at.id, steps };
      steps.unshift([...at.parentElement.children].indexOf(at));
    }
    return { id: "", steps };
  }

  function followPath({ id, steps }) {
    return steps.reduce((at, step) => at?.children[step], id ? document.getElementById(id) : document.body);
  }

  function exchangeParts(next) {
    const parts = readParts(next);
    document.dispatchEvent(new Event("archgen:version"));
    root.dataset.version = version = next.documentElement.dataset.version ?? version;
    // Scripts of a page's own keep their state in the address: they start again from there.
    if (parts.main !== written.main && hasOwnScripts) {
      location.reload();
      return;
    }
    document.title = next.title;
    if (parts.bar !== written.bar) {
      document.querySelectorAll(PARTS.bar).forEach((part, at) => {
        const other = next.querySelectorAll(PARTS.bar)[at];
        if (other) part.innerHTML = other.innerHTML;
      });
    }
    if (parts.tree !== written.tree) {
      const tree = document.getElementById("navigation");
      const top = tree.scrollTop;
      tree.replaceChildren(...next.getElementById("navigation").childNodes);
      tree.scrollTop = top;
    }
    if (parts.main !== written.main) {
      keepPlace(() => {
        const main = document.querySelector("main");
        main.replaceChildren(notes, ...next.querySelector("main").childNodes);
        // site.js equips the new content as it did the old, and what looks closely at a picture goes on with the new one.
        document.dispatchEvent(new Event("archgen:content"));
        showFields();
      });
    }
    written = parts;
  }

  const SHARED_SCRIPTS = /(^|\/)(assets\/(theme|site|search)|live\/live)\.js$/;
  const hasOwnScripts = [...document.querySelectorAll("script[src]")].some(
    (script) => !SHARED_SCRIPTS.test(script.getAttribute("src"))
  );

  let running = false, again = false;
  async function renew() {
    if (running) {
      again = true;
      return;
    }
    running = true;
    try {
      do {
        again = false;
        const answer = await fetch(location.href.split("#")[0], { cache: "no-store" });
        if (answer.ok) exchangeParts(new DOMParser().parseFromString(await answer.text(), "text/html"));
        else if (answer.status === 404) tellGone();
      } while (again);
    } catch (stopped) {
      // The server is gone; when it is back, the news say so.
    } finally {
      running = false;
    }
  }

  function tellGone() {
    shown = "gone";
    const home = element("a", { href: base + "index.html", textContent: "The start page" });
    notes.replaceChildren(element("div", { className: "lost" }, "This page is no longer part of the project; it is shown as it was. ", home));
    document.querySelector("main").prepend(notes);
  }

  const news = new EventSource(base + "live/news");
  news.addEventListener("message", (event) => {
    const status = JSON.parse(event.data);
    tell(status);
    if (status.version !== version) renew();
  });
  addEventListener("pagehide", () => news.close());
  addEventListener("pageshow", (event) => {
    if (event.persisted) location.reload();
  });

  // --- figures to try out ---------------------------------------------------------------------------------------
  const tried = new Map();
  const chain = /\/chains\/([^/]+)\.html$/.exec(location.pathname);
  const host = /\/hosts\/([^/]+)\.html$/.exec(location.pathname);
  const CHIPS = { met: "met", missed: "missed", "not proven": "not-proven", open: "open" };

  async function showFields() {
    if (!chain && !host) return;
    const answer = await fetch(base + "live/what-if?" + (chain ? "chain=" + chain[1] : "host=" + host[1]));
    const { figures } = await answer.json();
    document.querySelector("main .what-if")?.remove();
    if (figures.length) document.querySelector("main").append(makeCard(figures));
    if (tried.size) ask();
  }

  function makeField(figure) {
    const name = figure.label + " of " + figure.element;
    const field = figure.options
      ? element("select", { ariaLabel: name }, ...Object.entries(figure.options).map(([id, title]) => new Option(title, id)))
      : element("input", { type: "text", ariaLabel: name, placeholder: "not written", autocomplete: "off", spellcheck: false });
    field.value = tried.get(figure.set) ?? figure.value;
    const mark = () => field.classList.toggle("tried", tried.has(figure.set));
    mark();
    field.addEventListener("input", () => {
      const value = field.value.trim();
      if (value === figure.value || !value) tried.delete(figure.set);
      else tried.set(figure.set, value);
      mark();
      askSoon();
    });
    return field;
  }

  function makeTable(name, head, rows) {
    const table = element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
    return element("div", { className: "fields", role: "group", ariaLabel: name, tabIndex: 0 }, table);
  }

  function makeCard(figures) {
    const labels = ["Execution time", "Period", "Rate", "Priority", "Host"].filter((label) => figures.some((figure) => figure.label === label));
    const elements = [...new Set(figures.map((figure) => figure.element))];
    const head = element("tr", {}, element("th", { scope: "col", textContent: chain ? "Step" : "Node" }), ...labels.map((label) => element("th", { scope: "col", textContent: label })));
    const rows = elements.map((name) => {
      const cells = labels.map((label) => {
        const figure = figures.find((each) => each.element === name && each.label === label);
        return element("td", {}, ...(figure ? [makeField(figure)] : []));
      });
      return element("tr", {}, element("th", { scope: "row", textContent: name }), ...cells);
    });
    const clear = element("button", { type: "button", textContent: "As written" });
    clear.addEventListener("click", () => {
      tried.clear();
      showFields();
    });
    const form = element("form", {},
      makeTable("Figures", head, rows),
      element("div", { className: "buttons" }, clear, element("span", { className: "muted command" })),
      element("div", { className: "answer", ariaLive: "polite" }));
    form.addEventListener("submit", (event) => event.preventDefault());
    return element("section", { className: "what-if", ariaLabel: "What if" }, element("h2", { textContent: "What if" }),
      element("p", { className: "muted", textContent: "Change a figure: nothing is written. The answer is that of archgen timing --set." }), form);
  }

  let timer = 0, asked = 0;
  function askSoon() {
    clearTimeout(timer);
    timer = setTimeout(ask, 150);
  }

  async function ask() {
    const card = document.querySelector("main .what-if");
    const number = (asked += 1);
    const set = [...tried].map(([name, value]) => name + "=" + value);
    card.querySelector(".command").textContent = "";
    if (!set.length) {
      card.querySelector(".answer").replaceChildren();
      return;
    }
    const answer = await fetch(base + "live/what-if", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ set }) });
    const answered = await answer.json();
    if (number !== asked) return; // a later question is on its way
    const place = card.querySelector(".answer");
    if (answered.error) {
      place.replaceChildren(element("p", { className: "wrong", role: "alert", textContent: answered.error }));
      return;
    }
    const quoted = set.map((text) => " --set '" + text.replaceAll("'", "'\\''") + "'").join("");
    card.querySelector(".command").replaceChildren(element("code", { textContent: "archgen timing" + quoted }));
    const rows = answered.rows.filter((row) => row.differs || (row.kind === "chain" && chain && decodeURIComponent(chain[1]) === row.id));
    place.replaceChildren(rows.length ? makeAnswer(rows) : element("p", { textContent: "No chain and no load differs." }));
  }

  function makeAnswer(rows) {
    const cell = (side) => {
      const made = element("td", { className: "right" }, side.figure);
      if (side.status) made.append(" ", element("span", { className: "chip " + CHIPS[side.status], textContent: side.status + (side.margin ? " · " + side.margin : "") }));
      else if (side.margin) made.append(" ", element("span", { className: "muted", textContent: side.margin }));
      return made;
    };
    const head = element("tr", {}, ...["Chain or host", "As written", "Tried", "Difference"].map((title, at) => element("th", { scope: "col", className: at ? "right" : "", textContent: title })));
    const body = rows.map((row) => element("tr", { className: row.differs ? "" : "same" }, element("th", { scope: "row", textContent: row.title }), cell(row.now), cell(row.then), element("td", { className: "right", textContent: row.differs ? row.difference : "the same" })));
    return makeTable("Answer", head, body);
  }

  showFields();
})();
