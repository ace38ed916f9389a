"""The words in which two texts differ, with a few around them, so that a sentence can show what was rewritten."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

_CONTEXT_WORDS = 4
_MAX_WORDS = 24
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
        f"`{_quote_words(old_words, old_start, old_end)}` → `{_quote_words(new_words, new_start, new_end)}`"
        for old_start, old_end, new_start, new_end in opcodes[:_MAX_DIFFERENCES]
    ]
    surplus = len(opcodes) - _MAX_DIFFERENCES
    return ", ".join(pairs) + (f", and {surplus} more place{'s' if surplus > 1 else ''}" if surplus > 0 else "")


def cut_text(text: str) -> str:
    """Return the beginning of a text for a sentence, on one line and without backticks."""
    words = text.replace("`", "'").split()
    return _quote_words(words, 0, len(words))


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
        if joined and opcode[0] - joined[-1][1] <= _CONTEXT_WORDS:
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


def _quote_words(words: Sequence[str], start: int, end: int) -> str:
    """Return some words with those around them; what is cut shows."""
    first, last = max(start - _CONTEXT_WORDS, 0), min(end + _CONTEXT_WORDS, len(words))
    shown_words = [word if len(word) <= _MAX_WORD else f"{word[:_MAX_WORD]}…" for word in words[first:last]]
    is_cut = last < len(words) or len(shown_words) > _MAX_WORDS
    return " ".join([*(["…"] if first else []), *shown_words[:_MAX_WORDS], *(["…"] if is_cut else [])])
