"""Each refinement of the bounds that benchmarks/refinements.py switches off stands where it looks for it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest

_BENCHMARK = import_module("benchmarks.refinements")


@pytest.mark.parametrize("refinement", _BENCHMARK.REFINEMENTS, ids=lambda each: each.title)
def test_a_refinement_is_switched_off_for_a_while(refinement: Any) -> None:  # noqa: ANN401 - benchmarks are no package
    code = _BENCHMARK.find_function(refinement.place).__code__
    with _BENCHMARK.without(refinement):
        assert _BENCHMARK.find_function(refinement.place).__code__ != code
    assert _BENCHMARK.find_function(refinement.place).__code__ is code
