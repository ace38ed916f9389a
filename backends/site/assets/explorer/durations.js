// How long it takes from one element to another: of the ways of the fewest steps the slowest, step by step. The same sums as
// `archgen timing --from A --to B` makes of a way.
"use strict";
archgenExplorer.makeDurations = function (model) {
  const { unique } = archgenExplorer;
  const UNITS = [[1e9, "s"], [1e6, "ms"], [1e3, "µs"], [1, "ns"]];
  const leaving = model.activities.map(() => []);
  for (const step of model.steps) leaving[step.tail].push(step);

  const isOf = (hit) => ({ node, components }) => (hit.onlyNodes ? hit.nodes.has(node) : components.some((at) => hit.components.has(at)));
  // An unknown time outweighs all that is known: the way that nobody can vouch for is the slowest.
  const knownOf = (time) => (Array.isArray(time) ? time[0] : time ?? 0);
  const weigh = (times) => times.reduce(([gaps, sum], time) => [gaps + (time === null || Array.isArray(time)), sum + knownOf(time)], [0, 0]);
  const add = (one, other) => [one[0] + other[0], one[1] + other[1]];
  const isSlower = (one, other) => one[0] - other[0] || one[1] - other[1];

  // Goes on step by step from all starts at once; of the ways that reach something by as many steps, the slowest counts.
  function findWay(starts, ends, calls) {
    let front = new Map(starts.map(({ number, waits, responds }) => [number, { number, weight: weigh([waits, responds]), before: null, step: null }]));
    const seen = new Set(front.keys());
    while (front.size) {
      const next = new Map();
      for (const before of front.values()) {
        for (const step of leaving[before.number]) {
          if (seen.has(step.head) || (step.isCall && !calls)) continue;
          const reached = { number: step.head, weight: add(before.weight, weigh([step.link, step.waits, step.responds])), before, step };
          const known = next.get(step.head);
          if (!known || isSlower(reached.weight, known.weight) > 0) next.set(step.head, reached);
        }
      }
      for (const number of next.keys()) seen.add(number);
      const arrived = [...next.values()].filter(({ number }) => ends.has(number)).sort((a, b) => isSlower(b.weight, a.weight))[0];
      if (arrived) return arrived;
      front = next;
    }
    return null;
  }

  // The way with its parts in the order of time; null where none leads there.
  function measure({ first, last }) {
    const starts = model.activities.filter(isOf(first));
    const ends = new Set(model.activities.filter(isOf(last)).map(({ number }) => number));
    if (starts.some(({ number }) => ends.has(number))) return null;
    const end = findWay(starts, ends, false) ?? findWay(starts, ends, true);
    if (!end) return null;
    const rows = [];
    for (let each = end; each; each = each.before) {
      const activity = model.activities[each.number];
      const { link = 0, waits, responds, why } = each.step ?? activity;
      rows.unshift({ activity, why, parts: [["link", "link", link], ["sampling", "waits", waits], ["response", "responds", responds]].filter(([, , time]) => time !== 0) });
    }
    const [gaps, sum] = end.weight;
    return { rows, gaps, sum, nodes: unique([rows[0], rows.at(-1)].map(({ activity }) => model.nodes[activity.node].id)) };
  }

  // Three digits. An upper bound is rounded up, what is known of an unknown time down.
  function format(time, isLeast = false) {
    const [factor, unit] = UNITS.find(([each]) => time >= each) ?? UNITS.at(-1);
    const value = time / factor, scale = value >= 100 ? 1 : value >= 10 ? 10 : 100;
    return `${(isLeast ? Math.floor(value * scale + 1e-6) : Math.ceil(value * scale - 1e-6)) / scale} ${unit}`;
  }

  const describe = (time) => (time === null ? "nobody knows how long" : Array.isArray(time) ? `≥ ${format(time[0], true)}` : format(time));

  return { measure, format, describe, knownOf };
};
