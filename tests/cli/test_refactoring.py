"""`archgen rename`, `move`, `split` and `undo` as people call them: output, files, what is undone and what is not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.running import contents

PROJECT = """\
archgen: 1
groups:
  a:
    components:
      one: {outputs: {far: T}}
      two: {inputs: {i: {from: far}}}
types: {T: {message: std_msgs/msg/Empty}}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a project, and a cache of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return tmp_path / "robot"


def test_a_rename_is_written_and_undone(run: Run, folder: Path) -> None:
    before = contents(folder)
    ran = run("rename", "a.one", "uno", "-C", folder)
    assert (ran.status, ran.err) == (0, "")
    assert "the component `a.one` is `uno` now: 1 file\n" in ran.out
    assert "archgen.yaml:5\n" in ran.out
    assert "on the wire: the topic `/a/one/far` is `/a/uno/far` now" in ran.out
    assert (folder / "archgen.yaml").read_text(encoding="utf-8") == PROJECT.replace("one:", "uno:")
    undone = run("undo", "-C", folder)
    assert undone.status == 0
    assert "undone: the component `a.one` is `uno` now" in undone.out
    assert contents(folder) == before
    again = run("undo", "-C", folder)
    assert (again.status, "nothing to undo" in again.err) == (2, True)


def test_a_dry_run_prints_a_patch_and_writes_nothing(run: Run, folder: Path) -> None:
    ran = run("rename", "two", "due", "--dry-run", "-C", folder)
    assert ran.out == (
        "--- a/archgen.yaml\n+++ b/archgen.yaml\n@@ -3,5 +3,5 @@\n   a:\n     components:\n       one: {outputs: {far: T}}\n"
        "-      two: {inputs: {i: {from: far}}}\n+      due: {inputs: {i: {from: far}}}\n"
        " types: {T: {message: std_msgs/msg/Empty}}\n"
    )
    assert (folder / "archgen.yaml").read_text(encoding="utf-8") == PROJECT


def test_programs_get_json(run: Run, folder: Path) -> None:
    ran = run("rename", "two", "due", "--format", "json", "-C", folder)
    document = json.loads(ran.out)
    assert document["renamed"] == [{"kind": "component", "from": "a.two", "to": "a.due"}]
    assert [each["file"] for each in document["files"]] == ["archgen.yaml"]
    assert document["written"] is True
    refused = run("rename", "due", "one", "--format", "json", "-C", folder)
    assert refused.status == 2
    assert json.loads(refused.out)["refused"].startswith("the name is taken")


def test_a_refusal_says_what_to_do(run: Run, folder: Path) -> None:
    ran = run("rename", "two", "one", "-C", folder)
    assert (ran.status, ran.out) == (2, "")
    assert ran.err == (
        "Error: the name is taken: archgen.yaml:5:7 declares the component `a.one`; nothing was written\n"
        "choose another one\n"
    )
    assert (
        "no kind `componnt`: did you mean `component`?"
        in run("rename", "two", "x", "--kind", "componnt", "-C", folder).err
    )
    assert run("move", "two", "-C", folder).status == 2
    assert "no archgen.yaml" in run("rename", "x", "y", "-C", folder.parent).err


def test_moves_and_splits_are_undone_too(run: Run, folder: Path) -> None:
    before = contents(folder)
    assert run("split", "archgen.yaml", "--by", "component", "-C", folder).status == 0
    assert sorted(contents(folder)) == ["archgen.yaml", "groups/one.yaml", "groups/two.yaml"]
    assert run("undo", "-C", folder).status == 0
    assert contents(folder) == before
    assert not (folder / "groups").exists()
    assert run("move", "two", "--file", "two.yaml", "-C", folder).status == 0
    assert run("check", folder).status == 0


def test_what_was_edited_since_is_not_undone(run: Run, folder: Path) -> None:
    run("rename", "two", "due", "-C", folder)
    with (folder / "archgen.yaml").open("a", encoding="utf-8") as stream:
        stream.write("# mine\n")
    ran = run("undo", "-C", folder)
    assert ran.status == 2
    assert "archgen.yaml was edited since" in ran.err
    assert (folder / "archgen.yaml").read_text(encoding="utf-8").endswith("# mine\n")
