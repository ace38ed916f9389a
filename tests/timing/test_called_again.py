"""Data age where a call makes an element use its data again."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.simulation import simulate_system
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS

Derived = Callable[[str], Architecture]

CALLED = """
groups:
  g:
    components:
      fast: {outputs: {out: Data}}
      slow: {outputs: {out: Data}}
      both: {inputs: {a: fast.out, b: slow.out}, outputs: {out: Data, ask: Ask}}
      client: {inputs: {ask: both.ask}}
      sink: {inputs: {go: both.out}}
types: {Data: {message: std_msgs/msg/String}, Ask: {message: std_srvs/srv/Trigger}}
nodes:
  fast: {implements: fast, timing: {period: 10 ms, wcet: 0 ms, bcet: 0 ms}}
  slow: {implements: slow, timing: {period: 60 ms, wcet: 0 ms, bcet: 0 ms}}
  both: {implements: both, timing: {trigger: {all: [a, b]}, wcet: 1 ms, bcet: 1 ms}}
  client: {implements: client, timing: {period: 15 ms, wcet: 0 ms, bcet: 0 ms}}
  sink: {implements: sink, timing: {wcet: 1 ms, bcet: 1 ms}}
chains: {way: {through: [fast, both, sink]}}
"""


def test_a_call_uses_again_what_came_together_last(derived: Derived) -> None:
    """A sample of fast is taken when slow completes the pair, each 60 ms, and each call works with it until the next: it is
    up to 10 + 60 old then. In both and in sink a job
    may wait for one of the other kind: 2 ms each.
    """
    architecture = derived(CALLED)
    found = analyse_architecture(architecture)
    way = bound_all_chains(found, architecture)["way"]
    assert way.reduced_age.value == (10 + 60 + 2 + 2) * MS
    seen = simulate_system(found.system, 2, 6, {"way": way.through}).chains["way"].all_inputs.reduced_age
    assert seen is not None
    assert 50 * MS < seen <= way.reduced_age.value
