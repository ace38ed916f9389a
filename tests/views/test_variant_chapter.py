"""What documents say of variants: a table of them, and what is different in each."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.products.variant_differences import find_variant_differences
from archgen.views.pages.variant_chapter import make_variant_sections, make_variant_table
from archgen.views.shapes import Bullets, Facts, Markdown, Paragraph

ROBOT = """\
archgen: 1
groups: {g: {components: {a: {title: A, outputs: {x: T}}, b: {inputs: {x: {from: a.x, optional: true}}}}}}
types: {T: std_msgs/msg/Bool}
nodes: {a: a, b: b}
hosts: {pc: {cores: 2}}
variants:
  same: {title: The same}
  sim: {description: No *a*., of: same, without: g.a, drop: [hosts.pc.cores]}
"""


def check(folder: Path, text: str) -> pipeline.CheckedProject:
    """Check a project of one file."""
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(folder / "robot.yaml")


def test_each_variant_says_what_is_different(tmp_path: Path) -> None:
    checked = check(tmp_path, ROBOT)
    differences = find_variant_differences(checked)
    assert differences["same"].sentences == ()
    assert differences["sim"].sentences[0].startswith("component `g.a` is removed with 1 output")
    assert "host `pc`: cores no longer given (it was 2)" in differences["sim"].sentences
    same, sim = make_variant_sections(checked.architecture, differences)
    assert [type(block) for block in same.blocks] == [Facts, Paragraph]
    assert [type(block) for block in sim.blocks] == [Markdown, Facts, Bullets]
    assert isinstance(sim.blocks[1], Facts)
    assert [name for name, _ in sim.blocks[1].rows] == ["Id", "Built on", "Without", "Drops", "Written at"]
    assert isinstance(sim.blocks[2], Bullets)
    # Names are links to their pages.
    assert "component:g.a" in [run.ref for run in sim.blocks[2].items[0]]
    table = make_variant_table(checked.architecture, differences)
    assert table is not None
    assert [run.text for run in table.rows[0][3]] == ["nothing"]


def test_a_project_without_variants_has_no_chapter(tmp_path: Path) -> None:
    checked = check(tmp_path, ROBOT.partition("variants:")[0])
    assert find_variant_differences(checked) == {}
    assert make_variant_table(checked.architecture, {}) is None
