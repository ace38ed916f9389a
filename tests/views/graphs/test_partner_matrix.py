"""The matrix of partners that stands for an overview in which lines would cross too often."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.views.drawing_set import make_drawings
from archgen.views.graphs.partner_matrix import draw_partner_matrix, is_too_dense
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Sheet


def write_project(folder: Path, groups: int, partners: int) -> Architecture:
    """Write a project in which each group reads from every one before it."""
    lines = ["archgen: 1", "types: {T: std_msgs/msg/Empty}", "partners:"]
    lines += [f"  p{at}: {{title: 'Partner {at} of a long <name>'}}" for at in range(partners)]
    lines += ["groups:"]
    for at in range(groups):
        inputs = ", ".join(f"i{other}: g{other}.c.o" for other in range(at))
        owner = f"owner: p{at % partners}, " if partners else ""
        lines.append(f"  g{at}: {{{owner}components: {{c: {{inputs: {{{inputs}}}, outputs: {{o: T}}}}}}}}")
    file = folder / "archgen.yaml"
    file.write_text("\n".join(lines) + "\n", "utf-8")
    return pipeline.check_project(file).architecture


def list_cells(sheet: Sheet) -> list[str]:
    return [bar.tooltip for bar in sheet.bars if " to " in bar.tooltip]


@pytest.mark.parametrize("groups", [1, 2, 10, 12, 13, 20])
def test_boxes_are_drawn_as_long_as_few_lines_must_cross(groups: int, tmp_path: Path) -> None:
    # 12 groups that are all joined have 66 pairs, 66 - 36 + 6 = 36; 13 have 78, and 45 are more than 40.
    lookup = make_lookup(write_project(tmp_path, groups, 3))
    assert is_too_dense(lookup) is (groups > 12)
    drawings = make_drawings(lookup, None, "functional")
    for name in ("overview", "overview_upright"):
        drawing = drawings[name]
        assert isinstance(drawing, Sheet) is (groups > 12)
        assert ("cross at least" in " ".join(drawing.notes)) is (groups > 12)


@pytest.mark.parametrize(
    ("partners", "rows", "upright_rows"), [(0, 20, 14), (2, 20, 14), (3, 3, 3), (20, 20, 14), (40, 24, 14)]
)
def test_all_flows_are_counted_whatever_is_folded(partners: int, rows: int, upright_rows: int, tmp_path: Path) -> None:
    architecture = write_project(tmp_path, max(20, partners), partners)
    lookup = make_lookup(architecture)
    for upright, count in ((False, rows), (True, upright_rows)):
        sheet = draw_partner_matrix(lookup, upright=upright)
        assert len(list_cells(sheet)) == count * (count - 1)
        shown = sum(int(re.findall(r"(\d+) flow", cell)[0]) for cell in list_cells(sheet))
        owners = {each.id: each.owners[0] if partners > 2 else each.group for each in architecture.components.values()}
        flows = [
            (connection.outputs[0].rpartition(".")[0], connection.input.rpartition(".")[0])
            for connection in architecture.connections
        ]
        between = sum(owners[tail] != owners[head] for tail, head in flows)
        folded = max(20, partners) if partners < 3 else partners
        assert shown == between if folded <= count else shown < between
        assert all(text.size >= 7.5 for text in sheet.texts)


def test_a_cell_leads_to_the_page_of_its_pair(tmp_path: Path) -> None:
    sheet = draw_partner_matrix(make_lookup(write_project(tmp_path, 20, 4)))
    assert {bar.ref for bar in sheet.bars if bar.ref} == {
        f"pair:p{one}:p{other}" for one in range(4) for other in range(one + 1, 4)
    }


@pytest.mark.parametrize(("groups", "is_matrix"), [(20, False), (21, True)])
def test_more_groups_than_an_eye_can_follow_are_a_matrix(groups: int, *, is_matrix: bool, tmp_path: Path) -> None:
    lines = ["types: {T: std_msgs/msg/Empty}", "groups:"]
    for at in range(groups):
        inputs = ", ".join(f"i{step}: g{(at + step) % groups}.c.o" for step in (1, 3, 7))
        lines.append(f"  g{at}: {{components: {{c: {{inputs: {{{inputs}}}, outputs: {{o: T}}}}}}}}")
    (tmp_path / "archgen.yaml").write_text("\n".join(lines) + "\n", "utf-8")
    lookup = make_lookup(pipeline.check_project(tmp_path / "archgen.yaml").architecture)
    assert is_too_dense(lookup) is is_matrix
    drawing = make_drawings(lookup, None, "functional")["overview"]
    assert ("more lines than an eye can follow" in " ".join(drawing.notes)) is is_matrix
