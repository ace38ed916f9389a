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
    const membersOf = level.homes.map(() => []);
    for (const member of level.members) membersOf[level.homeOf(member)].push(member);
    const homes = level.homes.filter((home, at) => level.homePlaceOf(home) || membersOf[at].length);
    const wanted = level.opens ? homes.filter((home) => ask.open.includes(home.id)) : [];
    const starts = findStarts(level, ask, wanted);
    const { distances, near } = measureDistances(level, starts);
    const farness = (home) => distances.get(home.number) ?? Infinity;
    const busy = countFlows(level);

    const { kept, rest } = keepHomes(homes, wanted, ask, farness, near, starts);
    const opened = openHomes(wanted.filter((home) => kept.has(home)), membersOf, kept.size + (rest.length ? 1 : 0), ask, farness, busy);
    const boxes = [];
    const boxOf = new Array(level.members.length);
    for (const home of homes.filter((each) => kept.has(each))) addHome(home);
    if (rest.length) addRest();

    function addHome(home) {
      const members = membersOf[home.number];
      const shown = members.filter(ask.shows);
      const open = opened.get(home);
      const box = { id: "home " + home.number, kind: home.kind, element: home, home, title: home.title, open: Boolean(open), opens: level.opens,
        members, shown, hidden: Boolean(members.length) && !shown.length, folded: wanted.includes(home) && !open };
      boxes.push(box);
      if (!open) for (const member of members) boxOf[member.number] = box;
      else for (const member of open.members) {
        const own = { id: "member " + member.number, kind: member.kind, element: member, home, title: member.title, parent: box,
          members: [member], shown: [member], hidden: !ask.shows(member) };
        boxes.push(own);
        boxOf[member.number] = own;
      }
      if (open?.rest.length) addFold(`fold ${home.number}`, open.rest, { home, parent: box });
    }

    function addFold(id, members, more) {
      const noun = members[0]?.kind ?? "element";
      const shown = members.filter(ask.shows);
      const box = { id, kind: "fold", element: null, title: archgenExplorer.count(members.length, `more ${noun}`), members, shown,
        hidden: !shown.length, ...more };
      boxes.push(box);
      for (const member of members) boxOf[member.number] = box;
    }

    function addRest() {
      addFold("rest", rest.flatMap((home) => membersOf[home.number]), { homes: rest, home: null });
      boxes.at(-1).title = archgenExplorer.count(rest.length, `more ${rest[0].kind}`);
    }

    const arrows = mergeFlows(level, boxOf, ask);
    for (const box of boxes) {
      box.lit = ask.lit ? box.shown.some((member) => ask.lit.has(member.number)) : null;
      box.picked = box.element !== null && box.element === ask.picked;
    }
    const dropped = ask.full ? [] : dropArrows(arrows);
    return { boxes, arrows: arrows.filter((arrow) => !dropped.includes(arrow)), dropped, boxOf, rest,
      folded: boxes.filter((box) => box.folded), cut: boxes.filter((box) => box.kind === "fold" && box.parent),
      isFull: boxes.length > MAX_BOXES || arrows.length > MAX_ARROWS };
  };

  function findStarts(level, ask, wanted) {
    const starts = new Set();
    if (ask.picked) starts.add(level.homes.includes(ask.picked) ? ask.picked.number : level.homeOf(ask.picked));
    if (ask.lit) for (const at of ask.lit) starts.add(level.homeOf(level.members[at]));
    if (!starts.size && wanted.length) starts.add(level.homes.find((home) => home.id === ask.open.at(-1))?.number ?? wanted[0].number);
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

  // The nearest to what is chosen are opened first; the last one that fits may show a part of its members.
  function openHomes(wanted, membersOf, homeCount, ask, farness, busy) {
    const opened = new Map();
    let count = homeCount;
    const recent = (home) => ask.open.indexOf(home.id);
    for (const home of [...wanted].sort((a, b) => farness(a) - farness(b) || recent(b) - recent(a))) {
      const members = membersOf[home.number];
      const room = ask.full ? Infinity : MAX_BOXES - count;
      if (members.length <= room) opened.set(home, { members, rest: [] });
      else if (!opened.size && room > 2) {
        const rank = (member) => (member === ask.picked ? 1e9 : 0) + (ask.lit?.has(member.number) ? 1e6 : 0) + busy[member.number];
        const chosen = new Set([...members].sort((a, b) => rank(b) - rank(a)).slice(0, room - 1));
        opened.set(home, { members: members.filter((each) => chosen.has(each)), rest: members.filter((each) => !chosen.has(each)) });
      } else continue;
      count += opened.get(home).members.length;
    }
    return opened;
  }

  function mergeFlows(level, boxOf, ask) {
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
    for (const arrow of list) {
      const litFlows = ask.lit ? arrow.flows.filter((flow) => ask.lit.has(flow.tail) && ask.lit.has(flow.head) && ask.sideOf(flow)) : [];
      arrow.lit = ask.lit ? litFlows.length > 0 : null;
      arrow.shownFlows = litFlows.length ? litFlows : arrow.flows;
      const sides = litFlows.map(ask.sideOf);
      arrow.side = ["before", "after"].find((side) => sides.length && sides.filter((each) => each === side).length * 2 >= sides.length) ?? "plain";
      arrow.optional = arrow.flows.every((flow) => flow.optional);
      arrow.style = arrow.flows.every((flow) => flow.style === arrow.flows[0].style) ? arrow.flows[0].style : "data";
      arrow.picked = ask.pickedArrow === arrow.id;
    }
    return list;
  }

  // Too many arrows: those of single flows go first, then those inside of a home, last what is lit or at what is chosen.
  function dropArrows(arrows) {
    if (arrows.length <= MAX_ARROWS) return [];
    const rank = (arrow) => (arrow.picked || arrow.tail.picked || arrow.head.picked ? 1e9 : 0) + (arrow.lit ? 1e6 : 0) +
      (arrow.tail.parent && arrow.tail.parent === arrow.head.parent ? 1e3 : 0) + arrow.flows.length;
    return [...arrows].sort((a, b) => rank(b) - rank(a)).slice(MAX_ARROWS);
  }
})();
