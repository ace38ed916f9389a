// Where each box is, in pixels of the map: columns and heights come from the build, sizes from here. Opening a home (a group, a
// host, a composed component) widens its column and pushes aside only what it would cover.
"use strict";
archgenExplorer.layOut = (function () {
  const BOX = { width: 178, height: 48, line: 16 };
  const OUTER = { gap: 34, channel: 120 };
  const WAY_STEP = 13; // px between the ends of lines with numbers
  const LANE_GAP = 15; // px between a line that passes a column and what stands beside it
  const PITCHES = [92, 160]; // px from one row of the closed map to the next: as far apart as a screen's height allows
  const HEIGHT_SHARE = 0.5;
  const INNER = { pitch: 76, gap: 26, channel: 92 };
  const FRAME = { top: 62, side: 20, bottom: 20, lane: 9, loop: 24 };
  const FONT = '600 13px Inter, system-ui, sans-serif';
  const pen = document.createElement("canvas").getContext("2d");
  const widths = new Map();

  function measure(text, font = FONT) {
    const key = font + text;
    if (!widths.has(key)) {
      pen.font = font;
      widths.set(key, pen.measureText(text).width);
    }
    return widths.get(key);
  }

  // At most so many lines; the last one ends in an ellipsis where words are left. A long word is broken behind `_ . /`.
  function wrap(text, width, lines, font = FONT) {
    const result = [];
    let line = "";
    const pieces = text.match(/[^\s_./-]+[_./-]*\s*|\s+|[_./-]+\s*/gu) ?? [];
    for (const piece of pieces) {
      if (!line || measure((line + piece).trimEnd(), font) <= width) line += piece;
      else {
        result.push(line.trimEnd());
        line = piece;
      }
    }
    result.push(line.trimEnd());
    const shown = result.slice(0, lines);
    if (result.length > lines) shown[lines - 1] += " …";
    return shown.map((each) => cut(each, width, font));
  }

  function cut(text, width, font = FONT) {
    if (measure(text, font) <= width) return text;
    const letters = [...text.replace(/ …$/, "")];
    while (letters.length && measure(letters.join("") + "…", font) > width) letters.pop();
    return letters.join("").trimEnd() + "…";
  }

  // Middles as near to the wished ones as can be, so far apart that nothing overlaps (pool adjacent violators).
  function spread(wishes, boxes, gap) {
    const steps = [0];
    for (let at = 1; at < wishes.length; at += 1) {
      const [above, below] = [boxes[at - 1], boxes[at]];
      steps.push(steps[at - 1] + (above.height + below.height) / 2 + (above.isLane || below.isLane ? LANE_GAP : gap));
    }
    const blocks = [];
    wishes.forEach((wish, at) => {
      blocks.push([wish - steps[at], 1]);
      while (blocks.length > 1 && blocks.at(-2)[0] > blocks.at(-1)[0]) {
        const [last, size] = blocks.pop(), [first, other] = blocks.pop();
        blocks.push([(first * other + last * size) / (size + other), size + other]);
      }
    });
    return blocks.flatMap(([middle, size]) => new Array(size).fill(middle)).map((middle, at) => middle + steps[at]);
  }

  // Columns of boxes from the left; returns the size that they take, from 0, 0.
  function place(boxes, placeOf, { pitch, gap, channel }) {
    const columns = new Map();
    for (const box of boxes) {
      const [column] = (box.place = placeOf(box));
      if (!columns.has(column)) columns.set(column, []);
      columns.get(column).push(box);
    }
    let x = 0, top = boxes.length ? Infinity : 0, bottom = boxes.length ? -Infinity : 0;
    const order = [...columns.keys()].sort((a, b) => a - b);
    order.forEach((number, at) => {
      const column = columns.get(number).sort((a, b) => a.place[1] - b.place[1]);
      const middles = spread(column.map((box) => box.place[1] * pitch), column, gap);
      const width = Math.max(...column.map((box) => box.width));
      column.forEach((box, index) => {
        Object.assign(box, { x, y: middles[index] - box.height / 2, column: at, columnX: x, columnWidth: width });
        top = Math.min(top, box.y);
        bottom = Math.max(bottom, box.y + box.height);
      });
      x += width + channel;
    });
    return { width: Math.max(0, x - channel), top, bottom, columns: order.map((number) => columns.get(number).filter((box) => !box.isLane)) };
  }

  // What has no place of its own (what is folded, nodes without a home) stands below the last column.
  function findEnd(places) {
    const last = Math.max(0, ...places.map(([column]) => column));
    return [last, Math.max(-1, ...places.filter(([column]) => column === last).map(([, height]) => height)) + 1];
  }

  // The same whatever is open, so that positions stay.
  function choosePitch(known, last) {
    const heights = known.map(([, height]) => height);
    const rows = Math.max(...heights, 0) - Math.min(...heights, 0) + 1;
    return Math.min(PITCHES[1], Math.max(PITCHES[0], (((last + 1) * (BOX.width + OUTER.channel)) * HEIGHT_SHARE) / rows));
  }

  function sizeBox(box) {
    box.lines = wrap(box.title, BOX.width - (box.severity ? 40 : 24), 2);
    box.width = BOX.width;
    box.height = BOX.height + (box.lines.length - 1) * BOX.line;
  }

  // Where the ways of two boxes part: the innermost open box around both (null on the map itself), and what stands in there.
  function meet(one, other) {
    const pathOf = (box) => (box ? [...pathOf(box.parent), box] : []);
    const [first, second] = [pathOf(one), pathOf(other)];
    const at = first.findIndex((box, index) => box !== second[index]);
    return { home: first[at - 1] ?? null, tail: first[at], head: second[at] };
  }

  // How many arrows run back inside of a home past whole columns: they stand below its boxes.
  function countFeedback(arrows) {
    return arrows.filter(({ meeting: { tail, head } }) => tail.column - head.column > 1).length;
  }

  // Whether something runs within the last column: it swings out to the right of it.
  function hasLoop(arrows, last) {
    return arrows.some(({ meeting: { tail, head } }) => tail.column === last && head.column === last);
  }

  // What flows between two closed homes takes one line, in either direction, through the lanes that the build has found.
  function findWays(scene, level) {
    const ways = new Map(), closed = new Map();
    for (const box of scene.boxes) if (level.isHome(box.element) && !box.open) closed.set(box.element.number, box);
    // Whatever is shown or hidden: places stay.
    for (const [key, { ends, lanes }] of level.ways) {
      const [first, last] = ends.map((number) => closed.get(number));
      if (first && last) ways.set(key, { first, last, arrows: [], lanes: lanes.map((lane) => ({ isLane: true, lane, width: 0, height: 0 })) });
    }
    for (const arrow of scene.arrows) {
      const way = ways.get([arrow.tail, arrow.head].map((box) => closed.get(box.element?.number) === box ? box.element.number : -1).sort((a, b) => a - b).join(" "));
      if (!way) continue;
      arrow.way = way;
      way.arrows.push(arrow);
    }
    // A box is as high as its side with most ends needs.
    const counts = new Map();
    for (const { first, last } of ways.values()) {
      if (first.element.place?.[0] === last.element.place?.[0]) continue;
      for (const [box, side] of [[first, 1], [last, 0]]) counts.set(box, Object.assign(counts.get(box) ?? [0, 0], { [side]: (counts.get(box)?.[side] ?? 0) + 1 }));
    }
    for (const [box, sides] of counts) box.height = Math.max(box.height, (Math.max(...sides) - 1) * WAY_STEP + 14);
    return [...ways.values()];
  }

  function findInside(scene) {
    const inside = new Map([[null, []]]), arrows = new Map();
    for (const box of scene.boxes) {
      sizeBox(box);
      inside.get(box.parent ?? null).push(box);
      if (box.open) inside.set(box, []);
    }
    for (const arrow of scene.arrows) {
      arrow.meeting = meet(arrow.tail, arrow.head);
      const { home } = arrow.meeting;
      if (!arrows.has(home)) arrows.set(home, []);
      arrows.get(home).push(arrow);
    }
    return { inside, arrows };
  }

  return Object.assign(function layOut(scene, level) {
    const { inside, arrows } = findInside(scene);
    const placeIn = (boxes, placeOf, sizes, passing = []) => {
      const places = boxes.map((box) => box.element && placeOf(box.element)).filter(Boolean);
      const below = findEnd(places);
      return place([...boxes, ...passing], (box) => box.lane ?? ((box.element && placeOf(box.element)) || below), sizes(places, below[0]));
    };

    // From the inside to the outside: a home is as large as what it holds.
    function sizeHome(home) {
      const members = inside.get(home);
      members.filter((box) => box.open).forEach(sizeHome);
      const size = placeIn(members, level.placeOf, () => INNER);
      home.inner = size;
      home.lines = wrap(home.title, Math.max(BOX.width, size.width) - 40, 1);
      home.loops = hasLoop(arrows.get(home) ?? [], size.columns.length - 1) ? FRAME.loop : 0;
      home.width = Math.max(BOX.width + 40, size.width + 2 * FRAME.side) + home.loops;
      home.height = (members.length ? size.bottom - size.top : 0) + FRAME.top + FRAME.bottom + countFeedback(arrows.get(home) ?? []) * FRAME.lane;
    }

    // And from the outside to the inside: what a home holds moves with it.
    function moveInside(home) {
      const indent = (home.width - home.loops - home.inner.width) / 2;
      for (const box of inside.get(home)) {
        box.x += home.x + indent;
        box.columnX += home.x + indent;
        box.y += home.y + FRAME.top - home.inner.top;
        if (box.open) moveInside(box);
      }
    }

    const outer = inside.get(null);
    outer.filter((box) => box.open).forEach(sizeHome);
    const lanes = findWays(scene, level).flatMap((way) => way.lanes);
    const size = placeIn(outer, level.homePlaceOf, (known, last) => ({ ...OUTER, pitch: choosePitch(known, last) }), lanes);
    outer.filter((box) => box.open).forEach(moveInside);
    return { left: 0, right: size.width, top: size.top, bottom: size.bottom, columns: size.columns };
  }, { measure, wrap, cut, BOX, WAY_STEP });
})();
