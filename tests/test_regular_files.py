"""Files are opened without waiting: what is a pipe or a folder by now is told of."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.regular_files import NoRegularFileError, describe_file_kind, holds_bytes, open_named_file, read_named_file


def test_a_file_is_read_up_to_its_limit(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"12345")
    assert read_named_file(file, 5) == b"12345"
    with pytest.raises(OSError, match="it has more than 4 bytes"):
        read_named_file(file, 4)
    with open_named_file(file) as stream:
        assert stream.read(2) == b"12"


def test_a_pipe_and_a_folder_are_not_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path, kind in ((pipe, "a named pipe"), (tmp_path, "a folder")):
        with pytest.raises(NoRegularFileError, match=f"this is {kind}, not a file"):
            read_named_file(path, 5)
        assert not holds_bytes(path, b"")
        assert kind in describe_file_kind(path.lstat().st_mode)


def test_a_file_holds_its_bytes_and_no_other(tmp_path: Path) -> None:
    file = tmp_path / "file"
    assert not holds_bytes(file, b"")
    file.write_bytes(b"ab")
    assert [holds_bytes(file, data) for data in (b"a", b"ab", b"abc", b"ba")] == [False, True, False, False]
