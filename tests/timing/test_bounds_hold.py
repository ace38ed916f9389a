"""No simulation exceeds a bound: over random architectures with every kind of element. `make bench` runs ten times as many."""

from __future__ import annotations

import pytest

from tests.property_sizes import try_some
from tests.timing.exceeded import exceeded
from tests.timing.random_styles import STYLES, random_style_text
from tests.timing.random_systems import random_text


@pytest.mark.parametrize("first", try_some(range(0, 300, 25), 1, 6))
def test_no_simulation_exceeds_a_bound(first: int) -> None:
    found = {seed: exceeded(random_text(seed), seconds=1, seeds=3) for seed in range(first, first + 25)}
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 100


@pytest.mark.parametrize("first", try_some(range(0, 210, 35), 1, 3))
def test_no_simulation_exceeds_a_bound_of_many_on_one_host(first: int) -> None:
    found = {seed: exceeded(random_style_text(seed), seconds=1, seeds=4) for seed in range(first, first + 35)}
    assert {(seed, STYLES[seed % len(STYLES)]): wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 1000


def test_what_every_drops_is_not_lost_behind_a_job_that_still_waits() -> None:
    """`n10` works at every second message. One that is dropped while a job waits for a core is newer than that job's."""
    assert exceeded(random_style_text(4103), seconds=1, seeds=4)[0] == []
