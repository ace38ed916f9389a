"""Documents in a terminal: headings, tables in columns, paragraphs, nothing wider than it is."""

from __future__ import annotations

from archgen.emit.terminal.outline_text import write_outline_lines
from archgen.views.shapes import Bullets, Column, Facts, Outline, Paragraph, Section, Table, Text

TABLE = Table(
    "table:x",
    "By size",
    (Column("What"), Column("Count", align="right")),
    (((Text("one"),), (Text("7"),)), ((Text("two"), Text("below", line_break=True)), (Text("1234567"),))),
)
OUTLINE = Outline(
    "A title",
    "2 things",
    (("Name", (Text("value"),)),),
    sections=(
        Section("a", "Sizes", (TABLE, Paragraph((Text("A sentence with \x1b[31mcolour."),)))),
        Section("b", "Lists", (Bullets(((Text("item"),),)), Facts((("key", (Text("fact"),)),))), (Section("c", "In"),)),
    ),
)


def test_a_document_is_written_in_lines() -> None:
    assert (
        "\n".join(write_outline_lines(OUTLINE))
        == """\
A title (2 things)
  Name  value

Sizes (By size)
What          Count
one               7
two; below  1234567
A sentence with ␛[31mcolour.

Lists
- item
  key  fact

In"""
    )


def test_no_line_is_wider_than_the_terminal() -> None:
    long = Outline("word " * 40, sections=(Section("a", "word " * 30, (Paragraph((Text("word " * 50),)), TABLE)),))
    assert max(map(len, write_outline_lines(long, 40))) <= 40
