"""Which changes are edits of whose elements. tests/cli/test_foreign_edits.py has the table of the gate, with real authors."""

from __future__ import annotations

import pytest

from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.weakened_outputs import find_foreign_edits
from archgen.compare.review_facts import ReviewFacts
from tests.compare.conftest import Compared

ROBOT = """\
partners: {p: P, q: Q, r: R}
review: {breaking: {wire: off, promise: off, meaning: off, source: off, foreign: error}}
groups:
  g:
    owner: p
    components:
      a: {outputs: {x: T, y: T}}
      b: {owner: [q, p], inputs: {x: a.x}}
      c: {owner: q, inputs: {x: a.x}}
  h: {components: {d: {inputs: {x: a.x}}}}
types: {T: {message: std_msgs/msg/Int8}}
nodes:
  a: {implements: a, publishes: {x: {topic: /x}}}
  c: {implements: c, owner: r}
  d: d
chains: {go: {through: [a, c], deadline: 1 s}}
"""
EDITS = [
    ("a: {outputs", "a: {title: Eye, outputs", ["p"]),
    ("inputs: {x: a.x}}\n      c", "inputs: {x: a.y}}\n      c", ["q"]),
    ("topic: /x", "topic: /y", ["p"]),
    ("x: T, y: T", "x: T", ["p"]),
    ("x: T, y: T", "x: T, y: T, z: T", ["p"]),
    # A component of another owner in a group is that owner's; the group is the group's.
    ("      c: {owner: q, inputs: {x: a.x}}\n", "", ["q"]),
    ("      c: {owner", "      e: {}\n      c: {owner", ["p"]),
    ("d: {inputs", "e: {}\n      d: {inputs", []),
    # A node may belong to somebody else than its component.
    ("owner: r", "owner: r, package: k", ["r"]),
    ("  d: d", "  d: d\n  c2: {implements: c}", ["q"]),
    ("    owner: p", "    owner: r", ["p"]),
    ("partners: {p: P", "partners: {p: {title: P, contact: Pia}", ["p"]),
    ("deadline: 1 s", "deadline: 2 s", []),
    ("types: {T: {", "types: {T: {comment: Says, ", []),
    # References follow.
    ("a: {outputs: {x: T, y: T}}", "one: {outputs: {x: T, y: T}}", ["p"]),
]


@pytest.mark.parametrize(("old", "new", "owners"), EDITS)
def test_the_owner_of_what_is_written_is_named(compared: Compared, old: str, new: str, owners: list[str]) -> None:
    edited = ROBOT.replace(old, new, 1)
    if new.startswith("one: "):
        edited = (
            edited.replace("a.x", "one.x").replace("implements: a,", "implements: one,").replace("[a, c]", "[one, c]")
        )
    assert edited != ROBOT
    comparison = compared(ROBOT, edited)
    found = {(each.partner, each.category) for change in comparison.changes for each in change.breaks}
    assert sorted(found) == [(owner, "foreign") for owner in owners]


def test_nobody_is_asked_where_the_policy_does_not(compared: Compared) -> None:
    silent = ROBOT.replace("foreign: error", "foreign: off")
    assert not any(change.breaks for change in compared(silent, silent.replace("owner: r", "owner: p")).changes)


@pytest.mark.parametrize(
    ("followers", "facts", "count"),
    [((), ReviewFacts(), 1), (None, ReviewFacts(), 0), ((), ReviewFacts(is_decided=True), 0)],
)
def test_who_is_judged_elsewhere_is_not_judged_again(
    compared: Compared, followers: tuple[int, ...] | None, facts: ReviewFacts, count: int
) -> None:
    found = compared(ROBOT, ROBOT.replace("topic: /x", "topic: /y"))
    sides = found.before.architecture, found.after.architecture
    context = ChangeContext(*sides, found.matched_ids, found.versions, found.changes, facts, followers)
    assert len(list(find_foreign_edits(context))) == count
