// The panel at the side: what the chosen box or arrow is, its ports, chains, requirements and open points, and what can be done.
"use strict";
archgenExplorer.makePanel = function (model, root, actions, durations) {
  const { element, shape, count } = archgenExplorer;
  const MAX_FLOWS = 60;
  const panel = element("aside", { className: "panel", ariaLabel: "Details", hidden: true });
  const link = (address, text) => (address ? element("a", { href: root + address, textContent: text }) : element("span", { textContent: text }));

  const pickButton = (each, text = each.fullTitle ?? each.title) => {
    const button = element("button", { type: "button", className: "name", textContent: text });
    button.addEventListener("click", () => actions.pick(each));
    return button;
  };
  const section = (title, remark, ...children) => element("section", {}, element("h3", {}, title, remark ? element("span", { className: "muted", textContent: remark }) : ""), ...children);
  // As the chips of pages: an icon, the word of the state, and what is added behind a " · ".
  const chip = (status, text) => {
    const [word, ...added] = text.replace("<= ", "≤ ").replace(">= ", "≥ ").split(" · ");
    const icon = shape("svg", { class: "icon", viewBox: "0 0 16 16", width: 12, height: 12, "aria-hidden": "true" },
      shape("path", { d: model.icons.get(status) ?? "" }));
    return element("span", { className: "chip " + status.replace(" ", "-") }, icon, word, added.length ? element("span", { className: "addition", textContent: added.join(" · ") }) : "");
  };
  const tag = (text) => element("span", { className: "tag", textContent: text });
  const tool = (text, act, name = "") => {
    const button = element("button", { type: "button", className: name, textContent: text });
    button.addEventListener("click", act);
    return button;
  };

  function open(kind, title, crumb, ...children) {
    const close = tool("×", () => actions.pick(null), "close");
    close.ariaLabel = "Close the details";
    panel.replaceChildren(element("header", {}, element("p", { className: "crumb" }, [crumb].flat().filter(Boolean).flatMap((each) => [each, " › "]), kind), close,
      element("h2", { textContent: title, tabIndex: -1 })), ...children.flat().filter(Boolean));
    panel.hidden = false;
    panel.scrollTop = 0;
  }

  // --- elements -------------------------------------------------------------------------------------------------
  const titlesOf = (each, key) => actions.colours.valuesOf(each, key).map((value) => actions.colours.titleOf(key, value));

  function tagsOf(each) {
    const tags = each.keys.map((at) => model.keys[at]).filter(([key]) => key === "tag" || key === "role").map(([, value]) => value);
    return [...new Set([...titlesOf(each, "owner"), ...titlesOf(each, "status"), ...titlesOf(each, "host"), ...tags])].map(tag);
  }

  // What is around an element, the outermost first.
  const shellsAround = (each) => (each.around ? [...shellsAround(each.around), each.around] : []);
  const crumbsOf = (each) => [model.groups[each.group], ...shellsAround(each)].filter(Boolean).map((around) => pickButton(around, around.title));

  function showMember(each) {
    const chains = model.chains.filter((chain) => chain[each.kind + "s"].includes(each.number));
    const requirements = model.requirements.filter(({ components }) =>
      (each.kind === "component" ? [each.number] : each.components).some((at) => components.includes(at)));
    open(each.kind, each.title, crumbsOf(each),
      element("p", { className: "tags" }, ...tagsOf(each)),
      each.summary ? element("p", {}, each.summary + " ", each.address ? element("a", { href: root + each.address, textContent: "More" }) : "") : "",
      each.kind === "component" ? showPorts(each) : showTopics(each),
      each.line ? section("Timing", "", element("p", { textContent: each.line })) : "",
      showChains(chains), showRequirements(requirements),
      each.findings ? section("Open points", String(each.findings.length), element("ul", {}, each.findings.map(({ severity, message }) =>
        element("li", {}, chip(severity, severity), " ", message)))) : "",
      showOther(each), tools(each));
  }

  function showChains(chains) {
    return chains.length ? section("Chains through it", "", element("ul", {}, chains.map((chain) => element("li", { className: "chain" }, link(chain.address, chain.title),
      chain.status ? chip(chain.status, chain.words) : chain.words ? element("span", { className: "muted", textContent: chain.words }) : "")))) : "";
  }

  function showRequirements(requirements) {
    return requirements.length ? section("Requirements", String(requirements.length), element("ul", {}, requirements.map(({ id, title, address }) =>
      element("li", {}, link(address, id), " ", title)))) : "";
  }

  // A composed component: its own ports and open points, and what is inside.
  function showShell(shell, level) {
    const numbers = new Set(shell.leaves.map(({ number }) => number));
    const isInside = ({ components }) => components.some((at) => numbers.has(at));
    const serves = new Set(shell.keys.map((at) => model.keys[at]).filter(([key]) => key === "requirement").map(([, value]) => value));
    const findings = [shell, ...model.shells.filter((each) => shellsAround(each).includes(shell)), ...shell.leaves]
      .flatMap((each) => (each.findings ?? []).map((finding) => ({ each, ...finding })));
    open("composed component", shell.title, crumbsOf(shell),
      element("p", { className: "tags" }, shell.line ? tag(shell.line) : "", ...tagsOf(shell)),
      shell.summary ? element("p", {}, shell.summary + " ", shell.address ? element("a", { href: root + shell.address, textContent: "More" }) : "") : "",
      showPorts(shell),
      section("Inside", count(shell.leaves.length, "component"), element("ul", { className: "columns" },
        (level.children.get(shell) ?? model.components.filter(({ around }) => around === shell)).map((each) => element("li", {}, pickButton(each, each.title))))),
      showChains(model.chains.filter(isInside)), showRequirements(model.requirements.filter((each) => isInside(each) || serves.has(each.id))),
      findings.length ? section("Open points", findings.length > MAX_FLOWS ? `the first ${MAX_FLOWS} of ${findings.length}` : String(findings.length),
        element("ul", {}, findings.slice(0, MAX_FLOWS).map(({ each, severity, message }) => element("li", {}, chip(severity, severity), " ", message,
          each === shell ? "" : [" ", element("span", { className: "muted" }, "at "), pickButton(each, each.title)])))) : "",
      tools(shell));
  }

  function showOther(each) {
    const others = each.kind === "component" ? each.nodes.map((at) => model.nodes[at]) : each.components.map((at) => model.components[at]);
    if (!others.length) return "";
    return section(each.kind === "component" ? "Nodes" : "Implements", "", element("ul", {}, others.map((other) => element("li", {}, link(other.address, other.title)))));
  }

  function showPorts(component) {
    const sourcesOf = (port) => port.sources ?? model.sources[port.number] ?? [];
    const typeOf = (port) => model.types[port.type]?.name ?? model.types[model.outputs[sourcesOf(port)[0]]?.type]?.name ?? "";
    const row = (port, direction, others, flowNote) => element("li", {}, element("span", { className: "muted", textContent: direction }),
      element("div", {}, element("strong", { textContent: port.name }), " ", direction === "in" ? typeOf(port) : model.types[port.type]?.name ?? "", port.warning ? [" ", tag(port.warning)] : "", port.optional ? [" ", tag("optional")] : "", port.made ? [" ", tag("autoconnect")] : "",
        port.note ? element("div", { className: "muted", textContent: port.note }) : "",
        others.length ? element("div", {}, flowNote, others.flatMap((other, at) => [at ? ", " : "", pickButton(other, other.title), others.length === 1 && other.line ? element("span", { className: "muted", textContent: " · " + other.line }) : ""])) : ""));
    // The other end as it is called from here: of what lies in another composed component, that component.
    const own = [...shellsAround(component), component];
    const facing = (at) => [...shellsAround(model.components[at]), model.components[at]].find((each) => !own.includes(each));
    const others = (numbers) => archgenExplorer.unique([...numbers].map(facing).filter(Boolean));
    const isInside = (at) => component.isComposed && shellsAround(model.components[at]).includes(component);
    const inputs = component.inputs.map((port) => row(port, "in",
      others(component.isComposed ? port.sources.map((at) => model.outputs[at].component) : model.writers[port.number]), "from "));
    const outputs = component.outputs.map((port) => row(port, "out", others(component.isComposed
      ? port.ports.flatMap((at) => [...model.readers[at]]).filter((at) => !isInside(at)) : model.readers[port.number]), "to "));
    if (!inputs.length && !outputs.length) return "";
    return section("Ports", `${inputs.length} in, ${outputs.length} out`, element("ul", { className: "ports" }, inputs, outputs));
  }

  function showTopics(node) {
    const own = model.links.filter((each) => each.tail === node.number || each.head === node.number);
    if (!own.length) return "";
    const rows = own.slice(0, MAX_FLOWS).map((each) => {
      const [word, other] = each.tail === node.number ? ["to", each.head] : ["from", each.tail];
      return element("li", {}, element("span", { className: "muted", textContent: word === "to" ? "out" : "in" }),
        element("div", {}, link(each.topic.address, each.topic.name), each.topic.medium ? tag(each.topic.medium) : "", element("div", {}, word + " ", pickButton(model.nodes[other]))));
    });
    return section("Topics", count(own.length, "link"), element("ul", { className: "ports" }, rows));
  }

  function showHome(home, members) {
    open(home.kind, home.title, "", element("p", { className: "tags" }, home.owners ? tag(home.owners) : "", home.line ? tag(home.line) : ""),
      home.summary ? element("p", { textContent: home.summary }) : "",
      section(members[0]?.kind === "node" ? "Nodes" : "Components", String(members.length),
        element("ul", { className: "columns" }, members.map((member) => element("li", {}, pickButton(member, member.title))))), tools(home));
  }

  function tools(each) {
    const name = each.kind === "node" || each.kind === "component" ? each.id : each.kind === "host" ? `host:${archgenExplorer.grammar.quote(each.id)}` : each.id;
    return element("p", { className: "tools" },
      each.address ? element("a", { className: "primary", href: root + each.address, textContent: "Open page" }) : "",
      /^https?:/i.test(each.written?.[1] ?? "") ? element("a", { className: "edit", href: each.written[1], textContent: "Edit", title: each.written[0] }) : "",
      each.id ? tool("Focus", () => actions.focus(name, 1, 1)) : "",
      each.id ? tool("All before", () => actions.focus(name, Infinity, 0)) : "",
      each.id ? tool("All after", () => actions.focus(name, 0, Infinity)) : "",
      each.written?.length ? element("span", { className: "written muted" }, "Written in ", element("code", { textContent: each.written[0] })) : "");
  }

  // --- ways: from one element to another, step by step on one scale ------------------------------------------------
  const WAY_NOTE = "From what the first one takes in until the last one has acted on it. Of the ways of fewest steps this is the slowest; the terminal tells the others, the worst first: ";
  const KINDS = [["link", "on the link"], ["sampling", "waits"], ["response", "responds"], ["unknown", "not known"]];

  function showWay({ rows, gaps, sum, nodes }, title) {
    const most = gaps ? `At least ${durations.format(sum, true)}` : `At most ${durations.format(sum)}`;
    const unknown = gaps ? `Nobody knows how long: ${count(gaps, "time")} of it ${gaps > 1 ? "are" : "is"} not known, or only in part.` : "";
    const kinds = new Set(rows.flatMap(({ parts }) => parts.map(([kind, , time]) => (time === null ? "unknown" : kind))));
    open("way", title.replace("..", " → "), "",
      element("section", { className: "waterfall duration" }, element("p", { className: "sum", textContent: most }), unknown ? element("p", { textContent: unknown }) : "",
        element("p", { className: "kinds" }, KINDS.filter(([kind]) => kinds.has(kind)).map(([kind, words]) =>
          element("span", {}, shape("svg", { width: 16, height: 10, "aria-hidden": "true" }, shape("rect", { class: kind, width: 16, height: 10 })), " " + words))),
        drawSteps(rows, sum)),
      element("section", {}, element("p", { className: "muted" }, WAY_NOTE, element("code", { textContent: `archgen timing --from ${nodes[0]} --to ${nodes.at(-1)} --worst 10` }))));
  }

  // What nobody knows has no length: a piece of a fixed one stands for it, and pushes what follows.
  const GAP = 6; // per cent
  function drawSteps(rows, sum) {
    const gaps = rows.flatMap(({ parts }) => parts).filter(([, , time]) => time === null).length;
    const gap = Math.min(GAP, 50 / Math.max(1, gaps)), scale = (100 - gap * gaps) / (sum || 1);
    let at = 0;
    return element("ol", { className: "steps" }, rows.map(({ activity, parts, why }) => {
      const pieces = parts.map(([kind, , time]) => {
        const width = time === null ? gap : durations.knownOf(time) * scale;
        const piece = shape("rect", { class: time === null ? "unknown" : kind, x: at + "%", width: Math.max(width, 0.4) + "%", y: 4, height: 12 });
        at += width;
        return piece;
      });
      const words = parts.map(([, word, time]) => `${word} ${durations.describe(time)}`).join(", ");
      return element("li", {}, link(model.nodes[activity.node].address, activity.id),
        shape("svg", { class: "scale", width: "100%", height: 20, "aria-hidden": "true" }, ...pieces), element("p", { textContent: [words || "adds no time", why].filter(Boolean).join(" · ") }));
    }));
  }

  // --- arrows and folds -----------------------------------------------------------------------------------------
  function showArrow(arrow) {
    const members = arrow.flows[0].topic ? model.nodes : model.components;
    const endOf = (flow, side) => flow.ends?.[side] ?? members[flow[side]];
    const flows = [...arrow.flows, ...(arrow.way && arrow.twin ? arrow.twin.flows : [])];
    const rows = flows.slice(0, MAX_FLOWS).map((flow) => element("li", {},
      element("div", {}, element("strong", { textContent: flow.label }), flow.warning ? [" ", tag(flow.warning)] : "", flow.optional ? [" ", tag("optional")] : "", flow.made ? [" ", tag("autoconnect")] : "", flow.style !== "data" ? [" ", tag(flow.style)] : "", flow.medium ? [" ", tag(flow.medium)] : ""),
      element("div", {}, pickButton(endOf(flow, "tail")), element("span", { className: "muted", textContent: flow.topic ? "" : ` · ${flow.style === "data" || flow.style === "physical" ? flow.from : flow.to}` }),
        " → ", pickButton(endOf(flow, "head")), element("span", { className: "muted", textContent: flow.topic ? "" : ` · ${flow.style === "data" || flow.style === "physical" ? flow.to : flow.from}` }))));
    open(count(flows.length, "flow"), `${arrow.tailTitle} ${flows.length > arrow.flows.length ? "↔" : "→"} ${arrow.headTitle}`, "",
      section("What flows", flows.length > MAX_FLOWS ? `the first ${MAX_FLOWS}` : "", element("ul", { className: "flows" }, rows)));
  }

  function showFold(box) {
    const rows = box.elements.map((each) => element("li", {}, box.homes ? tool(each.title, () => actions.openHome(each), "name") : pickButton(each, each.title)));
    open("folded", box.title, "", element("p", { textContent: "These have no box of their own, so that the map stays within 150 boxes." }),
      element("ul", { className: "columns" }, rows), element("p", { className: "tools" }, tool("Show all boxes", () => actions.showAll())));
  }

  return { panel, showMember, showShell, showHome, showArrow, showFold, showWay, hide: () => (panel.hidden = true) };
};
