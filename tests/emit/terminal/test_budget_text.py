"""The budget of a chain as it is printed, and as data: whose element may take how much."""

from __future__ import annotations

from archgen.emit.terminal.chain_text import budget_to_json, format_budget
from archgen.timing.search.chain_budgets import find_chain_budget
from tests.timing.random_systems import architecture
from tests.timing.search.trials import bound_with, start_trials

TEXT = """
partners: {north: {title: North}, south: South}
groups:
  g:
    components:
      scan: {outputs: {out: Data}, owner: north}
      last: {inputs: {i: scan.out}, owner: south}
      beside: {outputs: {out: Data}}
nodes:
  scan: {implements: scan, host: p, timing: {rate: 10 Hz, wcet: 1 ms}}
  last: {implements: last, host: p, owner: [north, south], timing: {wcet: 20 ms}}
  beside: {implements: beside, host: p, timing: {period: 1 s, wcet: 9 ms}}
hosts: {p: {cores: 1}}
types: {Data: std_msgs/msg/Empty}
chains: {c: {through: [scan, last], deadline: 150 ms}}
"""


def test_partners_see_what_each_may_take() -> None:
    trials = start_trials(architecture(TEXT))
    result = bound_with(trials.architecture)["c"]
    budget = find_chain_budget(trials, result)
    assert list(format_budget(result, budget, {"north": "North", "south": "South"}, 200)) == [
        "c: 130 ms, deadline 150 ms, met, 20 ms left",
        "",
        "Each alone, all else as it is written: so much keeps the deadline",
        "  element  figure          written  at most",
        "  scan     execution time  1 ms     21 ms",
        "  last     execution time  20 ms    40 ms",
        "  scan     one every       100 ms   120 ms",
        "  beside   execution time  9 ms     29 ms",
        "",
        "All execution times of a host alone",
        "  p  may grow by the factor 1.666",
        "",
        "All together, each times 1.666: who may take how much",
        "  partner       element  written  may take",
        "  North         scan     1 ms     1.666 ms",
        "  North, South  last     20 ms    33.32 ms",
        "  nobody        beside   9 ms     14.994 ms  beside the chain",
    ]
    document = budget_to_json(result, budget)
    assert (document["slack"], document["factor"], document["hosts"]) == (
        20,
        1.666,
        {"p": {"factor": 1.666, "free": False}},
    )
    assert document["shares"][0] == {
        "owners": ["north"],
        "element": "scan",
        "figure": "wcet",
        "written": 1,
        "may_take": 1.666,
        "on_chain": True,
    }
