// Finds words in the index, which its parts hand over one after another. Loaded when somebody starts to search.
"use strict";
const archgenSearch = (function () {
  const SEPARATORS = /[^\p{L}\p{N}]+/u;
  const CAMEL = /[\p{Ll}\p{N}](?=\p{Lu})/gu;
  const SHOWN = 50;
  // What is looked for most stands first where the words fit equally well.
  const WEIGHTS = { component: 9, group: 8, node: 6, topic: 6, service: 6, action: 6, message: 6, type: 6, requirement: 6,
    chain: 6, partner: 6, page: 5, chapter: 4, port: 2, field: 2, connection: 1 };
  const FEW = 8; // With fewer exact results, words with one wrong letter are looked for as well.
  const LONGEST = 60; // Longer words are compared as they are: the pattern of all their mistakes grows with the square.
  const MOST_NEAR = 12; // More words than that no longer help to find what was meant.

  const kinds = new Map(); // kind -> { kind, weight, lines, folded, places, texts }
  const words = new Set(); // every word, folded: what a misspelt one may have meant
  const seenTokens = new Set();
  const selectors = new Set(); // owner:certh
  let wordList = null;
  const settings = { parts: [], count: 0, open: [], examples: [], questionWords: [] };

  // Small letters without accents and invisible characters, on both sides.
  function fold(text) {
    const small = text.toLowerCase();
    // eslint-disable-next-line no-control-regex
    return /^[\x00-\x7f]*$/.test(small) ? small : small.normalize("NFKD").replace(/[\p{M}\p{Cf}]/gu, "");
  }

  function rowsOf(kind) {
    if (!kinds.has(kind)) {
      kinds.set(kind, { kind, weight: WEIGHTS[kind] ?? 4, lines: [], folded: [], places: [], texts: [] });
    }
    return kinds.get(kind);
  }

  // The same words stand in thousands of lines: only new ones are folded and taken apart (SkeletonArray: also Skeleton, Array).
  function addWords(text) {
    for (const token of text.split(SEPARATORS)) {
      if (seenTokens.has(token)) continue;
      seenTokens.add(token);
      for (const part of [token, ...token.replace(CAMEL, "$& ").split(" ")]) words.add(fold(part));
    }
    wordList = null;
  }

  // --- what the parts of the index call -------------------------------------------------------------------------
  function index(given) {
    // Under `archgen serve` there may have been another index before.
    for (const part of [kinds, words, seenTokens, selectors]) part.clear();
    wordList = null;
    Object.assign(settings, given);
  }

  // Each line is a title, what is shown below it, and keys, with tabs between. Folding never makes or takes a line.
  function names(kind, lines, addresses) {
    const rows = rowsOf(kind);
    let place = "";
    for (const address of addresses.split("\n")) rows.places.push((place = address || place));
    for (const line of lines.split("\n")) rows.lines.push(line);
    for (const line of fold(lines).split("\n")) {
      rows.folded.push(line);
      const keys = line.slice(line.lastIndexOf("\t") + 1);
      if (keys.includes(":")) for (const key of keys.split(" ")) if (key.includes(":")) selectors.add(key);
    }
    addWords(lines);
  }

  function texts(kind, lines) {
    const rows = rowsOf(kind);
    for (const line of lines.split("\n")) {
      const at = line.indexOf("\t");
      const row = Number(line.slice(0, at));
      rows.texts[row] = (rows.texts[row] ?? "") + fold(line.slice(at + 1));
    }
    addWords(lines);
  }

  // --- one word in one row --------------------------------------------------------------------------------------
  const isLetter = (text, at) => {
    const code = text.charCodeAt(at);
    return (code > 96 && code < 123) || (code > 47 && code < 58) || code > 191;
  };

  // How well a word fits a line: the whole title, the start of it, the start of a word, anywhere; else what stands behind.
  function scoreWord(rows, row, word) {
    const line = rows.folded[row];
    let at = line.indexOf(word);
    if (at < 0) return rows.texts[row]?.includes(word) ? 1 : 0;
    const end = line.indexOf("\t");
    if (at >= end) return isLetter(line, at - 1) ? 4 : 8;
    if (end === word.length) return 100;
    if (at === 0) return isLetter(line, word.length) ? 44 : 56;
    for (let tries = 0; tries < 4 && isLetter(line, at - 1); tries += 1) {
      at = line.indexOf(word, at + 1);
      if (at < 0 || at >= end) return 16;
    }
    return isLetter(line, at - 1) ? 16 : isLetter(line, at + word.length) ? 36 : 48;
  }

  // The best of a word and of what it may have meant, which count for less the farther they are.
  function scoreTerm(rows, row, term) {
    if (term.selector) return hasKey(rows.folded[row], term.text) ? 10 : 0;
    let best = term.known ? scoreWord(rows, row, term.text) : 0;
    for (let at = 0; !best && at < term.near.length; at += 1) best = scoreWord(rows, row, term.near[at]) * (at ? 0.5 : 0.7);
    return best;
  }

  function hasKey(line, key) {
    const at = line.indexOf(key, line.lastIndexOf("\t"));
    return at > 0 && (line[at - 1] === "\t" || line[at - 1] === " ");
  }

  // --- a whole query --------------------------------------------------------------------------------------------
  function readQuery(query) {
    const terms = [];
    const pieces = query.split(/\s+/);
    const said = pieces.filter((piece) => piece && !settings.questionWords.includes(fold(piece)));
    for (const piece of said.length ? said : pieces) {
      const small = fold(piece);
      if (small.includes(":") && [...selectors].some((key) => key.startsWith(small))) {
        terms.push({ text: small, selector: true, near: [] });
        continue;
      }
      const texts = small.split(SEPARATORS).filter(Boolean);
      for (const text of texts) terms.push({ text, selector: false, known: isKnown(text), near: [] });
      // Signs and pictures alone are no word of the list; they may stand in a line all the same.
      if (small && !texts.length) terms.push({ text: small, selector: false, known: true, near: [] });
    }
    return terms;
  }

  // No line holds what no word holds, and there are far fewer words than lines.
  function isKnown(text) {
    wordList ??= [...words];
    return wordList.some((word) => word.includes(text));
  }

  // The heaviest kinds come first, so that what is drawn early stays where it is. Yields when the page should breathe.
  function* scan(rowScore) {
    const hits = [];
    for (const rows of [...kinds.values()].sort((a, b) => b.weight - a.weight)) {
      const end = rows.folded.length;
      for (let row = 0; row < end; row += 1) {
        const score = rowScore(rows, row);
        if (score) hits.push({ rows, row, score });
        if (row % 1024 === 1023) yield hits;
      }
    }
    return hits;
  }

  function* scanTerms(terms, phrase) {
    return yield* scan((rows, row) => {
      let total = rows.weight;
      for (const term of terms) {
        const score = scoreTerm(rows, row, term);
        if (!score) return 0;
        total += score;
      }
      const line = rows.folded[row];
      const length = line.indexOf("\t");
      if (phrase && line.lastIndexOf(phrase, length) >= 0) total += 30;
      // A component's many ports and connections hold its name as well.
      return total * (rows.weight > 2 ? 1 : 0.55) - Math.min(length, 80) / 16;
    });
  }

  // Names written as one word: "skeletontracker" finds skeleton_tracker.
  function* scanJoined(wanted) {
    return yield* scan((rows, row) => {
      const line = rows.folded[row];
      return line.slice(0, line.indexOf("\t")).replace(/[^\p{L}\p{N}]+/gu, "").includes(wanted) ? rows.weight : 0;
    });
  }

  // --- words with one letter wrong, missing, too much or exchanged ------------------------------------------------
  const LETTERS = "[\\p{L}\\p{N}]";
  const oneError = { intraSlice: [0, Infinity], intraIns: 1, intraSub: 1, intraTrn: 1, intraDel: 1 };
  const fuzzy = new uFuzzy({ unicode: true, interSplit: "[^\\p{L}\\p{N}]+", intraSplit: "", intraBound: "\\p{L}\\d|\\d\\p{L}",
    interBound: "[^\\p{L}\\p{N}]", intraChars: LETTERS, intraContr: "'\\p{L}{1,2}\\b", intraMode: 1,
    intraRules: () => oneError });

  // The words nearest to one, the most likely first.
  function nearWords(text) {
    if (text.length < 3 || text.length > LONGEST || !/\p{L}/u.test(text)) return [];
    wordList ??= [...words];
    const ranked = (fuzzy.filter(wordList, text) ?? []).map((at) => {
      const word = wordList[at];
      return { word, far: farness(text, word), order: Math.abs(word.length - text.length) + (word[0] === text[0] ? 0 : 2) };
    });
    ranked.sort((a, b) => a.far - b.far || a.order - b.order || (a.word < b.word ? -1 : 1));
    // Three letters with a wrong one are the start of half the words there are; four are somewhere inside of them.
    const limit = text.length < 4 ? 0 : text.length < 5 ? 1 : Math.max(1, ranked[0]?.far);
    const near = [];
    for (const { word, far } of ranked) {
      if (near.length === MOST_NEAR || far > limit) break;
      // Lines with "skeletons" are among those with "skeleton".
      if (word !== text && !near.some((other) => word.includes(other))) near.push(word);
    }
    return near;
  }

  // 0 where one change makes the text the word, 1 where it makes it the start of it, 2 where it only is inside of it.
  function farness(text, word) {
    let same = 0;
    while (same < text.length && text[same] === word[same]) same += 1;
    const swapped = text.slice(0, same) + (text[same + 1] ?? "") + (text[same] ?? "") + text.slice(same + 2);
    const corrected = [
      text.slice(0, same) + (word[same] ?? "") + text.slice(same + 1), // another letter
      text.slice(0, same) + text.slice(same + 1), // one too many
      text.slice(0, same) + (word[same] ?? "") + text.slice(same), // one missing
      swapped,
    ];
    if (corrected.includes(word)) return 0;
    return corrected.some((change) => word.startsWith(change)) ? 1 : 2;
  }

  // --- the answer -----------------------------------------------------------------------------------------------
  // A generator: yields functions that give the answer so far (null while there is none), and returns the whole answer.
  function* find(query, kind) {
    const terms = readQuery(query);
    if (!terms.length) return answer([], kind, terms, "");
    const phrase = terms.length > 1 ? fold(query.trim()) : "";
    const given = (hits) => (hits.length ? answer(hits, kind, terms, "") : null);
    let hits = [];
    if (terms.every((term) => term.selector || term.known)) hits = yield* convert(scanTerms(terms, phrase), given);
    if (hits.length >= FEW) return answer(hits, kind, terms, "");
    const nearby = yield* findNear(query, kind, terms, hits);
    const joined = fold(query).split(SEPARATORS).join("");
    if (nearby.total || joined.length < 5 || terms.some((term) => term.selector)) return nearby;
    return answer(yield* convert(scanJoined(joined), given), kind, terms, "");
  }

  function* findNear(query, kind, terms, hits) {
    const near = terms.map((term) => (term.selector ? term : { ...term, near: nearWords(term.text) }));
    const changed = near.filter((term) => term.near.length && (hits.length || !term.known));
    // All words may be known and never stand together: then one of them may be the wrong one.
    const suspects = changed.length ? changed : near.filter((term) => term.near.length);
    if (!suspects.length) return answer(hits, kind, terms, "");
    const seen = new Set(hits.map(({ rows, row }) => rows.places[row] + rows.lines[row]));
    const both = (more) => {
      const added = more.filter(({ rows, row }) => !seen.has(rows.places[row] + rows.lines[row]));
      // Behind what is spelt as written.
      const behind = hits.length ? added.map((hit) => ({ ...hit, score: hit.score - 1000 })) : added;
      if (!added.length) return null;
      const best = added.reduce((first, hit) => (hit.score > first.score ? hit : first));
      return answer([...hits, ...behind], kind, near, describeNear(query, near, suspects, best, hits.length));
    };
    const more = yield* convert(scanTerms(near, ""), both);
    return both(more) ?? answer(hits, kind, terms, "");
  }

  // Says what was taken instead, by the words of the best line.
  function describeNear(query, near, suspects, { rows, row }, hasExact) {
    const wordOf = (term) => {
      const scores = term.near.map((word) => scoreWord(rows, row, word));
      return term.near[scores.indexOf(Math.max(...scores))];
    };
    if (hasExact) return `Also what is spelt nearly so: ${suspects.map(wordOf).join(", ")}`;
    const meant = near.map((term) => (suspects.includes(term) ? wordOf(term) : term.text));
    return `Nothing is spelt “${query.trim()}”. Nearest: ${meant.join(", ")}`;
  }

  function* convert(scanning, toAnswer) {
    for (;;) {
      const { value, done } = scanning.next();
      if (done) return value;
      yield () => toAnswer(value);
    }
  }

  function answer(hits, kind, terms, note) {
    const counts = new Map();
    for (const { rows } of hits) counts.set(rows.kind, (counts.get(rows.kind) ?? 0) + 1);
    const wanted = kind && counts.has(kind) ? hits.filter((hit) => hit.rows.kind === kind) : hits;
    // One number for each hit, its score and its place, sorts ten times faster than comparing records.
    const order = Float64Array.from(wanted, (hit, at) => Math.round((hit.score + 2000) * 64) * 2097152 + (2097151 - at));
    order.sort();
    const shown = [];
    for (let at = order.length - 1; at >= 0 && shown.length < SHOWN; at -= 1) {
      const { rows, row } = wanted[2097151 - (order[at] % 2097152)];
      const [title, line] = rows.lines[row].split("\t");
      shown.push({ kind: rows.kind, title, line, place: rows.places[row] });
    }
    const marks = terms.flatMap((term) => (term.selector ? [] : [term.text, ...term.near]));
    return {
      total: hits.length, chosen: wanted.length, note, marks, shown,
      kinds: [...counts].sort((a, b) => (WEIGHTS[b[0]] ?? 4) - (WEIGHTS[a[0]] ?? 4) || (a[0] < b[0] ? -1 : 1)),
    };
  }

  // The pieces of a title, in turns plain and marked. Folding may change lengths, so each letter is folded by itself.
  function markTitle(title, marks) {
    let folded = "";
    const origin = [];
    let at = 0;
    for (const letter of title) {
      const small = fold(letter);
      for (let unit = 0; unit < small.length; unit += 1) origin.push(at);
      folded += small;
      at += letter.length;
    }
    const marked = new Uint8Array(title.length);
    for (const word of marks) {
      for (let from = folded.indexOf(word); word && from >= 0; from = folded.indexOf(word, from + word.length)) {
        marked.fill(1, origin[from], origin[from + word.length] ?? title.length);
      }
    }
    const pieces = [""];
    for (let unit = 0; unit < title.length; unit += 1) {
      if (pieces.length % 2 === marked[unit]) pieces.push("");
      pieces[pieces.length - 1] += title[unit];
    }
    return pieces;
  }

  return { index, names, texts, find, markTitle, settings };
})();
