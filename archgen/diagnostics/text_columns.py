"""Tables and long lines for a terminal, no wider than it is: cells are wrapped, and nothing is cut off.

Without a width (a file, a pipe) each row stays on one line, for grep, and is as wide as it must be. Whatever could move a
terminal's cursor, or hide or reorder text, becomes visible.
"""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from typing import TextIO

_JOINERS = frozenset("\u200c\u200d")
"""Joiners: some scripts need them, and they do no harm."""


def make_visible(text: str) -> str:
    """Return the text with every control, formatting and line-separating character replaced by a visible one.

    Control characters become their pictures (escape is `␛`), all others that do not print become `�`.
    """
    # Nearly every text: both tests run in C.
    if text.isascii() and text.isprintable():
        return text
    return "".join(_visible_character(character) for character in text)


def defuse_command(line: str) -> str:
    """Return a visible line that no workflow takes for one of its commands, which begin with `::` after blanks."""
    blanks = len(line) - len(line.lstrip())
    return f"{line[:blanks]}\\{line[blanks:]}" if line.startswith("::", blanks) else line


def format_json(data: object) -> str:
    """Return JSON in which everything that does not print is escaped: the data are the same, and terminals are safe."""
    text = json.dumps(data, ensure_ascii=False, indent=2) + "\n"
    if text.isascii() and "\x7f" not in text:
        return text
    # Such characters occur inside of strings only, where an escape means the same; [1:-1] takes the quotes off.
    return "".join(
        character
        if character == "\n" or character in _JOINERS or _visible_character(character) == character
        else json.dumps(character)[1:-1]
        for character in text
    )


def measure_width(text: str) -> int:
    """Return the columns that a visible text takes in a terminal: wide characters take two, combining ones none."""
    if text.isascii():
        return len(text)
    return sum(_character_width(character) for character in text)


def _visible_character(character: str) -> str:
    code = ord(character)
    if code < 0x20:  # noqa: PLR2004 - the C0 controls
        return chr(0x2400 + code)
    if code == 0x7F:  # noqa: PLR2004 - delete
        return "\u2421"
    # Joiners belong to the category Cf, which is replaced below.
    if character in _JOINERS:
        return character
    return "\ufffd" if unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"} else character


def _character_width(character: str) -> int:
    if character in _JOINERS or unicodedata.category(character) in {"Mn", "Me"}:
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def replace_surrogates(text: str) -> str:
    """Return a text as it comes back from a UTF-8 file, and as YAML can hold it: lone surrogates become `?`."""
    return text.encode("utf-8", "replace").decode("utf-8")


TextRow = Sequence[str]
_GAP = "  "
_NARROWEST_TERMINAL = 20
_NARROWEST_COLUMN = 20
"""In narrower columns names of elements become unreadable: a table shows each row as a list of its cells then."""
_NARROWEST_TEXT = 24
"""Where less room than this is left for the last cell of a row, it goes below the others."""
_PIECE_PATTERN = re.compile(r"[^\s./_:,>-]*[./_:,>-]*")
"""The parts of a word that is too long for a line: names break after their separators."""


def find_width(stream: TextIO) -> int | None:
    """Return the columns to write in: those that COLUMNS sets, else the terminal's; None where there is no terminal."""
    columns = os.environ.get("COLUMNS", "")
    if columns.isascii() and columns.isdigit() and int(columns):
        return max(int(columns), _NARROWEST_TERMINAL)
    if not stream.isatty():
        return None
    import shutil  # here: it loads four compressors

    return max(shutil.get_terminal_size().columns, _NARROWEST_TERMINAL)


