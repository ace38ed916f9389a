"""Mend a text that is half written, so that all else in it can be read: lines are blanked, and every position stays."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from archgen.diagnostics import Diagnostic
from archgen.frozen import NamedTuple

_MAX_CUTS = 12
_MAX_READING = 3_000_000
"""Characters that are read again and again for one mend: each try reads the whole text."""
FindErrors = Callable[[str], tuple[Diagnostic, ...]]
"""What keeps a text from being read; empty where it can be."""


class MendedText(NamedTuple):
    """A text that can be read, in place of one that cannot be."""

    text: str
    errors: tuple[Diagnostic, ...] = ()
    """What is wrong with the text as it is written; empty where that can be read, or where nothing helps."""
    lost_text: str = ""
    """What was written and is not read."""


def mend_text(text: str, cursor_line: int, good_text: str | None, find_errors: FindErrors) -> MendedText:
    """Return a text without the fewest lines that keep it from being read: that of the cursor, else those that errors blame,
    else as it was when it could be read last (`good_text`). Lines count from 1.
    """
    errors = find_errors(text)
    if not errors:
        return MendedText(text)
    lines = split_lines(text)
    tries = min(_MAX_CUTS, 1 + _MAX_READING // (len(text) + 1))
    # Of a merge conflict without its marks both sides would stay.
    for first_cuts in ((cursor_line,), ()) if errors[0].rule != "merge-conflict" else ():
        cuts = _find_cuts(lines, first_cuts, errors, find_errors, tries)
        if cuts:
            return MendedText(_blank_lines(lines, cuts), errors, "".join(lines[number - 1] for number in cuts))
    for candidate in _place_good_lines(lines, split_lines(good_text)) if good_text else ():
        if not find_errors(candidate):
            return MendedText(candidate, errors, text)
    return MendedText(text)


def split_lines(text: str) -> list[str]:
    """Return the lines of a text with their ends, as editors count them; behind the last end stands one more."""
    return re.split(r"(?<=\n)|(?<=\r)(?!\n)", text)


def measure_common_lines(old_lines: Sequence[str], new_lines: Sequence[str]) -> tuple[int, int]:
    """Return how many lines two texts have in common at their beginnings, and behind these at their ends."""
    shorter = min(len(old_lines), len(new_lines))
    above = next((at for at in range(shorter) if old_lines[at] != new_lines[at]), shorter)
    below = next((at for at in range(shorter - above) if old_lines[-1 - at] != new_lines[-1 - at]), shorter - above)
    return above, below


def _find_cuts(
    lines: Sequence[str], first_cuts: Iterable[int], errors: tuple[Diagnostic, ...], find_errors: FindErrors, tries: int
) -> list[int]:
    """Return the lines without which the others can be read; empty where more would have to go than are tried."""
    cuts = [number for number in first_cuts if _is_written(lines, number, ())]
    for _ in range(tries):
        if cuts:
            errors = find_errors(_blank_lines(lines, cuts))
            if not errors:
                return cuts
        blamed = (span.line for error in errors for span in (error.span, *(label.span for label in error.labels)))
        worst = next((number for number in blamed if _is_written(lines, number, cuts)), None)
        if worst is None:  # the parser stumbles behind what is wrong
            above = range(min(errors[0].span.line, len(lines)), 0, -1)
            worst = next((number for number in above if _is_written(lines, number, cuts)), None)
        if worst is None:
            return []
        cuts.append(worst)
    return []


def _is_written(lines: Sequence[str], number: int, cuts: Sequence[int]) -> bool:
    return 0 < number <= len(lines) and number not in cuts and bool(lines[number - 1].strip())


def _blank_lines(lines: Sequence[str], numbers: Iterable[int]) -> str:
    blanked = list(lines)
    for number in numbers:
        line = lines[number - 1]
        blanked[number - 1] = line[len(line.rstrip("\r\n")) :]
    return "".join(blanked)


def _place_good_lines(lines: Sequence[str], good_lines: Sequence[str]) -> Iterable[str]:
    """Yield the text of before so that what is as it was stands in the lines where it stands now; then as it was."""
    above, below = measure_common_lines(good_lines, lines)
    good_middle = good_lines[above : len(good_lines) - below]
    blanks = ["\n"] * (len(lines) - len(good_lines))
    if len(lines) >= len(good_lines):
        yield "".join((*good_lines[:above], *good_middle, *blanks, *good_lines[len(good_lines) - below :]))
    yield "".join(good_lines)
