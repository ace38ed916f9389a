// From the address to what it means on a level: the chosen element, open homes, what is lit, and the focus. What is not there is
// said, and the rest is obeyed.
"use strict";
archgenExplorer.readChoice = (function () {
  const { grammar } = archgenExplorer;

  return function readChoice(model, select, state, level) {
    const hints = [];
    const nearest = (name, things) => {
      const guess = archgenExplorer.findClosest(name, things.map(({ id }) => id));
      hints.push(`${name} is not here${guess ? `; nearest: ${guess}` : ""}.`);
    };
    const picked = readPick(level, state.pick, nearest);
    const open = readOpen(level, state.open, picked, nearest);
    const isNodes = level.members === model.nodes;
    const numbersOf = (selection) => (isNodes ? selection.nodes : selection.components);
    const selection = state.sel ? select(state.sel) : null;
    const isWrong = selection?.problems.some(({ severity }) => severity === "error");
    const lit = selection && !isWrong ? numbersOf(selection) : null;
    const focus = lit && readFocus(state.sel);
    const base = focus && numbersOf(select(focus.atom));
    const sideOf = base ? measureSides(isNodes ? model.nodeSteps : model.componentSteps, base, focus) : () => "plain";
    return { picked, open, selection, lit, focus, sideOf, hints };
  };

  function readPick(level, id, nearest) {
    if (!id || id.includes(">") || id.startsWith("fold ") || id === "rest") return null;
    const found = level.members.find((member) => member.id === id) ?? level.homes.find((home) => home.id === id);
    if (!found) return void nearest(id, [...level.members, ...level.homes]) ?? null;
    return level.opens || level.homes.includes(found) ? found : level.homes[level.homeOf(found)];
  }

  // The home of what is chosen is open: else it would have no box.
  function readOpen(level, ids, picked, nearest) {
    const open = ids.includes("*") ? level.homes.map(({ id }) => id) : [...ids];
    const known = open.filter((id) => level.homes.some((home) => home.id === id) || void nearest(id, level.homes));
    if (picked && !level.homes.includes(picked)) known.push(level.homes[level.homeOf(picked)].id);
    return [...new Set(known)];
  }

  // A selector of one word is a focus, with steps before and after.
  function readFocus(text) {
    const { words } = grammar.parse(text);
    if (words.length !== 1 || words[0].negative || words[0].rangeEnd) return null;
    const { atom, before, after } = words[0];
    const steps = (number) => (number === grammar.ALL_STEPS ? Infinity : number);
    return { atom: text.slice(atom.start, atom.end), before: steps(before), after: steps(after) };
  }

  // Whether a flow leads towards the focus, comes from it within the steps asked for, or neither.
  function measureSides(steps, base, focus) {
    const [before, after] = [measure(steps.before, base), measure(steps.after, base)];
    return ({ tail, head }) => {
      const feeds = before.get(head) < focus.before ? before.get(head) : Infinity;
      const fed = after.get(tail) < focus.after ? after.get(tail) : Infinity;
      return Math.min(feeds, fed) === Infinity ? "" : feeds <= fed ? "before" : "after";
    };
  }

  function measure(neighbours, starts) {
    const distances = new Map([...starts].map((at) => [at, 0]));
    for (const [at, distance] of distances) for (const other of neighbours[at]) if (!distances.has(other)) distances.set(other, distance + 1);
    return distances;
  }
})();
