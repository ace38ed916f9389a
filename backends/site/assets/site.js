// What pages can do beyond being read: light and dark, sorting and filtering tables, looking closely at pictures.
// Everything is there without it. Plain script: it runs from the disk.
"use strict";
(function () {
  const root = document.documentElement;
  const saverAddress = new URL("save.js", document.currentScript.src).href;

  function element(name, properties, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  // --- light and dark -------------------------------------------------------------------------------------------
  const button = document.querySelector("button.theme");
  const system = matchMedia("(prefers-color-scheme: dark)");
  const dark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
  const label = () => (button.textContent = dark() ? "Light" : "Dark");
  button.hidden = false;
  button.addEventListener("click", () => {
    root.dataset.theme = dark() ? "light" : "dark";
    try {
      localStorage.setItem("archgen-theme", root.dataset.theme);
    } catch (refused) {
      // The choice then holds for this page only.
    }
    label();
  });
  system.addEventListener("change", label);
  label();

  // --- the tree: show where the reader is -----------------------------------------------------------------------
  const tree = document.getElementById("navigation");
  function reveal() {
    const current = tree.querySelector("[aria-current]");
    if (current) tree.scrollTop = current.offsetTop - tree.clientHeight / 3;
  }
  tree.addEventListener("toggle", reveal);
  reveal();

  // --- tables: sort by a column, show the rows that hold some words ---------------------------------------------
  // The address says how: `?q=words&sort=-Deadline` for the first table of the page, `q2` and `sort2` for the second.
  // So Back finds the table as it was left, and a link shows to others what the sender sees.
  const order = new Intl.Collator("en", { numeric: true, sensitivity: "base" });
  const text = (row, at) => row.cells[at].textContent.trim();

  // A quantity is written in several units, so its cell has the exact number: an integer or a ratio. NaN: it has none.
  function number(row, at) {
    const [top, bottom = 1] = (row.cells[at].dataset.sort || "NaN").split("/").map(Number);
    return top / bottom;
  }

  // What has no number stays last both ways: unknown is neither the best nor the worst.
  function compare(at, down) {
    return (a, b) => {
      const [left, right] = [number(a, at), number(b, at)];
      if (isNaN(left) !== isNaN(right)) return isNaN(left) ? 1 : -1;
      return isNaN(left) ? order.compare(text(a, at), text(b, at)) * (down ? -1 : 1) : (left - right) * (down ? -1 : 1);
    };
  }

  function remember(name, value) {
    const address = new URL(location.href);
    if (value) address.searchParams.set(name, value);
    else address.searchParams.delete(name);
    try {
      history.replaceState(history.state, "", address);
    } catch (refused) {
      // Some browsers keep the address of a file as it is: the table works all the same.
    }
  }

  const PAGE_ROWS = 100, WIDE_COLUMNS = 9; // a page of a table as wide has fewer rows: all is to stay below 5,000 elements

  // Rows behind the first ones of a long table wait as text: a browser takes tens of thousands of cells badly.
  function takeRest(table) {
    const rest = table.closest(".table").querySelector("noscript.rest");
    if (!rest) return [];
    const held = document.createElement("template");
    held.innerHTML = rest.textContent;
    rest.remove();
    return [...held.content.querySelectorAll("tbody > tr")];
  }

  // All rows of a table in the order and among the words that are asked for; of a long one a page is shown.
  function listRows(table, suffix) {
    const shown = [...table.tBodies[0].rows];
    const given = [...shown, ...takeRest(table)];
    const isLong = given.length > shown.length;
    const pageRows = table.tHead.rows[0].cells.length < WIDE_COLUMNS ? PAGE_ROWS : 40;
    let rows = given, words = [], page = 0, size = isLong ? pageRows : Infinity;
    const list = {
      given,
      found: given.length,
      onDraw: () => {},
      sort(at, down) {
        rows = at < 0 ? given : [...given].sort(compare(at, down));
        list.turn(0);
      },
      filter(wanted) {
        words = wanted;
        list.turn(0);
      },
      matching: () => rows.filter((row) => {
        const said = row.textContent.toLowerCase();
        return words.every((word) => said.includes(word));
      }),
      turn(wanted) {
        const matching = list.matching();
        list.found = matching.length;
        page = Math.max(0, Math.min(wanted, Math.ceil(matching.length / size) - 1)) || 0;
        if (isLong) table.tBodies[0].replaceChildren(...matching.slice(page * size || 0, (page + 1) * size));
        else {
          for (const row of rows) row.hidden = !matching.includes(row);
          table.tBodies[0].append(...rows);
        }
        if (table.classList.contains("stood")) standRows(table);
        list.onDraw(page, size);
      },
      // The page on which a row stands that an address leads to.
      turnTo(id) {
        const at = list.matching().findIndex((row) => row.id === id || row.querySelector("#" + CSS.escape(id)));
        if (at < 0) return;
        list.turn(Math.floor(at / size));
        document.getElementById(id)?.scrollIntoView();
      },
    };
    if (!isLong) return list;
    const place = element("output", {});
    const back = element("button", { type: "button", textContent: "‹ Back" });
    const on = element("button", { type: "button", textContent: "Next ›" });
    const all = element("button", { type: "button" });
    const pager = element("div", { className: "pager" }, back, place, on, all);
    const go = (wanted) => {
      list.turn(wanted);
      remember("page" + suffix, page ? String(page + 1) : "");
    };
    back.addEventListener("click", () => go(page - 1));
    on.addEventListener("click", () => go(page + 1));
    all.addEventListener("click", () => {
      size = size === Infinity ? pageRows : Infinity;
      go(0);
    });
    list.onDraw = () => {
      const last = Math.min((page + 1) * size, list.found);
      place.textContent = list.found ? `${(page * size || 0) + 1} to ${last} of ${list.found}` : "none";
      back.disabled = !page;
      on.disabled = last >= list.found;
      all.textContent = size === Infinity ? "By pages" : "Show all";
    };
    table.closest(".table").append(pager);
    list.turn(0);
    return list;
  }

  function sortable(table, list, name) {
    const heads = [...table.tHead.rows[0].cells];
    const titles = heads.map((head) => head.textContent);
    function sort(at, down) {
      heads.forEach((other) => (other.ariaSort = null));
      if (at >= 0) heads[at].ariaSort = down ? "descending" : "ascending";
      list.sort(at, down);
    }
    heads.forEach((head, at) => {
      const control = element("button", { type: "button", className: "sort" }, ...head.childNodes);
      head.append(control);
      control.addEventListener("click", () => {
        const down = head.ariaSort === "ascending";
        sort(at, down);
        remember(name, (down ? "-" : "") + titles[at]);
      });
    });
    return (wanted) => sort(titles.indexOf(wanted.replace(/^-/, "")), wanted.startsWith("-"));
  }

  function filterable(table, list, name) {
    const caption = table.caption.textContent;
    const count = element("output", { className: "muted" });
    // Not completed by the browser: it would bring back the words after the rows were shown.
    const field = element("input", { type: "search", placeholder: "Filter", ariaLabel: "Filter: " + caption });
    field.autocomplete = "off";
    function filter() {
      const wanted = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      list.filter(wanted);
      count.textContent = wanted.length ? list.found + " of " + list.given.length : "";
    }
    field.addEventListener("input", () => {
      filter();
      remember(name, field.value.trim());
    });
    const csv = element("button", { type: "button", className: "csv", textContent: "Copy as CSV", ariaLabel: "Copy as CSV: " + caption });
    csv.addEventListener("click", () => {
      copy(writeCsv(table, list.matching())).then(() => {
        csv.textContent = "Copied";
        setTimeout(() => (csv.textContent = "Copy as CSV"), 1500);
      });
    });
    table.closest(".table").prepend(element("div", { className: "filter" }, field, csv, count));
    return (words) => {
      field.value = words;
      filter();
    };
  }

  // What a spreadsheet would take for a formula begins with an apostrophe, as in `archgen list --format csv`.
  function writeCsv(table, rows) {
    return [table.tHead.rows[0], ...rows].map((row) =>
      [...row.cells].map((cell) => {
        const lines = cell.cloneNode(true);
        for (const line of lines.querySelectorAll("br")) line.replaceWith("\n");
        for (const control of lines.querySelectorAll("button.copy")) control.remove();
        const said = lines.textContent.replace(/\u200b/g, "").trim();
        return '"' + (/^[=+\-@]/.test(said) ? "'" : "") + said.replace(/"/g, '""') + '"';
      }).join(",") + "\r\n").join("");
  }

  // A cell that lists a thousand names shows the first ones. Tables with a filter keep all: it looks for words in them.
  const CELL_NAMES = 60;
  const unfolding = new Set();
  function foldCells(table) {
    for (const cell of table.tBodies[0].querySelectorAll("td")) {
      const names = [...cell.children];
      if (names.length <= CELL_NAMES) continue;
      const rest = new Range();
      rest.setStartBefore(names[CELL_NAMES / 2]);
      rest.setEndAfter(cell.lastChild);
      const held = rest.extractContents();
      const unfold = element("button", { type: "button", textContent: names.length - CELL_NAMES / 2 + " more" });
      const show = () => {
        unfolding.delete(show);
        const next = held.querySelector("a");
        unfold.replaceWith(held);
        next?.focus();
      };
      unfold.addEventListener("click", show);
      unfolding.add(show);
      cell.append(unfold);
    }
  }
  matchMedia("print").addEventListener("change", () => unfolding.forEach((show) => show()));

  const obey = new Map();
  const lists = [];
  function equipTables() {
    obey.clear();
    lists.length = 0;
    // Cards are short, and in the order that matters.
    [...document.querySelectorAll(".table table")].filter((table) => !table.closest(".card, noscript")).forEach((table, at) => {
      const suffix = at ? at + 1 : "";
      const list = listRows(table, suffix);
      lists.push(list);
      if (list.given.length > 2) obey.set("sort" + suffix, sortable(table, list, "sort" + suffix));
      if (list.given.length < 10) foldCells(table);
      if (list.given.length > 9) obey.set("q" + suffix, filterable(table, list, "q" + suffix));
      if (list.given.length > PAGE_ROWS) obey.set("page" + suffix, (wanted) => list.turn(Number(wanted || 1) - 1));
    });
  }
  equipTables();
  // On each showing of the page, also one that the browser kept whole or whose fields it filled in by itself.
  function obeyAddress() {
    const wanted = new URLSearchParams(location.search);
    for (const [name, show] of obey) show(wanted.get(name) || "");
    showTarget();
  }
  function showTarget() {
    const id = decodeURIComponent(location.hash.slice(1));
    if (id && !document.getElementById(id)) for (const list of lists) list.turnTo(id);
  }
  addEventListener("hashchange", showTarget);
  addEventListener("pageshow", obeyAddress);
  if (location.search) obeyAddress();

  // On a telephone the rows of a table stand below one another: title and figure, and what else there is with its name.
  // Paper is no wider, yet has room for columns that are few.
  const narrow = matchMedia("(max-width: 44.99rem)");
  const paper = matchMedia("print");

  function standRows(table) {
    const titles = [...table.tHead.rows[0].cells].map((head) => head.textContent.trim());
    const figure = [...table.tHead.rows[0].cells].findIndex((head, at) => at > 0 && head.classList.contains("right"));
    // As blocks they are no table any more to those who listen: these words keep it one.
    table.setAttribute("role", "table");
    for (const part of table.querySelectorAll("thead, tbody")) part.setAttribute("role", "rowgroup");
    for (const row of table.rows) {
      row.setAttribute("role", "row");
      [...row.cells].forEach((cell, at) => {
        cell.setAttribute("role", cell.tagName === "TH" ? "columnheader" : "cell");
        if (cell.tagName === "TD" && at > 0) cell.dataset.label = titles[at];
        if (cell.tagName === "TD" && at === figure) cell.classList.add("key-figure");
      });
    }
  }

  const tables = [...document.querySelectorAll(".table:not(.narrow) table")].filter((table) => !table.closest(".card"));
  function arrangeRows() {
    for (const table of tables) {
      const stands = narrow.matches && !(paper.matches && table.tHead.rows[0].cells.length < 8);
      if (stands && !table.classList.contains("stood")) standRows(table);
      if (stands) table.classList.add("stood");
      table.classList.toggle("as-rows", stands);
    }
  }
  for (const medium of [narrow, paper]) medium.addEventListener("change", arrangeRows);
  arrangeRows();

  // A table that fits needs no box to scroll in: no stop for the Tab key, and its head stays in sight.
  const fitting = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      target.classList.remove("fits");
      const fits = target.scrollWidth <= target.clientWidth;
      target.classList.toggle("fits", fits);
      target.tabIndex = fits ? -1 : 0;
    }
  });
  function watchBoxes() {
    fitting.disconnect();
    for (const box of document.querySelectorAll(".scroll")) fitting.observe(box);
  }
  watchBoxes();

  // --- places that lead nowhere are copied ------------------------------------------------------------------------
  function copy(words) {
    if (navigator.clipboard) return navigator.clipboard.writeText(words);
    // Some browsers have no clipboard for pages from the disk.
    const field = element("textarea", { value: words, readOnly: true, className: "spoken" });
    document.body.append(field);
    field.select();
    document.execCommand("copy");
    field.remove();
    return Promise.resolve();
  }

  // Those of rows on further pages, too.
  const held = lists.flatMap((list) => list.given).flatMap((row) => [...row.querySelectorAll("code.place")]);
  for (const place of new Set([...document.querySelectorAll("code.place"), ...held])) {
    if (place.closest("a")) continue;
    const control = element("button", { type: "button", className: "copy", textContent: "Copy", ariaLabel: "Copy " + place.textContent });
    control.addEventListener("click", () => {
      copy(place.textContent).then(() => {
        control.textContent = "Copied";
        setTimeout(() => (control.textContent = "Copy"), 1500);
      });
    });
    place.after(control);
  }

  // --- pictures: the whole window, with wheel, drag and keys ----------------------------------------------------
  // What saves pictures is read when somebody asks for it.
  function readSaver() {
    if (globalThis.archgenSavePicture) return Promise.resolve();
    return new Promise((done, failed) => {
      document.head.append(element("script", { src: saverAddress, onload: done, onerror: failed }));
    });
  }

  async function save(view, name, format) {
    await readSaver();
    const { x, y, width, height } = view.viewBox.baseVal;
    const ground = getComputedStyle(document.body).backgroundColor;
    await archgenSavePicture([...view.children], { left: x, top: y, right: x + width, bottom: y + height }, ground, name, format);
  }

  function look(svg, caption, name) {
    let view = svg.cloneNode(true);
    const stage = element("div", { className: "stage", tabIndex: 0 }, view);
    stage.setAttribute("role", "group");
    stage.ariaLabel = caption + ". Plus and minus zoom, arrow keys move.";
    const close = element("button", { type: "button", textContent: "Close" });
    const tools = [["−", 0.8, "Smaller"], ["+", 1.25, "Larger"], ["Fit", 0, "Fit into the window"]].map(
      ([words, factor, name]) => {
        const tool = element("button", { type: "button", textContent: words, ariaLabel: name });
        tool.addEventListener("click", () => (factor ? zoom(factor) : fit()));
        return tool;
      }
    );
    const savers = ["SVG", "PNG"].map((format) => {
      const saver = element("button", { type: "button", textContent: format, ariaLabel: "Save as " + format });
      saver.addEventListener("click", () => save(view, name, format.toLowerCase()).catch(() => (saver.textContent = "Too large")));
      return saver;
    });
    const head = element("div", { className: "tools" }, element("span", { textContent: caption }), ...savers, ...tools, close);
    const dialog = element("dialog", { className: "look", ariaLabel: caption }, head, stage);
    let scale = 1, x = 0, y = 0;
    const place = () => (view.style.transform = `translate(${x}px, ${y}px) scale(${scale})`);

    function fit() {
      const natural = [svg.width.baseVal.value, svg.height.baseVal.value];
      view.style.width = natural[0] + "px";
      view.style.height = natural[1] + "px";
      scale = Math.min(stage.clientWidth / natural[0], stage.clientHeight / natural[1], 2);
      x = (stage.clientWidth - natural[0] * scale) / 2;
      y = (stage.clientHeight - natural[1] * scale) / 2;
      place();
    }
    function zoom(factor, at = [stage.clientWidth / 2, stage.clientHeight / 2]) {
      const next = Math.min(8, Math.max(0.1, scale * factor));
      x = at[0] - ((at[0] - x) * next) / scale;
      y = at[1] - ((at[1] - y) * next) / scale;
      scale = next;
      place();
    }
    stage.addEventListener("wheel", (event) => {
      event.preventDefault();
      const frame = stage.getBoundingClientRect();
      zoom(Math.exp(-event.deltaY / 400), [event.clientX - frame.left, event.clientY - frame.top]);
    }, { passive: false });
    let from = null, moved = false;
    stage.addEventListener("pointerdown", (event) => {
      from = [event.clientX - x, event.clientY - y];
      moved = false;
    });
    stage.addEventListener("pointermove", (event) => {
      if (!from || !event.buttons) return;
      if (!moved && Math.hypot(event.clientX - x - from[0], event.clientY - y - from[1]) < 4) return;
      if (!moved) stage.setPointerCapture(event.pointerId);
      moved = true;
      [x, y] = [event.clientX - from[0], event.clientY - from[1]];
      place();
    });
    stage.addEventListener("pointerup", () => (from = null));
    stage.addEventListener("click", (event) => moved && event.preventDefault(), true);
    stage.addEventListener("dragstart", (event) => event.preventDefault());
    stage.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
      if (step) [x, y] = [x + step[0], y + step[1]], place();
      else if (event.key === "+" || event.key === "=") zoom(1.25);
      else if (event.key === "-") zoom(0.8);
      else if (event.key === "0") fit();
      else return;
      event.preventDefault();
    });
    // The picture may be drawn anew while somebody looks at it: the same part stays in sight.
    function renew() {
      const figure = [...document.querySelectorAll("figure.picture")].find((each) => captionOf(each) === caption);
      const next = figure?.querySelector(".canvas svg");
      if (!next) return;
      const fresh = next.cloneNode(true);
      fresh.style.width = next.width.baseVal.value + "px";
      fresh.style.height = next.height.baseVal.value + "px";
      view.replaceWith(fresh);
      [view, svg] = [fresh, next];
      place();
    }
    document.addEventListener("archgen:content", renew);
    close.addEventListener("click", () => dialog.close());
    dialog.addEventListener("close", () => {
      document.removeEventListener("archgen:content", renew);
      dialog.remove();
    });
    document.body.append(dialog);
    dialog.showModal();
    fit();
    stage.focus();
  }

  const captionOf = (figure) => figure.querySelector("figcaption span")?.textContent;

  function equipPictures() {
    for (const figure of document.querySelectorAll("figure.picture")) {
      const svg = figure.querySelector(".canvas svg");
      if (!svg) continue;
      const caption = captionOf(figure);
      const open = figure.querySelector("a.whole");
      const name = new URL(open.href).pathname.replace(/^.*\/figures\/|\.svg$/g, "").replaceAll("/", "-");
      const control = element("button", { type: "button", className: "closer", ariaLabel: "Look closer: " + caption });
      control.textContent = "Look closer";
      control.addEventListener("click", () => look(svg, caption, name));
      open.before(control, " ");
      figure.classList.add("zooms");
      for (const canvas of figure.querySelectorAll(".canvas")) {
        canvas.addEventListener("click", (event) => {
          if (!event.target.closest("a")) look(canvas.querySelector("svg"), caption, name);
        });
      }
    }
  }
  equipPictures();

  // Under `archgen serve` the content of a page is exchanged while somebody reads it.
  document.addEventListener("archgen:content", () => {
    equipTables();
    obeyAddress();
    watchBoxes();
    equipPictures();
  });
})();
