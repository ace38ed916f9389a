"""What rests on a partner, as a document: its figures, its tables, and the bars of the site."""

from __future__ import annotations

from pathlib import Path

from archgen.products.agreement_documents import make_timed_lookup
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.reliance import impact_outline
from archgen.views.reliance.partner_impact import find_impact, find_parts_of, make_parts
from archgen.views.shapes import Outline, Paragraph, Table, Waterfall
from tests.late_robot import ROBOT, check


def outline_of(
    folder: Path, partner: str, text: str = ROBOT, until: str | None = None
) -> tuple[Outline, Waterfall | None]:
    lookup = make_timed_lookup(check(folder, text))
    late = find_parts_of(lookup, lookup.architecture.partners[partner])
    impact = find_impact(lookup, gather_exchanges(lookup), late, until=until)
    return impact_outline.make_impact_outline(lookup, impact), impact_outline.make_use_case_waterfall(lookup, impact)


def facts_of(outline: Outline) -> dict[str, str]:
    return {name: "".join(run.text for run in value) for name, value in outline.facts}


def rows_of(outline: Outline, title: str) -> list[list[str]]:
    (section,) = (each for each in outline.sections if each.title == title)
    (table,) = (block for block in section.blocks if isinstance(block, Table))
    return [["".join(run.text for run in cell) for cell in row] for row in table.rows]


def test_the_figures_count_what_rests_on_them(tmp_path: Path) -> None:
    outline, _ = outline_of(tmp_path, "north")
    assert outline.title == "If North is late"
    assert facts_of(outline) == {
        "Deadlines": "1 of 1 run through them",
        "Use cases": "1 of 2 need them, 1 at the first step",
        "Requirements": "2 of 3 rest on them",
        "Flows": "3 that 2 partners wait for",
        "Other components": "2 of 4 read from them; with what those feed it is 2",
        "Interfaces": "1 of 2 can be replaced by a recording or a stub",
    }


def test_a_partner_without_components_is_told_so(tmp_path: Path) -> None:
    outline, waterfall = outline_of(tmp_path, "idle")
    assert [run.text for notice in outline.notices for run in notice.inlines] == ["Idle owns no component."]
    assert outline.sections == ()
    assert waterfall is None


def test_what_to_settle_first_says_what_rests_on_it_and_what_stands_in(tmp_path: Path) -> None:
    outline, _ = outline_of(tmp_path, "north")
    first, second = rows_of(outline, "What to settle first")
    assert first[:3] == ["1. Eye · picture", "South, West", "1 deadline, 1 step, 2 readers"]
    assert first[-1] == "recording of /g/eye/picture"
    assert second[-1] == "none: its message is not agreed"


def test_use_cases_are_a_sign_a_step_and_bars_on_the_site(tmp_path: Path) -> None:
    outline, waterfall = outline_of(tmp_path, "south")
    assert rows_of(outline, "How far the use cases get") == [["UC-1 A talk", "-##.", "at step 2 of 4"]]
    assert waterfall is not None
    (step,) = waterfall.steps
    assert [(piece.kind, piece.start, piece.end, piece.tip) for piece in step.pieces] == [
        ("sampling", 0, 0.25, "step 1: runs"),
        ("response", 0.25, 0.75, "steps 2 to 3: needs them"),
        ("link", 0.75, 1, "step 4: never comes"),
    ]
    assert step.words == "stops at step 2 of 4"


def test_who_else_serves_a_requirement_is_a_partner_a_component_that_nobody_owns_or_nobody(tmp_path: Path) -> None:
    outline, _ = outline_of(tmp_path, "north", ROBOT.replace("[R-1, R-2]", "[R-2]").replace("[R-3]", "[R-1]"))
    assert rows_of(outline, "Requirements") == [["R-1", "It sees", "Bed, Scale"], ["R-2", "It speaks", "South"]]
    outline, _ = outline_of(tmp_path, "north", ROBOT.replace("[R-1, R-2]", "[R-2]"))
    assert rows_of(outline, "Requirements")[0] == ["R-1", "It sees", "nobody else"]


def test_chosen_components_are_named_by_their_titles(tmp_path: Path) -> None:
    lookup = make_timed_lookup(check(tmp_path))
    late = make_parts(lookup, ["g.mouth", "g.eye"])
    impact = find_impact(lookup, gather_exchanges(lookup), late)
    assert impact_outline.make_impact_outline(lookup, impact).title == "If Eye, Mouth are late"


def test_milestones_say_which_days_cannot_be_kept(tmp_path: Path) -> None:
    plan = ROBOT + 'milestones: {m: {title: It sees, date: 2027-03-01, needs: "owner:north"}, n: {needs: bed}}\n'
    outline, _ = outline_of(tmp_path, "north", plan)
    assert rows_of(outline, "Milestones") == [["It sees", "2027-03-01", "Eye, Mouth"]]
    assert facts_of(outline)["Milestones"] == "1 of 2 need them, the first on 2027-03-01"
    for text, until, words in (
        (plan, "2027-03-01", "None that is before 2027-03-01 needs them."),
        (ROBOT, "2027-03-01", "The project writes no milestones."),
    ):
        outline, _ = outline_of(tmp_path, "north", text, until)
        (section,) = (each for each in outline.sections if each.title == "Milestones")
        (paragraph,) = section.blocks
        assert isinstance(paragraph, Paragraph)
        assert "".join(run.text for run in paragraph.inlines) == words
