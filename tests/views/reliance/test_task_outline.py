"""What a partner has to do, as a document."""

from __future__ import annotations

from pathlib import Path

from archgen.products.agreement_documents import make_timed_lookup
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.reliance.partner_impact import find_impact, find_parts_of
from archgen.views.reliance.partner_tasks import find_tasks, make_task_outline
from archgen.views.shapes import Outline, Table
from tests.late_robot import ROBOT, check


def outline_of(folder: Path, partner: str, text: str = ROBOT) -> Outline:
    lookup = make_timed_lookup(check(folder, text))
    exchanges = gather_exchanges(lookup)
    impact = find_impact(lookup, exchanges, find_parts_of(lookup, lookup.architecture.partners[partner]))
    return make_task_outline(lookup, find_tasks(lookup, exchanges, impact))


def rows_of(outline: Outline, title: str) -> list[list[str]]:
    (section,) = (each for each in outline.sections if each.title == title)
    (table,) = (block for block in section.blocks if isinstance(block, Table))
    return [["".join(run.text for run in cell) for cell in row] for row in table.rows]


def test_the_list_says_what_rests_on_each_and_where_it_is_written(tmp_path: Path) -> None:
    outline = outline_of(tmp_path, "north")
    assert outline.title == "North: what is to do"
    assert [(name, "".join(run.text for run in value)) for name, value in outline.facts] == [
        ("Interfaces", "2 of 2 given have open terms, for 2 partners"),
        ("Waits for", "1 have open terms that 1 partner owes"),
        ("Deadlines", "0 of 1 through them are met"),
        ("Findings", "1 to mend: 1 warning"),
    ]
    first = rows_of(outline, "To do")[0]
    assert first == [
        "1. State size and QoS offered of g.eye.picture",
        "1 deadline: It answers (400 ms); South, West wait",
        "archgen.yaml:19",
    ]
    assert rows_of(outline, "Waits for") == [["South", "Brain · word", "size, QoS offered"]]


def test_who_has_nothing_to_do_is_told_so(tmp_path: Path) -> None:
    (section,) = outline_of(tmp_path, "idle").sections
    assert [run.text for block in section.blocks for run in block.inlines] == ["Nothing is open."]  # type: ignore[union-attr]


def test_planned_nodes_have_a_table(tmp_path: Path) -> None:
    planned = ROBOT.replace("eye: {implements: eye,", "eye: {implements: eye, status: planned,")
    assert rows_of(outline_of(tmp_path, "north", planned), "Still to be made") == [
        ["eye", "1 deadline: It answers (400 ms); South, West wait"]
    ]
