"""What the reasons of a chain say of runs: what a step takes with all that fires it on its core."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.analysis import RunResponse
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.figures.timing_values import UNKNOWN_VALUE
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import read_sketch


@pytest.mark.parametrize(
    ("is_known", "ending"),
    [
        (True, ": with what fires it on its core 5 ms, of which 2 ms are counted already: 5 ms - 2 ms = 3 ms"),
        (False, ""),
    ],
)
def test_the_time_of_a_step_is_the_rest_of_a_run_whose_time_is_known(is_known: bool, ending: str) -> None:  # noqa: FBT001
    nodes = {"a @pc": "period: 100 ms, wcet: 2 ms, priority: 2", "b @pc": "behaviour: event, wcet: 3 ms, priority: 1"}
    model = read_sketch(nodes, "a>b", "hosts: {pc: {cores: 1}}\nchains: {c: {through: [a, b]}}")
    analysis = analyse_architecture(model)
    chains = bound_all_chains(analysis, model)
    shown = analysis if is_known else replace(analysis, runs={"b": RunResponse(UNKNOWN_VALUE, ())})
    assert f"b takes 3 ms at most{ending}" in [line.text for line in explain_word(shown, chains, "c")]
