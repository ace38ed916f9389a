// What a mistyped name means: the same but for case and separators, else the one with the fewest slips, one for every three
// letters. The same as archgen/diagnostics/suggestions.py.
"use strict";
archgenExplorer.findClosest = (function () {
  const MAX_LENGTH = 200;
  const fold = (word) => word.toLowerCase().replace(/[-_ ]/g, "");

  // Optimal string alignment: a swap of adjacent letters is one slip. Gives up above the limit.
  function countSlips(one, other, limit) {
    if (Math.abs(one.length - other.length) > limit) return limit + 1;
    let previous = [], last = [], row = Array.from({ length: other.length + 1 }, (_, at) => at);
    for (let i = 1; i <= one.length; i += 1) {
      [previous, last, row] = [last, row, [i]];
      for (let j = 1; j <= other.length; j += 1) {
        const same = one[i - 1] === other[j - 1] ? 0 : 1;
        row[j] = Math.min(row[j - 1] + 1, last[j] + 1, last[j - 1] + same);
        if (i > 1 && j > 1 && one[i - 1] === other[j - 2] && one[i - 2] === other[j - 1]) row[j] = Math.min(row[j], previous[j - 2] + 1);
      }
      if (Math.min(...row) > limit) return limit + 1;
    }
    return row[other.length];
  }

  // Names in the order of their characters, as Python sorts them.
  const byCode = (a, b) => (a < b ? -1 : a > b ? 1 : 0);

  return function findClosest(word, candidates) {
    const names = [...new Set(candidates)].sort(byCode);
    const folded = fold(word);
    const same = names.find((name) => fold(name) === folded);
    if (same !== undefined) return same;
    if (word.length > MAX_LENGTH) return null;
    let best = null, limit = Math.max(1, Math.floor(word.length / 3));
    for (const name of names) {
      const slips = countSlips(word, name, limit);
      if (slips <= limit) {
        best = name;
        limit = slips - 1;
        if (limit < 0) break;
      }
    }
    return best;
  };
})();
