"""Rules on rules for names, where several speak of one change; one by one they are in cases/remapped_names.txt."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

from archgen.analyses import remapped_names
from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]

ROBOT = """
groups: {{g: {{components: {{a: {{outputs: {{o: std_msgs/msg/Bool}}}}, b: {{inputs: {{i: a.o}}}}}}}}}}
nodes:
  sup: {{implements: a, publishes: {{o: /safety}}, {rules}}}
  reader: {{implements: b, subscribes: {{i: /safety}}}}
"""


def find_rules(architecture: Architecture) -> list[str]:
    """Return what is found, by rule and severity."""
    found = [(each, severity) for rule, severity in remapped_names.RULES for each in rule(architecture)]
    return [f"{each.rule} {each.severity or severity}" for each, severity in found]


@pytest.mark.parametrize(
    ("rules", "found"),
    [
        ("remaps: {/safety: /safety_raw}", ["remapped-away error"]),
        ('arguments: ["--ros-args", "-r", "/safety:=/safety_raw"]', ["remapped-away error"]),
        ('arguments: ["/safety:=/safety_raw"]', ["remapped-away error"]),
        ("remaps: {safety: /safety_raw}", ["remapped-away error"]),
        ("namespace: /a, remaps: {safety: /safety_raw}", ["unused-remap warning"]),
        ("remaps: {/safty: /safety_raw}", ["unused-remap warning"]),
        ('arguments: ["--ros-args", "-r", "__ns:=/b"]', []),
        ('arguments: ["--ros-args", "-r", "other:/safety:=/x"]', []),
        ("remaps: {/safety: /x, /x: /safety}", ["unused-remap warning", "remapped-away error"]),
        ('arguments: ["--ros-args", "-r", "/safety:=/safety"], remaps: {/safety: /x}', ["repeated-remap note"]),
        ("remaps: {/safety: /a/1b}", ["invalid-remap error"]),
        ("kind: program, command: [run], arguments: ['/safety:=/x']", []),
    ],
)
def test_a_rule_is_told_once(derived: Derived, rules: str, found: list[str]) -> None:
    assert find_rules(derived(ROBOT.format(rules=rules))) == found


@pytest.mark.parametrize(
    ("other", "severity"),
    [
        ("{status: existing, package: p, executable: e}", "note"),
        ("{status: planned, package: p, executable: e}", "error"),
        ("{status: existing, kind: program, command: [run]}", "error"),
        ("{status: existing, package: p, executable: e, publishes: {/other: {message: std_msgs/msg/Bool}}}", "error"),
    ],
)
def test_only_an_existing_node_of_which_nothing_is_known_may_write_what_is_missed(
    derived: Derived, other: str, severity: str
) -> None:
    robot = ROBOT.format(rules="remaps: {/safety: /safety_raw}")
    assert find_rules(derived(f"{robot}  other: {other}\n")) == [f"remapped-away {severity}"]


def test_a_reader_that_follows_is_no_loss(derived: Derived) -> None:
    rules = "remaps: {/safety: /safety_raw}"
    reader = "subscribes: {i: /safety}"
    followed = ROBOT.format(rules=rules).replace(reader, f"{reader}, {rules}")
    assert find_rules(derived(followed)) == []


def test_thousands_of_rules_are_judged_quickly(derived: Derived) -> None:
    rules = ", ".join(f"/wrong_{i}: /y_{i}" for i in range(2000))
    architecture = derived(ROBOT.format(rules=f"remaps: {{{rules}}}"))
    start = time.process_time()
    assert len(find_rules(architecture)) == 2000
    assert time.process_time() - start < 5
