"""Files of a cache: whole or not there, and only the newest."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.cache.cache_files import remove_oldest, store_file


def test_a_file_replaces_the_one_before_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    for data in (b"first", b"second"):
        store_file(tmp_path / "new" / "a.stamp", data)
    assert {path.name: path.read_bytes() for path in (tmp_path / "new").iterdir()} == {"a.stamp": b"second"}


def test_a_store_that_fails_leaves_the_file_before_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store_file(tmp_path / "a.stamp", b"first")

    def fail(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError):  # noqa: PT011 - the one of above
        store_file(tmp_path / "a.stamp", b"second")
    assert (tmp_path / "a.stamp").read_bytes() == b"first"


def test_the_oldest_of_one_suffix_are_removed(tmp_path: Path) -> None:
    for age, name in enumerate(["c.stamp", "a.stamp", "b.stamp", "z.docx"]):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (1000 - age, 1000 - age))
    remove_oldest(tmp_path, ".stamp", 2)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.stamp", "c.stamp", "z.docx"]
    remove_oldest(tmp_path / "gone", ".stamp", 0)
