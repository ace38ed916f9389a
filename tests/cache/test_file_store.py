"""The store of cached files: bounded, never half written, and never in anybody's way."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.cache.file_store import FileStore, digest_bytes, digest_text


def test_what_is_stored_is_loaded(tmp_path: Path) -> None:
    files = FileStore(tmp_path / "new" / "folder", ".kind")
    assert files.load("a") is None
    files.store("a", b"one")
    files.store("a", b"two")
    assert files.load("a") == b"two"
    assert [path.name for path in (tmp_path / "new" / "folder").iterdir()] == ["a.kind"]


def test_the_oldest_beyond_the_bound_are_removed_and_other_kinds_stay(tmp_path: Path) -> None:
    FileStore(tmp_path, ".other").store("x", b"")
    files = FileStore(tmp_path, ".kind", most_files=2)
    for age, key in enumerate("abc"):
        files.store(key, b"")
        path = files.path_of(key)
        assert path is not None
        os.utime(path, (1000 + age, 1000 + age))
    files.store("d", b"")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["c.kind", "d.kind", "x.other"]


def test_without_a_folder_nothing_is_stored() -> None:
    files = FileStore(None, ".kind", 1)
    files.store("a", b"one")
    files.prune(0)
    assert files.load("a") is None
    assert files.path_of("a") is None


def test_a_disk_that_takes_nothing_is_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = FileStore(tmp_path, ".kind")
    files.store("a", b"old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", fail)
    files.store("a", b"new")
    assert files.load("a") == b"old"
    assert len(list(tmp_path.iterdir())) == 1


def test_what_a_killed_run_left_goes_among_the_oldest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = FileStore(tmp_path, ".kind", 2)

    def kill(*_: object) -> None:
        raise SystemExit

    monkeypatch.setattr("os.replace", kill)
    monkeypatch.setattr("os.unlink", lambda _: None)
    with pytest.raises(SystemExit):
        files.store("a", b"one")
    monkeypatch.undo()
    (left_over,) = tmp_path.iterdir()
    os.utime(left_over, (1, 1))
    files.store("b", b"two")
    files.store("c", b"three")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.kind", "c.kind"]


def test_digests_take_lone_surrogates_and_missing_files() -> None:
    assert digest_text("\ud800") != digest_text("\udfff")
    assert digest_bytes(None) is None
    assert digest_bytes(b"") == digest_text("")
