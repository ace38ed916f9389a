"""How many examples a property tries, by the markers that were asked for."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import settings

from tests.property_sizes import choose_profile, count_examples


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
