"""Sentences that name figures and tables: each says what it is for, those of one kind together."""

from __future__ import annotations

from archgen.views.report.printed_report import mention_section
from archgen.views.shapes import Block, Column, Figure, Paragraph, Section, Table


def _figure(anchor: str) -> Figure:
    return Figure(anchor, anchor, "", "")


def _table(anchor: str) -> Table:
    return Table(anchor, "", (Column("A"),), ())


def _mention(*blocks: Block) -> str:
    first = mention_section(Section("page:x", "X", blocks)).blocks[0]
    assert isinstance(first, Paragraph)
    return "".join(part.ref or part.text for part in first.inlines)


def test_a_sentence_says_what_a_table_is_for() -> None:
    assert _mention(_table("table:connections")) == "table:connections lists who sends what to whom."


def test_many_pictures_of_one_kind_are_named_by_the_first_and_the_last() -> None:
    figures = [_figure(f"figure:load/{name}") for name in "abc"]
    assert (
        _mention(_figure("figure:load"), *figures)
        == "figure:load compares the load of all hosts; figure:load/a to figure:load/c show what one host spends its time on."
    )


def test_what_has_no_words_is_named_all_the_same() -> None:
    assert _mention(_table("table:own"), _table("table:size")) == (
        "table:size counts the parts of the architecture; see also table:own."
    )
    assert _mention(_figure("figure:own")) == "See figure:own."


def test_the_summary_has_one_sentence_for_its_tables() -> None:
    below = Section("summary:chains", "Chains", (_table("table:worst_chains"),))
    section = mention_section(Section("page:index", "Summary", (_figure("figure:overview"),), (below,)))
    assert len(section.sections[0].blocks) == 1
    assert isinstance(section.blocks[0], Paragraph)
    assert [part.ref for part in section.blocks[0].inlines if part.ref] == ["figure:overview", "table:worst_chains"]
