// What boxes and arrows say: the second line, and the tooltip, which is also the name that screen readers hear.
"use strict";
archgenExplorer.describeScene = (function () {
  const SEVERITIES = ["error", "warning", "note"];
  const MAX_NAMED_FLOWS = 8;

  function countMembers(box, noun) {
    const { members, shown } = box;
    const count = shown.length === members.length ? String(members.length) : `${shown.length} of ${members.length}`;
    return noun ? `${count} ${noun}${members.length === 1 ? "" : "s"}` : count;
  }

  function writeLine(box) {
    const { element: each } = box;
    const noun = box.members[0]?.kind ?? "element";
    if (box.kind === "fold") return box.homes ? "open one in the panel" : "folded, + shows them";
    if (box.parent) return each.line;
    if (box.open) return [each.owners, countMembers(box, noun)].filter(Boolean).join(" · ");
    return [each.owners || each.line, countMembers(box, each.owners ? "" : noun)].filter(Boolean).join(" · ");
  }

  function describeBox(box) {
    box.line = writeLine(box);
    const severities = box.shown.map((member) => member.severity);
    box.severity = box.open ? "" : SEVERITIES.find((severity) => severities.includes(severity)) ?? "";
    const state = box.opens && !box.parent ? (box.open ? "open" : "closed") : "";
    const kind = [box.kind, state, box.severity && `has a finding: ${box.severity}`].filter(Boolean).join(", ");
    box.tip = [box.title, box.element?.id, box.line, kind].filter(Boolean).join("\n");
  }

  function describeArrow(arrow) {
    const labels = arrow.flows.slice(0, MAX_NAMED_FLOWS).map(({ label }) => label);
    const rest = arrow.flows.length - labels.length;
    arrow.tip = [`${arrow.tail.title} → ${arrow.head.title}`, ...labels, rest ? `and ${rest} more` : ""].filter(Boolean).join("\n");
  }

  return function describeScene(scene) {
    scene.boxes.forEach(describeBox);
    scene.arrows.forEach(describeArrow);
  };
})();
