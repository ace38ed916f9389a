"""A chain that ends at an element that runs beside itself: what began earlier may end later, and replace what was sent."""

from __future__ import annotations

from archgen.simulation import simulate_system
from archgen.timing.chains.chain_bounds import bound_all_chains, find_data_age
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.exceeded import exceeded
from tests.timing.random_systems import architecture
from tests.timing.task_sets import MS

OVERTAKEN = """\
groups: {g: {components: {n0: {outputs: {x: {type: T, external: World}}}, n1: {inputs: {x: n0.x}, outputs: {y: T}}}}}
nodes:
  n0: {implements: n0, host: h, timing: {behaviour: periodic, period: 22 ms, jitter: 0 ms, wcet: 0 ms, bcet: 0 ms}}
  n1: {implements: n1, host: h, threads: 8, reentrant: true, timing: {behaviour: event, wcet: 25 ms, bcet: 1 ms}}
hosts: {h: {cores: 8}}
chains: {c: {through: [n0, n1], deadline: 60 ms}}
"""
TWO_TRIGGERS = """\
groups:
  g:
    components:
      n0: {outputs: {x: {type: T, external: World}}}
      n1: {inputs: {x: n0.x}, outputs: {y: T}}
      n2: {inputs: {x: n0.x, y: n1.y}, outputs: {z: T}}
nodes:
  n0: {implements: n0, host: h, timing: {behaviour: periodic, period: 100 ms, jitter: 0 ms, wcet: 1 ms, bcet: 1 ms}}
  n1: {implements: n1, host: h, timing: {behaviour: event, wcet: 5 ms, bcet: 1 ms}}
  n2: {implements: n2, host: h, threads: 3, reentrant: true, timing: {behaviour: event, wcet: 10 ms, bcet: 1 ms}}
hosts: {h: {cores: 8}}
chains: {c: {through: [n0, n2], deadline: 150 ms}}
"""


def test_what_is_replaced_by_older_data_is_older_than_the_reaction_is_late() -> None:
    analysis = analyse_architecture(architecture(OVERTAKEN))
    result = bound_all_chains(analysis, architecture(OVERTAKEN))["c"]
    age = find_data_age(CostNetwork.of_analysis(analysis), result)
    seen = simulate_system(analysis.system, 5, 8, {"c": result.through}).chains["c"]
    assert seen.all_inputs.age is not None
    assert result.bound.value is not None
    assert age.value is not None
    assert result.bound.value < seen.all_inputs.age.largest <= age.value
    assert seen.all_inputs.age.largest == 69 * MS
    assert any(
        "n1 runs beside itself, and may send older data after newer" in note for note in result.bound.assumptions
    )


def test_what_is_seen_stays_below_what_is_printed() -> None:
    for text in (OVERTAKEN, TWO_TRIGGERS):
        assert exceeded(text, 5, 8)[0] == []


def test_an_element_whose_outputs_come_in_order_adds_nothing() -> None:
    model = architecture(OVERTAKEN.replace("reentrant: true", "reentrant: false"))
    analysis = analyse_architecture(model)
    result = bound_all_chains(analysis, model)["c"]
    assert find_data_age(CostNetwork.of_analysis(analysis), result) == result.bound
