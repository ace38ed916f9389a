// The explorer's data: tables come as classic scripts (so that it works from the disk) and become objects here.
// The order of the fields is that of archgen/views/explorer/map_shapes.py. Loaded first: it also hides the static page.
"use strict";
const archgenExplorer = (function () {
  document.documentElement.classList.add("explores");
  const tables = {};
  const FIELDS = {
    groups: ["address", "id", "title", "owners", "summary", "place", "nodePlace", "written"],
    hosts: ["address", "id", "title", "line", "summary", "place", "written"],
    components: ["address", "id", "title", "group", "line", "summary", "keys", "period", "progress", "severity", "place",
      "written"],
    shells: ["address", "id", "title", "group", "around", "components", "line", "summary", "keys", "severity", "place", "written"],
    nodes: ["address", "id", "title", "components", "group", "host", "line", "summary", "keys", "period", "severity",
      "place", "hostPlace", "written"],
    topics: ["address", "name", "flow", "medium"],
    types: ["name", "message"],
    outputs: ["component", "name", "type", "note", "warning"],
    inputs: ["component", "name", "type", "note", "marks"],
    rims: ["shell", "isOutput", "name", "type", "note", "marks", "ports", "sources"],
    activities: ["id", "node", "components", "waits", "responds", "why"],
    steps: ["tail", "head", "isCall", "link", "waits", "responds", "why"],
    chains: ["address", "id", "title", "status", "words", "components", "nodes"],
    requirements: ["address", "id", "title", "components"],
    findings: ["kind", "element", "severity", "message"],
  };
  const STYLES = ["data", "physical", "service", "action"];

  // Each part of the data calls this; a long table comes in several.
  function addRows(name, rows) {
    tables[name] = (tables[name] ?? []).concat(rows);
  }

  function named(name) {
    const fields = FIELDS[name];
    return (tables[name] ?? []).map((row, number) => {
      const made = { number };
      fields.forEach((field, at) => (made[field] = row[at]));
      return made;
    });
  }

  // All elements, with the neighbours that steps of selectors follow, and the flows that arrows show.
  function readModel() {
    const model = { keys: tables.keys ?? [], names: new Map(), icons: new Map(tables.icons ?? []) };
    for (const name of Object.keys(FIELDS)) model[name] = named(name);
    for (const [key, value, title] of tables.names ?? []) model.names.set(key + ":" + value, title);
    for (const { element, kind, severity, message } of model.findings) {
      (model[["components", "nodes", "shells"][kind]][element].findings ??= []).push({ severity, message });
    }
    for (const component of model.components) Object.assign(component, { kind: "component", inputs: [], outputs: [], nodes: [], around: null });
    for (const node of model.nodes) {
      node.kind = "node";
      for (const at of node.components) model.components[at].nodes.push(node.number);
    }
    for (const port of model.outputs) model.components[port.component].outputs.push(port);
    for (const port of model.inputs) model.components[port.component].inputs.push(port);
    addShells(model);
    for (const group of model.groups) group.kind = "group";
    for (const host of model.hosts) host.kind = "host";
    // The lines between groups that the build has found: through which places between their ends they pass.
    model.ways = new Map((tables.ways ?? []).map(([first, last, lanes]) => [[first, last].sort((a, b) => a - b).join(" "), { ends: [first, last], lanes }]));
    addFlows(model);
    addLinks(model);
    return model;
  }

  // Composed components, outer ones first: each with all components inside, and its ports with what stands behind them.
  function addShells(model) {
    for (const shell of model.shells) {
      const around = model.shells[shell.around] ?? null;
      Object.assign(shell, { kind: "component", isComposed: true, around, inputs: [], outputs: [], nodes: [], leaves: [] });
      for (const at of shell.components) {
        const component = model.components[at];
        component.around = shell;
        // Ports that nothing inside carries: they are a component of the same id, until somebody designs what does.
        if (component.id === shell.id) component.title = "Not designed yet";
      }
    }
    for (const component of model.components) {
      for (let shell = component.around; shell; shell = shell.around) {
        shell.leaves.push(component);
        shell.nodes = [...new Set([...shell.nodes, ...component.nodes])];
      }
    }
    for (const each of [...model.shells, ...model.components]) each.fullTitle = (each.around ? each.around.fullTitle + " · " : "") + each.title;
    for (const port of model.inputs) readMarks(port);
    for (const rim of model.rims) {
      readMarks(rim);
      rim.element = model.shells[rim.shell];
      rim.element[rim.isOutput ? "outputs" : "inputs"].push(rim);
      for (const at of rim.ports) (model[rim.isOutput ? "outputs" : "inputs"][at].rims ??= []).push(rim);
    }
  }

  function readMarks(port) {
    port.optional = Boolean(port.marks & 1);
    port.made = Boolean(port.marks & 2);
  }

  function addFlows(model) {
    const steps = newSteps(model.components.length);
    model.readers = model.outputs.map(() => new Set());
    model.writers = model.inputs.map(() => new Set());
    model.sources = model.inputs.map(() => []);
    model.flows = (tables.flows ?? []).map(([style, inputAt, outputs, medium = ""], number) => {
      const input = model.inputs[inputAt];
      const writer = model.outputs[outputs[0]].component;
      const isCall = style > 1;
      for (const at of outputs) model.readers[at].add(input.component);
      model.writers[inputAt].add(writer);
      model.sources[inputAt].push(...outputs);
      addStep(steps, writer, input.component);
      if (isCall) addStep(steps, input.component, writer);
      const names = outputs.map((at) => model.outputs[at].name).join(", ");
      const types = [...new Set(outputs.map((at) => model.types[model.outputs[at].type]?.name).filter(Boolean))];
      const warning = [...new Set(outputs.map((at) => model.outputs[at].warning).filter(Boolean))].join(", ");
      return { number, warning, style: STYLES[style], medium, tail: isCall ? input.component : writer, head: isCall ? writer : input.component,
        optional: input.optional, made: input.made, label: types.join(", ") || names, from: names, to: input.name, types, input, outputs,
        writers: outputs.map((at) => model.outputs[at]) };
    });
    for (const [tail, head] of tables.extra ?? []) addStep(steps, tail, head);
    model.componentSteps = steps;
  }

  function addLinks(model) {
    const steps = newSteps(model.nodes.length);
    model.links = (tables.links ?? []).map(([tail, head, at], number) => {
      const topic = model.topics[at];
      addStep(steps, tail, head);
      if (topic.flow !== "topic") addStep(steps, head, tail);
      return { number, style: topic.flow === "topic" ? "data" : topic.flow, medium: topic.medium ?? "", tail, head, optional: false, label: topic.name, topic,
        from: topic.name, to: "", types: [] };
    });
    model.nodeSteps = steps;
  }

  // A level that the project has not (hosts, where no node runs on one) has no places.
  const orNull = (place) => (place?.length ? place : null);

  const newSteps = (count) => ({ after: Array.from({ length: count }, () => new Set()), before: Array.from({ length: count }, () => new Set()) });

  function addStep(steps, tail, head) {
    if (tail === head) return;
    steps.after[tail].add(head);
    steps.before[head].add(tail);
  }

  // What a level shows: members, the homes that hold them, and flows.
  function readLevel(model, name) {
    const level = name === "components" || name === "groups" ? readComponentLevel(model, name) : readNodeLevel(model, name);
    const homes = new Set(level.homes), shells = new Set(level.shells);
    level.isHome = (each) => homes.has(each);
    level.isContainer = (each) => homes.has(each) || shells.has(each);
    // What is around an element, the outermost first.
    level.aroundOf = (each) => {
      if (homes.has(each)) return [];
      const path = [];
      for (let shell = each.around; shells.has(shell); shell = shell.around) path.unshift(shell);
      return [level.homes[level.homeOf(each)], ...path];
    };
    // What stands directly in a home or in a composed component, and all members inside, in the order of the members.
    level.children = new Map([...homes, ...shells].map((container) => [container, []]));
    const leaves = level.homes.map(() => []);
    const known = new Set();
    for (const member of level.members) {
      leaves[level.homeOf(member)].push(member);
      const path = [...level.aroundOf(member), member];
      for (let at = path.length - 1; at > 0 && !known.has(path[at]); at -= 1) {
        known.add(path[at]);
        level.children.get(path[at - 1]).push(path[at]);
      }
    }
    level.leavesOf = (each) => (homes.has(each) ? leaves[each.number] : each.isComposed ? each.leaves : [each]);
    return level;
  }

  function readComponentLevel(model, name) {
    const opens = name === "components";
    return { name, members: model.components, flows: model.flows, homes: model.groups, shells: opens ? model.shells : [],
      homeOf: (each) => each.group, placeOf: (each) => orNull(each.place), homePlaceOf: (home) => orNull(home.place), opens, ways: model.ways };
  }

  // Nodes without a home get one of their own.
  function readNodeLevel(model, name) {
    const byHost = name === "hosts";
    const homes = byHost ? model.hosts : model.groups;
    const field = byHost ? "host" : "group";
    const isOpen = model.nodes.some((node) => node[field] < 0);
    const rest = { kind: byHost ? "host" : "group", id: "", title: byHost ? "On no host yet" : "Of no group", number: homes.length,
      owners: "", line: "", summary: "", address: "", place: null };
    return { name, members: model.nodes, flows: model.links, homes: isOpen ? [...homes, rest] : homes, shells: [],
      homeOf: (node) => (node[field] < 0 ? homes.length : node[field]),
      placeOf: (node) => orNull(byHost ? node.hostPlace : node.place),
      homePlaceOf: (home) => orNull(byHost ? home.place : home.nodePlace), opens: true, ways: new Map() };
  }

  // An element with properties and children: text is text, whatever it holds.
  function element(name, properties, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(properties ?? {})) {
      if (key in made) made[key] = value;
      else made.setAttribute(key, value);
    }
    made.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== ""));
    return made;
  }

  function shape(name, attributes, ...children) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes ?? {})) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  const unique = (values) => [...new Set(values)];
  const count = (number, noun) => `${number.toLocaleString("en")} ${number === 1 ? noun : noun + "s"}`;

  return { addRows, readModel, readLevel, element, shape, unique, count };
})();
