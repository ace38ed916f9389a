"""Matrices: who gives what to whom, ordered so that little runs back; partners; requirements against components."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import check_project
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.matrix_shapes import Matrix, count_cells, fold_matrix
from archgen.views.pages import matrix_pages

ROBOT = """\
ros: {distro: jazzy}
partners: {p: {title: Partner P}, q: {title: Partner Q}}
requirements: {R-1: Grips, R-2: Nobody's}
hosts: {pc: {title: Computer, cores: 4}}
groups:
  acting:
    title: Acting
    owner: q
    components:
      hand: {title: Hand, requirements: [R-1], inputs: {i: plan.o}, outputs: {felt: std_msgs/msg/Bool}}
      plan: {title: Plan, inputs: {i: eye.o}, outputs: {o: std_msgs/msg/Bool, more: std_msgs/msg/Bool}}
  sensing:
    title: Sensing
    owner: p
    components:
      eye: {title: Eye, inputs: {again: plan.more}, outputs: {o: std_msgs/msg/Image, two: std_msgs/msg/Bool}}
      look: {title: Look, inputs: {i: eye.two}}
nodes:
  eye: {implements: eye, host: pc, package: eye_pkg}
  plan: {implements: plan}
"""


def look_up(folder: Path, text: str = ROBOT) -> Lookup:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder / "robot.yaml")
    return make_lookup(checked.architecture, checked.findings)


def counts_of(matrix: Matrix) -> dict[tuple[str, str], int]:
    columns = matrix.column_entries
    return {
        (matrix.rows[row].title, columns[column].title): len(flows)
        for (row, column), flows in count_cells(matrix).items()
    }


def test_rows_give_and_columns_take(tmp_path: Path) -> None:
    matrix = matrix_pages.make_component_matrix(look_up(tmp_path))
    assert counts_of(matrix) == {("Plan", "Hand"): 1, ("Eye", "Plan"): 1, ("Plan", "Eye"): 1, ("Eye", "Look"): 1}
    assert [entry.title for entry in matrix.groups] == ["Acting", "Sensing"]
    # Within a group what feeds comes first.
    assert [entry.title for entry in matrix.rows] == ["Plan", "Hand", "Eye", "Look"]
    assert matrix.order == "the order with the least feedback, found by exact search"


def test_folded_into_groups_a_cell_counts_what_all_members_give(tmp_path: Path) -> None:
    folded = fold_matrix(matrix_pages.make_component_matrix(look_up(tmp_path)))
    assert [(entry.title, entry.remark) for entry in folded.rows] == [("Acting", "Partner Q"), ("Sensing", "Partner P")]
    assert counts_of(folded) == {
        ("Acting", "Acting"): 1,
        ("Acting", "Sensing"): 1,
        ("Sensing", "Acting"): 1,
        ("Sensing", "Sensing"): 1,
    }
    assert [folded.runs_back(row, column) for row, column in ((0, 1), (1, 1), (1, 0))] == [False, False, True]


def test_nodes_fold_into_hosts_and_those_without_one_stay(tmp_path: Path) -> None:
    matrix = matrix_pages.make_node_matrix(look_up(tmp_path))
    assert next(entry for entry in matrix.rows if entry.title == "eye").group == 0
    assert next(entry for entry in matrix.rows if entry.title == "plan").group is None
    assert matrix.groups[0].title == "Computer"
    assert "Computer" in [entry.title for entry in fold_matrix(matrix).rows]


def test_requirements_stand_against_the_components_that_serve_them(tmp_path: Path) -> None:
    matrix = matrix_pages.make_requirement_matrix(look_up(tmp_path))
    assert counts_of(matrix) == {("R-1 Grips", "Hand"): 1}
    # What nobody serves comes first.
    assert [entry.title for entry in matrix.rows] == ["R-2 Nobody's", "R-1 Grips"]
    assert not matrix.is_square


def test_between_partners_neither_direction_runs_back(tmp_path: Path) -> None:
    counts = {("p", "q"): 2, ("q", "p"): 1}
    matrix = matrix_pages.make_partner_matrix(look_up(tmp_path), counts, dict.fromkeys(counts, "pair:p:q"))
    assert counts_of(matrix) == {("Partner P", "Partner Q"): 2, ("Partner Q", "Partner P"): 1}
    assert not matrix.runs_back(1, 0)
    assert {flow.ref for flow in matrix.flows} == {"pair:p:q"}


def test_a_page_is_made_only_for_what_has_something_to_show(tmp_path: Path) -> None:
    pages = list(matrix_pages.make_matrix_pages(look_up(tmp_path), with_nodes=True))
    assert [page.path for page in pages] == ["matrix.html", "matrix/nodes.html", "matrix/requirements.html"]
    assert pages[0].matrix is not None
    assert ("Nodes", "page:matrix/nodes") in pages[0].matrix.related
    assert list(matrix_pages.make_matrix_pages(look_up(tmp_path, "groups: {}"), with_nodes=True)) == []
    alone = list(
        matrix_pages.make_matrix_pages(look_up(tmp_path, "groups: {g: {components: {a: {}}}}"), with_nodes=True)
    )
    assert [page.path for page in alone] == ["matrix.html"]
