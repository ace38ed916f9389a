"""Counted points that are kept between runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.history import history_counting
from archgen.history.history_counting import PointCache


def test_what_is_stored_is_loaded(tmp_path: Path) -> None:
    PointCache(tmp_path, "robot").store_points({"tree": {"groups": 2}})
    assert PointCache(tmp_path, "robot").load_points() == {"tree": {"groups": 2}}


def test_each_place_of_a_project_and_each_program_has_points_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    PointCache(tmp_path, "robot").store_points({"tree": {"groups": 2}})
    assert PointCache(tmp_path, "arm").load_points() == {}
    monkeypatch.setattr(history_counting, "stamp_program", lambda: "another")
    assert PointCache(tmp_path, "robot").load_points() == {}


@pytest.mark.parametrize("damage", [b"", b"{", b"[1]", b"\xff", b"null"])
def test_a_damaged_file_counts_as_empty(tmp_path: Path, damage: bytes) -> None:
    cache = PointCache(tmp_path, "robot")
    cache.store_points({})
    next(tmp_path.iterdir()).write_bytes(damage)
    assert cache.load_points() == {}


def test_entries_that_are_no_points_are_left_out(tmp_path: Path) -> None:
    cache = PointCache(tmp_path, "robot")
    cache.store_points({})
    next(tmp_path.iterdir()).write_text('{"good": {"x": 1}, "bad": 3, "worse": null}', encoding="utf-8")
    assert cache.load_points() == {"good": {"x": 1}}


def test_without_a_folder_nothing_is_kept_and_nothing_fails() -> None:
    PointCache(None, "robot").store_points({"tree": {}})
    assert PointCache(None, "robot").load_points() == {}


def test_eight_files_are_kept(tmp_path: Path) -> None:
    for number in range(10):
        PointCache(tmp_path, f"robot{number}").store_points({})
    assert len(list(tmp_path.iterdir())) == 8
