"""How an architecture grew, as charts and tables."""

from __future__ import annotations

from archgen.model.project_history import FindingCounts, History, HistoryPoint, ProgressRow
from archgen.views.shapes import Figure, Paragraph, Table
from archgen.views.tables import statistics_tables


def point(month: int, components: int, mapped: int, errors: int = 0) -> HistoryPoint:
    def row(scope: str, name: str, count: int) -> ProgressRow:
        found = FindingCounts(error=errors, note=1)
        return ProgressRow(scope, name, name.title(), count, count, count, min(mapped, count), 0, 0, found)  # type: ignore[arg-type]

    rows = (row("project", "robot", components), row("group", "sensing", components))
    return HistoryPoint("a" * 40, f"2026-{month:02d}-03", 1, mapped, 0, 0, rows)


GROWN = History((point(1, 4, 0, 7), point(2, 4, 2), point(3, 6, 6)), "month")


def cells(table: Table) -> list[tuple[str, ...]]:
    return [tuple("".join(part.text for part in cell) for cell in row) for row in table.rows]


def test_charts_show_how_much_is_mapped_and_what_is_found() -> None:
    mapped, found = statistics_tables.make_growth_charts(GROWN)
    assert (mapped.id, mapped.conclusion) == (
        "history/progress",
        "Components mapped to nodes: 0 of 4 in 2026-01, 6 of 6 in 2026-03.",
    )
    assert [(b.title, [(s.kind, s.length) for s in b.segments], b.value) for b in mapped.bars] == [
        ("2026-01", [("other_load", 4)], "0 of 4"),
        ("2026-02", [("load", 2), ("other_load", 2)], "2 of 4"),
        ("2026-03", [("load", 6)], "6 of 6"),
    ]
    first = found.bars[0]
    assert (first.value, [(s.kind, s.length) for s in first.segments]) == ("8", [("missed", 7), ("best", 1)])


def test_the_table_has_the_newest_first_and_groups_are_compared_with_the_beginning() -> None:
    paragraph, progress, findings, table, groups = statistics_tables.make_growth_blocks(
        GROWN, ("history/progress", "history/findings")
    )
    assert isinstance(paragraph, Paragraph)
    assert isinstance(progress, Figure)
    assert isinstance(findings, Figure)
    assert isinstance(table, Table)
    assert isinstance(groups, Table)
    assert cells(table)[0] == ("2026-03", "6", "0", "100 %", "100 %", "100 %", "0 %", "0 %", "0 / 0 / 1")
    assert cells(groups) == [("Sensing", "4 → 6", "0 % → 100 %", "0 %", "7 / 0 / 1 → 0 / 0 / 1")]


def test_one_month_is_no_history() -> None:
    assert statistics_tables.make_growth_blocks(History(GROWN.points[:1], "month"), ()) == ()


def test_what_a_chart_leaves_out_is_said() -> None:
    long = History(tuple(point(1 + at % 12, at + 1, 0) for at in range(30)), "month")
    (chart, _) = statistics_tables.make_growth_charts(long)
    assert (len(chart.bars), chart.notes) == (24, ("The table has 6 older months too.",))


def test_a_shallow_clone_is_told_and_what_was_not_drawn_is_not_shown() -> None:
    paragraph, table, _ = statistics_tables.make_growth_blocks(History(GROWN.points, "month", whole=False), ())
    assert isinstance(paragraph, Paragraph)
    assert "shallow" in str(paragraph)
    assert isinstance(table, Table)
