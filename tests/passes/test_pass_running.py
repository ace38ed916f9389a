"""Passes run in order, with those before them that they need; what they make is judged as a project."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.passes import PASSES, Pass, PassWork, ProjectTree, UnknownPassError, order_passes
from archgen.pipeline import check_project, transform_project
from tests.judged_projects import judge_shipped

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def _do_nothing(work: PassWork) -> None:
    del work


def _make_pass(name: str, needs: str = "", leaves: str = "", ends: str = "") -> Pass:
    return Pass(name, f"Does {name}.", _do_nothing, tuple(needs.split()), tuple(leaves.split()), tuple(ends.split()))


KNOWN = {
    each.name: each
    for each in (
        _make_pass("plain", leaves="no_generics"),
        _make_pass("write_out", leaves="no_instances", ends="flat"),
        _make_pass("lay_flat", needs="no_instances no_generics", leaves="flat"),
        _make_pass("wrap", ends="no_generics"),
        _make_pass("send", needs="flat no_generics"),
    )
}


def _names(*asked: str) -> list[str]:
    return [each.name for each in order_passes(asked, KNOWN)]


def test_what_a_pass_needs_runs_before_it_once() -> None:
    assert _names("lay_flat", "lay_flat") == ["write_out", "plain", "lay_flat", "lay_flat"]
    assert _names("send") == ["write_out", "plain", "lay_flat", "send"]


def test_what_another_pass_ended_is_given_again() -> None:
    assert _names("lay_flat", "wrap", "send") == ["write_out", "plain", "lay_flat", "wrap", "plain", "send"]


def test_a_name_that_is_no_pass_is_guessed() -> None:
    with pytest.raises(UnknownPassError, match="no pass named `lay_fat`: did you mean `lay_flat`"):
        _names("lay_fat")


def test_every_state_that_a_shipped_pass_needs_is_left_by_one() -> None:
    left = {state for each in PASSES.values() for state in each.leaves}
    assert {state for each in PASSES.values() for state in each.needs} <= left


def test_what_no_pass_changes_is_judged_once(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("groups: {g: {components: {a: {outputs: {x: Pose}}}}}\n")
    checked_project = check_project(tmp_path)
    same_project = transform_project(checked_project, ["remove_generics"])
    assert same_project.architecture is checked_project.architecture
    assert same_project.findings == checked_project.findings
    assert same_project.transformed
    assert same_project.transformed.passes == ("remove_generics",)
    cleaning = judge_shipped(EXAMPLES / "cleaning_robot")
    changed_project = transform_project(cleaning, ["remove_generics"])
    assert changed_project.architecture is not cleaning.architecture
    assert changed_project.transformed
    assert changed_project.transformed.is_changed


def test_a_transformed_project_is_judged_and_the_checked_one_stays(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("groups: {g: {components: {a: {outputs: {x: Pose}}}}}\n")

    def add_title(work: PassWork) -> None:
        work.tree.set(("groups", "g", "title"), "Gee", ("groups", "g"))

    known = {"add_title": Pass("add_title", "Adds a title.", add_title)}
    checked = check_project(tmp_path)
    transformed = transform_project(checked, ["add_title"], known)
    assert transformed.architecture.groups["g"].title == "Gee"
    assert checked.architecture.groups["g"].title == "G"
    assert transformed.transformed is not None
    assert transformed.transformed.passes == ("add_title",)
    assert list(transformed.transformed.provenance) == [("groups", "g", "title")]


def test_what_stands_in_a_list_says_that_its_name_follows() -> None:
    checked = judge_shipped(EXAMPLES / "cleaning_robot")
    transformed = transform_project(checked, ["normalise_connections"]).transformed
    assert transformed is not None
    assert [path[-1] for path in transformed.provenance] == ["lidar", "gps", "pose_fusion"]
    assert {origin.passes for origin in transformed.provenance.values()} == {("complete_names",)}


def test_a_connection_that_stands_at_its_source_says_so(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "groups:\n  g:\n    components:\n      a: {outputs: {x: {type: Pose, to: b.y}}}\n      b: {inputs: {y: {}, z: a.x}}\n"
    )
    transformed = transform_project(check_project(tmp_path), ["normalise_connections"]).transformed
    assert transformed is not None
    ((path, origin),) = transformed.provenance.items()
    assert path == ("groups", "g", "components", "b", "inputs", "y", "from", 0)
    assert (origin.passes, str(origin.at)) == (("normalise_connections",), "archgen.yaml:4:41")


def test_the_linker_is_asked_again_once_a_target_has_moved(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "groups: {g: {components: {a: {outputs: {x: Pose}}, b: {inputs: {y: {type: Pose}}}}}}\n"
    )
    checked = check_project(tmp_path)
    work = PassWork(checked.loaded_project, ProjectTree(checked.merged_table), checked.architecture.interfaces)
    output = ("groups", "g", "components", "a", "outputs", "x")
    work.tree.set((*output, "to"), ["b.y"], output)
    assert work.link().joined_sources.list_sources(("input", "g.b.y")) == ()
    PASSES["normalise_connections"].run(work)
    (source,) = work.link().joined_sources.list_sources(("input", "g.b.y"))
    assert source.target.id == "g.a.x"