def wrap_line(line: str, width: int | None, hanging: int = 4) -> list[str]:
    """Wrap a visible line; the lines that follow are indented by `hanging` more than it is."""
    if width is None or measure_width(line) <= width:
        return [line]
    indent = len(line) - len(line.lstrip(" "))
    indent = min(indent, width // 2)
    hanging = min(indent + hanging, width // 2)
    first, *others = wrap_cell(line.strip(), width - indent, width - hanging)
    return [" " * indent + first, *(" " * hanging + other for other in others)]


def wrap_cell(text: str, width: int, later_width: int | None = None) -> list[str]:
    """Wrap a visible text at blanks; words that are too long break after their separators, at last anywhere."""
    if measure_width(text) <= width:
        return [text]
    lines, room = [""], width
    later_width = width if later_width is None else later_width
    for word in text.split():
        for number, piece in enumerate(_split_word(word, later_width)):
            gap = " " if lines[-1] and not number else ""
            needed = len(gap) + measure_width(piece)
            if lines[-1] and needed > room:
                lines.append(piece)
                room = later_width - measure_width(piece)
            else:
                lines[-1] += gap + piece
                room -= needed
    return lines


def _split_word(word: str, width: int) -> Iterator[str]:
    """Yield a word whole if it fits into a line, else its parts."""
    if measure_width(word) <= width:
        yield word
        return
    for piece in _PIECE_PATTERN.findall(word):
        part, room = "", width
        for character in piece:
            needed = measure_width(character)
            if needed > room:
                yield part
                part, room = "", width
            part, room = part + character, room - needed
        if part:
            yield part


def align_rows(rows: Iterable[TextRow], width: int | None = None, indent: str = _GAP) -> Iterator[str]:
    """Yield rows in aligned columns. The last cell of a row needs no width of its own: it is the one to be wrapped."""
    # Made visible before it is measured: replacements may have another width.
    cleaned = [[make_visible(cell) for cell in row] for row in rows]
    widths = _measure_columns([row[:-1] for row in cleaned])
    if width is not None:
        widths = _shrink_columns(widths, width - len(indent) - len(_GAP) * max(len(widths) - 1, 0))
    for row in cleaned:
        yield from _align_row(row, widths[: len(row) - 1], width, indent)


def format_section(title: str, rows: Iterable[TextRow], width: int | None = None) -> Iterator[str]:
    """Yield rows in aligned columns below a title, with an empty line behind them; nothing where there are no rows."""
    section_rows = list(rows)
    if section_rows:
        yield title
        yield from align_rows(section_rows, width)
        yield ""


def _align_row(row: list[str], widths: list[int], width: int | None, indent: str) -> Iterator[str]:
    used = len(indent) + sum(each + len(_GAP) for each in widths)
    last_width = measure_width(row[-1]) if width is None else width - used
    # A short last cell is wrapped beside the others, if at all; a text that has no room there goes below.
    if last_width >= min(measure_width(row[-1]), _NARROWEST_TEXT):
        yield from _join_cells(row, [*widths, max(last_width, 1)], indent)
        return
    yield from _join_cells(row[:-1], widths, indent)
    if row[-1]:
        yield from wrap_line(f"{indent}    {row[-1]}", width, hanging=0)


def format_table(
    headings: TextRow, rows: Iterable[TextRow], width: int | None = None, *, has_figures: bool = False
) -> Iterator[str]:
    """Yield a table below its headings. On a terminal that is too narrow for it each row is a list of its cells.

    `has_figures`: columns of figures are set flush right.
    """
    cleaned = [[make_visible(cell) for cell in row] for row in (headings, *rows)]
    widths = _measure_columns(cleaned)
    if has_figures:
        flush_columns = {at for at in range(len(headings)) if all(row[at][:1].isdigit() for row in cleaned[1:])}
        cleaned = [
            [cell.rjust(widths[at]) if at in flush_columns else cell for at, cell in enumerate(row)] for row in cleaned
        ]
    if width is not None:
        shrunk = _shrink_columns(widths, width - len(_GAP) * (len(widths) - 1))
        if any(new < min(old, _NARROWEST_COLUMN) for new, old in zip(shrunk, widths, strict=True)):
            yield from _list_cells(cleaned, width)
            return
        widths = shrunk
    for row in cleaned:
        yield from _join_cells(row, widths, "")


def _list_cells(table: list[list[str]], width: int) -> Iterator[str]:
    """Yield each row as its first cell and, below it, the others with their headings; empty ones are left out."""
    headings, *rows = table
    name_width = max(measure_width(heading) for heading in headings[1:])
    for row in rows:
        yield from wrap_line(row[0], width)
        for heading, cell in zip(headings[1:], row[1:], strict=True):
            if cell.strip():
                label = heading.strip() + ":"
                yield from align_rows([(label.ljust(name_width + 1), cell.strip())], width)


def _measure_columns(rows: list[list[str]]) -> list[int]:
    count = max((len(row) for row in rows), default=0)
    return [max((measure_width(row[at]) for row in rows if at < len(row)), default=0) for at in range(count)]


def _shrink_columns(widths: list[int], room: int) -> list[int]:
    """Return widths that fit into the room: the widest columns give first, down to one common width."""
    if sum(widths) <= room:
        return widths
    limit = max(
        (each for each in range(1, min(max(widths), room) + 1) if sum(min(w, each) for w in widths) <= room), default=1
    )
    spare = room - sum(min(width, limit) for width in widths)
    shrunk = []
    for width in widths:
        extra = 1 if width > limit and spare > 0 else 0
        spare -= extra
        shrunk.append(min(width, limit) + extra)
    return shrunk


def _join_cells(row: list[str], widths: list[int], indent: str) -> Iterator[str]:
    """Yield the lines of one row, each cell wrapped into its column."""
    wrapped = [wrap_cell(cell, width) for cell, width in zip(row, widths, strict=True)]
    for number in range(max(map(len, wrapped), default=0)):
        cells = [lines[number] if number < len(lines) else "" for lines in wrapped]
        padded = (cell + " " * (width - measure_width(cell)) for cell, width in zip(cells, widths, strict=True))
        yield (indent + _GAP.join(padded)).rstrip()
