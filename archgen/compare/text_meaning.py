"""Whether two texts may mean something else (units, frames and signs matter, how a sentence is written does not), and the words in which they differ."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

_WORDS_AROUND = 4
_MAX_QUOTED_WORDS = 24
"""How many words of one side are quoted of one difference."""
_MAX_WORD = 60
"""How many characters of one word are quoted."""
_MAX_DIFFERENCES = 3
_MAX_COMPARED_WORDS = 600
"""Texts longer than this are compared from both ends alone: finding all differences would take their product."""
Opcode = tuple[int, int, int, int]
"""Where a difference begins and ends, in the words before and after."""


def describe_text_difference(before: str, after: str) -> str:
    """Return what differs between two texts as quoted pairs of old and new words: `… in metres` → `… in millimetres`."""
    old_words, new_words = before.replace("`", "'").split(), after.replace("`", "'").split()
    opcodes = list(find_differences(old_words, new_words))
    pairs = [
        f"`{_quote_around(old_words, old_start, old_end)}` → `{_quote_around(new_words, new_start, new_end)}`"
        for old_start, old_end, new_start, new_end in opcodes[:_MAX_DIFFERENCES]
    ]
    surplus = len(opcodes) - _MAX_DIFFERENCES
    return ", ".join(pairs) + (f", and {surplus} more place{'s' if surplus > 1 else ''}" if surplus > 0 else "")


def cut_text(text: str) -> str:
    """Return the beginning of a text for a sentence, on one line and without backticks."""
    words = text.replace("`", "'").split()
    return _quote_around(words, 0, len(words))


def find_differences(old_words: Sequence[str], new_words: Sequence[str]) -> Iterator[Opcode]:
    """Yield where two texts differ; differences with hardly a word in between are one."""
    # Imported here: most comparisons change no long text.
    from difflib import SequenceMatcher

    start = _common_length(old_words, new_words)
    end = _common_length(old_words[start:][::-1], new_words[start:][::-1])
    old_end, new_end = len(old_words) - end, len(new_words) - end
    if max(len(old_words), len(new_words)) > _MAX_COMPARED_WORDS:
        yield start, old_end, start, new_end
        return
    matcher = SequenceMatcher(None, old_words[start:old_end], new_words[start:new_end], autojunk=False)
    joined: list[Opcode] = []
    for tag, old_from, old_to, new_from, new_to in matcher.get_opcodes():
        if tag == "equal":
            continue
        opcode = (start + old_from, start + old_to, start + new_from, start + new_to)
        if joined and opcode[0] - joined[-1][1] <= _WORDS_AROUND:
            opcode = (joined[-1][0], opcode[1], joined[-1][2], opcode[3])
            joined.pop()
        joined.append(opcode)
    yield from joined


def _common_length(words: Sequence[str], other_words: Sequence[str]) -> int:
    length = 0
    for word, other_word in zip(words, other_words, strict=False):
        if word != other_word:
            break
        length += 1
    return length


def _quote_around(words: Sequence[str], start: int, end: int) -> str:
    """Return some words with those around them; what is cut shows."""
    first, last = max(start - _WORDS_AROUND, 0), min(end + _WORDS_AROUND, len(words))
    shown_words = [word if len(word) <= _MAX_WORD else f"{word[:_MAX_WORD]}…" for word in words[first:last]]
    is_cut = last < len(words) or len(shown_words) > _MAX_QUOTED_WORDS
    return " ".join([*(["…"] if first else []), *shown_words[:_MAX_QUOTED_WORDS], *(["…"] if is_cut else [])])


_INTERVAL_END = r"\s*[-+\u2212]?(?:\d[\w.]*|inf\w*|pi|[\u03c0\u221e])\s*"
_TOKEN = re.compile(
    # an interval with its brackets: [0, 1) does not hold 1
    rf"[\[\](]{_INTERVAL_END}[,;]{_INTERVAL_END}[\[\])]"
    r"|(?<![\w.,])[-+\u2212\u00b1]?\d+(?:[.,]\d+)*"  # a number with its sign: 1.0 is not 10
    r"|(?<![\w-])[-+\u2212\u00b1](?=[^\W\d])"  # the sign of an axis: -x; not the hyphen of right-handed
    r"|[^\W\d]\w*"
    r"|\d+|!(?==)|(?<!\w)!(?=\w)|~(?=[\w.+-])"  # not equal, not, about; no exclamation
    r"|[%\u2030\u00b0<>=\u2260\u2248\u2264\u2265*/^|&+\u00b1\u00d7\u00f7\u221a\u00b2\u00b3]"
)
_LONGEST_UNIT = 3
_WORD = re.compile(r"\w+")
_SHORT_WORDS = frozenset(
    _WORD.findall(
        "a all an and any are as at be but by can did do each few for from had has he how i if in is it its let lot may "
        "new no non nor not now of off old on one or our out own per put raw say see set she so than that the then they "
        "this to too two up us use via was way we who why yes yet you"
    )
)
"""Words that are as short as units and none: a capital letter begins a sentence, and says nothing."""
_MEASURES = frozenset(
    _WORD.findall(
        "um mm cm dm m km micrometre millimetre centimetre metre kilometre micrometer millimeter centimeter meter "
        "kilometer inch inches foot feet ns us ms s nanosecond microsecond millisecond second minute hour hz khz mhz rad "
        "mrad deg radian degree nm newton v mv ma w mw kw pa kpa mpa bar kg celsius kelvin fahrenheit pixel px percent "
        "frame axis x y z roll pitch yaw left right forward backward positive negative clockwise counterclockwise origin "
        "absolute relative normalised normalized signed unsigned row column latitude longitude east north enu ned"
    )
)
"""Words that say how to read a number, in lower case and in the singular."""
_CONTEXT_WORDS, _MAX_WORDS = 3, 12


def differs_in_meaning(before: str, after: str) -> bool:
    """Whether two texts differ in more than capital letters, blanks and punctuation that is no sign of mathematics."""
    return before != after and _list_tokens(before) != _list_tokens(after)


def differs_in_measures(before: str, after: str) -> bool:
    """Whether two texts give other numbers, units, frames or directions."""
    return before != after and _list_measures(before) != _list_measures(after)


def quote_difference(before: str, after: str) -> tuple[str, str]:
    """Return where two texts differ, with some words around it, each on one line."""
    old_words, new_words = before.split(), after.split()
    pairs = zip(old_words, new_words, strict=False)
    first = next((index for index, (old, new) in enumerate(pairs) if old != new), min(len(old_words), len(new_words)))
    start = max(first - _CONTEXT_WORDS, 0)
    return _quote_words(old_words, start), _quote_words(new_words, start)


def _quote_words(words: Sequence[str], start: int) -> str:
    lead = "… " if start else ""
    return lead + " ".join(words[start : start + _MAX_WORDS]) + (" …" if start + _MAX_WORDS < len(words) else "")


def _list_tokens(text: str) -> list[str]:
    return [_fold_word("".join(token.split())) for token in _TOKEN.findall(text)]


def _fold_word(word: str) -> str:
    """Return a word without its capital letters, unless they may tell a unit: mW is not MW."""
    folded_word = word.casefold()
    return word if len(word) <= _LONGEST_UNIT and folded_word not in _SHORT_WORDS else folded_word


def _list_measures(text: str) -> list[str]:
    """Return the words of measure in a text, each with the number or sign in front of it: `22 objects` is no measure."""
    tokens = _list_tokens(text)
    pairs = zip(["", *tokens], tokens, strict=False)
    return [
        word
        for previous, token in pairs
        if _is_measure(token)
        for word in ("" if previous[:1].isalpha() or previous[:1] == "_" else previous, token)
        if word
    ]


def _is_measure(token: str) -> bool:
    folded_token = token.casefold()
    return folded_token in _MEASURES or folded_token.removesuffix("s") in _MEASURES
