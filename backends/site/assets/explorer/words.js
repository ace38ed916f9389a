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

  function writeLine(box, level) {
    const { element: each } = box;
    const noun = box.members[0]?.kind ?? "element";
    if (box.kind === "fold") return box.homes ? "open one in the panel" : "folded, + shows them";
    if (!level.isContainer(each)) return each.line;
    if (each.isComposed) return [each.line, countMembers(box, each.line && !box.open ? "" : noun)].filter(Boolean).join(" · ");
    if (box.open) return [each.owners, countMembers(box, noun)].filter(Boolean).join(" · ");
    return [each.owners || each.line, countMembers(box, each.owners ? "" : noun)].filter(Boolean).join(" · ");
  }

  function describeBox(box, level) {
    box.line = writeLine(box, level);
    const findings = [box.element, ...box.shown, ...listShells(box.element, level)];
    const severities = archgenExplorer.unique(findings).map((each) => each?.severity);
    box.severity = box.open ? "" : SEVERITIES.find((severity) => severities.includes(severity)) ?? "";
    const state = box.opens ? (box.open ? "open" : "closed") : "";
    const kind = [box.element?.isComposed ? "composed component" : box.kind, state, box.severity && `has a finding: ${box.severity}`].filter(Boolean).join(", ");
    box.tip = [box.title, box.element?.id, box.line, kind].filter(Boolean).join("\n");
  }

  // The composed components that a closed box holds, to any depth.
  function listShells(each, level) {
    const inner = (level.children.get(each) ?? []).filter(({ isComposed }) => isComposed);
    return inner.flatMap((shell) => [shell, ...listShells(shell, level)]);
  }

  // A box as it is called beside another one: where they stand in different frames, with what is around it.
  function nameFrom(box, other) {
    return box.parent === other.parent ? box.title : box.element?.fullTitle ?? box.title;
  }

  function describeArrow(arrow) {
    const labels = arrow.flows.slice(0, MAX_NAMED_FLOWS).map(({ label, medium, warning }) =>
      [label, medium && `(${medium})`, warning && `(${warning})`].filter(Boolean).join(" "));
    const rest = arrow.flows.length - labels.length;
    [arrow.tailTitle, arrow.headTitle] = [nameFrom(arrow.tail, arrow.head), nameFrom(arrow.head, arrow.tail)];
    arrow.tip = [`${arrow.tailTitle} → ${arrow.headTitle}`, ...labels, rest ? `and ${rest} more` : ""].filter(Boolean).join("\n");
  }

  return function describeScene(scene, level) {
    scene.boxes.forEach((box) => describeBox(box, level));
    scene.arrows.forEach(describeArrow);
  };
})();
