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
    const isNodes = level.members === model.nodes;
    const picked = readPick(level, isNodes ? [] : model.shells, state.pick, nearest);
    const open = readOpen(level, state.open, picked, nearest);
    const numbersOf = (selection) => (isNodes ? selection.nodes : selection.components);
    const selection = state.sel ? select(state.sel) : null;
    const isWrong = selection?.problems.some(({ severity }) => severity === "error");
    const all = selection && !isWrong ? numbersOf(selection) : null;
    const shortest = all && selection.ends ? keepShortest(model, isNodes, all, selection.ends) : all;
    const lit = state.ways ? all : shortest, longer = all ? all.size - shortest.size : 0;
    const focus = lit && readFocus(state.sel);
    const base = focus && numbersOf(select(focus.atom));
    const sideOf = base ? measureSides(isNodes ? model.nodeSteps : model.componentSteps, base, focus) : () => "plain";
    return { picked, open, selection, lit, longer, focus, sideOf, hints };
  };

  function readPick(level, allShells, id, nearest) {
    if (!id || id.includes(">") || id.startsWith("fold ") || id === "rest") return null;
    // Composed components first: ports that nothing carries yet are a component of the same id.
    const found = [...allShells, ...level.members, ...level.homes].find((each) => each.id === id);
    if (!found) return void nearest(id, [...allShells, ...level.members, ...level.homes]) ?? null;
    return level.opens || level.isHome(found) ? found : level.homes[level.homeOf(found)];
  }

  // `*` opens all homes, `**` all that they hold as well. What is around something open or chosen is open: else that would have no box.
  function readOpen(level, ids, picked, nearest) {
    const containers = [...level.homes, ...level.shells];
    const byId = new Map(containers.map((each) => [each.id, each]));
    const wanted = ids.includes("**") ? containers : ids.includes("*") ? [...level.homes] : [];
    for (const id of ids.filter((each) => each !== "*" && each !== "**")) {
      if (byId.has(id)) wanted.push(byId.get(id));
      else nearest(id, containers);
    }
    const open = wanted.flatMap((each) => [...level.aroundOf(each), each]);
    if (picked) open.push(...level.aroundOf(picked));
    return archgenExplorer.unique(open.map(({ id }) => id));
  }

  // Of all that lies on ways from one end to the other, what lies on those of fewest steps: of a robot with feedback nearly
  // everything lies on some way.
  function keepShortest(model, isNodes, all, { first, last }) {
    const { before, after } = isNodes ? model.nodeSteps : model.componentSteps;
    const [starts, ends] = [first, last].map((end) => (isNodes ? end.nodes : end.components));
    if ([...starts].some((each) => ends.has(each))) return all;
    // The first step of outputs is to their own readers.
    const outputs = isNodes ? [] : first.outputs;
    const gone = measure(after, outputs.length ? outputs.flatMap((at) => [...model.readers[at]]) : starts), left = measure(before, ends);
    const isStart = (each) => outputs.length > 0 && starts.has(each);
    const count = (each) => (isStart(each) ? Infinity : (gone.get(each) ?? Infinity) + (left.get(each) ?? Infinity));
    const fewest = Math.min(...[...all].map(count));
    return fewest === Infinity ? all : new Set([...all].filter((each) => isStart(each) || count(each) === fewest));
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
