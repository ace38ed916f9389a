"""What partners lose: who is named, how many, and by which change."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from archgen.compare import Change
from archgen.compare.comparison import ChangeKind
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name, tick_sorted_names
from archgen.compare.losses.fallen_figures import _has_grown as has_grown
from archgen.compare.losses.fallen_figures import _lateness_reason as lateness_reason
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.losses.weakened_demands import _drops_requirement as drops_requirement
from archgen.compare.matched_ids import MatchedIds
from archgen.timing.figures.timing_values import TimingValue
from tests.compare.conftest import Compared
from tests.compare.elements import by_key, element, pair
from tests.compare.losses.test_losses import BASE, broken
from tests.compare.losses.test_missed_deadlines import BASE as TIMED

BEFORE = by_key(
    element("output g.a.x", owner="certh", own_id="g.old.x"),
    element("input g.b.i", owner="sssa"),
    element("input g.b.j", owner="sssa", optional=True),
    element("host pc", owner="certh"),
    element("port n.publishes.x", parent="node n", refs="g.a.x"),
    element("port n.internal.publishes.s", parent="node n"),
    element("port n.publishes.gone", parent="node n", refs="g.a.gone"),
)
AFTER = by_key(
    element("output g.a.x", owner="certh"),
    element("input g.b.i", owner="tum"),
    element("input g.b.j", owner="tum", optional=True),
    element("output g.c.x"),
    element("port n.publishes.x", parent="node n", refs="g.a.x"),
    element("port n.internal.publishes.s", parent="node n"),
    element("port n.publishes.new", parent="node n", refs="g.a.new"),
)


def context(*changes: Change, matched: MatchedIds | None = None) -> ChangeContext:
    nobody = cast("Any", SimpleNamespace(partners={}))
    return ChangeContext(nobody, nobody, matched or MatchedIds(), pair(BEFORE, AFTER), changes)


def change(kind: ChangeKind, key: str, name: str | None = None, *parts: Change) -> Change:
    element_kind, element_id = key.split(" ")
    return Change(kind, element_kind, element_id, key=name, parts=parts)


def test_changes_are_found_by_element_key_and_kind() -> None:
    part = change("removed", "output g.a.x")
    found = context(
        change("removed", "component g.a", None, part),
        change("changed", "output g.a.x", "type"),
        change("changed", "output g.a.x", "medium"),
        change("changed", "output g.a.x", "type"),
        change("renamed", "output g.a.x"),
    )
    assert found.change_indices("output", "g.a.x") == [0, 1, 2, 3, 4]
    assert found.change_indices("output", "g.a.x", "type") == [1, 3]
    assert found.change_indices("output", "g.a.x", "type", "medium") == [1, 2, 3]
    assert found.change_indices("output", "g.a.y") == []
    assert found.indices_by_change_kind("output", "g.a.x", "removed") == [0]
    assert found.indices_by_change_kind("output", "g.a.x", "removed", "renamed") == [0, 4]
    assert [index for index, _ in found.find_changes("component", "g.a")] == [0]


def test_removed_elements_are_found_by_their_common_id() -> None:
    matched = MatchedIds()
    matched.add_pair("output", "g.old.x", "g.a.x")
    matched.add_pair("input", "g.old.i", "g.b.i")
    found = context(
        change("removed", "output g.old.x"),
        change("changed", "output g.old.x", "type"),
        change("removed", "connection g.old.i"),
        matched=matched,
    )
    assert found.change_indices("output", "g.a.x") == [0]
    assert found.change_indices("connection", "g.b.i") == [2]
    assert found.owners_of_change(0) == {"certh"}
    assert found.owners_of_change(2) == frozenset()  # the input changed hands


def test_owners() -> None:
    found = context()
    assert found.lasting_owners("output", "g.a.x") == {"certh"}
    assert found.lasting_owners("input", "g.b.i") == frozenset()
    assert found.lasting_owners("host", "pc") == {"certh"}
    assert found.lasting_owners("output", "g.c.x") == frozenset()
    assert found.owner_before("input", "g.b.i") == "sssa"
    assert found.owner_before("output", "g.c.x") is None
    assert found.old_id("output", "g.a.x") == "g.old.x"
    assert found.old_id("output", "g.c.x") == "g.c.x"
    assert [found.needs_source(name) for name in ("g.b.i", "g.b.j", "g.b.gone")] == [True, False, False]


def test_what_nodes_say_of_ports() -> None:
    found = context(
        change("changed", "port n.publishes.x", "topic"),
        change("changed", "port n.publishes.x", "qos"),
        change("removed", "port n.publishes.x"),
        change("changed", "port n.internal.publishes.s", "topic"),
        change("changed", "port m.publishes.x", "topic"),
        change("removed", "port n.publishes.gone"),
        change("added", "port n.publishes.new"),
    )
    assert found.port_change_indices("n", "g.a.x") == [0, 1, 2]
    assert found.port_change_indices("n", "g.a.x", "topic") == [0, 2]
    assert found.port_change_indices("n", "g.a.x", "qos", "topic") == [0, 1, 2]
    assert found.port_change_indices("n", "") == [3]
    assert found.port_change_indices("n", "g.a.y") == []
    assert found.port_change_indices("n", "g.a.gone") == [5]
    assert found.port_change_indices("n", "g.a.new") == [6]


@pytest.mark.parametrize(
    ("parts", "verb", "reasons"),
    [
        ({"sssa": ["a"]}, "runs", ["sssa: on `pc`, where `a` of sssa runs"]),
        ({"sssa": ["a"]}, "is", ["sssa: on `pc`, where `a` of sssa is"]),
        ({"sssa": ["b", "a"]}, "uses", ["sssa: on `pc`, where `a` and `b` of sssa use"]),
        (
            {"tum": ["a"], "certh": ["z"], "sssa": ["b"]},
            "is",
            [f"{each}: on `pc`, where `b` of sssa and `a` of tum are" for each in ("sssa", "tum")],
        ),
        ({"certh": ["z"]}, "is", []),
    ],
)
def test_shared_losses(parts: dict[str, list[str]], verb: str, reasons: list[str]) -> None:
    losses = context(change("changed", "host pc", "cores")).shared_losses([0], parts, "on `pc`, where {}", verb)
    assert [f"{loss.partner}: {loss.reason}" for loss in losses] == reasons


def test_nobody_breaks_itself() -> None:
    found = context(change("changed", "host pc", "cores"), change("changed", "output g.c.x", "type"))
    assert list(found.losses_of_users([0, 1], ["certh"], "why {}", "reads")) == [
        PartnerLoss(1, "certh", "why certh reads")
    ]


def test_names_in_ticks_are_sorted_and_limited() -> None:
    assert tick_name("a`b") == "`a'b`"
    assert tick_sorted_names("dcba") == "`a`, `b`, `c` and `d`"
    assert tick_sorted_names("edcba") == "`a`, `b`, `c` and 2 more"


def test_requirements_that_a_change_drops() -> None:
    def drops(before: object, after: object) -> bool:
        each = Change("changed", "component", "g.a", key="requirements", before=before, after=after)
        return drops_requirement(context(each), 0, "R")

    assert drops(["R", "S"], ["S"])
    assert drops(["R"], None)
    assert not drops(["R"], ["R", "S"])
    assert not drops(["S"], None)
    assert not drops(None, ["R"])


def value(number: int | None) -> TimingValue:
    return cast("TimingValue", type("Value", (), {"value": number})())


def test_traffic_that_grew() -> None:
    cases = [(1, 2, True), (2, 1, False), (1, 1, False), (None, 1, True), (1, None, False), (None, None, False)]
    assert [has_grown(value(old), value(new)) for old, new, _ in cases] == [grown for _, _, grown in cases]


def test_all_changes_that_can_worsen_but_those_of_chains() -> None:
    part = change("added", "output g.d.x")
    found = context(
        change("changed", "component g.a", "title"),
        change("changed", "component g.a", "timing.rate"),
        change("changed", "chain c", "through"),
        change("renamed", "group g", None, part),
    )
    assert TimingCauses(found, cast("Any", None)).all_worsening_changes() == [1, 3]


REDEFINED = BASE.replace("Colour image", "x_msgs/msg/Image") + (
    'ros: {distro: jazzy, definitions: {x_msgs/msg/Image: "int8 a\\nint8 b", x_msgs/msg/Tracks: int8 c}}\n'
)
NEW = "what was built before cannot talk to what is built after"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("int8 b", "int16 b", f"changes the type of `b` in `x_msgs/msg/Image`, which SSSA uses; {NEW}"),
        ("int8 a\\nint8 b", "int8 b\\nint8 a", f"puts fields in another order in `x_msgs/msg/Image`, which SSSA uses; {NEW}"),
        ("int8 b", "int8 b\\nint8 d", f"adds `d` in `x_msgs/msg/Image`, which SSSA uses; even a field more makes another message to ROS: {NEW}"),
        ("int8 b", "int8 d", f"removes `b` and adds `d` in `x_msgs/msg/Image`, which SSSA uses; {NEW}"),
        ("int8 b", "int16 b\\nint8 d", f"changes the type of `b` and adds `d` in `x_msgs/msg/Image`, which SSSA uses; {NEW}"),
    ],
)  # fmt: skip
def test_fields(compared: Compared, old: str, new: str, said: str) -> None:
    assert broken(compared, REDEFINED, [(old, new)]) == [f"x_msgs/msg/Image/fields sssa: {said}"]


def result(verdict: str, bound: int | None, *, terms: bool = True) -> Any:  # noqa: ANN401 - stands for a result
    limits = SimpleNamespace(value=None if bound is None else bound * 10**6, complete=True)
    deadline = SimpleNamespace(value=5 * 10**6, complete=True)
    return SimpleNamespace(
        id="c", verdict=verdict, bound=limits, deadline=deadline, late_run=None, terms=(1,) if terms else ()
    )


MISSES = "makes the chain `c` miss its deadline of 5 ms"


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        (result("met", 4), result("met", 5), ""),
        (result("met", 4), result("missed", 6), f"{MISSES} (4 ms → 6 ms)"),
        (result("met", 4), result("open", None), "leaves the chain `c`, which met its deadline of 5 ms with 4 ms, without a bound"),
        (result("met", 4), result("open", None, terms=False), "cuts the chain `c`, which met its deadline of 5 ms with 4 ms"),
        (result("missed", 6), result("missed", 7), ""),
        (result("missed", 6), result("missed", None), ""),
        (result("missed", 6), result("missed", 6), ""),
        (result("missed", 7), result("missed", 6), ""),
        (result("missed", None), result("missed", 6), ""),
        (result("missed", 6), result("met", 4), ""),
        (result("open", None), result("missed", 6), ""),
    ],
)  # fmt: skip
def test_how_much_worse_a_chain_is(before: Any, after: Any, reason: str) -> None:  # noqa: ANN401
    assert lateness_reason(before, after) == reason


def test_a_host_of_several_cores(compared: Compared) -> None:
    base = (
        TIMED[: TIMED.index("chains:")].replace("pc: {cores: 1", "pc: {cores: 2").replace("wcet: 20 ms", "wcet: 60 ms")
    )
    assert broken(compared, base, [("wcet: 2 ms", "wcet: 150 ms")]) == [
        "sensing.camera/timing.wcet sssa: overloads the host `pc` (105 % of its 2 cores), where `mind` of SSSA runs"
    ]
