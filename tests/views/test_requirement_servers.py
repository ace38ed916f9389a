"""A requirement knows the chains that serve it, and whether they are in time."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.context_pages import make_context_pages
from archgen.views.requirement_servers import describe_chain_state
from archgen.views.shapes import Bullets, Paragraph
from archgen.views.tables.architecture_tables import make_requirement_table
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
        "chain Late: not proven, chain In good time: met, chain Free: without a deadline",
        "Eye, chain In good time: met",
    ]


def test_the_page_of_a_requirement_lists_its_chains(tmp_path: Path) -> None:
    pages = {page.section.anchor: page for page in make_context_pages(look_up(tmp_path), tuple)}
    blocks = pages["requirement:R-1"].section.blocks
    assert [
        "".join(part.text for part in item) for block in blocks if isinstance(block, Bullets) for item in block.items
    ] == ["Late: not proven", "In good time: met", "Free: without a deadline"]
    assert not [block for block in blocks if isinstance(block, Paragraph) and block.kind == "warning"]
    assert Bullets not in {type(block) for block in pages["requirement:R-3"].section.blocks}


def test_a_card_names_what_serves_a_requirement_and_what_a_chain_serves(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert make_card(lookup, "requirement", "R-2").lists == (("served by", ("g.eye", "the chain good (met)")),)
    assert make_card(lookup, "chain", "late").facts == (
        ("deadline", "10 ms"),
        ("state", "not proven"),
        ("requirements", "R-1"),
    )


@pytest.mark.parametrize("chain", ["late", "good"])
def test_without_an_analysis_a_chain_has_no_state(tmp_path: Path, chain: str) -> None:
    architecture = look_up(tmp_path).architecture
    assert describe_chain_state(make_lookup(architecture), architecture.chains[chain]) == ""
