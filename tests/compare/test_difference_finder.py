"""Which differences are one change, and which belong to another."""

from __future__ import annotations

import pytest

from archgen.compare.change_listing import DifferenceFinder, change_order
from archgen.compare.comparison import Change
from archgen.compare.matched_ids import MatchedIds
from tests.compare.conftest import Compared, Told
from tests.compare.elements import pair, some

ROBOT = """\
groups:
  g:
    components:
      a: {functionality: Sees what is there, outputs: {x: T, y: T}}
      b: {functionality: Finds what is lost, inputs: {x: a.x, y: a.y}}
      c: {inputs: {x: a.x}}
nodes:
  na: {implements: a, publishes: {x: {topic: /x}}}
  nb: {implements: b}
"""


def heads(told: Told, *edits: tuple[str, str], base: str = ROBOT) -> list[str]:
    """Edit the robot, and return what changed without the sentences."""
    after = base
    for old, new in edits:
        assert old in after, old
        after = after.replace(old, new)
    return [line.split(": ")[0] for line in told(base, after)]


TWO = ROBOT.replace("  nb:", "  nc: {implements: a, publishes: {y: {topic: /y}}}\n  nb:")
CASES: dict[str, tuple[str, list[tuple[str, str]], list[str]]] = {
    "an output beside one like it is not taken for that": (
        ROBOT,
        [(", y: T}", "}"), (", y: a.y", "")],
        ["removed output g.a.y", "removed input g.b.y", "  removed connection g.b.y"],
    ),
    "a connection to a new output is part of it": (
        ROBOT,
        [("y: T}", "y: T, z: T}"), ("y: a.y", "y: [a.y, a.z]")],
        ["added output g.a.z", "  changed connection g.b.y"],
    ),
    "a connection turned to another output that exists is its own decision": (
        ROBOT,
        [("x: T, y: T", "y: T"), ("c: {inputs: {x: a.x}}", "c: {inputs: {x: a.y}}"), ("{x: a.x, y", "{x: , y"), ("publishes: {x: {topic: /x}}", "package: p")],
        ["removed output g.a.x", "  removed connection g.b.x", "  removed port na.publishes.x", "changed connection g.c.x", "changed node na"],
    ),
    "a component with its ports, connections and what its node says of them": (
        ROBOT,
        [("      c: {inputs: {x: a.x}}\n", "      c: {inputs: {x: a.x}}\n      d: {inputs: {x: a.x}, outputs: {o: T}}\n"), ("  nb:", "  nd: {implements: d, publishes: {o: {topic: /o}}}\n  nb:")],
        ["added component g.d", "  added output g.d.o", "  added input g.d.x", "  added connection g.d.x", "added node nd", "  added port nd.publishes.o"],
    ),
    "what a node says of a port that stays": (
        ROBOT,
        [("publishes: {x: {topic: /x}}", "publishes: {x: {topic: /x}, y: {topic: /y}}")],
        ["changed port na.publishes.y"],
    ),
    "what a node no longer says of a port that stays": (ROBOT, [(", publishes: {x: {topic: /x}}", "")], ["changed port na.publishes.x"]),
    "which of two nodes carries a port": (
        TWO,
        [("publishes: {x: {topic: /x}}", "publishes: {x: {topic: /x}, y: {topic: /y}}"), ("{y: {topic: /y}}}\n  nb", "{x: {topic: /x}}}\n  nb")],
        ["added port na.publishes.y", "added port nc.publishes.x", "removed port nc.publishes.y"],
    ),
    "a port of a node that came": (
        ROBOT,
        [("  nb:", "  nn: {implements: c, internal: {publishes: {s: {topic: /s}}}}\n  nb:")],
        ["added node nn", "  added port nn.internal.publishes.s"],
    ),
    "an internal port of a node that stays": (
        ROBOT,
        [("publishes: {x: {topic: /x}}", "publishes: {x: {topic: /x}}, internal: {publishes: {s: {topic: /s}}}")],
        ["added port na.internal.publishes.s"],
    ),
    "a type that is only used is not there by itself": (ROBOT, [("y: T}", "y: U}")], ["changed output g.a.y"]),
    "a group with all it has": (
        ROBOT,
        [("nodes:", "  h: {components: {d: {outputs: {o: T}}}}\nnodes:")],
        ["added group h", "  added component h.d", "    added output h.d.o"],
    ),
    "a component in a group that is called otherwise": (
        ROBOT.replace("nodes:", "  h: {components: {d: {title: D}}}\nnodes:"),
        [("  g:", "  gg:")],
        ["renamed group gg"],
    ),
    "a component in another group": (
        ROBOT.replace("nodes:", "  h: {components: {d: {title: D}}}\nnodes:"),
        [("      b: {functionality: Finds what is lost, inputs: {x: a.x, y: a.y}}\n", ""), ("{d: {title: D}}", "{d: {title: D}, b: {functionality: Finds what is lost, inputs: {x: a.x, y: a.y}}}")],
        ["moved component h.b"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_changes(told: Told, case: str) -> None:
    base, edits, expected = CASES[case]
    assert heads(told, *edits, base=base) == expected


def test_a_reference_to_what_has_no_output_yet_is_a_connection(told: Told) -> None:
    text = "groups: {g: {components: {a: {title: A}, b: {title: B}, c: {inputs: {x: a}}}}}\n"
    assert heads(told, ("x: a", "x: b"), base=text) == ["changed connection g.c.x"]
    assert heads(told, ("x: a", "x: "), base=text) == ["removed connection g.c.x"]


def test_lost_sources_have_their_old_ids(compared: Compared) -> None:
    after = (
        ROBOT.replace("      a: ", "      eye: ").replace("a.x, y: a.y", "eye.x, y: eye.y").replace("{x: a.x}", "{x: }")
    )
    found = compared(ROBOT, after.replace("implements: a,", "implements: eye,"))
    (change,) = (each for each in found.changes if each.element_kind == "connection")
    assert (change.element_id, change.before, change.after) == ("g.c.x", ["g.a.x"], [])


def test_an_input_that_lost_its_source_has_its_old_id(compared: Compared) -> None:
    text = ROBOT.replace("c: {inputs: {x: a.x}}", "c: {functionality: Shows what there is, inputs: {x: a.x, y: a.y}}")
    after = text.replace("      c: ", "      d: ").replace("there is, inputs: {x: a.x", "there is, inputs: {x: ")
    (lost,) = (each for each in compared(text, after).changes if each.element_kind == "connection")
    (renamed,) = (each for each in compared(text, after).changes if each.kind == "renamed")
    assert (renamed.kind, renamed.element_id, renamed.old_id) == ("renamed", "g.d", "g.c")
    assert (lost.kind, lost.element_kind, lost.element_id) == ("removed", "connection", "g.c.x")


def test_the_order_of_changes() -> None:
    def change(kind: str, element: str, key: str | None = None) -> Change:
        element_kind, name = element.split(" ")
        return Change(kind, element_kind, name, key=key)  # type: ignore[arg-type]

    ordered = [
        change("added", "project robot"),
        change("renamed", "host a"),
        change("moved", "host a"),
        change("removed", "host a"),
        change("added", "host a"),
        change("changed", "host a"),
        change("changed", "host a", "cores"),
        change("changed", "host a", "title"),
        change("added", "host b"),
        change("added", "view a"),
    ]
    assert sorted([*ordered[5:], *ordered[:5]], key=change_order) == ordered


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (ROBOT, ROBOT.replace("      b: {", "      b: [").replace("a.y}}", "a.y}]"), []),
        (ROBOT, ROBOT.replace("a: {functionality", "a: [functionality").replace("y: T}}", "y: T}]"), []),
    ],
)
def test_what_could_not_be_read_did_not_change(told: Told, before: str, after: str, expected: list[str]) -> None:
    assert [line.split(": ")[0] for line in told(before, after)] == expected
    assert [line.split(": ")[0] for line in told(after, before)] == expected


@pytest.mark.parametrize(
    ("before", "after", "lost", "reported"),
    [
        ("g.i <- g.x", "", ("", ""), True),
        ("g.i <- g.x", "", ("", "x"), False),
        ("g.i <- g.x", "", ("", "i"), False),
        ("g.i <- g.x", "", ("x", ""), True),
        ("", "g.i <- g.x", ("x", ""), False),
        ("", "g.i <- g.x", ("", "x"), True),
        ("g.i <- g.x", "g.i <- g.y", ("", "y"), True),
        ("g.i <- g.x", "g.i <- g.y", ("y", ""), False),
    ],
)
def test_a_connection_whose_end_could_not_be_read(
    before: str,
    after: str,
    lost: tuple[str, str],
    reported: bool,  # noqa: FBT001
) -> None:
    ports = some("input g.i", "output g.x", "output g.y")
    versions = pair(ports, ports, (before, after), lost)
    finder = DifferenceFinder(ports, ports, MatchedIds(), versions)
    assert bool(finder.find_all_changes(versions.connections_before, versions.connections_after)) is reported
