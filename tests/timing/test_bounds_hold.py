"""No simulation exceeds a bound: over random architectures with every kind of element. `make bench` runs ten times as many."""

from __future__ import annotations

import pytest

from tests.timing.exceeded import exceeded
from tests.timing.random_systems import random_text


@pytest.mark.parametrize("first", range(0, 500, 50))
def test_no_simulation_exceeds_a_bound(first: int) -> None:
    found = {seed: exceeded(random_text(seed), seconds=1, seeds=4) for seed in range(first, first + 50)}
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 350
