"""Documents as Markdown: headings, tables, and nothing that a text could open."""

from __future__ import annotations

from archgen.products.outline_markdown import render_outline_markdown
from archgen.views.shapes import Column, Outline, Section, Table, Text


def test_texts_are_inert() -> None:
    table = Table("table:x", "All", (Column("What"),), (((Text("a | b <script> [x](y)"),),),))
    words = render_outline_markdown(Outline("T", sections=(Section("s", "Of it", (table,)),)))
    assert words.startswith("# T\n")
    assert "## Of it" in words
    assert "<script>" not in words
    assert "a \\| b" in words
