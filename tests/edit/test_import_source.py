"""Whether the source of a slice changed since its import, whatever a record says of where to look."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.edit.earlier_import import digest_sources, list_stale_slices, write_source_records
from archgen.pipeline import check_project

PROJECT = "archgen: 1\nproject: {id: rover, title: Rover}\n"


def write(root: Path, files: dict[str, str]) -> None:
    """Write files below a folder."""
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")


def list_stale(project: Path) -> list[str]:
    return [each.message for each in list_stale_slices(check_project(project))]


def test_what_changed_is_told_and_what_is_made_or_hidden_does_not_count(tmp_path: Path) -> None:
    write(tmp_path, {"src/a/main.py": "1", "src/a/b.txt": "2", "src/robot/archgen.yaml": PROJECT})
    source, project = tmp_path / "src", tmp_path / "src/robot"
    write(project, write_source_records(project, ["archgen.yaml"], [source]))
    assert list_stale(project) == []
    write(
        tmp_path, {"src/build/x": "1", "src/.git/y": "2", "src/robot/more.yaml": "groups: {}\n", "src/a/.hidden": "3"}
    )
    assert list_stale(project) == []
    for name in ("src/a/main.py", "src/a/new.py"):
        before = (tmp_path / name).read_text() if (tmp_path / name).exists() else None
        write(tmp_path, {name: "other"})
        assert list_stale(project) == [
            "`..` changed since archgen.yaml was imported: the project may be older than its source"
        ]
        write(tmp_path, {name: before or ""})
        if before is None:
            (tmp_path / name).unlink()
    (source / "a/link.py").symlink_to("/etc/hostname")
    assert list_stale(project) == []
    (source / "a/b.txt").rename(source / "a/c.txt")
    assert len(list_stale(project)) == 1


@pytest.mark.parametrize(
    "record",
    [
        *("", "files: [", "[]", "files: x", "files: [1]", "files: []", "digest: 3", 'files: ["\\0"]', "files: [/etc]"),
        *("files: [../../..]", "files: [gone]", f"files: [{'x' * 5000}]"),
    ],
)
def test_a_record_that_leads_nowhere_or_out_is_left_alone(tmp_path: Path, record: str) -> None:
    write(tmp_path / "a/b", {"archgen.yaml": PROJECT, ".archgen/imported_from/archgen.yaml": record})
    assert list_stale(tmp_path / "a/b") == []


def test_large_files_count_by_their_sizes_and_pipes_not_at_all(tmp_path: Path) -> None:
    (tmp_path / "s").mkdir()
    with (tmp_path / "s/bag.db3").open("wb") as file:
        file.truncate(3_000_000)
    os.mkfifo(tmp_path / "s/pipe")
    first = digest_sources([tmp_path / "s"], tmp_path)
    with (tmp_path / "s/bag.db3").open("r+b") as file:
        file.write(b"x")
    assert digest_sources([tmp_path / "s"], tmp_path) == first
    with (tmp_path / "s/bag.db3").open("ab") as file:
        file.write(b"x")
    assert digest_sources([tmp_path / "s"], tmp_path) != first
