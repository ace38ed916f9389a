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
    nodes: ["address", "id", "title", "components", "group", "host", "line", "summary", "keys", "period", "severity",
      "place", "hostPlace", "written"],
    topics: ["address", "name", "flow"],
    types: ["name", "message"],
    outputs: ["component", "name", "type", "note"],
    inputs: ["component", "name", "type", "note", "optional"],
    chains: ["address", "id", "title", "status", "words", "components", "nodes"],
    requirements: ["address", "id", "title", "components"],
    findings: ["isNode", "element", "severity", "message"],
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
    for (const { element, isNode, severity, message } of model.findings) {
      (model[isNode ? "nodes" : "components"][element].findings ??= []).push({ severity, message });
    }
    for (const component of model.components) Object.assign(component, { kind: "component", inputs: [], outputs: [], nodes: [] });
    for (const node of model.nodes) {
      node.kind = "node";
      for (const at of node.components) model.components[at].nodes.push(node.number);
    }
    for (const port of model.outputs) model.components[port.component].outputs.push(port);
    for (const port of model.inputs) model.components[port.component].inputs.push(port);
    for (const group of model.groups) group.kind = "group";
    for (const host of model.hosts) host.kind = "host";
    addFlows(model);
    addLinks(model);
    return model;
  }

  function addFlows(model) {
    const steps = newSteps(model.components.length);
    model.readers = model.outputs.map(() => new Set());
    model.writers = model.inputs.map(() => new Set());
    model.sources = model.inputs.map(() => []);
    model.flows = (tables.flows ?? []).map(([style, inputAt, outputs], number) => {
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
      return { number, style: STYLES[style], tail: isCall ? input.component : writer, head: isCall ? writer : input.component,
        optional: Boolean(input.optional), label: types.join(", ") || names, from: names, to: input.name, types };
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
      return { number, style: topic.flow === "topic" ? "data" : topic.flow, tail, head, optional: false, label: topic.name, topic,
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

  // What a level shows: members, the homes that hold them, and flows. Nodes without a home get one of their own.
  function readLevel(model, name) {
    if (name === "components" || name === "groups") {
      return { name, members: model.components, flows: model.flows, homes: model.groups, homeOf: (member) => member.group,
        placeOf: (member) => orNull(member.place), homePlaceOf: (home) => orNull(home.place), opens: name === "components" };
    }
    const byHost = name === "hosts";
    const homes = byHost ? model.hosts : model.groups;
    const field = byHost ? "host" : "group";
    const isOpen = model.nodes.some((node) => node[field] < 0);
    const rest = { kind: byHost ? "host" : "group", id: "", title: byHost ? "On no host yet" : "Of no group", number: homes.length,
      owners: "", line: "", summary: "", address: "", place: null };
    return { name, members: model.nodes, flows: model.links, homes: isOpen ? [...homes, rest] : homes,
      homeOf: (node) => (node[field] < 0 ? homes.length : node[field]),
      placeOf: (node) => orNull(byHost ? node.hostPlace : node.place),
      homePlaceOf: (home) => orNull(byHost ? home.place : home.nodePlace), opens: true };
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

  const count = (number, noun) => `${number.toLocaleString("en")} ${number === 1 ? noun : noun + "s"}`;

  return { addRows, readModel, readLevel, element, shape, count };
})();
