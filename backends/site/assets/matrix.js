// Works a matrix: folds and unfolds groups, orders rows, shows what a cell holds and the loop that it closes.
// The page has the matrix as a table already; its data come as a script, so that it works from the disk.
"use strict";
(function () {
  const { rows, columns, groups, titles, flows, words, order, back: marksBack } = archgenMatrix;
  const [rowWord, groupWord, flowWord, giverWord] = words;
  const isSquare = !columns.length;
  const MOST_ROWS = 150; // a table of so many squared is still drawn within a second
  const DENSE = 24; // from so many columns on cells are small
  const WAIT = 120; // ms that the pointer rests before a card is shown
  const MOST_LISTED = 6;
  const box = document.querySelector(".matrix-box");
  const tools = document.querySelector(".matrix-tools");
  const summary = document.querySelector(".matrix-summary");
  const side = document.querySelector(".matrix-side");

  function element(name, properties, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children.filter((child) => child !== null));
    return made;
  }
  const plural = (word, count) => (count === 1 ? word : /[^aeiou]y$/.test(word) ? word.slice(0, -1) + "ies" : word + "s");
  const counted = (count, word) => count + " " + plural(word, count);
  const capital = (word) => word[0].toUpperCase() + word.slice(1);
  const linked = (entry) => (entry.href ? element("a", { href: entry.href, textContent: entry.title }) : element("span", { textContent: entry.title }));

  // --- state, which stands in the address ------------------------------------------------------------------------
  const folding = isSquare && groups.length > 1;
  const open = new Set();
  let sorting = "feedback";

  function readAddress() {
    const wanted = new URLSearchParams(location.search);
    const level = wanted.get("level");
    const isSmall = rows.length <= 30 && !level && !wanted.has("open");
    if (level === rowWord || isSmall) groups.forEach((_, at) => open.add(at));
    for (const name of (wanted.get("open") ?? "").split("~")) {
      const at = groups.findIndex((group) => group[0] === name);
      if (at >= 0) open.add(at);
    }
    if (["feedback", "name", "flows"].includes(wanted.get("order"))) sorting = wanted.get("order");
  }

  function remember() {
    const address = new URL(location.href);
    const all = open.size === groups.length;
    const set = (name, value) => (value ? address.searchParams.set(name, value) : address.searchParams.delete(name));
    set("level", !folding ? "" : all ? rowWord : open.size ? "" : groupWord);
    set("open", folding && !all && open.size ? [...open].map((at) => groups[at][0]).join("~") : "");
    set("order", sorting === "feedback" ? "" : sorting);
    try {
      history.replaceState(history.state, "", address);
    } catch (refused) {
      // Some browsers keep the address of a file as it is.
    }
  }

  // --- what is shown: entries that stand for one row of the data, or for a folded group ---------------------------
  function makeEntry([title, href, remark, group], members) {
    return { title, href, remark, group, members };
  }

  function listEntries(all) {
    const blocks = new Map();
    all.forEach((row, at) => {
      const key = row[3] < 0 || !folding ? "row " + at : row[3];
      if (!blocks.has(key)) blocks.set(key, []);
      blocks.get(key).push(makeEntry(row, [at]));
    });
    let shown = [...blocks].map(([key, members]) => {
      if (typeof key === "string" || open.has(key)) return members;
      const [title, href, remark] = groups[key];
      const size = counted(members.length, rowWord);
      return [{ title, href, remark: remark ? remark + " · " + members.length : size, group: key, members: members.flatMap((one) => one.members), folded: true }];
    });
    if (sorting !== "feedback") {
      const rank = sorting === "name" ? (a, b) => a.title.localeCompare(b.title, "en", { numeric: true }) : (a, b) => weight(b) - weight(a);
      shown.forEach((block) => block.sort(rank));
      const total = (block) => block.reduce((sum, one) => sum + weight(one), 0);
      const name = (block) => (block[0].group >= 0 && folding ? groups[block[0].group][0] : block[0].title);
      shown.sort(sorting === "name" ? (a, b) => name(a).localeCompare(name(b), "en", { numeric: true }) : (a, b) => total(b) - total(a));
    }
    shown.forEach((block) => (block[0].begins = true));
    return shown.flat();
  }

  const weights = new Map();
  for (const [row, column] of flows) {
    weights.set(row, (weights.get(row) ?? 0) + 1);
    if (isSquare) weights.set(column, (weights.get(column) ?? 0) + 1);
  }
  const weight = (entry) => entry.members.reduce((sum, at) => sum + (weights.get(at) ?? 0), 0);

  let down = [], across = [], cells = new Map();

  function gather() {
    down = listEntries(rows);
    across = isSquare ? down : columns.map((column, at) => makeEntry(column, [at]));
    const rowPlaces = new Map(down.flatMap((entry, place) => entry.members.map((at) => [at, place])));
    const columnPlaces = isSquare ? rowPlaces : new Map(across.map((_, at) => [at, at]));
    cells = new Map();
    for (const flow of flows) {
      const key = rowPlaces.get(flow[0]) + " " + columnPlaces.get(flow[1]);
      if (!cells.has(key)) cells.set(key, []);
      cells.get(key).push(flow);
    }
  }

  const runsBack = (row, column) => marksBack && row > column;

  // The shortest way back from the taker to the giver: with the cell itself it is a loop.
  function findLoop(row, column) {
    const before = new Map([[column, null]]);
    const queue = [column];
    for (const at of queue) {
      if (at === row) break;
      for (let next = 0; next < across.length; next += 1) {
        if (!before.has(next) && cells.has(at + " " + next)) {
          before.set(next, at);
          queue.push(next);
        }
      }
    }
    if (!before.has(row)) return null;
    const way = [];
    for (let at = row; at !== null; at = before.get(at)) way.unshift(at);
    return way;
  }

  // --- the table ------------------------------------------------------------------------------------------------
  function draw(focusOn) {
    hideCard();
    gather();
    note.textContent = "";
    if (down.length > MOST_ROWS) {
      open.clear();
      gather();
      note.textContent = `Above ${MOST_ROWS} rows groups stay folded.`;
    }
    const body = element("tbody", {}, ...down.map(drawRow));
    const heads = across.map((entry) => {
      const head = element("th", { scope: "col", title: entry.title }, element("div", {}, linked(entry)));
      return head;
    });
    const table = element("table", { className: "matrix" + (across.length > DENSE ? " dense" : "") + (isSquare ? "" : " oblong") },
      element("caption", { className: "spoken", textContent: document.querySelector("h1").textContent + ": " + giverWord }),
      element("thead", {}, element("tr", {}, element("td", {}), ...heads)), body);
    table.style.setProperty("--columns", across.length);
    box.replaceChildren(table);
    const links = [...table.querySelectorAll("td > a")];
    links.forEach((link, at) => (link.tabIndex = at ? -1 : 0));
    describe();
    drawBackList();
    drawTools();
    if (focusOn !== undefined) table.querySelector(`[data-group="${focusOn}"]`)?.focus();
  }

  function drawRow(entry, row) {
    const head = element("th", { scope: "row" });
    if (folding && entry.group >= 0 && (entry.folded || entry.begins)) {
      const name = groups[entry.group][0];
      const control = element("button", { type: "button", className: "fold", textContent: entry.folded ? "▸" : "▾", ariaLabel: (entry.folded ? "Unfold " : "Fold ") + name, title: (entry.folded ? "Unfold " : "Fold ") + name });
      control.ariaExpanded = String(!entry.folded);
      control.dataset.group = entry.group;
      control.addEventListener("click", () => {
        if (entry.folded) open.add(entry.group);
        else open.delete(entry.group);
        draw(entry.group);
        remember();
      });
      head.append(control);
    }
    head.append(linked(entry));
    if (entry.remark) head.append(element("span", { className: "remark", textContent: entry.remark }));
    const line = element("tr", { className: entry.begins && folding && !entry.folded ? "begins" : "" }, head);
    // Of many columns empty cells beside one another are one: a hundred groups squared are ten thousand cells.
    const joins = across.length > DENSE;
    let gap = null;
    across.forEach((_, column) => {
      const cell = drawCell(row, column);
      const isEmpty = !cell.className;
      if (isEmpty && gap && joins) {
        gap.colSpan += 1;
        gap.className = "gap";
        return;
      }
      gap = isEmpty ? cell : null;
      line.append(cell);
    });
    return line;
  }

  function drawCell(row, column) {
    const inside = cells.get(row + " " + column);
    if (isSquare && row === column) {
      const cell = element("td", { className: "self" });
      if (inside) cell.append(String(inside.length), element("small", { textContent: "inside" }));
      return cell;
    }
    if (!inside) return element("td", {});
    const step = [8, 4, 2, 1].find((least) => inside.length >= least);
    const back = runsBack(row, column);
    const link = element("a", { href: titles[inside[0][2]][1] || "#content", textContent: inside.length });
    link.ariaLabel = `${down[row].title} to ${across[column].title}: ${counted(inside.length, flowWord)}${back ? ", runs back" : ""}`;
    link.dataset.row = row;
    link.dataset.column = column;
    return element("td", { className: "f" + step + (back ? " back" : "") }, link);
  }

  function describe() {
    let between = 0, back = 0;
    for (const [key, list] of cells) {
      const [row, column] = key.split(" ").map(Number);
      if (!isSquare || row !== column) between += list.length;
      if (runsBack(row, column)) back += list.length;
    }
    const word = down.every((entry) => entry.folded) ? groupWord : rowWord;
    const among = down.every((entry) => entry.folded) || !down.some((entry) => entry.folded) ? counted(down.length, word) : `${down.length} rows`;
    const direction = marksBack ? `, ${back || "none"} of them ${back === 1 ? "runs" : "run"} back` : "";
    summary.textContent = `${giverWord}; ${counted(between, flowWord)} ${isSquare ? "between" : "of"} ${among}${direction}`;
    const said = { feedback: order, name: "by name, in their groups", flows: `most ${flowWord}s first, in their groups` };
    document.querySelector(".matrix-order").textContent = said[sorting];
  }

  function drawBackList() {
    side.querySelector(".back-list")?.remove();
    if (!marksBack) return;
    const back = [...cells].map(([key, list]) => [...key.split(" ").map(Number), list.length]).filter(([row, column]) => row > column).sort((a, b) => b[2] - a[2]);
    if (!back.length) return;
    const items = back.slice(0, 12).map(([row, column, count]) => {
      const control = element("button", { type: "button" }, `${down[row].title} → ${across[column].title}`, element("b", { textContent: count }));
      control.addEventListener("click", () => box.querySelector(`a[data-row="${row}"][data-column="${column}"]`).focus());
      return element("li", {}, control);
    });
    const more = back.length > 12 ? element("p", { className: "muted", textContent: `and ${back.length - 12} more cells` }) : null;
    side.append(element("section", { className: "back-list" }, element("h2", { textContent: "What runs back" }), element("ul", {}, ...items), more));
  }

  // --- tools ----------------------------------------------------------------------------------------------------
  const levels = element("div", { className: "levels", role: "group", ariaLabel: "Level" });
  const sorter = element("select", { ariaLabel: "Order" },
    ...[["feedback", marksBack ? "Order: least feedback" : "Order: as declared"], ["name", "Order: name"], ["flows", `Order: most ${flowWord}s`]].map(([value, text]) => element("option", { value, textContent: text })));
  const note = element("span", { className: "muted", role: "status" });
  sorter.addEventListener("change", () => {
    sorting = sorter.value;
    draw();
    remember();
  });
  if (folding) {
    for (const [word, unfolds] of [[groupWord, false], [rowWord, true]]) {
      const control = element("button", { type: "button", textContent: capital(plural(word, 2)) });
      control.dataset.unfolds = unfolds;
      control.addEventListener("click", () => {
        open.clear();
        if (unfolds) groups.forEach((_, at) => open.add(at));
        draw();
        remember();
      });
      levels.append(control);
    }
    tools.prepend(levels);
  }
  summary.before(sorter);
  summary.after(note);

  function drawTools() {
    sorter.value = sorting;
    for (const control of levels.children) {
      control.ariaPressed = String(control.dataset.unfolds === "true" ? open.size === groups.length : open.size === 0);
    }
  }

  // --- the card: what hover shows, focus shows too ---------------------------------------------------------------
  const card = element("div", { className: "matrix-card", hidden: true });
  let timer = 0, shownFor = null;
  document.querySelector(".matrix-view").append(card);

  function hideCard() {
    clearTimeout(timer);
    card.hidden = true;
    shownFor = null;
    box.querySelectorAll(".lit, .crossed").forEach((lit) => lit.classList.remove("lit", "crossed"));
  }

  function showCard(link) {
    clearTimeout(timer);
    if (shownFor === link) return;
    hideCard();
    shownFor = link;
    const row = Number(link.dataset.row), column = Number(link.dataset.column);
    const list = cells.get(row + " " + column);
    const back = runsBack(row, column);
    card.replaceChildren(
      element("p", { className: "pair" }, linked(down[row]), " → ", linked(across[column])),
      element("p", { className: "muted", textContent: counted(list.length, flowWord) + (back ? ", run back: below the diagonal" : "") }),
      element("ul", {}, ...listFlows(list)));
    const way = marksBack ? findLoop(row, column) : null;
    if (way) card.append(element("p", { className: "loop", textContent: "Loop: " + [down[row], ...way.slice(0, -1).map((at) => down[at])].map((entry) => entry.title).join(" → ") + " → back" }));
    const cell = link.parentElement;
    [...cell.parentElement.children].slice(1).forEach((other) => other.classList.add("lit"));
    for (const line of box.querySelectorAll("tr")) lightColumn(line, column);
    card.hidden = false;
    place(cell.getBoundingClientRect());
  }

  // The cell of a line in a column; of several in one, the place of that column alone.
  function lightColumn(line, column) {
    let at = -1; // the head of the row
    for (const cell of line.children) {
      if (at <= column && column < at + cell.colSpan) {
        cell.classList.add(cell.colSpan > 1 ? "crossed" : "lit");
        cell.style.setProperty("--from", column - at);
        return;
      }
      at += cell.colSpan;
    }
  }

  // Each thing once, with its ends where the row or the column stands for several.
  function listFlows(list) {
    const told = new Map();
    for (const [row, column, title] of list) {
      const [text, href] = titles[title];
      const ends = isSquare ? rows[row][0] + " → " + rows[column][0] : "";
      const key = text + "\n" + ends;
      told.set(key, { text, href, ends, count: (told.get(key)?.count ?? 0) + 1 });
    }
    const items = [...told.values()].slice(0, MOST_LISTED).map(({ text, href, ends, count }) =>
      element("li", {}, linked({ title: text + (count > 1 ? ` (${count})` : ""), href }), ends ? element("span", { className: "muted", textContent: ends }) : null));
    if (told.size > MOST_LISTED) items.push(element("li", { className: "muted", textContent: `and ${told.size - MOST_LISTED} more` }));
    return items;
  }

  // Below the cell, or above it where that has more room; never over the row's head.
  function place(cell) {
    const { offsetWidth: width, offsetHeight: height } = card;
    const below = innerHeight - cell.bottom > height + 12 || innerHeight - cell.bottom > cell.top;
    const head = box.querySelector("tbody th").getBoundingClientRect().right;
    const left = Math.min(Math.max(head + 8, cell.left), Math.max(8, innerWidth - width - 12));
    card.style.left = left + "px";
    card.style.top = (below ? cell.bottom + 6 : Math.max(8, cell.top - height - 6)) + "px";
  }

  const cellLink = (event) => event.target.closest?.("td > a[data-row]");
  box.addEventListener("pointerover", (event) => {
    if (event.pointerType === "touch") return;
    const link = cellLink(event);
    clearTimeout(timer);
    timer = setTimeout(() => (link ? showCard(link) : hideCard()), WAIT);
  });
  box.addEventListener("pointerleave", () => (timer = setTimeout(hideCard, 2 * WAIT)));
  card.addEventListener("pointerenter", () => clearTimeout(timer));
  card.addEventListener("pointerleave", () => (timer = setTimeout(hideCard, WAIT)));
  box.addEventListener("focusin", (event) => {
    const link = cellLink(event);
    if (link && link.matches(":focus-visible, :focus")) showCard(link);
  });
  box.addEventListener("scroll", hideCard);
  // What holds several things opens its card; one thing is a link like any other.
  box.addEventListener("click", (event) => {
    const link = cellLink(event);
    if (!link || event.ctrlKey || event.metaKey) return;
    const list = cells.get(link.dataset.row + " " + link.dataset.column);
    if (new Set(list.map((flow) => flow[2])).size < 2 && event.pointerType !== "touch") return;
    event.preventDefault();
    showCard(link);
    if (event.detail === 0) card.querySelector("li a")?.focus();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && !card.hidden) {
      const link = shownFor;
      const wasInside = card.contains(document.activeElement);
      if (wasInside) link.focus();
      hideCard();
    }
  });

  // --- keys: arrows between filled cells ------------------------------------------------------------------------
  box.addEventListener("keydown", (event) => {
    const link = cellLink(event);
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    if (!link || !step) return;
    event.preventDefault();
    let row = Number(link.dataset.row) + step[0], column = Number(link.dataset.column) + step[1];
    while (row >= 0 && column >= 0 && row < down.length && column < across.length) {
      const next = box.querySelector(`a[data-row="${row}"][data-column="${column}"]`);
      if (next) {
        link.tabIndex = -1;
        next.tabIndex = 0;
        next.focus();
        return;
      }
      row += step[0];
      column += step[1];
    }
  });

  readAddress();
  draw();
})();
