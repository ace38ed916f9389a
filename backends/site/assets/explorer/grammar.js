// The grammar of selectors: `2+driving.safety_supervisor tag:safety -sensing.*`. The same as archgen/model/selector_parser.py,
// word by word; tests run both on one table of cases.
"use strict";
archgenExplorer.grammar = (function () {
  const KEYS = ["tag", "owner", "status", "type", "medium", "role", "host", "package", "requirement", "behaviour", "finding", "node", "is", "library", "parameter", "property", "variant", "deprecated", "use_case"];
  const ALL_STEPS = -1;
  const MAX_STEP_DIGITS = 6;
  const FORMS = "a word is `x`, `+x`, `x+`, `2+x+1` or `x..y`, where x is a path or `key:value`";
  // Blanks as Python has them: \s of JavaScript lacks some and has others.
  const BLANK = "\\t-\\r\\x1c-\\x20\\x85\\xa0\\u1680\\u2000-\\u200a\\u2028\\u2029\\u202f\\u205f\\u3000";
  const WORD = new RegExp(`(?:[^${BLANK}"]|"[^"]*"?)+`, "gu");
  const BEFORE = /([0-9]*)\+/y;
  const AFTER = /\+([0-9]*)/y;
  const ATOM = new RegExp(`(?:([^${BLANK}:+.",]+):)?(?:"([^"]*)"|((?:(?!\\.\\.)[^${BLANK}+":,])+))`, "yu");

  const problem = (message, start, end, help = null, severity = "error") => ({ message, start, end, severity, help });

  // What matches at a place, within the text up to there.
  function matchAt(pattern, text, at) {
    pattern.lastIndex = at;
    return pattern.exec(text);
  }

  function parse(text) {
    const words = [], problems = [];
    for (const match of text.matchAll(WORD)) {
      const word = parseWord(text, match.index, match.index + match[0].length);
      const wrong = word.message ? [word] : findUnknownKeys(word);
      problems.push(...wrong);
      if (!wrong.length) words.push(word);
    }
    if (!words.length && !problems.length) problems.push(problem("the selector is empty", 0, text.length, FORMS));
    return { words, problems };
  }

  function parseWord(text, start, end) {
    const reserved = findReserved(text, start, end);
    if (reserved) return reserved;
    const within = text.slice(0, end);
    const negative = text[start] === "-";
    let at = start + Number(negative);
    const before = matchAt(BEFORE, within, at);
    if (before) at += before[0].length;
    const atom = parseAtom(within, at, end);
    if (atom.message) return atom;
    at = atom.end;
    let rangeEnd = null;
    const after = matchAt(AFTER, within, at);
    if (after) at += after[0].length;
    else if (within.startsWith("..", at) && !before) {
      rangeEnd = parseAtom(within, at + 2, end);
      if (rangeEnd.message) return rangeEnd;
      at = rangeEnd.end;
    }
    if (at < end) return problem(`\`${text.slice(at, end)}\` is more than a word can hold`, at, end, FORMS);
    const long = [before, after].find((match) => match && match[1].length > MAX_STEP_DIGITS);
    if (long) return problem(`\`${long[1]}\` steps are too many`, start, end, "leave the number out to take all of them");
    return { atom, negative, before: readSteps(before), after: readSteps(after), rangeEnd };
  }

  function findReserved(text, start, end) {
    let quoted = false;
    for (let at = start; at < end; at += 1) {
      if (text[at] === '"') quoted = !quoted;
      else if (text[at] === "," && !quoted) return problem("`,` is reserved; words are separated by blanks", at, at + 1);
    }
    return quoted ? problem("the quote is not closed", start, end, 'write `type:"Point cloud"`') : null;
  }

  function parseAtom(within, start, end) {
    const match = matchAt(ATOM, within, start);
    if (!match) {
      const wrong = within.slice(start, end);
      const message = wrong ? `a path or \`key:value\` is expected, not \`${wrong}\`` : "a path or `key:value` is missing";
      return problem(message, wrong ? start : Math.max(start - 1, 0), end, FORMS);
    }
    const atomEnd = start + match[0].length;
    if (within.startsWith(":", atomEnd) && atomEnd < end) {
      return problem(`\`${match[0]}:\` needs a value`, start, end, 'write `tag:safety` or `type:"Point cloud"`');
    }
    return { key: match[1] ?? null, value: match[2] ?? match[3], start, end: atomEnd };
  }

  const readSteps = (match) => (!match ? 0 : match[1] ? Number(match[1]) : ALL_STEPS);

  function findUnknownKeys(word) {
    return [word.atom, word.rangeEnd].filter((atom) => atom && atom.key !== null && !KEYS.includes(atom.key)).map((atom) => {
      const guess = archgenExplorer.findClosest(atom.key, KEYS);
      const help = guess ? `did you mean \`${guess}:\`?` : `keys are ${KEYS.join(", ")}`;
      return problem(`no key \`${atom.key}\``, atom.start, atom.start + atom.key.length, help);
    });
  }

  // A value as a word of a selector, quoted where it would end early.
  function quote(value) {
    return new RegExp(`^[^${BLANK}+":,]+$`, "u").test(value) && !value.includes("..") ? value : `"${value.replaceAll('"', "")}"`;
  }

  return { parse, problem, quote, ALL_STEPS, KEYS };
})();
