// What of a level is on the map: open and closed homes, members, merged arrows, and what is folded to keep within the budget.
"use strict";
archgenExplorer.makeScene = (function () {
  const MAX_BOXES = 150;
  const MAX_ARROWS = 300;

  // Homes by their distance from some, along flows in either direction.
  function measureDistances(level, starts) {
    const near = level.homes.map(() => new Set());
    for (const { tail, head } of level.flows) {
      const [from, to] = [level.homeOf(level.members[tail]), level.homeOf(level.members[head])];
      if (from !== to) near[from].add(to), near[to].add(from);
    }
    const distances = new Map([...starts].map((at) => [at, 0]));
    for (const [at, distance] of distances) for (const other of near[at]) if (!distances.has(other)) distances.set(other, distance + 1);
    return { distances, near };
  }

  // `ask`: { open: ids, lit: numbers or null, picked: a box or null, shows(member), full }.
  return function makeScene(level, ask) {
    const homes = level.homes.filter((home) => level.homePlaceOf(home) || level.leavesOf(home).length);
    const wanted = new Set(level.opens ? [...homes, ...level.shells].filter(({ id }) => ask.open.includes(id)) : []);
    const wantedHomes = homes.filter((home) => wanted.has(home));
    const starts = findStarts(level, ask, wantedHomes);
    const { distances, near } = measureDistances(level, starts);
    const farness = (home) => distances.get(home.number) ?? Infinity;

    const { kept, rest } = keepHomes(homes, wantedHomes, ask, farness, near, starts);
    const opened = openContainers(level, wanted, kept, kept.size + (rest.length ? 1 : 0), ask, farness);
    const boxes = [];
    const boxOf = new Array(level.members.length);
    for (const home of homes.filter((each) => kept.has(each))) addContainer(home, home);
    if (rest.length) addRest();

    function addContainer(each, home, parent) {
      const members = level.leavesOf(each);
      const shown = members.filter(ask.shows);
      const open = opened.get(each);
      const box = { id: `${each.isComposed ? "shell" : "home"} ${each.number}`, kind: each.kind, element: each, home, parent, title: each.title,
        open: Boolean(open), opens: level.opens, members, shown, hidden: Boolean(members.length) && !shown.length, folded: wanted.has(each) && !open };
      boxes.push(box);
      if (!open) for (const member of members) boxOf[member.number] = box;
      else for (const child of open.children) (child.isComposed ? addContainer : addMember)(child, home, box);
      if (open?.rest.length) addFold(`fold ${each.isComposed ? "shell " : ""}${each.number}`, open.rest, { home, parent: box });
    }

    function addMember(member, home, parent) {
      const box = { id: "member " + member.number, kind: member.kind, element: member, home, title: member.title, parent, members: [member],
        shown: [member], hidden: !ask.shows(member) };
      boxes.push(box);
      boxOf[member.number] = box;
    }

    function addFold(id, elements, more) {
      const members = elements.flatMap((each) => level.leavesOf(each));
      const noun = elements[0]?.kind ?? "element";
      const shown = members.filter(ask.shows);
      const box = { id, kind: "fold", element: null, title: archgenExplorer.count(elements.length, `more ${noun}`), elements, members, shown,
        hidden: !shown.length, ...more };
      boxes.push(box);
      for (const member of members) boxOf[member.number] = box;
    }

    function addRest() {
      addFold("rest", rest, { homes: rest, home: null });
    }

    const arrows = mergeFlows(level, boxOf, opened, ask);
    for (const box of boxes) {
      box.lit = ask.lit ? box.shown.some((member) => ask.lit.has(member.number)) : null;
      box.picked = box.element !== null && box.element === ask.picked;
    }
    const dropped = ask.full ? [] : dropArrows(arrows);
    return { boxes, arrows: arrows.filter((arrow) => !dropped.includes(arrow)), dropped, boxOf, rest,
      folded: boxes.filter((box) => box.folded), cut: boxes.filter((box) => box.kind === "fold" && box.parent),
      isFull: boxes.length > MAX_BOXES || arrows.length > MAX_ARROWS };
  };

  function findStarts(level, ask, wantedHomes) {
    const starts = new Set();
    if (ask.picked) starts.add(level.isHome(ask.picked) ? ask.picked.number : level.homeOf(ask.picked));
    if (ask.lit) for (const at of ask.lit) starts.add(level.homeOf(level.members[at]));
    if (!starts.size && wantedHomes.length) {
      const last = [...level.homes, ...level.shells].find(({ id }) => id === ask.open.at(-1));
      starts.add(!last ? wantedHomes[0].number : level.isHome(last) ? last.number : level.homeOf(last));
    }
    return starts;
  }

  function countFlows(level) {
    const counts = new Array(level.members.length).fill(0);
    for (const { tail, head } of level.flows) (counts[tail] += 1), (counts[head] += 1);
    return counts;
  }

  // Where there are more homes than boxes may be, those stay that are open, chosen, their neighbours, and then the nearest.
  function keepHomes(homes, wanted, ask, farness, near, starts) {
    if (ask.full || homes.length <= MAX_BOXES) return { kept: new Set(homes), rest: [] };
    const size = new Map(homes.map((home) => [home, near[home.number].size]));
    const order = [...homes].sort((a, b) => Number(wanted.includes(b)) - Number(wanted.includes(a)) || farness(a) - farness(b) || size.get(b) - size.get(a));
    const limit = wanted.length ? Math.round(MAX_BOXES * 0.66) : MAX_BOXES - 1;
    const kept = new Set(order.slice(0, Math.max(limit, starts.size ? 1 : 0)));
    return { kept, rest: homes.filter((home) => !kept.has(home)) };
  }

  // The nearest to what is chosen are opened first, and what is around it to its depth; then composed components, outer ones
  // first. The first one that is too large shows a part of what is inside.
  function openContainers(level, wanted, kept, homeCount, ask, farness) {
    const opened = new Map();
    const busy = countFlows(level);
    const around = new Set(ask.picked ? level.aroundOf(ask.picked) : []);
    const isLit = (each) => Boolean(ask.lit) && level.leavesOf(each).some(({ number }) => ask.lit.has(number));
    const far = (each) => (level.isHome(each) ? farness(each) : isLit(each) ? 0 : farness(level.homes[level.homeOf(each)]));
    const recent = (each) => ask.open.indexOf(each.id);
    let count = homeCount, inner = [];

    function open(each) {
      const children = level.children.get(each);
      const room = ask.full ? Infinity : MAX_BOXES - count;
      if (children.length <= room) opened.set(each, { children, rest: [] });
      else if ((!opened.size || around.has(each)) && room > 2) opened.set(each, choosePart(children, room - 1));
      else return;
      const shown = opened.get(each).children;
      count += shown.length;
      for (const child of shown) if (wanted.has(child)) around.has(child) ? open(child) : inner.push(child);
    }

    function choosePart(children, size) {
      const rank = (each) => (each === ask.picked || around.has(each) ? 1e9 : 0) + (isLit(each) ? 1e6 : 0) +
        level.leavesOf(each).reduce((sum, { number }) => sum + busy[number], 0);
      const ranks = new Map(children.map((each) => [each, rank(each)]));
      const chosen = new Set([...children].sort((a, b) => ranks.get(b) - ranks.get(a)).slice(0, size));
      return { children: children.filter((each) => chosen.has(each)), rest: children.filter((each) => !chosen.has(each)) };
    }

    let waiting = level.homes.filter((home) => wanted.has(home) && kept.has(home));
    while (waiting.length) {
      const order = new Map(waiting.map((each) => [each, [far(each), -recent(each)]]));
      waiting.sort((a, b) => order.get(a)[0] - order.get(b)[0] || order.get(a)[1] - order.get(b)[1]).forEach(open);
      [waiting, inner] = [inner, []];
    }
    return opened;
  }

  function mergeFlows(level, boxOf, opened, ask) {
    const arrows = new Map();
    for (const flow of level.flows) {
      const [tail, head] = [boxOf[flow.tail], boxOf[flow.head]];
      // Nearly all would lead to the box that stands for everything else.
      if (tail === head || tail.id === "rest" || head.id === "rest" || !ask.shows(level.members[flow.tail]) || !ask.shows(level.members[flow.head])) continue;
      const id = tail.id + ">" + head.id;
      if (!arrows.has(id)) arrows.set(id, { id, tail, head, flows: [] });
      arrows.get(id).flows.push(flow);
    }
    const list = [...arrows.values()];
    const see = level.shells.length ? (flows) => seeFlows(level, opened, flows) : (flows) => flows;
    for (const arrow of list) {
      const litFlows = ask.lit ? arrow.flows.filter((flow) => ask.lit.has(flow.tail) && ask.lit.has(flow.head) && ask.sideOf(flow)) : [];
      arrow.lit = ask.lit ? litFlows.length > 0 : null;
      const sides = litFlows.map(ask.sideOf);
      arrow.side = ["before", "after"].find((side) => sides.length && sides.filter((each) => each === side).length * 2 >= sides.length) ?? "plain";
      arrow.flows = see(arrow.flows);
      arrow.shownFlows = litFlows.length ? see(litFlows) : arrow.flows;
      arrow.optional = arrow.flows.every((flow) => flow.optional);
      arrow.made = arrow.flows.every((flow) => flow.made);
      arrow.style = arrow.flows.every((flow) => flow.style === arrow.flows[0].style) ? arrow.flows[0].style : "data";
      arrow.medium = arrow.flows.every((flow) => flow.medium === arrow.flows[0].medium) ? arrow.flows[0].medium : "";
      arrow.picked = ask.pickedArrow === arrow.id;
    }
    return list;
  }

  // Flows as they are seen where composed components are closed: from port to port of these, and once, however many read it inside.
  function seeFlows(level, opened, flows) {
    const seen = new Map();
    const seenEnd = (number) => {
      const member = level.members[number];
      return level.aroundOf(member).find((each) => each.isComposed && !opened.has(each)) ?? member;
    };
    for (const flow of flows) {
      const ends = { tail: seenEnd(flow.tail), head: seenEnd(flow.head) };
      if (!ends.tail.isComposed && !ends.head.isComposed) {
        seen.set(flow.number, flow);
        continue;
      }
      const [writer, reader] = flow.style === "service" || flow.style === "action" ? [ends.head, ends.tail] : [ends.tail, ends.head];
      const outer = findRims(flow.input, reader).filter(({ sources }) => flow.outputs.some((at) => sources.includes(at)));
      const from = archgenExplorer.unique(flow.writers.flatMap((port) => nameAt(level, port, writer))).join(", ");
      const to = outer.length ? archgenExplorer.unique(outer.map(({ name }) => name)).join(", ") : nameAt(level, flow.input, reader)[0];
      const key = [flow.style, flow.medium, ends.tail.id, ends.head.id, from, to].join("\n");
      const made = outer.length ? outer.every((rim) => rim.made) : flow.made, optional = outer.length ? outer.every((rim) => rim.optional) : flow.optional;
      const known = seen.get(key);
      if (known) {
        known.types = archgenExplorer.unique([...known.types, ...flow.types]);
        known.label = known.types.join(", ") || known.from;
        known.made &&= made;
        known.optional &&= optional;
      } else seen.set(key, { ...flow, ends, from, to, made, optional, label: flow.types.join(", ") || from });
    }
    return [...seen.values()];
  }

  function findRims(port, element) {
    return element.isComposed ? (port.rims ?? []).filter((rim) => rim.element === element) : [];
  }

  // A port as it is called at a composed component: by the ports there, else by its path inside.
  function nameAt(level, port, element) {
    if (!element.isComposed) return [port.name];
    const rims = findRims(port, element);
    return rims.length ? rims.map(({ name }) => name) : [`${level.members[port.component].id}.${port.name}`.slice(element.id.length + 1)];
  }

  // Too many arrows: those of single flows go first, then those inside of a home, last what is lit or at what is chosen.
  function dropArrows(arrows) {
    if (arrows.length <= MAX_ARROWS) return [];
    const rank = (arrow) => (arrow.picked || arrow.tail.picked || arrow.head.picked ? 1e9 : 0) + (arrow.lit ? 1e6 : 0) +
      (arrow.tail.parent && arrow.tail.parent === arrow.head.parent ? 1e3 : 0) + arrow.flows.length;
    return [...arrows].sort((a, b) => rank(b) - rank(a)).slice(MAX_ARROWS);
  }
})();
