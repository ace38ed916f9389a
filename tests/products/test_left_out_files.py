"""A project that no longer reads a file: one edit with all that goes with it, and no list of findings about the rest."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.markdown.comparison_markdown import write_comparison_markdown
from archgen.pipeline import check_project
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.changes.comparison_document import ComparisonDocument, describe_comparison

FILES = {
    "archgen.yaml": """\
project: {id: mini}
partners: {a: A, b: B}
sources: [a.yaml, b.yaml, nodes.yaml]
ros: {distro: jazzy, interfaces: ["msg/**/*.msg"]}
types: {Stop: {message: m_msgs/msg/Stop, size: 10 B}, Go: {message: m_msgs/msg/Go, size: 10 B}}
""",
    "a.yaml": """\
groups: {sense: {owner: a, components: {eye: {outputs: {stop: Stop, go: Go}}, ear: {inputs: {go: eye.go}}}}}
""",
    "b.yaml": """\
groups: {drive: {owner: b, components: {base: {inputs: {stop: eye.stop, go: eye.go}}}}}
""",
    "nodes.yaml": """\
nodes:
  eye: {implements: eye, timing: {rate: 10 Hz, wcet: 1 ms}, publishes: {stop: /stop, go: /go}}
  ear: {implements: ear, timing: {rate: 10 Hz, wcet: 1 ms}}
""",
    "msg/m_msgs/msg/Stop.msg": "uint8 what\n",
    "msg/m_msgs/msg/Go.msg": "uint8 what\n",
}


def describe(folder: Path, *changes: tuple[str, str, str]) -> ComparisonDocument:
    """Compare the project with a later one in which texts of files are replaced; without a text the file is deleted."""
    versions = []
    for name, edits in (("before", ()), ("after", changes)):
        for file, text in FILES.items():
            for edited_file, old, new in edits:
                assert old in FILES[edited_file]
                text = text.replace(old, new) if file == edited_file else text  # noqa: PLW2901
            (folder / name / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / name / file).write_text(text, encoding="utf-8")
        versions.append(folder / name)
    sides = [ProjectVersion(version.name, check_project(version)) for version in versions]
    return describe_comparison(compare_named_versions(*sides), "before", "after")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (", nodes.yaml]", "]", "`sources` no longer names `nodes.yaml`: 2 nodes are not read any more"),
        (
            ', interfaces: ["msg/**/*.msg"]',
            "",
            "`ros.interfaces` no longer names `msg/m_msgs/msg/Go.msg` and `msg/m_msgs/msg/Stop.msg`: 2 message definitions are not read any more",
        ),
        (
            "msg/**/*.msg",
            "msg/**/Go.msg",
            "`ros.interfaces` no longer names `msg/m_msgs/msg/Stop.msg`: 1 message definition is not read any more",
        ),
    ],
)
def test_what_is_not_read_any_more_is_one_edit(tmp_path: Path, old: str, new: str, told: str) -> None:
    document = describe(tmp_path, ("archgen.yaml", old, new))
    (item,) = document.breaking_changes
    assert item.change.text == told
    assert item.partners == ("B",)
    assert document.change_groups == ()
    comment = write_comparison_markdown(document)
    assert "unchecked-message`:" not in comment
    assert "unmapped-component`:" not in comment


def test_what_is_missing_of_it_is_found_with_it(tmp_path: Path) -> None:
    (item,) = describe(tmp_path, ("archgen.yaml", ', interfaces: ["msg/**/*.msg"]', "")).breaking_changes
    assert item.agreements == ("found as `unchecked-message` at `archgen.yaml:5:25` and `archgen.yaml:5:69`",)


def test_an_emptied_file_is_read(tmp_path: Path) -> None:
    document = describe(tmp_path, ("nodes.yaml", FILES["nodes.yaml"], "nodes: {}\n"))
    texts = [item.change.text for item in document.breaking_changes]
    texts += [edit.text for group in document.change_groups for edit in group.changes]
    assert not [text for text in texts if "no longer names" in text]
    assert any(text.startswith("node `ear`") and " is removed" in text for text in texts)
