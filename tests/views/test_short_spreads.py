"""A partner in a short form: what it gives and takes in one table, what is told together, and the first of its deadlines."""

from __future__ import annotations

from archgen.model.architecture import Partner
from archgen.views import inline_text
from archgen.views.pages.short_spreads import list_short_blocks
from archgen.views.shapes import Inlines, Paragraph, Table

PARTNER = Partner("p", "Partner P")


def cells(*texts: str) -> tuple[Inlines, ...]:
    """Return a row of plain texts."""
    return tuple(map(inline_text.to_inlines, texts))


def read(inlines: Inlines) -> str:
    """Return the words of some runs."""
    return "".join(run.text for run in inlines)


def make_flow(number: int) -> tuple[Inlines, ...]:
    """Return the row of a flow without an age."""
    return cells(f"scan {number}", "Other", "/scan", "10 Hz", "100 ms", "", "rate", "nothing")


def test_both_sides_are_in_one_table_and_the_verb_stands_once() -> None:
    sides = [
        ("Gives", [make_flow(1), make_flow(2)], "9 interfaces; those of one partner are told together."),
        ("Takes", [make_flow(3)], ""),
    ]
    table, remark = list_short_blocks(PARTNER, sides, (), ())
    assert isinstance(table, Table)
    assert (table.anchor, table.caption) == ("table:flows/p", "What Partner P gives and takes")
    titles = [column.title for column in table.columns]
    assert titles == ["", "What, by or for", "To or from", "Topic", "Rate", "Gap ≤", "Promised", "Open"]
    beginnings = [(read(row[0]), read(row[1])) for row in table.rows]
    assert beginnings == [("Gives", "scan 1"), ("", "scan 2"), ("Takes", "scan 3")]
    assert isinstance(remark, Paragraph)
    assert read(remark.inlines) == "Gives 9 interfaces; those of one partner are told together. The workbook has each."


def test_the_first_deadlines_follow_what_rests_on_it() -> None:
    deadlines = [cells(f"Chain {number}", "", "10 ms", "90 ms", "100 ms", "met") for number in range(5)]
    impact = Paragraph(inline_text.to_inlines("It rests on Partner P: 5 of 9 deadlines."))
    _, said = list_short_blocks(PARTNER, [("Gives", [make_flow(1)], "")], deadlines, [impact])
    assert isinstance(said, Paragraph)
    first = "Chain 0 (10 ms of 90 ms are its own, deadline 100 ms: met)"
    words = read(said.inlines)
    assert words.startswith(f"It rests on Partner P: 5 of 9 deadlines. Deadlines: {first}; Chain 1 (")
    assert "Chain 3" not in words
    _, alone = list_short_blocks(PARTNER, [("Gives", [make_flow(1)], "")], (), [impact])
    assert isinstance(alone, Paragraph)
    assert read(alone.inlines) == "It rests on Partner P: 5 of 9 deadlines."
