// What the reader has chosen, and how it stands in the address: `#level=components&open=human_state&sel=2%2Bfall_detector%2B1`.
// A step that Back should undo makes an entry in the history; moving and zooming only change the last one.
"use strict";
archgenExplorer.makeState = function (onChange, begin) {
  const LEVELS = ["groups", "components", "nodes", "hosts"];
  const VIEW_DELAY = 250; // ms without moving before the place is written into the address
  const initial = () => ({ level: "components", open: [], sel: "", pick: "", colour: "group", only: [], full: false, ways: false, list: false, at: null });
  const state = initial();
  let timer = 0;

  function read() {
    const given = new URLSearchParams(location.hash.slice(1));
    Object.assign(state, initial());
    if (!location.hash) begin(state);
    const level = given.get("level");
    if (LEVELS.includes(level)) state.level = level;
    if (location.hash) state.open = (given.get("open") ?? "").split(" ").filter(Boolean);
    state.sel = given.get("sel") ?? "";
    state.pick = given.get("pick") ?? "";
    state.colour = given.get("colour") ?? "group";
    state.only = given.getAll("only").map((text) => [text.slice(0, text.indexOf(":")), text.slice(text.indexOf(":") + 1)])
      .filter(([key]) => key);
    state.full = given.has("full");
    state.ways = given.get("ways") === "all";
    state.list = given.get("view") === "list";
    const at = (given.get("at") ?? "").split(",").map(Number);
    state.at = at.length === 3 && at.every(Number.isFinite) && at[2] > 0 ? at : null;
    return level && !LEVELS.includes(level) ? [`There is no level “${level}”.`] : [];
  }

  function write() {
    const given = new URLSearchParams({ level: state.level });
    if (state.open.length) given.set("open", state.open.join(" "));
    if (state.sel) given.set("sel", state.sel);
    if (state.pick) given.set("pick", state.pick);
    if (state.colour !== "group") given.set("colour", state.colour);
    for (const [key, value] of state.only) given.append("only", key + ":" + value);
    if (state.full) given.set("full", "1");
    if (state.ways) given.set("ways", "all");
    if (state.list) given.set("view", "list");
    if (state.at) given.set("at", state.at.map((value) => Math.round(value * 100) / 100).join(","));
    return "#" + given;
  }

  function put(isNew) {
    const address = write();
    if (address === location.hash) return;
    try {
      history[isNew ? "pushState" : "replaceState"](null, "", address);
    } catch (refused) {
      // Some browsers limit how often an address may change: the map works all the same.
    }
  }

  function change(parts) {
    clearTimeout(timer);
    // Another selector begins with its shortest ways.
    Object.assign(state, "sel" in parts ? { ways: false } : {}, parts);
    put(true);
    onChange();
  }

  function moved(at) {
    state.at = at;
    clearTimeout(timer);
    timer = setTimeout(() => put(false), VIEW_DELAY);
  }

  // Back and Forward, and addresses that somebody writes by hand: both may tell the same change.
  let last = location.hash;
  function obey() {
    if (location.hash === last && location.hash === write()) return;
    last = location.hash;
    clearTimeout(timer);
    onChange(read());
  }
  addEventListener("popstate", obey);
  addEventListener("hashchange", obey);

  return { state, read, change, moved, LEVELS };
};
