"""The file with a project's schema: written whole or not at all, and renewed only where it is archgen's own."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from archgen.emit.file_tree import OutputError
from archgen.pipeline import CheckedProject, check_project
from archgen.products.editor_schema_file import explain_set_up, render_schema, write_schema
from archgen.products.editor_schema_marks import SCHEMA_FILE
from archgen.products.schema_renewal import renew_schema
from tests.repositories import git, repository

PROJECT = "archgen: 1\npartners: {lab: Lab}\n"
MORE = PROJECT + "hosts: {pc: A computer}\n"


def offered_hosts(root: Path) -> list[str]:
    schema = json.loads((root / SCHEMA_FILE).read_bytes())
    return list(schema["$defs"]["hosts"]["properties"])


def change(root: Path, text: str = MORE) -> CheckedProject:
    (root / "archgen.yaml").write_text(text, encoding="utf-8")
    return check_project(root)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Give a project in a repository that ignores the schema, which is there."""
    root = repository(tmp_path / "r", {"archgen.yaml": PROJECT, ".gitignore": ".vscode/archgen.schema.json\n"})
    write_schema(check_project(root))
    return root


def test_it_is_written_once_and_only_when_changed(root: Path) -> None:
    path = root / SCHEMA_FILE
    assert write_schema(check_project(root)) == (path, False)
    assert write_schema(change(root)) == (path, True)
    assert offered_hosts(root) == ["pc"]
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_the_same_project_gives_the_same_bytes(root: Path) -> None:
    assert render_schema(check_project(root)) == (root / SCHEMA_FILE).read_bytes()


@pytest.mark.parametrize("text", ["{}", "", '{"name": "package"}', "hosts: {}"])
def test_a_file_of_somebody_else_is_kept(text: str, root: Path) -> None:
    (root / "x.json").write_text(text, encoding="utf-8")
    with pytest.raises(OutputError, match="is no schema that archgen wrote"):
        write_schema(check_project(root), root / "x.json")
    assert (root / "x.json").read_text(encoding="utf-8") == text


def test_the_schema_of_an_older_init_is_replaced(root: Path) -> None:
    (root / "old.json").write_text('{\n "$schema": "x",\n "$id": "urn:archgen:schema:1"\n}', encoding="utf-8")
    assert write_schema(check_project(root), root / "old.json")[1]


@pytest.mark.parametrize("linked", [SCHEMA_FILE, ".vscode"])
def test_a_link_is_refused(linked: str, root: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    (root / linked).rename(elsewhere)
    (root / linked).symlink_to(elsewhere)
    before = elsewhere.read_bytes() if elsewhere.is_file() else (elsewhere / "archgen.schema.json").read_bytes()
    checked_project = change(root)
    with pytest.raises(OutputError, match="is a link"):
        write_schema(checked_project)
    assert not renew_schema(checked_project)
    assert before == (
        elsewhere.read_bytes() if elsewhere.is_file() else (elsewhere / "archgen.schema.json").read_bytes()
    )


def test_it_is_renewed_when_names_change(root: Path) -> None:
    assert not renew_schema(check_project(root))
    assert renew_schema(change(root))
    assert offered_hosts(root) == ["pc"]
    assert not renew_schema(check_project(root))


def test_a_change_without_new_names_writes_nothing(root: Path) -> None:
    before = (root / SCHEMA_FILE).stat()
    assert not renew_schema(change(root, f"{PROJECT}# a comment\n"))
    after = (root / SCHEMA_FILE).stat()  # reading it may change when it was last read
    assert (after.st_ino, after.st_mtime_ns, after.st_size) == (before.st_ino, before.st_mtime_ns, before.st_size)


def test_it_is_not_renewed_where_there_is_none(root: Path) -> None:
    (root / SCHEMA_FILE).unlink()
    assert not renew_schema(change(root))
    assert not (root / SCHEMA_FILE).exists()


def test_it_is_not_renewed_without_the_mark(root: Path) -> None:
    (root / SCHEMA_FILE).write_text("{}", encoding="utf-8")
    assert not renew_schema(change(root))


def test_it_is_not_renewed_where_git_does_not_ignore_it(root: Path) -> None:
    (root / ".gitignore").unlink()
    assert not renew_schema(change(root))


def test_it_is_not_renewed_where_git_keeps_it(root: Path) -> None:
    git(root, "add", "-f", SCHEMA_FILE)
    assert not renew_schema(change(root))


def test_it_is_not_renewed_outside_of_a_repository(root: Path) -> None:
    (root / ".git").rename(root / "git")
    assert not renew_schema(change(root))


def test_names_stay_while_a_file_cannot_be_read(root: Path) -> None:
    before = (root / SCHEMA_FILE).read_bytes()
    assert not renew_schema(change(root, "partners: {lab: [\n"))
    assert (root / SCHEMA_FILE).read_bytes() == before


def test_a_typing_error_elsewhere_keeps_no_name_back(root: Path) -> None:
    assert renew_schema(change(root, f"{MORE}nodes: {{n: {{implements: nothing.there, host: pcc}}}}\n"))
    assert offered_hosts(root) == ["pc"]


def test_a_disk_that_refuses_is_no_failure(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    before = (root / SCHEMA_FILE).read_bytes()
    checked_project = change(root)
    monkeypatch.setattr(os, "replace", refuse)
    assert not renew_schema(checked_project)
    assert (root / SCHEMA_FILE).read_bytes() == before
    assert [file.name for file in (root / ".vscode").iterdir()] == ["archgen.schema.json"]


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("# yaml-language-server: $schema=.vscode/archgen.schema.json\n", None),
        (
            "# yaml-language-server: $schema=.archgen/archgen.schema.json\n",
            "the first line of archgen.yaml names another schema: write `# yaml-language-server: $schema=.vscode/archgen.schema.json`",
        ),
        (
            "",
            "editors find it by the line `# yaml-language-server: $schema=.vscode/archgen.schema.json` on top of a file, or by a setting",
        ),
    ],
)
def test_it_says_how_editors_find_it(text: str, advice: str | None, root: Path) -> None:
    assert explain_set_up(change(root, text + PROJECT), root / SCHEMA_FILE) == advice


def test_nothing_needs_to_be_done_where_settings_are(root: Path) -> None:
    (root / ".vscode/settings.json").write_text("{}", encoding="utf-8")
    assert explain_set_up(check_project(root), root / SCHEMA_FILE) is None
