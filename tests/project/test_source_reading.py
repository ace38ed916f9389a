"""Every file below a project that may be a slice is read, or named where users look."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project

SLICE = "groups: {g: {components: {weeder: {outputs: {x: T}}}}}\n"


def write_project(folder: Path, files: dict[str, str], head: str = "archgen: 1\n") -> tuple[list[str], list[str]]:
    """Write a project; return the ids of its components, and what is said of files that are not read."""
    for name, text in {"archgen.yaml": head, **files}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    checked = check_project(folder)
    told = [f"{d.severity} {d.span}: {d.message}" for d in checked.findings if d.rule == "ignored-file"]
    return list(checked.architecture.components), told


@pytest.mark.parametrize(
    "name", ["weeder.yaml", "weeder.yml", "groups/weeder.yml", "a/b/c.yml", "groups/WEEDER.YAML", "weeder.Yml"]
)
def test_a_slice_is_read_whichever_ending_it_has(tmp_path: Path, name: str) -> None:
    assert write_project(tmp_path, {name: SLICE}) == (["g.weeder"], [])


def test_a_library_is_read_whichever_ending_its_files_have(tmp_path: Path) -> None:
    files = {"lib/drivers.yml": "component_types: {laser: {outputs: {scan: Scan}}}\n"}
    files["a.yaml"] = "groups: {g: {components: {front: {is: lib.laser}}}}\n"
    assert write_project(tmp_path, files, "archgen: 1\nlibraries: {lib: lib}\n") == (["g.front"], [])


def test_what_a_pattern_leaves_out_for_its_ending_is_told_at_the_pattern(tmp_path: Path) -> None:
    files = {"groups/weeder.yml": SLICE, "groups/arm.yaml": "groups: {a: {components: {hand: Hand}}}\n"}
    components, told = write_project(tmp_path, files, 'archgen: 1\nsources: ["groups/*.yaml"]\n')
    assert components == ["a.hand"]
    assert told == [
        "warning archgen.yaml:2:11: `groups/weeder.yml` is not read: `groups/*.yaml` names files that end in `.yaml`"
    ]
    assert write_project(tmp_path, {}, 'archgen: 1\nsources: ["groups/*.yaml", "groups/*.yml"]\n')[1] == []
    (tmp_path / "groups/weeder.yml").rename(tmp_path / "groups/weeder.YAML")
    assert write_project(tmp_path, {}, 'archgen: 1\nsources: ["groups/*.yaml"]\n')[1] == [
        "warning archgen.yaml:2:11: `groups/weeder.YAML` is not read: `groups/*.yaml` names files that end in `.yaml`"
    ]


@pytest.mark.parametrize("head", ["archgen: 1\n", 'archgen: 1\nsources: ["**/*.yaml"]\n'])
def test_a_slice_that_says_it_is_a_project_is_told(tmp_path: Path, head: str) -> None:
    text = f"archgen: 1\n{SLICE}"
    assert write_project(tmp_path, {"groups/weeder.yaml": text}, head) == (
        [],
        ["warning groups/weeder.yaml:1:1: `archgen:` makes this file a project of its own: it is no part of this one"],
    )
    # With a name it is one: a packed project beside others.
    _, told = write_project(tmp_path, {"groups/weeder.yaml": f"{text}project: {{id: other, title: Other}}\n"}, head)
    assert told == [
        "note groups/weeder.yaml:1:1: `archgen:` makes this file a project of its own: it is no part of this one"
    ]


def test_what_is_generated_into_the_project_is_nobodys_slip(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("groups: {g: {components: {a: A}}}\n", encoding="utf-8")
    for name, text in {
        "ws/.archgen/start.json": "{}",
        "ws/start/compose/pc.yaml": "services: {a: b}",
        "own/x.yaml": "a: b",
        "ws/y.yaml": "group: {}",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (told,) = (d.message for d in check_project(tmp_path).findings if d.rule == "ignored-file")
    assert told == "`ws/y.yaml`, `own/x.yaml` hold no element of the language and are not read"
