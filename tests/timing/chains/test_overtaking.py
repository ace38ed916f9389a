"""What a reentrant source sends may come in another order than its activations: readers that wait are longer without it."""

from __future__ import annotations

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture

PROJECT = """
groups:
  g:
    components:
      src: {outputs: {out: Data}}
      use: {inputs: {in: g.src.out}}
types: {Data: std_msgs/msg/Empty}
hosts: {pc: {cores: 4}, other: {cores: 1}}
links: {lan: {connects: [pc, other], latency: 0 ms}}
nodes:
  src: {implements: g.src, host: pc, threads: 3, reentrant: REENTRANT, timing: {period: 40 ms, jitter: JITTER, wcet: 15 ms, bcet: 1 ms}}
  use: {implements: g.use, host: other, timing: {period: 100 ms, wcet: 1 ms}}
chains: {c: {through: [g.src, g.use]}}
"""


@pytest.mark.parametrize(
    ("reentrant", "jitter", "why"),
    [
        # R is 15 ms and two more activations in three threads: 15 + 2 x 15 / 3. What began before a message has ended 25 ms after
        # its activation; the next one begins 40 + 30 ms later at most.
        ("true", "30 ms", "reads /g/src/out every 100 ms at the latest, which an older one may replace for 95 ms"),
        # 15 ms less 1 ms are no more than lie between two activations: none overtakes another.
        ("true", "0 ms", "reads /g/src/out every 100 ms at the latest"),
        ("false", "30 ms", "reads /g/src/out every 100 ms at the latest"),
    ],
)
def test_a_newer_message_may_be_replaced_by_an_older_one(reentrant: str, jitter: str, why: str) -> None:
    model = architecture(PROJECT.replace("REENTRANT", reentrant).replace("JITTER", jitter))
    analysis = analyse_architecture(model)
    (chain,) = bound_all_chains(analysis, model).values()
    assert chain.terms[1].why == why
