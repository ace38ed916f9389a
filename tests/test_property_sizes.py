"""How many examples a property tries, by the markers that were asked for; that it tries the same whatever else was imported."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests import property_sizes
from tests.property_sizes import (
    QUICK_PROFILE,
    choose_profile,
    count_examples,
    list_seeds,
    try_some,
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
        ("not slow", 50),
        ("not slow and not build and not ros", 50),
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


def test_properties_without_a_number_of_their_own_try_an_eighth_too(pytestconfig: pytest.Config) -> None:
    choose_profile(pytestconfig)
    quick = settings.get_current_profile_name() == QUICK_PROFILE
    assert settings.default is not None
    assert settings.default.max_examples == (12 if quick else 100)


def test_no_property_fails_for_the_time_that_it_takes(pytestconfig: pytest.Config) -> None:
    choose_profile(pytestconfig)
    assert settings.default is not None
    assert settings.default.deadline is None
    assert settings(max_examples=count_examples(400)).deadline is None


def _sort_by_mark(samples: Iterable[pytest.ParameterSet]) -> dict[str, list[object]]:
    """Return the samples that `make test` tries, those that `make test-all` does (`slow`), and those of `make properties`."""
    sorted_samples = dict[str, list[object]]()
    for sample in samples:
        marks = " ".join(mark.name for mark in sample.marks) or "quick"
        sorted_samples.setdefault(marks, []).append(sample.values if len(sample.values) > 1 else sample.values[0])
    return sorted_samples


@pytest.mark.parametrize(
    ("count", "quick", "shown_count"), [(1, [0], 1), (3, [0], 1), (16, [0, 2], 5), (40, [0, 2, 5, 7, 10], 13)]
)
def test_an_eighth_of_the_seeds_is_tried_at_once_and_a_third_by_all_tests(
    count: int, quick: list[int], shown_count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = {"quick": quick, "slow": [seed for seed in range(shown_count) if seed not in quick]}
    monkeypatch.setattr(property_sizes, "DRAWS_ANEW", False)
    assert {"slow": [], **_sort_by_mark(list_seeds(count))} == shown
    # `make properties` leaves none out.
    monkeypatch.setattr(property_sizes, "DRAWS_ANEW", True)
    further = {"hypothesis": [*range(shown_count, count)]}
    assert {"slow": [], "hypothesis": [], **_sort_by_mark(list_seeds(count))} == {**shown, **further}


@pytest.mark.parametrize("draws_anew", [False, True])
def test_some_from_all_over_the_samples_are_tried_at_once_and_none_is_left_out(
    draws_anew: bool,  # noqa: FBT001 - a parameter
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(property_sizes, "DRAWS_ANEW", draws_anew)
    assert _sort_by_mark(try_some("abc")) == {"quick": ["a"], "slow": ["b", "c"]}
    assert _sort_by_mark(try_some([(1, "a"), (2, "b")])) == {"quick": [(1, "a")], "slow": [(2, "b")]}
    assert _sort_by_mark(try_some("abcdef", 3)) == {"quick": ["a", "c", "e"], "slow": ["b", "d", "f"]}
    further = {"hypothesis": ["e", "f"]} if draws_anew else {}
    assert _sort_by_mark(try_some("abcdef", 2, 4)) == {"quick": ["a", "c"], "slow": ["b", "d"], **further}
    assert _sort_by_mark(try_some("abcdef", 0, 4)) == {"slow": ["a", "b", "c", "d"], **further}


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


def test_a_sample_keeps_its_own_marks_and_name() -> None:
    named = pytest.param("c", marks=pytest.mark.build, id="third")
    tried = try_some(["a", ("b",), named, "d"], 2)
    assert [(each.values, [mark.name for mark in each.marks], each.id) for each in tried] == [
        (("a",), [], None),
        (("b",), ["slow"], None),
        (("c",), ["build"], "third"),
        (("d",), ["slow"], None),
    ]
