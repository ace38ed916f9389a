// Which components and nodes a selector means. The same as archgen/model/selector_evaluation.py and selector_keys.py; tests run
// both on one table of cases. Elements are their numbers in the tables.
"use strict";
archgenExplorer.makeSelector = function (model) {
  const { parse, problem, ALL_STEPS } = archgenExplorer.grammar;
  const NAMES_HELP = "`archgen list` gives the names of all elements";
  const MAX_LISTED = 8;
  const BLANKS = /[\t-\r\x1c-\x20\x85\xa0\u1680\u2000-\u200a\u2028\u2029\u202f\u205f\u3000]+/u;
  const ALL_BELOW = ".**"; // behind a path: everything below it, to any depth
  const PATH_KINDS = ["group", "component", "output"];
  const numbers = (things) => things.map((_, at) => at);
  const union = (...sets) => new Set(sets.flatMap((set) => [...set]));

  // --- names: any ending of a complete id -----------------------------------------------------------------------
  const portId = (port) => `${model.components[port.component].id}.${port.name}`;
  // Behind the components stand the composed ones, behind the ports theirs; what is among both is one.
  const shellsById = new Map(model.shells.map((shell) => [shell.id, shell]));
  const componentIds = new Set(model.components.map(({ id }) => id));
  const wholes = model.shells.filter(({ id }) => !componentIds.has(id));
  const rimId = (rim) => `${rim.element.id}.${rim.name}`;
  const listRims = (isOutput, ports) => {
    const known = new Set(ports.map(portId));
    return model.rims.filter((rim) => Boolean(rim.isOutput) === isOutput && !known.has(rimId(rim)));
  };
  const rims = { output: listRims(true, model.outputs), input: listRims(false, model.inputs) };
  const ids = {
    group: model.groups.map((group) => group.id), component: [...model.components, ...wholes].map((component) => component.id),
    output: [...model.outputs.map(portId), ...rims.output.map(rimId)], input: [...model.inputs.map(portId), ...rims.input.map(rimId)],
    node: model.nodes.map((node) => node.id),
  };
  const endings = {};
  for (const [kind, names] of Object.entries(ids)) {
    endings[kind] = new Map();
    names.forEach((name, at) => {
      for (let end = name; ; end = end.slice(end.indexOf(".") + 1)) {
        if (!endings[kind].has(end)) endings[kind].set(end, []);
        endings[kind].get(end).push(at);
        if (!end.includes(".")) break;
      }
    });
  }

  function resolve(path, kinds) {
    const found = kinds.flatMap((kind) => (endings[kind].get(path) ?? []).map((at) => ({ kind, at, id: ids[kind][at] })));
    const complete = kinds.flatMap((kind) => found.filter((each) => each.kind === kind && each.id === path))[0];
    return complete ? [complete] : found;
  }

  function fits(pattern, text) {
    const [first, ...rest] = pattern.split("*");
    if (!rest.length) return pattern === text;
    const last = rest.pop();
    if (text.length < first.length + last.length || !text.startsWith(first) || !text.endsWith(last)) return false;
    const end = text.length - last.length;
    let at = first.length;
    for (const piece of rest) {
      const place = text.indexOf(piece, at);
      if (place < 0 || place + piece.length > end) return false;
      at = place + piece.length;
    }
    return true;
  }

  function fitsEnding(name, parts) {
    const own = name.split(".");
    return own.length >= parts.length && parts.every((part, at) => fits(part, own[own.length - parts.length + at]));
  }

  // --- hits -----------------------------------------------------------------------------------------------------
  const hitOf = (components, nodes, more = {}) =>
    ({ components: new Set(components), nodes: new Set(nodes), elements: [], outputs: [], onlyNodes: false, includesComponents: true, ...more });

  // The ports of components behind that of a composed one; any other stands for itself.
  const listLeafPorts = (kind, at) => rims[kind][at - model[kind + "s"].length]?.ports ?? [at];

  function hitOfElements(elements) {
    const components = new Set();
    for (const { kind, at, id } of elements) {
      if (kind === "group") for (const component of model.components) component.group === at && components.add(component.number);
      if (kind === "component") for (const leaf of shellsById.get(id)?.leaves ?? [model.components[at]]) components.add(leaf.number);
      if (kind === "output" || kind === "input") for (const port of listLeafPorts(kind, at)) components.add(model[kind + "s"][port].component);
    }
    const nodes = elements.filter(({ kind }) => kind === "node").map(({ at }) => at);
    const outputs = elements.filter(({ kind }) => kind === "output").map(({ at }) => at);
    return hitOf(components, nodes, { elements, outputs: outputs.length === elements.length ? outputs.flatMap((at) => listLeafPorts("output", at)) : [],
      onlyNodes: nodes.length > 0 && !components.size });
  }

  const NODE_KEYS = new Set(["host", "package", "node"]);

  function hitOfKey(key, value) {
    const pattern = key === "type" ? value.split(BLANKS).filter(Boolean).join(" ") : value;
    const matches = key === "property" ? archgenExplorer.propertyConditions.read(value, fits) ?? (() => false) : (text) => fits(pattern, text);
    const wanted = new Set(numbers(model.keys).filter((at) => model.keys[at][0] === key && matches(model.keys[at][1])));
    const has = (each) => each.keys.some((at) => wanted.has(at));
    const pick = (things) => things.filter(has).map((each) => each.number);
    const nodes = key === "node" ? model.nodes.filter((node) => fits(value, node.id)).map((node) => node.number) : pick(model.nodes);
    const components = NODE_KEYS.has(key) ? [] : pick(model.components);
    // Most statuses are those of nodes: where no component says this one, steps are between nodes.
    return hitOf(components, key === "type" ? [] : nodes,
      { onlyNodes: NODE_KEYS.has(key) || (key === "status" && !components.length), includesComponents: key !== "owner" });
  }

  function evaluateAtom(atom, problems) {
    const { key, value, start, end } = atom;
    if (key !== null) {
      const hit = hitOfKey(key, value);
      if (!hit.components.size && !hit.nodes.size) problems.push(problem(`nothing has \`${key}:${value}\``, start, end, null, "warning"));
      return hit;
    }
    if (value.endsWith(ALL_BELOW) && !value.slice(0, -ALL_BELOW.length).includes("*")) {
      return evaluatePath(value.slice(0, -ALL_BELOW.length), start, end - ALL_BELOW.length, problems);
    }
    if (value.includes("*")) {
      const parts = value.split(".");
      const found = ["group", "component", "output", "node"].flatMap((kind) =>
        numbers(kind === "output" ? model.outputs : ids[kind]).filter((at) => fitsEnding(ids[kind][at], parts)).map((at) => ({ kind, at, id: ids[kind][at] })));
      if (!found.length) problems.push(problem(`nothing fits \`${value}\``, start, end, null, "warning"));
      return hitOfElements(found);
    }
    return evaluatePath(value, start, end, problems);
  }

  function evaluatePath(path, start, end, problems) {
    const found = [PATH_KINDS, ["node"], ["input"]].map((kinds) => resolve(path, kinds)).find((each) => each.length) ?? [];
    if (found.length > 1) {
      const quoted = found.slice(0, MAX_LISTED).map(({ id }) => `\`${id}\``);
      const last = found.length > quoted.length ? `${found.length - quoted.length} more` : quoted.pop();
      problems.push(problem(`\`${path}\` can mean ${quoted.join(", ")} or ${last}`, start, end,
        `write more of the path, such as \`${found[0].id}\``));
    } else if (!found.length) {
      const dots = path.split(".").length;
      const pool = [...PATH_KINDS, "node"].flatMap((kind) => [...endings[kind].keys()].filter((name) => name.split(".").length === dots));
      const guess = archgenExplorer.findClosest(path, pool);
      problems.push(problem(`nothing is called \`${path}\``, start, end, guess ? `did you mean \`${guess}\`?` : NAMES_HELP));
    }
    return hitOfElements(found.length === 1 ? found : []);
  }

  // --- steps and ways -------------------------------------------------------------------------------------------
  function reach(neighbours, starts, limit = Infinity) {
    const seen = new Set(starts);
    let front = [...seen];
    for (let step = 0; front.length && step < limit; step += 1) {
      const next = [];
      for (const each of front) for (const other of neighbours[each]) if (!seen.has(other)) seen.add(other), next.push(other);
      front = next;
    }
    return seen;
  }

  // The first step of outputs is to their own readers: they feed less than their component does.
  function reachAfter(hit, limit) {
    const { after } = model.componentSteps;
    if (!hit.outputs.length || limit === 0) return reach(after, hit.components, limit);
    return reach(after, hit.outputs.flatMap((at) => [...model.readers[at]]), limit - 1);
  }

  function addOtherLevel(hit) {
    const nodes = [...hit.components].flatMap((at) => model.components[at].nodes);
    const crossing = hit.includesComponents ? [...hit.nodes].flatMap((at) => model.nodes[at].components) : [];
    return { ...hit, includesComponents: true, components: union(hit.components, crossing), nodes: union(hit.nodes, nodes) };
  }

  function addNeighbours(hit, before, after) {
    if (hit.onlyNodes) {
      const { nodeSteps } = model;
      return hitOf([], union(reach(nodeSteps.before, hit.nodes, before), reach(nodeSteps.after, hit.nodes, after)),
        { elements: hit.elements, onlyNodes: true });
    }
    const full = addOtherLevel(hit);
    const upstream = reach(model.componentSteps.before, full.components, before);
    return hitOf(union(full.components, upstream, reachAfter(full, after)), full.nodes, { elements: hit.elements });
  }

  const common = (one, other) => [...one].filter((each) => other.has(each));

  function findWays(first, last) {
    const elements = [...first.elements, ...last.elements];
    if (first.onlyNodes && last.onlyNodes) {
      const { before, after } = model.nodeSteps;
      return addOtherLevel(hitOf([], common(reach(after, first.nodes), reach(before, last.nodes)), { elements, onlyNodes: true }));
    }
    const [from, to] = [addOtherLevel(first), addOtherLevel(last)];
    const way = new Set(common(reachAfter(from, Infinity), reach(model.componentSteps.before, to.components)));
    if (from.outputs.length && way.size) for (const at of from.components) way.add(at);
    return addOtherLevel(hitOf(way, [], { elements }));
  }

  // Both ends of a way: between nodes where both are nodes.
  function readEnds(first, last) {
    const onlyNodes = first.onlyNodes && last.onlyNodes;
    return { first: { ...addOtherLevel(first), onlyNodes }, last: { ...addOtherLevel(last), onlyNodes } };
  }

  function evaluateWord(word, problems) {
    const limit = (steps) => (steps === ALL_STEPS ? Infinity : steps);
    let hit = evaluateAtom(word.atom, problems);
    if (word.rangeEnd) {
      const last = evaluateAtom(word.rangeEnd, problems);
      return { ...findWays(hit, last), ends: readEnds(hit, last) };
    }
    if (word.before || word.after) hit = addNeighbours(hit, limit(word.before), limit(word.after));
    return addOtherLevel(hit);
  }

  // --- the whole selector: all words, less those with `-` ---------------------------------------------------------
  function subtract(wanted, refused) {
    const refusedComponents = union(...refused.map((hit) => hit.components));
    const refusedNodes = union(...refused.filter((hit) => hit.onlyNodes).map((hit) => hit.nodes));
    const without = (set, others) => new Set([...set].filter((each) => !others.has(each)));
    const components = without(union(...wanted.map((hit) => hit.components)), refusedComponents);
    const nodes = without(union(...wanted.map((hit) => hit.nodes)), refusedNodes);
    for (const at of [...nodes]) {
      const own = model.nodes[at].components;
      if (own.some((each) => refusedComponents.has(each)) && !own.some((each) => components.has(each))) nodes.delete(at);
    }
    return { components, nodes, elements: wanted.flatMap((hit) => hit.elements), ends: wanted.length === 1 ? wanted[0].ends : undefined };
  }

  return function select(text) {
    const { words, problems } = parse(text);
    const evaluate = (negative) => words.filter((word) => word.negative === negative).map((word) => evaluateWord(word, problems));
    const [wanted, refused] = [evaluate(false), evaluate(true)];
    if (problems.some(({ severity }) => severity === "error")) return { components: new Set(), nodes: new Set(), elements: [], problems };
    if (!wanted.length) wanted.push(hitOf(numbers(model.components), numbers(model.nodes)));
    return { ...subtract(wanted, refused), problems };
  };
};
