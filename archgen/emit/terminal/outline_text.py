"""A document of paragraphs, lists and tables for the terminal, no wider than it is."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import defuse_command, make_visible, measure_width
from archgen.diagnostics.text_columns import align_rows, format_table, wrap_line
from archgen.views.inline_text import join_runs
from archgen.views.shapes import Block, Bullets, Facts, Outline, Paragraph, Section, Table


def write_outline_lines(outline: Outline, width: int | None = None) -> Iterator[str]:
    """Yield the lines of a document; pictures and texts in Markdown are left out."""
    lines = [
        *wrap_line(make_visible(f"{outline.title} ({outline.subtitle})" if outline.subtitle else outline.title), width),
        *align_rows([(name, join_runs(value)) for name, value in outline.facts], width),
        *(line for notice in outline.notices for line in _write_block(notice, width)),
        *(line for section in outline.sections for line in _write_section(section, width)),
    ]
    yield from map(defuse_command, lines)


def _write_section(section: Section, width: int | None) -> Iterator[str]:
    yield ""
    tables = [block for block in section.blocks if isinstance(block, Table)]
    yield from wrap_line(make_visible(f"{section.title} ({tables[0].caption})" if tables else section.title), width)
    for block in section.blocks:
        yield from _write_block(block, width)
    for inner in section.sections:
        yield from _write_section(inner, width)


def _write_block(block: Block, width: int | None) -> Iterator[str]:
    match block:
        case Table():
            rows = [[column.title for column in block.columns]]
            rows += [[make_visible(join_runs(cell)) for cell in row] for row in block.rows]
            for at, column in enumerate(block.columns):
                if column.align == "right":
                    room = max(measure_width(row[at]) for row in rows)
                    rows = [[*row[:at], row[at].rjust(room), *row[at + 1 :]] for row in rows]
            yield from format_table(rows[0], rows[1:], width)
        case Paragraph():
            yield from wrap_line(make_visible(join_runs(block.inlines)), width, 0)
        case Bullets():
            for item in block.items:
                yield from wrap_line(make_visible(f"- {join_runs(item)}"), width, 2)
        case Facts():
            yield from align_rows([(name, join_runs(value)) for name, value in block.rows], width)
        case _:
            pass
