"""`list_changes`: the changes of a whole comparison, without what it makes of them."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.compare.change_listing import list_changes
from archgen.compare.compare_versions import compare_versions
from archgen.products.compared_versions import make_comparison_input
from tests.judged_projects import judge_ramcip

BEFORE = """\
archgen: 1
partners: {lab: Lab, uni: University}
groups: {g: {components: {
  a: {owner: lab, outputs: {x: T, y: T}},
  b: {owner: uni, inputs: {x: a.x, y: a.y}}}}}
hosts: {pc: {cores: 2}}
types: {T: std_msgs/msg/Bool}
"""
AFTER = BEFORE.replace("cores: 2", "cores: 4").replace(", y: T", "").replace(", y: a.y", "")


def check_text(folder: Path, text: str) -> pipeline.CheckedProject:
    """Check a project of one file."""
    folder.mkdir()
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(folder / "robot.yaml")


def test_changes_are_those_of_a_comparison(tmp_path: Path) -> None:
    before, after = (
        make_comparison_input(check_text(tmp_path / name, text)) for name, text in (("old", BEFORE), ("new", AFTER))
    )
    listed = list_changes(before, after)
    whole = compare_versions(before, after).changes
    assert sorted(change.text for change in listed) == sorted(change.text for change in whole)
    assert "host `pc`: cores 2 → 4" in [change.text for change in listed]
    assert any(change.breaks for change in whole)
    assert not any(change.breaks for change in listed)


def test_a_variant_of_the_example_differs_as_a_comparison_says() -> None:
    checked = judge_ramcip()
    base = make_comparison_input(checked)
    for variant in checked.variants.values():
        after = make_comparison_input(variant)
        whole = sorted(change.text for change in compare_versions(base, after).changes)
        assert whole
        assert sorted(change.text for change in list_changes(base, after)) == whole
