"""What a try costs, and what comes of a change that makes no sense."""

from __future__ import annotations

import pytest

from archgen.timing.search import change_trials
from archgen.timing.search.change_trials import TriedChange, TriesSpentError
from tests.timing.random_systems import architecture
from tests.timing.search.trials import start_trials
from tests.timing.sketches import sketch

TEXT = sketch(
    {"a @p": "period: 100 ms, wcet: 1 ms", "b @p": "wcet: 3 ms, bcet: 3 ms"},
    "a>b",
    "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 1 s}, other: {through: [b], deadline: 1 s}}",
)
CHANGE = (TriedChange("a", "timing.period", "50ms"),)


def test_a_long_search_costs_more_than_one_try(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(change_trials, "_TERMS_PER_TRY", 1)
    trials = start_trials(architecture(TEXT), tries=1000)
    trials.find_slack("c", CHANGE)
    assert trials.tries_left < 999


def test_an_analysis_is_one_try_and_what_was_tried_is_none() -> None:
    trials = start_trials(architecture(TEXT), tries=10)
    tries_left = [trials.tries_left]
    for changes in ((), CHANGE, CHANGE):
        trials.find_slack("c", changes)
        trials.find_slack("other", changes)
        trials.find_floors(changes)
        tries_left.append(trials.tries_left)
    assert tries_left == [10, 10, 9, 9]


def test_no_more_is_tried_than_is_allowed() -> None:
    trials = start_trials(architecture(TEXT), tries=1)
    trials.find_slack("c", CHANGE)
    with pytest.raises(TriesSpentError):
        trials.find_slack("c", (TriedChange("a", "timing.period", "60ms"),))


def test_a_change_that_makes_no_sense_proves_nothing() -> None:
    """No execution time is below the best one."""
    trials = start_trials(architecture(TEXT))
    senseless = (TriedChange("b", "timing.wcet", "2ms"),)
    assert trials.find_slack("c", senseless) is None
    assert trials.find_floors(senseless) == {}
    assert trials.find_slack("c", (TriedChange("b", "timing.wcet", "4ms"),)) == 895 * 10**6
