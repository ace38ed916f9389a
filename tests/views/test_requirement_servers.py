"""A requirement knows the chains that serve it, and whether they are in time."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.requirement_pages import make_requirement_pages
from archgen.views.requirement_servers import describe_chain_state
from archgen.views.shapes import Bullets, Facts, Markdown, Paragraph, Table, Text
from archgen.views.tables.requirement_tables import make_requirement_table
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """\
requirements: {R-1: Stops in time, R-2: Looks, R-3: Nobody's}
hosts: {pc: {cores: 2}}
groups:
  g:
    components:
      eye: {requirements: [R-2], outputs: {o: std_msgs/msg/Bool}}
      brake: {inputs: {i: eye.o}}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 5 ms}}
  brake: {implements: brake, host: pc, timing: {behaviour: event, wcet: 5 ms}}
chains:
  late: {through: [g.eye, g.brake], deadline: 10 ms, requirements: [R-1]}
  good: {title: In good time, through: [g.eye, g.brake], deadline: 1 s, requirements: [R-1, R-2]}
  free: {through: [g.eye, g.brake], requirements: [R-1]}
"""


def look_up(folder: Path) -> Lookup:
    (folder / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    architecture = check_project(folder / "robot.yaml").architecture
    return make_lookup(architecture, timing_lookup=analyse_with_chains(architecture))


def test_the_table_of_requirements_names_chains_with_their_state(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    table = make_requirement_table(lookup, lookup.architecture.requirements.values())
    assert table is not None
    assert ["".join(part.text for part in row[-1]) for row in table.rows] == [
        "uncovered no component yet",
        "chain Late: missed, chain In good time: met, chain Free: without a deadline",
        "Eye, chain In good time: met",
    ]


def test_the_page_of_a_requirement_lists_its_chains(tmp_path: Path) -> None:
    pages = {page.section.anchor: page for page in make_requirement_pages(look_up(tmp_path))}
    blocks = pages["requirement:R-1"].section.blocks
    assert [
        "".join(part.text for part in item) for block in blocks if isinstance(block, Bullets) for item in block.items
    ] == ["Late: missed", "In good time: met", "Free: without a deadline"]
    assert not [block for block in blocks if isinstance(block, Paragraph) and block.kind == "warning"]
    assert Bullets not in {type(block) for block in pages["requirement:R-3"].section.blocks}


def test_a_card_names_what_serves_a_requirement_and_what_a_chain_serves(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert make_card(lookup, "requirement", "R-2").lists == (("served by", ("g.eye", "the chain good (met)")),)
    assert make_card(lookup, "chain", "late").facts == (
        ("deadline", "10 ms"),
        ("state", "missed"),
        ("requirements", "R-1"),
    )


@pytest.mark.parametrize("chain", ["late", "good"])
def test_without_an_analysis_a_chain_has_no_state(tmp_path: Path, chain: str) -> None:
    architecture = look_up(tmp_path).architecture
    assert describe_chain_state(make_lookup(architecture), architecture.chains[chain]) == ""


TREE = """\
use_cases: {UC-1: Walks}
requirements:
  R-1: {title: Safe, kind: safety, priority: must, source: "D3, 4", rationale: People *fall*., description: More}
  R-1.1: {title: Stops, parent: R-1, verified_by: [UC-1, late, tests/stop.py, By hand]}
  R-1.2: {title: Slow, parent: [R-1, R-2], verified_by: By hand}
  R-2: {title: Nice, verified_by: good}
  R-3: Nobody's
  R-4: {title: Never verified}
