"""What pages of nodes say of their timing."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.lookup import make_lookup
from archgen.views.timing.element_timing import make_node_facts
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """
groups:
  g:
    components:
      slow: {outputs: {a: A}, timing: {rate: 10 Hz, wcet: 20 ms}}
      quick: {inputs: {a: slow.a}, timing: {rate: 50 Hz, wcet: 5 ms}}
types: {A: std_msgs/msg/Bool}
hosts: {pc: {cores: %d, scheduling: fixed_priority}}
nodes:
  slow: {implements: slow, host: pc, timing: {priority: 10}}
  quick: {implements: quick, host: pc, timing: {priority: 20}}
"""


@pytest.mark.parametrize(
    ("cores", "words"),
    [(1, "within 30 ms (by fixed priorities): 20 ms of its own, 10 ms quick"), (2, "within 20 ms (several cores)")],
)
def test_a_response_names_whose_work_it_waits_for(tmp_path: Path, cores: int, words: str) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(ROBOT % cores, encoding="utf-8")
    architecture = check_project(file).architecture
    lookup = make_lookup(architecture, (), timing_lookup=analyse_with_chains(architecture))
    facts = make_node_facts(lookup, architecture.nodes["slow"])
    assert ["".join(part.text for part in fact.value) for fact in facts if fact.title == "Response"] == [words]
