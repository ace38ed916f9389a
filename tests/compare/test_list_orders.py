"""Comparing and merging agree on what a list is: where the order says nothing, both sides may add to it."""

from __future__ import annotations

import pytest

from archgen.merge.file_merge import merge_contents
from tests.compare.conftest import Compared

ROBOT = """\
archgen: 1
project: {id: r, title: R}
partners: {p: P, q: {title: Q, reviewers: [ada, bob]}}
requirements: {R-1: {title: One}, R-2: Two, R-3: {title: Three, parent: [R-1, R-2]}}
groups:
  g:
    owner: p
    components:
      a: {outputs: {x: T, y: T, z: T}, tags: [fast, safe], requirements: [R-1, R-2]}
      b: {inputs: {x: a.x, y: a.y, z: [a.x, a.z]}, timing: {trigger: [x, y], wcet: 1 ms}, open: [front, rear]}
      c: {inputs: {x: {from: [a.x, a.y]}}, timing: {trigger: {all: [x]}, wcet: 1 ms, cores: [0, 1]}}
hosts: {pc: {cores: 4}, arm: , eye: }
links: {lan: {connects: [pc, arm]}}
nodes:
  a: {implements: a, host: pc}
  b: {implements: [b, c], host: pc, start: {after: [a, m]}, callback_groups: {one: [b, c]}}
  m: {kind: program, command: [run, fast], start: [a, o]}
  o: {kind: program, command: [other]}
chains: {k: {through: [a, b], requirements: [R-1, R-2]}}
variants: {low: Low, sim: {drop: [links.lan, chains.k]}}
"""


@pytest.mark.parametrize(
    "listed",
    [
        "reviewers: [ada, bob]",
        "parent: [R-1, R-2]",
        "tags: [fast, safe]",
        "requirements: [R-1, R-2]",
        "z: [a.x, a.z]",
        "trigger: [x, y]",
        "open: [front, rear]",
        "from: [a.x, a.y]",
        "cores: [0, 1]",
        "connects: [pc, arm]",
        "implements: [b, c]",
        "after: [a, m]",
        "one: [b, c]",
        "start: [a, o]",
        "drop: [links.lan, chains.k]",
    ],
)
def test_where_a_turned_list_compares_equal_both_sides_may_add_to_it(compared: Compared, listed: str) -> None:
    assert listed in ROBOT
    key, _, items = listed.removesuffix("]").partition("[")
    first, second = items.split(", ")
    assert not compared(ROBOT, ROBOT.replace(listed, f"{key}[{second}, {first}]")).changes
    ours, theirs = (ROBOT.replace(listed, f"{key}[{items}, {more}]", 1) for more in ("n1", "n2"))
    merged = merge_contents(ROBOT.encode(), ours.encode(), theirs.encode())
    assert merged.content == ROBOT.replace(listed, f"{key}[{items}, n1, n2]", 1).encode()


@pytest.mark.parametrize("listed", ["through: [a, b]", "command: [run, fast]"])
def test_where_a_turned_list_is_a_change_what_both_add_is_a_conflict(compared: Compared, listed: str) -> None:
    key, _, items = listed.removesuffix("]").partition("[")
    first, second = items.split(", ")
    assert compared(ROBOT, ROBOT.replace(listed, f"{key}[{second}, {first}]")).changes
    ours, theirs = (ROBOT.replace(listed, f"{key}[{items}, {more}]") for more in ("n1", "n2"))
    assert merge_contents(ROBOT.encode(), ours.encode(), theirs.encode()).problem
