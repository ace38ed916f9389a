"""Whether two texts may mean something else: units, frames and signs matter, how a sentence is written does not."""

from __future__ import annotations

import re
from collections.abc import Sequence

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
    return _list_tokens(before) != _list_tokens(after)


def differs_in_measures(before: str, after: str) -> bool:
    """Whether two texts give other numbers, units, frames or directions."""
    return _list_measures(before) != _list_measures(after)


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
    return [word for previous, token in pairs if _is_measure(token) for word in (_keep_number(previous), token) if word]


def _keep_number(token: str) -> str:
    return "" if token[:1].isalpha() or token[:1] == "_" else token


def _is_measure(token: str) -> bool:
    folded_token = token.casefold()
    return folded_token in _MEASURES or folded_token.removesuffix("s") in _MEASURES
