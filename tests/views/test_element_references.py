"""Where names lead, who owns what a finding is about, and which chains are in trouble."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project
from archgen.views import element_references
from archgen.views.lookup import make_lookup
from archgen.views.pages import page_marks
from archgen.views.shapes import Page, Section
from archgen.views.tables import deployment_tables
from archgen.views.timing import timing_verdicts

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
    links = f"{ROBOT}hosts: {{pc: , arm: }}\nlinks: {{lan: {{connects: [pc, arm], owner: p}}, wan: [pc, arm]}}\n"
    (tmp_path / "robot.yaml").write_text(links, encoding="utf-8")
    lookup = make_lookup(check_project(tmp_path / "robot.yaml").architecture)
    assert [element_references.find_owners(lookup.architecture, name) for name in ("lan", "wan")] == [("p",), ()]
    table = deployment_tables.make_link_table(lookup)
    assert table is not None
    assert [column.title for column in table.columns] == ["Link", "Connects", "Owner", "Bandwidth", "Latency"]
    assert [[run.text for run in row[2]] for row in table.rows] == [["P"], []]


def test_without_timing_no_chain_is_in_trouble(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    checked = check_project(tmp_path / "robot.yaml")
    lookup = make_lookup(checked.architecture, checked.findings)
    assert timing_verdicts.list_troubled_chains(lookup) == []
    pages = (
        Page(f"{name}.html", f"page:{name}", name, "spanning", Section(f"page:{name}", name))
        for name in ("findings", "chains")
    )
    assert [page.mark for page in page_marks.mark_pages(lookup, pages)] == ["open", None]
