"""Files of other tools are read within limits, and nothing of an archive reaches the disk."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from archgen.importers import foreign_files
from archgen.importers.foreign_files import read_archive_members, read_bounded
from archgen.importers.foreign_import import ForeignFileError


def test_a_file_that_is_too_large_is_refused(tmp_path: Path) -> None:
    (tmp_path / "model.xmi").write_bytes(b"12345")
    assert read_bounded(tmp_path / "model.xmi", 5) == b"12345"
    with pytest.raises(ForeignFileError, match="it is larger than"):
        read_bounded(tmp_path / "model.xmi", 4)


@pytest.mark.parametrize(("name", "words"), [("", "it is a folder"), ("none.xmi", "there is no such file")])
def test_what_is_no_file_is_told(tmp_path: Path, name: str, words: str) -> None:
    with pytest.raises(ForeignFileError, match=words):
        read_bounded(tmp_path / name)


def test_members_of_an_archive_are_read_by_their_ending(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "model.mdzip", "w") as archive:
        archive.writestr("../../evil.XMI", "<a/>")
        archive.writestr("picture.png", "x")
    assert list(read_archive_members(tmp_path / "model.mdzip", (".xmi",))) == [("../../evil.XMI", b"<a/>")]
    assert [path.name for path in tmp_path.iterdir()] == ["model.mdzip"]


def test_a_bomb_stops_at_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foreign_files, "MAX_MODEL_BYTES", 1000)
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.xmi", b"0" * 600)
        archive.writestr("b.xmi", b"0" * 600)
    with pytest.raises(ForeignFileError, match="it is larger than"):
        list(read_archive_members(tmp_path / "bomb.zip", (".xmi",)))


def test_a_damaged_archive_is_told(tmp_path: Path) -> None:
    (tmp_path / "half.zip").write_bytes(b"PK\x03\x04 and nothing more")
    with pytest.raises(ForeignFileError, match="the zip file is damaged"):
        list(read_archive_members(tmp_path / "half.zip", (".xmi",)))
