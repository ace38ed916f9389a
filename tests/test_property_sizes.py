"""How many examples a property tries, by the markers that were asked for; that it tries the same whatever else was imported."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.property_sizes import (
    QUICK_PROFILE,
    choose_profile,
    count_examples,
    list_seeds,
    mark_further_samples,
)


@pytest.fixture(autouse=True)
def profile() -> Iterator[None]:
    """Leave the profile as it was."""
    name = settings.get_current_profile_name()
    yield
    settings.load_profile(name)


@pytest.mark.parametrize(
    ("markers", "count"),
    [
        ("", 400),
        ("slow", 400),
        ("not build", 400),
        ("not slow", 100),
        ("not slow and not build and not ros", 100),
    ],
)
def test_all_examples_are_tried_unless_slow_tests_are_left_out(
    markers: str, count: int, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pytestconfig.option, "markexpr", markers)
    choose_profile(pytestconfig)
    assert count_examples(400) == count


def test_one_example_at_least_is_tried(pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pytestconfig.option, "markexpr", "not slow")
    choose_profile(pytestconfig)
    assert count_examples(1) == 1


def test_properties_without_a_number_of_their_own_try_a_quarter_too(pytestconfig: pytest.Config) -> None:
    choose_profile(pytestconfig)
    quick = settings.get_current_profile_name() == QUICK_PROFILE
    assert settings.default is not None
    assert settings.default.max_examples == (25 if quick else 100)


def test_no_property_fails_for_the_time_that_it_takes(pytestconfig: pytest.Config) -> None:
    choose_profile(pytestconfig)
    assert settings.default is not None
    assert settings.default.deadline is None
    assert settings(max_examples=count_examples(400)).deadline is None


def _split_by_mark(samples: Iterable[object]) -> tuple[list[object], list[tuple[object, ...]]]:
    """Return the samples that `make test` tries, and those that only `make test-all` does."""
    plain, slow = list[object](), list[tuple[object, ...]]()
    for sample in samples:
        if isinstance(sample, pytest.ParameterSet):
            assert [mark.name for mark in sample.marks] == ["slow"]
            slow.append(tuple(sample.values))
        else:
            plain.append(sample)
    return plain, slow


@pytest.mark.parametrize(("count", "quick_count"), [(1, 1), (3, 1), (16, 2), (40, 5)])
def test_an_eighth_of_the_seeds_is_tried_at_once_and_none_is_left_out(count: int, quick_count: int) -> None:
    quick, slow = _split_by_mark(list_seeds(count))
    assert quick == list(range(quick_count))
    assert slow == [(seed,) for seed in range(quick_count, count)]


def test_the_first_sample_is_tried_at_once_and_none_is_left_out() -> None:
    assert _split_by_mark(mark_further_samples(["a", "b", "c"])) == (["a"], [("b",), ("c",)])
    assert _split_by_mark(mark_further_samples([(1, "a"), (2, "b")])) == ([(1, "a")], [(2, "b")])


def _draw() -> list[tuple[str, int]]:
    drawn: list[tuple[str, int]] = []

    @given(st.text(), st.integers())
    @settings(settings.get_profile(QUICK_PROFILE), max_examples=200, derandomize=True, database=None)
    def keep(text: str, number: int) -> None:
        drawn.append((text, number))

    keep()
    return drawn


def test_the_same_is_drawn_whatever_was_imported_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = _draw()
    lines = [f"T{number} = ('drawn from here {number}', {number * 7 + 10**6})" for number in range(500)]
    (tmp_path / "imported_between_draws.py").write_text("\n".join(lines), encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("imported_between_draws")
    assert _draw() == before
