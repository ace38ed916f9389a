"""Counted points that are kept between runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.history import point_cache


def test_what_is_stored_is_loaded(tmp_path: Path) -> None:
    path = point_cache.cache_file(tmp_path, "robot")
    point_cache.store_points(path, {"tree": {"groups": 2}})
    assert point_cache.load_points(path) == {"tree": {"groups": 2}}


def test_each_place_of_a_project_and_each_program_has_a_file_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = point_cache.cache_file(tmp_path, "robot")
    assert point_cache.cache_file(tmp_path, "robot") == first
    assert point_cache.cache_file(tmp_path, "arm") != first
    monkeypatch.setattr(point_cache, "stamp_program", lambda: "another")
    assert point_cache.cache_file(tmp_path, "robot") != first


@pytest.mark.parametrize("damage", [b"", b"{", b"[1]", b"\xff", b"null"])
def test_a_damaged_file_counts_as_empty(tmp_path: Path, damage: bytes) -> None:
    (tmp_path / "a.history").write_bytes(damage)
    assert point_cache.load_points(tmp_path / "a.history") == {}


def test_entries_that_are_no_points_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "a.history").write_text('{"good": {"x": 1}, "bad": 3, "worse": null}')
    assert point_cache.load_points(tmp_path / "a.history") == {"good": {"x": 1}}


def test_without_a_folder_nothing_is_kept_and_nothing_fails() -> None:
    assert point_cache.cache_file(None, "robot") is None
    assert point_cache.load_points(None) == {}
    point_cache.store_points(None, {"tree": {}})


def test_a_folder_that_cannot_be_written_costs_nothing_but_time(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    point_cache.store_points(tmp_path / "file" / "a.history", {"tree": {}})


def test_eight_files_are_kept(tmp_path: Path) -> None:
    for number in range(10):
        point_cache.store_points(tmp_path / f"{number}.history", {})
    assert len(list(tmp_path.iterdir())) == 8
