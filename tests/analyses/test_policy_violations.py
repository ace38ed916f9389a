"""Tests of policies: what may not flow, over topics and services, directly and by selectors that reach further."""

from __future__ import annotations

import pytest

from tests.judged_projects import check_text

_ROBOT = """\
groups:
  reasoning:
    components:
      reasoner: {outputs: {goal: Goal, thought: Goal}}
      watcher: {inputs: {check: base.check}}
  driving:
    components:
      planner: {inputs: {goal: reasoner}, outputs: {command: Command}}
      base: {role: sink, inputs: {command: planner.command, loop: base.echo}, outputs: {check: Check, echo: Goal}}
types:
  Goal: geometry_msgs/msg/PoseStamped
  Command: geometry_msgs/msg/Twist
  Check: std_srvs/srv/Trigger
"""
_CHECK = "5: `driving.base.check` goes to `reasoning.watcher.check`"


def _found(tails: str, heads: str) -> list[str]:
    text = f'{_ROBOT}policies: {{p: {{title: Not so, forbid: {{from: "{tails}", to: "{heads}"}}}}}}\n'
    return [f"{d.span.line}: {d.message}" for d in check_text(text) if d.rule == "forbidden-flow"]


@pytest.mark.parametrize(
    ("tails", "heads", "flows"),
    [
        (
            "reasoning",
            "planner",
            ["8: `reasoning.reasoner.goal` and `reasoning.reasoner.thought` go to `driving.planner.goal`"],
        ),
        ("reasoner", "base", []),
        ("reasoner+", "base", ["9: `driving.planner.command` goes to `driving.base.command`", _CHECK]),
        ("planner", "role:sink", ["9: `driving.planner.command` goes to `driving.base.command`"]),
        ("base", "planner", []),
        # A service carries data both ways.
        ("watcher", "base", [_CHECK]),
        ("base", "watcher", [_CHECK]),
        # What a component sends itself is no flow.
        ("base", "base", []),
    ],
)
def test_a_policy_forbids_direct_flows(tails: str, heads: str, flows: list[str]) -> None:
    forbids = ", which the policy `p` forbids: Not so"
    assert sorted(_found(tails, heads)) == sorted(f"{flow}{forbids}" for flow in flows)
