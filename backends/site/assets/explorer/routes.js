// How arrows run: one curve with level ends, past the boxes of the columns between. Ends are spread along a side by the height
// of the other end, so that lines leave and arrive without crossing.
"use strict";
archgenExplorer.routeArrows = (function () {
  const { layOut } = archgenExplorer;
  const SPREAD = 9; // px between two ends on one side
  const UNDER = 4; // px that what lies under a closed home stands out above it
  const MARGIN = 13; // px between a line and a box that it passes
  const EDGE = 4; // px between a line and the rim of the map
  const LOOP = 46; // px that a line between boxes of one column swings out
  const OUTSIDE = { first: 30, lane: 9, channel: 5, corner: 14, inner: 16 }; // px below all boxes, between two lines there, and beside columns
  const TURN = [26, 80]; // px that a curve takes before it is level again: more, the higher it climbs

  const middle = (box) => box.y + box.height / 2;
  const right = (box) => box.x + box.width;

  // Which sides an arrow leaves and reaches: to the right where the other end is, else back to the left, else round.
  function chooseSides(arrow, boxes, columns) {
    const { tail, head } = arrow;
    const { way } = arrow;
    arrow.twin = way?.arrows.find((other) => other !== arrow) ?? null;
    arrow.isUpright = Boolean(way) && tail.column === head.column && Math.abs(columns[tail.column].indexOf(tail) - columns[head.column].indexOf(head)) === 1;
    arrow.turn = right(tail) <= head.x ? "forward" : right(head) <= tail.x ? "back" : "loop";
    // Columns are level at the left: where something wide stands between, the way round is there.
    const isLeft = arrow.turn === "loop" && isBlocked(arrow, boxes);
    arrow.tailSide = arrow.turn === "back" || isLeft ? "left" : "right";
    arrow.headSide = arrow.turn === "forward" || isLeft ? "left" : "right";
    // Back past whole columns: round the outside of the map, or below what is in the same home, where it crosses no box.
    arrow.isOutside = !way && arrow.turn === "back" && arrow.meeting.tail.column - arrow.meeting.head.column > 1;
  }

  // Whether a box stands in the way of a line that swings out to the right of two boxes, one above the other.
  function isBlocked({ tail, head, meeting }, boxes) {
    const [upper, lower] = tail.y < head.y ? [tail, head] : [head, tail];
    const edge = Math.max(right(tail), right(head));
    const around = new Set([...listFrames(tail, meeting.home), ...listFrames(head, meeting.home)]);
    const isBetween = (box) => box.y + box.height > upper.y + upper.height && box.y < lower.y && box !== upper && box !== lower;
    return boxes.some((box) => isBetween(box) && right(box) > edge + MARGIN && box.x < edge + LOOP && !around.has(box) && !holds(box, tail));
  }

  function holds(frame, box) {
    for (let each = box.parent; each; each = each.parent) if (each === frame) return true;
    return false;
  }

  // The open boxes around a box, the innermost first, up to the one that holds the whole arrow.
  function listFrames(box, home) {
    const frames = [];
    for (let frame = box.parent ?? null; frame !== home; frame = frame.parent ?? null) frames.push(frame);
    return frames;
  }

  // The lane that a line takes next from one of its ends.
  const nextOf = ({ way }, box) => (way ? (box === way.first ? way.lanes[0] : way.lanes.at(-1)) : undefined);

  function spreadEnds(arrows) {
    const sides = new Map();
    const add = (box, side, arrow, end, other) => {
      const key = box.id + " " + side;
      if (!sides.has(key)) sides.set(key, []);
      sides.get(key).push({ box, side, arrow, end, other });
    };
    for (const arrow of arrows) {
      // Both directions of one line have their ends in common, and an upright one has none at a side.
      if (arrow.isUpright || (arrow.way && arrow.way.arrows[0] !== arrow)) continue;
      add(arrow.tail, arrow.tailSide, arrow, "start", nextOf(arrow, arrow.tail) ?? arrow.head);
      add(arrow.head, arrow.headSide, arrow, "stop", nextOf(arrow, arrow.head) ?? arrow.tail);
    }
    for (const ends of sides.values()) {
      // What comes from below all boxes ends lowest.
      ends.sort((a, b) => a.arrow.isOutside - b.arrow.isOutside || middle(a.other) - middle(b.other) || (a.arrow.id < b.arrow.id ? -1 : 1));
      const { box } = ends[0];
      const step = Math.min(ends.some(({ arrow }) => arrow.way) ? layOut.WAY_STEP : SPREAD, (box.height - 14) / Math.max(1, ends.length - 1));
      ends.forEach(({ arrow, end, side }, at) => {
        arrow[end] = [side === "left" ? box.x : right(box), middle(box) + (at - (ends.length - 1) / 2) * step];
        if (arrow.way && arrow.twin) arrow.twin[end === "start" ? "stop" : "start"] = arrow[end];
      });
    }
  }

  // The columns that a line passes on its way, from left to right: each with what is in the way there.
  function listStrips(arrow, scene, bounds) {
    const [left, to] = arrow.turn === "forward" ? [arrow.tail, arrow.head] : [arrow.head, arrow.tail];
    const { home } = arrow.meeting;
    const [leaves, enters] = [listFrames(left, home), listFrames(to, home).reverse()];
    const ends = new Set([left, to, ...leaves, ...enters]);
    const strips = [];
    const add = (boxes, min, max) => {
      const [{ columnX, columnWidth }] = boxes;
      // A narrow box in a wide column: the line passes what is beside it.
      const [from, end] = [Math.max(columnX, min), Math.min(columnX + columnWidth, max)];
      const own = boxes.filter((box) => !ends.has(box) && right(box) > from + 1 && box.x < end - 1);
      if (own.length && end - from > 4) strips.push({ from, to: end, boxes: own });
    };
    const [start, end] = [right(left), to.x];
    let from = start;
    for (const frame of leaves) {
      for (const column of frame.inner.columns) add(column, from, Math.min(end, right(frame)));
      from = right(frame);
    }
    for (const column of home ? home.inner.columns : bounds.columns) add(column, from, enters.length ? enters[0].x : end);
    enters.forEach((frame, at) => {
      for (const column of frame.inner.columns) add(column, Math.max(start, frame.x), enters[at + 1]?.x ?? end);
    });
    return joinStrips(strips);
  }

  // Where frames stand one above the other their columns overlap: what is in the way of both is in the way of one.
  function joinStrips(strips) {
    const joined = [];
    for (const strip of strips.sort((a, b) => a.from - b.from)) {
      const last = joined.at(-1);
      if (!last || strip.from >= last.to) joined.push(strip);
      else Object.assign(last, { to: Math.max(last.to, strip.to), boxes: [...last.boxes, ...strip.boxes] });
    }
    return joined;
  }

  // The free height that is nearest to a wished one; lines that share a gap keep a little apart.
  function findGap(strip, wish, used) {
    const taken = strip.boxes.map((box) => [box.y - MARGIN, box.y + box.height + MARGIN]).sort((a, b) => a[0] - b[0]);
    const choices = [wish];
    for (const [top, bottom] of taken) choices.push(top, bottom);
    const free = choices.filter((y) => taken.every(([top, bottom]) => y <= top || y >= bottom));
    const best = free.reduce((one, other) => (Math.abs(other - wish) < Math.abs(one - wish) ? other : one), free[0] ?? wish);
    const key = Math.round(strip.from) + " " + Math.round(best / 4);
    const count = used.get(key) ?? 0;
    used.set(key, count + 1);
    return best + (best === wish ? 0 : (count % 2 ? -1 : 1) * Math.ceil(count / 2) * 2.5);
  }

  // A line that goes to the right does not turn back to the left, and the other way round.
  function keepAhead(x, y, [lastX, lastY], direction) {
    const turn = Math.min(TURN[1], Math.max(TURN[0], Math.abs(y - lastY) / 3));
    return direction > 0 ? Math.max(x, lastX + turn) : Math.min(x, lastX - turn);
  }

  const num = (value) => Math.round(value * 10) / 10;
  const curve = ([x1, y1], [x2, y2]) => {
    const bend = (x2 - x1) * 0.5;
    return `C${num(x1 + bend)} ${num(y1)} ${num(x2 - bend)} ${num(y2)} ${num(x2)} ${num(y2)}`;
  };

  function drawPath(arrow, scene, bounds, used) {
    const { start, stop } = arrow;
    if (arrow.turn === "loop") {
      const isLeft = arrow.tailSide === "left", out = LOOP + Math.min(40, Math.abs(start[1] - stop[1]) / 12);
      const x = isLeft ? Math.min(start[0], stop[0]) - out : Math.max(start[0], stop[0]) + out;
      arrow.points = [start, [x + (isLeft ? LOOP : -LOOP) / 4, (start[1] + stop[1]) / 2], stop];
      arrow.direction = isLeft ? 1 : -1;
      // The curve comes three quarters as far as the points that it bends to.
      bounds.left = Math.min(bounds.left, x + out / 4 - EDGE);
      bounds.right = Math.max(bounds.right, x - out / 4 + EDGE);
      return `M${num(start[0])} ${num(start[1])}C${num(x)} ${num(start[1])} ${num(x)} ${num(stop[1])} ${num(stop[0])} ${num(stop[1])}`;
    }
    arrow.direction = arrow.turn === "forward" ? 1 : -1;
    const strips = listStrips(arrow, scene, bounds);
    const way = [start];
    for (const strip of arrow.direction > 0 ? strips : strips.reverse()) {
      const [near, far] = arrow.direction > 0 ? [strip.from, strip.to] : [strip.to, strip.from];
      const share = ((near + far) / 2 - start[0]) / (stop[0] - start[0] || 1);
      const y = findGap(strip, start[1] + (stop[1] - start[1]) * share, used);
      way.push([keepAhead(near - arrow.direction * 8, y, way.at(-1), arrow.direction), y], [far + arrow.direction * 8, y]);
    }
    // The last curve needs room as well.
    if (way.length > 1) way.at(-1)[0] = keepAhead(way.at(-1)[0], way.at(-1)[1], stop, -arrow.direction);
    way.push(stop);
    arrow.points = way;
    let path = `M${num(start[0])} ${num(start[1])}`;
    for (let at = 1; at < way.length; at += 1) {
      path += way[at][1] === way[at - 1][1] ? `L${num(way[at][0])} ${num(way[at][1])}` : curve(way[at - 1], way[at]);
    }
    return path;
  }

  // The line between two closed homes: through its lanes, or straight to the next box of the column.
  function routeWay(arrow) {
    const { way, tail, head } = arrow;
    const isForth = tail === way.first;
    if (arrow.isUpright) {
      const [x, down] = [tail.x + tail.width / 2, tail.y < head.y];
      // A closed home has the rim of another one above it.
      [arrow.start, arrow.stop] = down ? [[x, tail.y + tail.height], [x, head.y - UNDER]] : [[x, tail.y - UNDER], [x, head.y + head.height]];
      arrow.direction = down ? 1 : -1;
      arrow.points = [arrow.start, arrow.stop];
      return `M${num(x)} ${num(arrow.start[1])}L${num(x)} ${num(arrow.stop[1])}`;
    }
    arrow.direction = isForth ? 1 : -1;
    const lanes = way.lanes.flatMap(({ columnX, columnWidth, y }) => [[columnX, y], [columnX + columnWidth, y]]);
    arrow.points = [arrow.start, ...(isForth ? lanes : lanes.reverse()), arrow.stop];
    return arrow.points.slice(1).reduce((path, to, at) => path + (at % 2 ? `L${num(to[0])} ${num(to[1])}` : curve(arrow.points[at], to)),
      `M${num(arrow.start[0])} ${num(arrow.start[1])}`);
  }

  // A line through points, level or upright from one to the next, with round corners.
  function roundCorners(points, radius) {
    const length = ([x1, y1], [x2, y2]) => Math.abs(x2 - x1) + Math.abs(y2 - y1);
    const toward = ([x1, y1], [x2, y2], way) => [x1 + Math.sign(x2 - x1) * way, y1 + Math.sign(y2 - y1) * way];
    const text = ([x, y]) => `${num(x)} ${num(y)}`;
    let path = `M${text(points[0])}`;
    for (let at = 1; at < points.length - 1; at += 1) {
      const [last, here, next] = points.slice(at - 1, at + 2);
      const before = length(last, here) / (at === 1 ? 1 : 2), after = length(here, next) / (at === points.length - 2 ? 1 : 2);
      const r = Math.min(radius, before, after);
      path += `L${text(toward(here, last, r))}Q${text(here)} ${text(toward(here, next, r))}`;
    }
    return path + `L${text(points.at(-1))}`;
  }

  // From a box that is inside of open homes: down between the columns there, and below each home to its side.
  function leaveHomes(start, box, home, at, side) {
    const points = [start];
    let inner = box;
    for (const frame of listFrames(box, home)) {
      const between = (side < 0 ? inner.columnX - OUTSIDE.inner : inner.columnX + inner.columnWidth + OUTSIDE.inner) + side * (at % 6) * 4;
      points.push([between, points.at(-1)[1]], [between, frame.y + frame.height + 7 + (at % 6) * 4]);
      inner = frame;
    }
    return points;
  }

  // Feedback: down beside the column that it leaves, to the left below all boxes, up beside the column that it reaches. Short
  // ways run inside of long ones. The map grows by what they take; a home has grown by it already (see `layOut`).
  function routeOutside(arrows, bounds) {
    const outside = arrows.filter((arrow) => arrow.isOutside);
    const span = ({ meeting: { tail, head } }) => tail.columnX - head.columnX;
    outside.sort((a, b) => span(a) - span(b) || b.start[1] - a.start[1] || (a.id < b.id ? -1 : 1));
    const bottom = bounds.bottom;
    const counts = new Map();
    const total = (place) => outside.filter(({ meeting }) => meeting.home === place).length;
    for (const arrow of outside) {
      const { home: within, tail, head } = arrow.meeting;
      const at = counts.get(within) ?? 0, step = Math.min(OUTSIDE.channel, 60 / Math.max(1, total(within)));
      counts.set(within, at + 1);
      const y = within ? within.y + within.height - OUTSIDE.inner - (total(within) - 1 - at) * OUTSIDE.lane : bottom + OUTSIDE.first + at * OUTSIDE.lane;
      const [from, to] = [tail.columnX - 22 - at * step, head.columnX + head.columnWidth + 22 + at * step];
      const leave = leaveHomes(arrow.start, arrow.tail, within, at, -1);
      const reach = leaveHomes(arrow.stop, arrow.head, within, at, 1);
      arrow.direction = -1;
      arrow.points = [[from, y], [to, y]];
      arrow.path = roundCorners([...leave, [from, leave.at(-1)[1]], [from, y], [to, y], [to, reach.at(-1)[1]], ...reach.reverse()], OUTSIDE.corner);
      if (!within) bounds.bottom = Math.max(bounds.bottom, y + OUTSIDE.lane);
    }
  }

  // Where the name of what flows stands: in the widest free piece of the line, off both ends.
  function placeLabel(arrow) {
    if (arrow.turn === "loop") return arrow.points[1];
    let best = null;
    for (let at = 1; at < arrow.points.length; at += 1) {
      const [[x1, y1], [x2, y2]] = [arrow.points[at - 1], arrow.points[at]];
      const isChannel = at % 2 === 1;
      if (isChannel && (!best || Math.abs(x2 - x1) > best.width)) best = { width: Math.abs(x2 - x1), at: [(x1 + x2) / 2, (y1 + y2) / 2] };
    }
    return best.at;
  }

  return function routeArrows(scene, bounds) {
    const arrows = scene.arrows;
    const used = new Map();
    for (const arrow of arrows) if (arrow.way) arrow.way.arrows = arrow.way.arrows.filter((each) => arrows.includes(each));
    for (const arrow of arrows) chooseSides(arrow, scene.boxes, bounds.columns);
    spreadEnds(arrows);
    routeOutside(arrows, bounds);
    for (const arrow of arrows) {
      if (arrow.isUpright || (arrow.way && arrow.turn !== "loop")) arrow.path = routeWay(arrow);
      else if (!arrow.isOutside) arrow.path = drawPath(arrow, scene, bounds, used);
      arrow.labelAt = placeLabel(arrow);
    }
  };
})();
