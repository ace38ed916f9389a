"""What a try costs, and what counts as harm to other chains."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

from archgen.timing.analysis import ChainResult, ChainVerdict
from archgen.timing.search import change_trials
from archgen.timing.search.change_trials import Changes, TriedChange
from tests.timing.random_systems import architecture
from tests.timing.search.trials import start_trials
from tests.timing.sketches import sketch

TEXT = sketch(
    {"a @p": "period: 100 ms, wcet: 1 ms", "b @p": "wcet: 3 ms"},
    "a>b",
    "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 1 s}, other: {through: [b], deadline: 1 s}}",
)
CHANGE = (TriedChange("a", "timing.period", "50ms"),)


@pytest.mark.parametrize(
    ("before", "after", "is_harmed"),
    [
        ("met", "met", False),
        ("met", "open", True),
        ("met", "not proven", True),
        ("open", "not proven", False),
        ("not proven", "open", False),
        ("open", "missed", True),
        ("not proven", "missed", True),
        ("missed", "met", False),
    ],
)
def test_a_chain_is_harmed_by_a_worse_verdict_and_nobody_knows_which_of_two_open_ones_is(
    monkeypatch: pytest.MonkeyPatch,
    before: ChainVerdict,
    after: ChainVerdict,
    is_harmed: bool,  # noqa: FBT001
) -> None:
    trials = start_trials(architecture(TEXT))

    def bound_chain(_: str, changes: Changes = ()) -> ChainResult:
        return cast("ChainResult", SimpleNamespace(verdict=after if changes else before))

    monkeypatch.setattr(trials, "bound_chain", bound_chain)
    assert trials.harms_others("c", CHANGE) is is_harmed


def test_a_long_search_costs_more_than_one_try(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(change_trials, "_TERMS_PER_TRY", 1)
    trials = start_trials(architecture(TEXT), tries=1000)
    trials.bound_chain("c", CHANGE)
    assert trials.tries_left < 999
