"""Where names lead, who owns what a finding is about, and which chains are in trouble."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project
from archgen.views import element_references
from archgen.views.lookup import make_lookup
from archgen.views.pages import page_marks

ROBOT = """\
partners: {p: {title: P}}
requirements: {R-1: Stops}
groups:
  g:
    components:
      eye: {owner: p, requirements: [R-1], outputs: {o: std_msgs/msg/Bool}}
      brake: {inputs: {i: eye.o}}
"""


def test_names_lead_to_their_elements_and_ports_to_their_components(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    architecture = check_project(tmp_path / "robot.yaml").architecture
    names = ("g", "g.eye", "g.eye.o", "R-1", "p", "nobody")
    assert [element_references.find_reference(architecture, name) for name in names] == [
        "group:g",
        "component:g.eye",
        "component:g.eye",
        "requirement:R-1",
        "partner:p",
        None,
    ]
    owners = [element_references.find_owners(architecture, name) for name in ("g.eye.o", "g.eye", "g.brake", None)]
    assert owners == [("p",), ("p",), (), ()]


def test_without_timing_no_chain_is_in_trouble(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    assert page_marks.list_troubled_chains(make_lookup(check_project(tmp_path / "robot.yaml").architecture)) == []
