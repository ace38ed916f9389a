"""Whatever lies where a file should be: text or a diagnostic, and nothing that is waited for."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.syntax import project_files
from archgen.syntax.folder_files import FolderFiles


def problem(root: Path, name: str = "a.yaml") -> tuple[str, str, int, int]:
    """Read a file that cannot be used: rule, message, line and column."""
    found = project_files.read_text_file(FolderFiles(root), name).problem
    assert found is not None
    assert found.span.file == name
    return found.rule, found.message, found.span.line, found.span.column


def test_text_with_a_byte_order_mark_and_windows_line_ends(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbfa: 1\r\nb: \xc3\xa4\r\n")
    assert project_files.read_text_file(FolderFiles(tmp_path), "a.yaml") == project_files.FileText("a: 1\r\nb: ä\r\n")


@pytest.mark.parametrize(
    ("data", "message", "line", "column"),
    [
        (b"a: 1\nb: \xc3\xa4\xff", "the byte 0xFF is not UTF-8", 2, 5),
        (b"a: 1\r\nb\0: 2", "a NUL character cannot stand in a text file", 2, 2),
        ("a: 1".encode("utf-16"), "the file is encoded as UTF-16", 1, 1),
        (b"a: \xed\xa0\x80", "the byte 0xED is not UTF-8", 1, 4),
    ],
)
def test_bytes_that_are_no_text(tmp_path: Path, data: bytes, message: str, line: int, column: int) -> None:
    (tmp_path / "a.yaml").write_bytes(data)
    assert problem(tmp_path) == ("syntax-error", message, line, column)


def test_a_file_of_50_megabytes(tmp_path: Path) -> None:
    with (tmp_path / "a.yaml").open("wb") as stream:
        stream.truncate(50_000_000)
    assert problem(tmp_path) == ("too-large", "the file is larger than 16 MiB", 1, 1)


def test_a_folder(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").mkdir()
    assert problem(tmp_path)[1] == "this is a folder, not a file"


def test_a_pipe_that_nobody_writes(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.yaml")
    assert problem(tmp_path)[1] == "this is a named pipe, not a file"


def test_a_device(tmp_path: Path) -> None:
    assert problem(Path("/dev"), "zero")[1] == "this is a device, not a file"
    assert project_files.read_text_file(FolderFiles(tmp_path), "../../../../../../../../dev/zero").problem is not None


def test_a_broken_link(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").symlink_to("nothing.yaml")
    assert problem(tmp_path)[1] == "this is a broken link: what it points to does not exist"


def test_a_link_to_itself(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").symlink_to("a.yaml")
    assert problem(tmp_path)[0] == "syntax-error"


def test_a_link_that_leaves_the_project(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("x")
    project = tmp_path / "project"
    project.mkdir()
    (project / "a.yaml").symlink_to(tmp_path / "secret")
    assert problem(project)[1] == "this link leads out of the project's folder"


def test_a_link_within_the_project(tmp_path: Path) -> None:
    (tmp_path / "b.yaml").write_text("a: 1")
    (tmp_path / "a.yaml").symlink_to("b.yaml")
    assert project_files.read_text_file(FolderFiles(tmp_path), "a.yaml").text == "a: 1"


def test_a_file_that_does_not_exist(tmp_path: Path) -> None:
    assert problem(tmp_path)[1] == "the file cannot be read: no such file or directory"