""" + ROBOT.partition("\n")[2].replace("[R-2]", "[R-1.2, R-4]").replace("[R-1]", "[R-1.1]").replace(
    "[R-1, R-2]", "[R-2]"
)


def look_up_tree(folder: Path) -> Lookup:
    (folder / "robot.yaml").write_text(TREE, encoding="utf-8")
    architecture = check_project(folder / "robot.yaml").architecture
    return make_lookup(architecture, timing_lookup=analyse_with_chains(architecture))


def plain(cell: Iterable[Text]) -> str:
    return "".join(part.text for part in cell).replace("\u2003", ">")


def test_the_table_is_a_tree_with_states(tmp_path: Path) -> None:
    lookup = look_up_tree(tmp_path)
    table = make_requirement_table(lookup, lookup.architecture.requirements.values())
    assert table is not None
    assert [column.title for column in table.columns] == ["Id", "Requirement", "Served by", "Verified by", "State"]
    assert [" | ".join(plain(cell) for cell in row) for row in table.rows] == [
        "R-1 | Safesafety · must | both of its parts served | both of its parts verified | missed",
        "R-1.1 | >Stops | chain Late: missed, chain Free: without a deadline | UC-1, chain Late: missed, tests/stop.py, By hand | missed",
        "R-1.2 | >Slow | Eye | By hand | met",
        "R-2 | Nice | chain In good time: met, its part served | chain In good time: met, its part verified | met",
        "R-1.2 | >Slow (also above) |  |  | ",
        "R-3 | Nobody's | uncovered no component yet |  | uncovered",
        "R-4 | Never verified | Eye |  | open",
    ]


def test_the_page_says_what_it_is_part_of_and_what_shows_that_it_is_met(tmp_path: Path) -> None:
    pages = {page.section.anchor: page for page in make_requirement_pages(look_up_tree(tmp_path))}
    part, whole = pages["requirement:R-1.2"].section.blocks, pages["requirement:R-1"].section.blocks
    assert isinstance(part[1], Facts)
    assert [(name, plain(value)) for name, value in part[1].rows] == [("State", "met"), ("Part of", "R-1 SafeR-2 Nice")]
    assert [plain(block.inlines) for block in whole if isinstance(block, Paragraph)] == [
        "Safe",
        "Rationale",
        "No component serves it as a whole: both of its parts served.",
        "Nothing verifies it as a whole: both of its parts verified.",
    ]
    assert [block.text for block in whole if isinstance(block, Markdown)] == ["More", "People *fall*."]
    assert [plain(row[0]) for block in whole if isinstance(block, Table) for row in block.rows] == ["R-1.1", "R-1.2"]
    warned = [block for block in pages["requirement:R-4"].section.blocks if isinstance(block, Paragraph)]
    assert [plain(block.inlines) for block in warned if block.kind == "warning"] == [
        "Nothing verifies this requirement yet."
    ]


def test_the_card_of_a_whole_lists_its_parts_with_their_states(tmp_path: Path) -> None:
    lookup = look_up_tree(tmp_path)
    card = make_card(lookup, "requirement", "R-1")
    assert card.facts[-5:] == (
        ("state", "missed"), ("kind", "safety"), ("priority", "must"), ("rationale", "People *fall*."), ("source", "D3, 4"),
    )  # fmt: skip
    assert dict(card.lists)["parts"] == ("R-1.1 Stops (missed)", "R-1.2 Slow (met)")
    part = dict(make_card(lookup, "requirement", "R-1.1").lists)
    assert part["verified by"] == ("the use case UC-1", "the chain late (missed)", "tests/stop.py", "By hand")


def test_a_tree_as_deep_as_there_are_requirements_is_shown(tmp_path: Path) -> None:
    lines = [f"  R-{n}: {{title: T, parent: R-{n - 1}}}\n" for n in range(1, 3000)]
    (tmp_path / "deep.yaml").write_text(f"requirements:\n  R-0: T\n{''.join(lines)}", encoding="utf-8")
    lookup = make_lookup(check_project(tmp_path / "deep.yaml").architecture)
    table = make_requirement_table(lookup, lookup.architecture.requirements.values())
    assert table is not None
    assert plain(table.rows[-1][1]) == ">>>>>>2999 T"
    assert len(list(make_requirement_pages(lookup))) == 3000
