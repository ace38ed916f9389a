"""Files that are read once, however many variants name them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import FileRefusal, RememberedFiles

PROJECT = """archgen: 1
ros: {distro: jazzy, interfaces: [msgs/Level.msg, demo_msgs/msg/Level.msg]}
groups: {g: {components: {a: {outputs: {o: Level}}, b: {inputs: {i: a.o}}}}}
types: {Level: {message: demo_msgs/msg/Level}}
variants: {one: {drop: [g.b]}, two: {drop: [g.a]}}
"""


def test_a_file_is_as_it_was_when_it_was_read_first(tmp_path: Path) -> None:
    files = RememberedFiles(FolderFiles(tmp_path))
    (tmp_path / "a.txt").write_bytes(b"one")
    assert (files.fetch_bytes("a.txt"), isinstance(files.fetch_bytes("b.txt"), FileRefusal)) == (b"one", True)
    (tmp_path / "a.txt").write_bytes(b"two")
    (tmp_path / "b.txt").write_bytes(b"late")
    assert (files.fetch_bytes("a.txt"), isinstance(files.fetch_bytes("b.txt"), FileRefusal)) == (b"one", True)
    assert (files.root, files.commit, files.has_path("b.txt"), files.is_behind_link("a.txt")) == (
        tmp_path,
        "",
        True,
        False,
    )
    assert [sorted(names) for _, _, names in files.walk_folders("")] == [["a.txt", "b.txt"]]


def test_a_large_file_is_not_kept(tmp_path: Path) -> None:
    (tmp_path / "picture.png").write_bytes(bytes(300_000))
    files = RememberedFiles(FolderFiles(tmp_path))
    assert files.fetch_bytes("picture.png") == bytes(300_000)
    (tmp_path / "picture.png").write_bytes(b"small")
    assert files.fetch_bytes("picture.png") == b"small"


def test_what_variants_name_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    (tmp_path / "demo_msgs/msg").mkdir(parents=True)
    (tmp_path / "demo_msgs/msg/Level.msg").write_text("float64 metres\n", encoding="utf-8")
    read_paths = list[str]()
    fetch = FolderFiles.fetch_bytes

    def count(files: FolderFiles, path: str) -> bytes | FileRefusal:
        read_paths.append(path)
        return fetch(files, path)

    monkeypatch.setattr(FolderFiles, "fetch_bytes", count)
    checked = check_project(tmp_path)
    assert set(checked.variants) == {"one", "two"}
    assert read_paths.count("demo_msgs/msg/Level.msg") == 1
    assert isinstance(checked.loaded_project.files, FolderFiles)
