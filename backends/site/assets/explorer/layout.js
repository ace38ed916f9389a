// Where each box is, in pixels of the map: columns and heights come from the build, sizes from here. Opening a home widens its
// column and pushes aside only what it would cover.
"use strict";
archgenExplorer.layOut = (function () {
  const BOX = { width: 178, height: 48, line: 16 };
  const OUTER = { gap: 34, channel: 120 };
  const PITCHES = [92, 160]; // px from one row of the closed map to the next: as far apart as a screen's height allows
  const HEIGHT_SHARE = 0.5;
  const INNER = { pitch: 76, gap: 26, channel: 92 };
  const FRAME = { top: 62, side: 20, bottom: 20, lane: 9 };
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
  function spread(wishes, heights, gap) {
    const steps = [0];
    for (let at = 1; at < wishes.length; at += 1) steps.push(steps[at - 1] + (heights[at - 1] + heights[at]) / 2 + gap);
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
      const middles = spread(column.map((box) => box.place[1] * pitch), column.map((box) => box.height), gap);
      const width = Math.max(...column.map((box) => box.width));
      column.forEach((box, index) => {
        Object.assign(box, { x, y: middles[index] - box.height / 2, column: at, columnX: x, columnWidth: width });
        top = Math.min(top, box.y);
        bottom = Math.max(bottom, box.y + box.height);
      });
      x += width + channel;
    });
    return { width: Math.max(0, x - channel), top, bottom, columns: order.map((number) => columns.get(number)) };
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

  // How many arrows run back inside of a home past whole columns: they stand below its boxes.
  function countFeedback(scene, home) {
    return scene.arrows.filter(({ tail, head }) => tail.parent === home && head.parent === home && tail.column - head.column > 1).length;
  }

  return Object.assign(function layOut(scene, level) {
    const outer = scene.boxes.filter((box) => !box.parent);
    const inside = new Map(outer.map((box) => [box, []]));
    for (const box of scene.boxes) {
      sizeBox(box);
      if (box.parent) inside.get(box.parent).push(box);
    }
    for (const [home, members] of inside) {
      if (!home.open) continue;
      const below = findEnd(members.map((box) => box.element && level.placeOf(box.element)).filter(Boolean));
      const size = place(members, (box) => (box.element && level.placeOf(box.element)) || below, INNER);
      home.inner = size;
      home.lines = wrap(home.title, Math.max(BOX.width, size.width) - 40, 1);
      home.width = Math.max(BOX.width + 40, size.width + 2 * FRAME.side);
      home.height = (members.length ? size.bottom - size.top : 0) + FRAME.top + FRAME.bottom + countFeedback(scene, home) * FRAME.lane;
    }
    const known = outer.map((box) => box.element && level.homePlaceOf(box.element)).filter(Boolean);
    const below = findEnd(known);
    const size = place(outer, (box) => (box.element && level.homePlaceOf(box.element)) || below, { ...OUTER, pitch: choosePitch(known, below[0]) });
    for (const [home, members] of inside) {
      const indent = (home.width - (home.inner?.width ?? 0)) / 2;
      for (const box of members) {
        box.x += home.x + indent;
        box.columnX += home.x + indent;
        box.y += home.y + FRAME.top - home.inner.top;
      }
    }
    return { left: 0, right: size.width, top: size.top, bottom: size.bottom, columns: size.columns };
  }, { measure, wrap, cut, BOX });
})();
