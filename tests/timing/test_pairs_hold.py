"""No simulation exceeds a bound where two features of the language meet: each pair of them, at least 30 systems each."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.property_sizes import DRAWS_ANEW, count_examples, try_some
from tests.timing.exceeded import exceeded_by
from tests.timing.random_pairs import list_pairs, random_pair_text, read_variants

_SYSTEMS = 55 if DRAWS_ANEW else 30
"""Of each of the 91 pairs: 5,000 in all are drawn anew by `make properties`."""


@pytest.mark.parametrize(("first", "second"), try_some(list_pairs()))
@given(seed=st.integers(0, 10**9))
@settings(max_examples=count_examples(_SYSTEMS))
def test_no_simulation_exceeds_a_bound_where_two_features_meet(first: str, second: str, seed: int) -> None:
    text = random_pair_text((first, second), seed)
    with tempfile.TemporaryDirectory() as place:
        wrong = [exceeded_by(model, seconds=1, seeds=2)[0] for model in read_variants(text, Path(place))]
    assert wrong == [[]] * len(wrong)


def test_each_pair_is_in_the_systems_that_are_drawn_for_it() -> None:
    """All pairs hold many bounds: nothing that a feature brings leaves all figures open."""
    held = 0
    with tempfile.TemporaryDirectory() as place:
        for number, pair in enumerate(list_pairs()[::9]):
            for model in read_variants(random_pair_text(pair, number), Path(place)):
                held += exceeded_by(model, seconds=1, seeds=1)[1]
    assert held > 250


@pytest.mark.parametrize(
    ("pair", "seed"),
    [
        (("services", "dropped"), 153),  # a core given up before its turn had no storing wait
        (
            ("GPU", "variants"),
            1253006,
        ),  # who shares a callback group with a user of a GPU on another core waits for its use
    ],
)
def test_what_once_failed_holds(pair: tuple[str, str], seed: int) -> None:
    with tempfile.TemporaryDirectory() as place:
        models = list(read_variants(random_pair_text(pair, seed), Path(place)))
        assert [exceeded_by(model, seconds=1, seeds=3)[0] for model in models] == [[]] * len(models)
