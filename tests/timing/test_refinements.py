"""Each refinement of the bounds that benchmarks/refinements.py switches off stands where it looks for it."""

from __future__ import annotations

import pytest

from benchmarks.refinements import REFINEMENTS, Refinement, find_function, without


@pytest.mark.parametrize("refinement", REFINEMENTS, ids=lambda each: each.title)
def test_a_refinement_is_switched_off_for_a_while(refinement: Refinement) -> None:
    code = find_function(refinement.place).__code__
    with without(refinement):
        assert find_function(refinement.place).__code__ != code
    assert find_function(refinement.place).__code__ is code
