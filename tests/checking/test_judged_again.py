"""A project is judged in its variants, and again behind passes."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import project
from archgen.checking.checked_project import CheckedProject
from archgen.checking.derived_projects import (
    UnknownVariantError,
    judge_in_variants,
    keep_variant_findings,
    list_variant_names,
    read_origins,
    stand_in_variants,
    transform_project,
)
from archgen.checking.linked_project import merge_project
from archgen.timing.run_analysis import AnalysisMemory

ROBOT = """\
archgen: 1
groups: {g: {components: {cam: {outputs: {image: sensor_msgs/msg/Image}}, look: {inputs: {image: cam.image}}}}}
variants: {blind: {without: cam}, deaf: {without: look}}
"""


def judge(folder: Path, text: str = ROBOT, names: tuple[str, ...] | None = None) -> CheckedProject:
    """Judge a project of one file in its variants."""
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return judge_in_variants(merge_project(project.load_project(folder)), AnalysisMemory(), names)


def test_each_variant_is_judged_unless_others_are_asked_for(tmp_path: Path) -> None:
    judged = judge(tmp_path)
    assert list(judged.variants) == ["blind", "deaf"]
    assert list(judged.variants["blind"].architecture.components) == ["g.look"]
    assert list(judge(tmp_path, names=("deaf",)).variants) == ["deaf"]
    assert list_variant_names(tmp_path) == ("blind", "deaf")


def test_a_project_stands_in_the_variants_that_are_named(tmp_path: Path) -> None:
    judged = judge(tmp_path)
    assert stand_in_variants(judged, ["blind"]) is judged.variants["blind"]
    both = stand_in_variants(judged, ["blind", "deaf"])
    assert both.steps == ("blind", "deaf")
    assert list(both.architecture.components) == []
    base = stand_in_variants(judged, ["base"])
    assert (base.variants, base.findings) == ({}, judged.own_findings)
    assert "variants" not in base.merged_table.entries


def test_findings_are_kept_by_the_variants_in_which_they_hold(tmp_path: Path) -> None:
    judged = judge(tmp_path)
    in_blind = keep_variant_findings(judged, ["blind"]).findings
    in_base = keep_variant_findings(judged, ["base"]).findings
    assert {each.rule for each in in_blind} - {each.rule for each in in_base} == {"unfed-input"}


def test_a_variant_that_does_not_exist_is_guessed(tmp_path: Path) -> None:
    judged = judge(tmp_path)
    with pytest.raises(UnknownVariantError, match="no variant named `blond`: did you mean `blind`"):
        stand_in_variants(judged, ["blond"])
    with pytest.raises(UnknownVariantError, match="there are `base`, `blind` and `deaf`"):
        keep_variant_findings(judged, ["x"])


def test_what_passes_make_is_judged_and_known_again(tmp_path: Path) -> None:
    flat = transform_project(judge(tmp_path), ["flatten"])
    assert flat.transformed is not None
    assert flat.variants == {}
    made = "archgen: 1\ngroups: {g: {components: {cam: {}}}}  # archgen: made[flatten] from old.yaml:3:1\n"
    read = read_origins(judge(tmp_path, made))
    assert read.architecture.made_elements
    assert read_origins(judge(tmp_path)).architecture.made_elements == {}
