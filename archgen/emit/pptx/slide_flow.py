"""What stands where on slides: blocks become pieces of known height, which flow over as many slides as they need.

Programs let the rows of a table grow with their text, so heights are estimated, as those of the report are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import fsum

from archgen.emit.picture import Picture
from archgen.emit.text_metrics import (
    BOLD_FACTOR,
    count_lines,
    join_hard_blanks,
    measure_code,
    measure_word,
    share_width,
    split_name,
)
from archgen.frozen import dataclass, replace
from archgen.views.shapes import (
    Block,
    Bullets,
    Facts,
    Figure,
    Inlines,
    Markdown,
    Paragraph,
    Section,
    Table,
    Text,
    keep_columns,
)

SLIDE_WIDTH, SLIDE_HEIGHT = 960.0, 540.0
"""In points, as all lengths here."""
MARGIN = 36.0
BODY_TOP, BODY_BOTTOM = 84.0, 504.0
_GUTTER = 24.0
_LEFT_SHARE, _PICTURE_SHARE = 0.58, 0.64
"""The first of two columns: what flows, or a picture with nothing below it."""
_LINE = 1.23
"""LibreOffice sets lines of Carlito and Consolas so high."""
_PADDING = 3.0
"""Above and below the text of a cell."""
SIDE_PADDING = 7.0
GAP = 6.0
_SIZES, _SIZES_BESIDE, _SIZES_ABOVE_PICTURES = (16.0, 15.0, 14.0, 13.0, 12.0), (14.0, 13.0, 12.0, 11.5), (13.0, 12.0)
"""A section is set in the largest type in which it takes as few slides as in the smallest, which a room can read."""
_MAX_CELL_LINES, _MAX_TEXT_LINES = 6, 10
"""Longer texts end in an ellipsis: a slide is looked at, the report has all of it."""
_LEAST_PICTURE = 150.0
"""A picture that would be less high begins a slide."""
_MAX_SCALE = 1.5
"""A picture of one box is not drawn out over the slide."""
_LEAST_SCALE = 0.55
"""A picture that a whole slide shows smaller has type that nobody reads."""
FIGURE_SCALE = 1.9
"""How much larger figures are than the words below them."""
_CODE_EXCESS = 0.15
"""How much wider than text code runs, which is set smaller."""
_MAX_WORD_SHARE = 0.4
_HEADING_SHARE = 0.6
"""A heading of so much of its width takes two lines at most."""
_SAFETY = 0.96
"""The share of a width that is taken for lines: fonts differ from program to program."""


@dataclass(frozen=True, slots=True)
class Place:
    """A rectangle of a slide."""

    left: float
    top: float
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class PlacedText:
    """Paragraphs in a box, each with its runs; sizes are those of the type."""

    place: Place
    paragraphs: tuple[Inlines, ...]
    size: float


@dataclass(frozen=True, slots=True)
class PlacedTable:
    """Some rows of a table below its heading."""

    place: Place
    table: Table
    widths: Sequence[float]
    heights: tuple[float, ...]
    size: float
    has_heading: bool


@dataclass(frozen=True, slots=True)
class PlacedPicture:
    """A picture, as large as its place allows."""

    place: Place
    picture: Picture
    alt: str


Placed = PlacedText | PlacedTable | PlacedPicture


@dataclass(frozen=True, slots=True)
class _Column:
    """A column of a slide: where it stands and how large its text is set."""

    left: float
    width: float
    size: float


def flow_section(section: Section, pictures: Mapping[str, Picture]) -> tuple[tuple[Placed, ...], ...]:
    """Return what stands on each slide of a section; at least one, which may be empty.

    Two sections stand side by side, with the blocks of what holds them below, over the whole width.
    """
    parts = section.sections if len(section.sections) > 1 else ()
    blocks = (
        section.blocks if parts else [*section.blocks, *(each for part in section.sections for each in part.blocks)]
    )
    is_above_picture = not parts and any(isinstance(each, Figure) for each in blocks)
    sizes = _SIZES_BESIDE if parts else _SIZES_ABOVE_PICTURES if is_above_picture else _SIZES
    # Of slides of the same number the first ones, which are set largest.
    sheets = min((_lay_out_blocks(parts, blocks, pictures, size) for size in sizes), key=len)
    return tuple(map(tuple, sheets))


def _lay_out_blocks(
    parts: Sequence[Section], blocks: Sequence[Block], pictures: Mapping[str, Picture], size: float
) -> list[list[Placed]]:
    """Return what stands on each slide: parts side by side, and blocks below them."""
    full = SLIDE_WIDTH - 2 * MARGIN
    sheets: list[list[Placed]] = [[]]
    if parts:
        is_picture_alone = not blocks and all(isinstance(each, Figure) for each in parts[0].blocks)
        left = round((full - _GUTTER) * (_PICTURE_SHARE if is_picture_alone else _LEFT_SHARE))
        right = _Column(MARGIN + left + _GUTTER, full - left - _GUTTER, size)
        _add_column(sheets, 0, parts[0].blocks, _Column(MARGIN, left, size), pictures, BODY_TOP)
        beside = [block for each in parts[1:] for block in each.blocks]
        _add_column(sheets, 0, beside, right, pictures, BODY_TOP)
    top = max((each.place.top + each.place.height + GAP for each in sheets[-1]), default=BODY_TOP)
    _add_column(sheets, len(sheets) - 1, blocks, _Column(MARGIN, full, size), pictures, top)
    return sheets


def _add_column(  # noqa: PLR0913, PLR0917 - where it begins
    sheets: list[list[Placed]],
    first: int,
    blocks: Sequence[Block],
    column: _Column,
    pictures: Mapping[str, Picture],
    top: float,
) -> None:
    """Add what blocks become to the slides from one on; paragraphs in a row are one text that people edit."""
    last: Placed | None = None
    for number, placed in _flow_blocks(blocks, column, pictures, top):
        while len(sheets) <= first + number:
            sheets.append([])
        sheet = sheets[first + number]
        if isinstance(placed, PlacedText) and isinstance(last, PlacedText) and sheet[-1:] == [last]:
            place = replace(last.place, height=placed.place.top + placed.place.height - last.place.top)
            last = sheet[-1] = replace(last, place=place, paragraphs=(*last.paragraphs, *placed.paragraphs))
        else:
            sheet.append(last := placed)


def _flow_blocks(
    blocks: Sequence[Block], column: _Column, pictures: Mapping[str, Picture], top: float
) -> Iterator[tuple[int, Placed]]:
    """Yield what blocks become from a height on, each with the number of its slide."""
    sheet = 0
    for index, block in enumerate(blocks):
        follower = blocks[index + 1] if index + 1 < len(blocks) else None
        if isinstance(block, Table):
            for part in _cut_table(block, column, BODY_BOTTOM - top):
                height = fsum(part.heights)
                if top + height > BODY_BOTTOM and top > BODY_TOP:
                    sheet, top = sheet + 1, BODY_TOP
                yield sheet, replace(part, place=Place(column.left, top, column.width, height))
                top += height + GAP
        elif isinstance(block, Figure):
            picture = pictures.get(block.graph)
            is_large = picture is not None and _fit_picture(picture, column, BODY_TOP) < _LEAST_SCALE
            if picture is None or not picture.png or is_large:
                lack = "is too large for a slide; the site has it" if is_large else "could not be drawn"
                note = (Text(f"This picture {lack}. {block.alt}".strip(), muted=True),)
                text = _fit_text((note,), column)
                yield sheet, _place_text(text, column, top)
                top += _measure_text(text, column) + GAP
                continue
            if BODY_BOTTOM - top < _LEAST_PICTURE:
                sheet, top = sheet + 1, BODY_TOP
            scale = _fit_picture(picture, column, top)
            width, height = picture.width * scale, picture.height * scale
            place = Place(column.left + (column.width - width) / 2, top, width, height)
            yield sheet, PlacedPicture(place, picture, block.alt or block.caption)
            top += height + GAP
        else:
            for paragraph in _list_paragraphs(block):
                text = _fit_text((paragraph,), column)
                height = _measure_text(text, column)
                # A line above a table stays with its first row.
                needed = height + (_measure_start(follower, column) if isinstance(follower, Table) else 0)
                if top + needed > BODY_BOTTOM and top > BODY_TOP:
                    sheet, top = sheet + 1, BODY_TOP
                yield sheet, _place_text(text, column, top)
                top += height + GAP


def _fit_picture(picture: Picture, column: _Column, top: float) -> float:
    return min(column.width / picture.width, (BODY_BOTTOM - top) / picture.height, _MAX_SCALE)


def _list_paragraphs(block: Block) -> Iterator[Inlines]:
    match block:
        case Paragraph():
            yield block.inlines
        case Bullets():
            for item in block.items:
                yield (Text("• "), *item)
        case Facts():
            for name, value in block.rows:
                yield (Text(f"{name}: ", strong=True), *value)
        case Markdown():
            yield (Text(" ".join(block.text.split())),)


def _fit_text(paragraphs: Sequence[Inlines], column: _Column) -> tuple[Inlines, ...]:
    return tuple(cut_runs(each, column.width, column.size, _MAX_TEXT_LINES) for each in paragraphs)


def _measure_text(paragraphs: Sequence[Inlines], column: _Column) -> float:
    lines = sum(_count_run_lines(each, column.width, column.size) for each in paragraphs)
    return lines * column.size * _LINE + 2


def _place_text(paragraphs: tuple[Inlines, ...], column: _Column, top: float) -> PlacedText:
    height = _measure_text(paragraphs, column)
    return PlacedText(Place(column.left, top, column.width, height), paragraphs, column.size)


def _count_run_lines(inlines: Inlines, width: float, size: float) -> int:
    """Return how many lines runs take; each line break begins one."""
    is_bold = any(run.strong or run.status for run in inlines)
    letters = sum(len(run.text) for run in inlines) or 1
    code_share = sum(len(run.text) for run in inlines if run.code) / letters
    usable = width * _SAFETY / (size * (BOLD_FACTOR if is_bold else 1) * (1 + _CODE_EXCESS * code_share))
    lines = "".join(f"\n{run.text}" if run.line_break else run.text for run in inlines).split("\n")
    return sum(count_lines(line, usable) for line in lines)


def cut_runs(inlines: Inlines, width: float, size: float, max_lines: int) -> Inlines:
    """Return runs that take at most so many lines; what is cut ends in an ellipsis."""
    kept = tuple(replace(run, text=" ".join(run.text.split("\n"))) if "\n" in run.text else run for run in inlines)
    room = sum(len(run.text) for run in kept)
    while (lines := _count_run_lines(kept, width, size)) > max_lines:
        room = min(room * max_lines // lines, room - 1)
        kept = tuple(_take_characters(kept, max(room, 1)))
        if room <= 1:
            break
    return kept


def _take_characters(inlines: Inlines, room: int) -> Iterator[Text]:
    for run in inlines:
        if len(run.text) >= room:
            yield replace(run, text=f"{run.text[: room - 1].rstrip()}…")
            return
        room -= len(run.text)
        yield run


def _cut_table(table: Table, column: _Column, room: float) -> Iterator[PlacedTable]:
    """Yield parts of a table, the first one in the room that is left, the others on slides of their own."""
    table = _drop_bars(table)
    whole = _set_table(table, column)
    top = 1 if whole.has_heading else 0
    head, heights = whole.heights[:top], whole.heights[top:]
    start, used = 0, fsum(head)
    for at, height in enumerate(heights):
        if used + height > room:
            if at > start:
                yield _take_rows(whole, head, start, at)
            start, used, room = at, fsum(head), BODY_BOTTOM - BODY_TOP
        used += height
    yield _take_rows(whole, head, start, len(heights))


def _take_rows(whole: PlacedTable, head: tuple[float, ...], start: int, end: int) -> PlacedTable:
    heights = (*head, *whole.heights[len(head) + start : len(head) + end])
    return replace(whole, table=replace(whole.table, rows=whole.table.rows[start:end]), heights=heights)


def _set_table(table: Table, column: _Column) -> PlacedTable:
    """Return a table as it is in a column, wherever it stands."""
    size = column.size
    widths = _share_width(table, column)
    has_heading = any(each.title for each in table.columns)
    rows = tuple(
        tuple(
            cut_runs(cell, width - 2 * SIDE_PADDING, size, _MAX_CELL_LINES)
            for cell, width in zip(row, widths, strict=True)
        )
        for row in table.rows
    )
    heights = [_measure_row(row, widths, size, is_figures=not has_heading) for row in rows]
    if has_heading:
        titles = tuple((Text(each.title, strong=True),) for each in table.columns)
        heights.insert(0, _measure_row(titles, widths, size, is_figures=False))
    return PlacedTable(Place(0, 0, 0, 0), replace(table, rows=rows), widths, tuple(heights), size, has_heading)


def _drop_bars(table: Table) -> Table:
    """Return a table without columns of nothing but bars."""
    kept = [at for at in range(len(table.columns)) if any(run.text for row in table.rows for run in row[at])]
    return keep_columns(table, kept or [0])


def _share_width(table: Table, column: _Column) -> list[float]:
    weights = [each.weight for each in table.columns]
    shares = [column.width * each / fsum(weights) for each in weights]
    if not any(each.title for each in table.columns):
        return shares
    words, lines, parts = [], [], []
    for at, each in enumerate(table.columns):
        cells = ((Text(each.title, strong=True),), *(row[at] for row in table.rows))
        runs = [(run, _measure_run(run, column.size)) for cell in cells for run in cell]
        longest = max(width for _, widths in runs for width in widths)
        heading = _measure_line(cells[0][0], column.size) * _HEADING_SHARE
        words.append(min(max(longest, heading), column.width * _MAX_WORD_SHARE))
        parts.append(max(_measure_part(run, widths) for run, widths in runs))
        lines.append(max((fsum(_measure_line(run, column.size) for run in cell) for cell in cells[1:]), default=0.0))
    needed = [max(sides) + 2 * SIDE_PADDING for sides in zip(words, lines, strict=True)]
    if all(share >= width for share, width in zip(shares, needed, strict=True)):
        return shares
    room = column.width - 2 * SIDE_PADDING * len(weights)
    return [width + 2 * SIDE_PADDING for width in share_width(words, lines, parts, weights, room)]


def _measure_run(run: Text, size: float) -> list[float]:
    """Return the width of each word of a run, and of none."""
    scale = size / _SAFETY * (BOLD_FACTOR if run.strong or run.status else 1)
    return [
        0.0,
        *(
            (measure_code(word) if run.code else measure_word(word)) * scale
            for word in join_hard_blanks(run.text).split()
        ),
    ]


def _measure_line(run: Text, size: float) -> float:
    return fsum(_measure_run(run, size)) + run.text.count(" ") * size / 4


def _measure_part(run: Text, widths: Sequence[float]) -> float:
    """Return the width of what must stand on one line: a word, or a part of a name."""
    if not run.code:
        return max(widths)
    names = zip(join_hard_blanks(run.text).split(), widths[1:], strict=True)
    return max((width * len(part) / len(name) for name, width in names for part in split_name(name)), default=0.0)


def _measure_row(row: Sequence[Inlines], widths: Sequence[float], size: float, *, is_figures: bool) -> float:
    lines = max(
        (
            _count_run_lines(cell, width - 2 * SIDE_PADDING, size) + (FIGURE_SCALE - 1 if is_figures else 0)
            for cell, width in zip(row, widths, strict=True)
        ),
        default=1,
    )
    return lines * size * _LINE + 2 * _PADDING


def _measure_start(table: Table, column: _Column) -> float:
    """Return the height of a table's heading and its first row."""
    first = _set_table(replace(table, rows=table.rows[:1]), column)
    return fsum(first.heights)
