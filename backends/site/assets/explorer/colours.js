// What boxes can be coloured and filtered by: partner, status, type, period, host, requirement, findings, progress, declared properties.
// A colour never says anything alone: the legend has the words, and the panel of each element too.
"use strict";
archgenExplorer.makeColours = function (model) {
  const TITLES = { group: "group", owner: "partner", status: "status", type: "type", period: "period", host: "host",
    requirement: "requirement", finding: "findings", progress: "progress" };
  // A declared property is `property:sil`; its choices follow it in their order.
  const PROPERTIES = [...model.names].filter(([name]) => /^property:[^:]+$/.test(name));
  for (const [name, title] of PROPERTIES) TITLES[name] = title;
  const choiceRank = (key, value) => [...model.names.keys()].indexOf(`${key}:${value}`);
  const STATUS_ORDER = ["planned", "adapted", "existing"];
  const STEPS = ["described", "typed", "mapped", "timed", "traced"];
  const PERIODS = [...model.names.keys()].filter((name) => name.startsWith("period:")).map((name) => name.slice(7));
  const SEVERITIES = { error: "an error", warning: "a warning", note: "a note" };
  const HUES = 10;
  // As in the overview: by the order in which the project declares its partners, so that whoever is added changes no colour.
  const PARTNERS = [...model.names.keys()].filter((name) => name.startsWith("owner:")).map((name) => name.slice(6));
  const PARTNER_HUES = 9;

  const nodesOf = (member) => (member.kind === "node" ? [member] : member.nodes.map((at) => model.nodes[at]));
  const componentsOf = (member) => (member.kind === "node" ? member.components.map((at) => model.components[at]) : [member]);
  const keysOf = (member, key) => member.keys.map((at) => model.keys[at]).filter(([name]) => name === key).map(([, value]) => value);
  const unique = (values) => [...new Set(values.filter((value) => value !== null && value !== undefined && value !== ""))];
  const countBits = (bits) => STEPS.filter((_, at) => bits & (1 << at)).length;

  // All values of a member, for filters; an empty list means that nothing is known.
  function valuesOf(member, key) {
    if (key === "owner") return keysOf(member, "owner");
    if (key.startsWith("property:")) return listFigures(member, key.slice(9));
    // What a component says of itself counts before what its nodes say.
    if (key === "status" && keysOf(member, key).length) return keysOf(member, key);
    if (key === "status" || key === "host") return unique(nodesOf(member).flatMap((node) => keysOf(node, key)));
    if (key === "type") return unique(componentsOf(member).flatMap((each) => [...each.outputs, ...each.inputs].map((port) => model.types[port.type]?.name)));
    if (key === "period") return [member.period];
    if (key === "requirement") return unique(componentsOf(member).flatMap((each) => keysOf(each, "requirement")));
    if (key === "finding") return unique((member.findings ?? []).map(({ severity }) => severity));
    if (key === "progress") return STEPS.filter((_, at) => componentsOf(member).some((each) => !(each.progress & (1 << at))));
    return [];
  }

  const listFigures = (member, name) => keysOf(member, "property").filter((text) => text.startsWith(name + "=")).map((text) => text.slice(name.length + 1));

  // The one value that gives a member its colour.
  function valueOf(member, key) {
    const values = valuesOf(member, key);
    if (key === "status") return STATUS_ORDER.find((status) => values.includes(status)) ?? "";
    if (key === "type") return model.types[componentsOf(member)[0]?.outputs[0]?.type]?.name ?? "";
    if (key === "requirement") return values.length ? "serves one" : "";
    if (key === "finding") return Object.keys(SEVERITIES).find((severity) => values.includes(severity)) ?? "";
    if (key === "progress") return String(Math.min(...componentsOf(member).map((each) => countBits(each.progress)), STEPS.length));
    return values[0] ?? "";
  }

  const NOTHING = { owner: "nobody yet", status: "no node yet", type: "no output", period: "unknown", host: "no host yet", requirement: "serves none",
    finding: "nothing found", progress: "" };

  function titleOf(key, value) {
    if (value === "") return NOTHING[key] ?? "not said";
    if (key === "progress") return /^\d$/.test(value) ? `${value} of ${STEPS.length} steps` : `not ${value} yet`;
    if (key === "finding") return SEVERITIES[value] ?? value;
    if (key === "requirement" && value === "serves one") return "serves a requirement";
    return model.names.get(key + ":" + value) ?? value;
  }

  const SPECIAL = {
    finding: { error: "error", warning: "warning", note: "link", "": "none" },
    status: { existing: "ok", adapted: "link", planned: "warning", "": "none" },
    requirement: { "serves one": "ok", "": "warning" },
    progress: { 0: "error", 1: "error", 2: "warning", 3: "warning", 4: "link", 5: "ok" },
  };

  // For each member a class and a title of its colour; and the legend, the most frequent value first.
  function colourLevel(level, key) {
    if (!(key in TITLES) || key === "group") {
      return { key: "group", classOf: (member) => `hue-${level.homeOf(member) % HUES}`, legend: [], nameOf: () => "" };
    }
    const values = level.members.map((member) => valueOf(member, key));
    const counts = new Map();
    for (const value of values) counts.set(value, (counts.get(value) ?? 0) + 1);
    const order = [...counts.keys()].sort((a, b) => rank(key, a, b) || counts.get(b) - counts.get(a) || (a < b ? -1 : 1));
    const classes = new Map(order.map((value) => [value, classOfValue(key, value, order)]));
    const legend = [];
    for (const value of order) {
      const name = classes.get(value);
      const isRest = name === "hue-rest";
      const entry = isRest ? legend.find((each) => each.className === name) : null;
      if (entry) entry.count += counts.get(value);
      else legend.push({ className: name, title: isRest ? "others" : titleOf(key, value), count: counts.get(value) });
    }
    return { key, classOf: (member) => classes.get(values[member.number]), legend, nameOf: (member) => titleOf(key, values[member.number]) };
  }

  function rank(key, a, b) {
    if ((a === "") !== (b === "")) return a === "" ? 1 : -1;
    if (key === "period") return PERIODS.indexOf(a) - PERIODS.indexOf(b);
    if (key.startsWith("property:")) return choiceRank(key, a) - choiceRank(key, b) || (parseFloat(a) - parseFloat(b) || 0);
    return key === "progress" ? Number(a) - Number(b) : 0;
  }

  function classOfValue(key, value, order) {
    if (key === "period") return "period-" + value.replaceAll("_", "-");
    if (SPECIAL[key]) return "hue-" + (SPECIAL[key][value] ?? "none");
    if (value === "") return "hue-none";
    if (key === "owner") {
      const place = PARTNERS.indexOf(value) + 1;
      return place > 0 && place <= PARTNER_HUES ? `partner-${place}` : "hue-rest";
    }
    const at = order.filter((each) => each !== "").indexOf(value);
    return at < HUES - 1 ? `hue-${at + 1}` : "hue-rest";
  }

  // Values to filter by, with how many members have each.
  function listValues(level, key) {
    const counts = new Map();
    for (const member of level.members) for (const value of valuesOf(member, key)) counts.set(value, (counts.get(value) ?? 0) + 1);
    return [...counts].map(([value, number]) => ({ value, title: titleOf(key, value), count: number }))
      .sort((a, b) => (key === "period" ? PERIODS.indexOf(a.value) - PERIODS.indexOf(b.value) : a.title.localeCompare(b.title, "en", { numeric: true })));
  }

  // Within a key one of its values is enough; each key must fit.
  function makeFilter(only) {
    const byKey = new Map();
    for (const [key, value] of only) byKey.set(key, [...(byKey.get(key) ?? []), value]);
    return (member) => [...byKey].every(([key, wanted]) => valuesOf(member, key).some((value) => wanted.includes(value)));
  }

  return { TITLES, colourLevel, listValues, makeFilter, titleOf, valuesOf, STEPS };
};
