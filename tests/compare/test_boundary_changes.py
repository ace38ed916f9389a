"""Interfaces of two versions beside one another: who follows whom, which figures count, and whom they concern."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import TimingPair
from archgen.compare.boundary_changes import _compare_interfaces as compare_interfaces
from archgen.compare.boundary_changes import _follow_readers as follow_readers
from archgen.compare.boundary_changes import _follow_topics as follow_topics
from archgen.compare.boundary_changes import _InterfaceVersion as InterfaceVersion
from archgen.compare.boundary_changes import _merge_pairs as merge_pairs
from archgen.compare.boundary_changes import find_boundary_changes
from archgen.compare.comparison import BoundaryChange, ComparedFigure, FigureKey, WireNames
from archgen.compare.matched_ids import MatchedIds
from archgen.model.node import Qos
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Checked
from tests.compare.elements import pair, some

AB = ("a", "b")
MS = 10**6


def read_version(figures: str = "", wire: str = "/x", lacks: str = "", own_id: str = "") -> InterfaceVersion:
    """Return an interface: `rate=10 asked=5`; `lacks` says which ends nobody wrote, a QoS is its deadline (`-`);
    times are in ms.
    """
    values: dict[FigureKey, ComparedFigure] = {}
    for word in figures.split():
        name, value = word.split("=")
        scale = 1 if name == "rate" else MS
        if name in {"asked", "offered"}:
            deadline = None if value == "-" else TimingValue(Fraction(value) * MS)
            values[FigureKey(f"QoS {name}", str(len(values)))] = Qos(deadline=deadline)  # type: ignore[arg-type]
        else:
            values[FigureKey(name.replace("_", " "))] = TimingValue(None if value == "?" else Fraction(value) * scale)
    return InterfaceVersion(own_id, values, WireNames("topic", (wire,)), "sender" not in lacks, "receiver" not in lacks)


def write_change(change: BoundaryChange) -> str:
    """Write a change in one line."""
    figures = [f"{each.key.name}:{_show(each.before)}..{_show(each.after)}" for each in change.figures]
    facts = (
        change.kind,
        f"{change.interface_id}{f'({change.old_id})' if change.old_id else ''}",
        f"{'+'.join(change.givers)}>{'+'.join(change.takers)}",
        *figures,
        f"over {_scale(change.missed_deadline.value)}" if change.missed_deadline else "",
        f"concerns {''.join(sorted(change.concerned_partners))}",
    )
    return " ".join(filter(None, facts))


def _show(figure: object) -> str:
    if isinstance(figure, TimingValue):
        return _scale(figure.value)
    if isinstance(figure, Qos):
        return _scale(figure.deadline and figure.deadline.value)
    return figure.names[0] if isinstance(figure, WireNames) else "-"


def _scale(value: Any) -> str:  # noqa: ANN401 - a figure or a quantity
    return str(Fraction(value) / MS if value and value >= MS else value)


def compare(old: InterfaceVersion | None, new: InterfaceVersion | None) -> list[str]:
    """Compare an interface x of a and b."""
    sides = [{("x", AB): version} if version else {} for version in (old, new)]
    return [write_change(change) for change in compare_interfaces(*sides)]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (read_version("rate=10"), read_version("rate=10"), []),
        (read_version("rate=10"), read_version("rate=5"), ["changed x a>b rate:10..5 concerns ab"]),
        (None, read_version("rate=5"), ["added x a>b rate:-..5 concerns ab"]),
        (read_version("rate=10"), None, ["removed x a>b rate:10..- concerns ab"]),
        (None, read_version(), ["added x a>b concerns ab"]),
        (read_version(own_id="old"), read_version(), []),
        (read_version("rate=1", own_id="old"), read_version("rate=2"), ["changed x(old) a>b rate:1..2 concerns ab"]),
        (read_version("rate=1", own_id="x"), read_version("rate=2"), ["changed x a>b rate:1..2 concerns ab"]),
        (None, read_version("rate=2", own_id="old"), ["added x a>b rate:-..2 concerns ab"]),
        # Small changes, and what only comes sooner, concern nobody.
        (read_version("rate=1000"), read_version("rate=1002"), ["changed x a>b rate:1000..1002 concerns "]),
        (read_version("rate=1000"), read_version("rate=1001"), []),
        (read_version("largest_gap=9"), read_version("largest_gap=9.0000005"), []),
        (read_version("largest_gap=5 asked=5"), read_version("largest_gap=5.0000005 asked=5"), ["changed x a>b largest gap:5..10000001/2000000 over 5 concerns ab"]),
        (read_version("largest_gap=9"), read_version("largest_gap=8"), ["changed x a>b largest gap:9..8 concerns "]),
        # Another QoS that is asked for concerns the taker alone, unless it is not offered.
        (read_version("offered=5 asked=-"), read_version("offered=5 asked=9"), ["changed x a>b QoS asked:None..9 concerns b"]),
        (read_version("offered=5 asked=-"), read_version("offered=5 asked=4"), ["changed x a>b QoS asked:None..4 concerns ab"]),
        (read_version("offered=5 asked=-"), read_version("offered=4 asked=-"), ["changed x a>b QoS offered:5..4 concerns ab"]),
        (read_version("rate=1 offered=5 asked=-"), read_version("rate=2 offered=5 asked=9"), ["changed x a>b rate:1..2 QoS asked:None..9 concerns ab"]),
        # A deadline that was kept, and is no longer.
        (read_version("largest_gap=4 asked=5"), read_version("largest_gap=6 asked=5"), ["changed x a>b largest gap:4..6 over 5 concerns ab"]),
        (read_version("largest_gap=5 asked=5"), read_version("largest_gap=6 asked=5"), ["changed x a>b largest gap:5..6 over 5 concerns ab"]),
        (read_version("largest_gap=4 asked=6"), read_version("largest_gap=6 asked=6"), ["changed x a>b largest gap:4..6 concerns ab"]),
        (read_version("largest_gap=6 asked=5"), read_version("largest_gap=7 asked=5"), ["changed x a>b largest gap:6..7 concerns ab"]),
        (read_version("largest_gap=4 asked=5 asked=8"), read_version("largest_gap=9 asked=5 asked=8"), ["changed x a>b largest gap:4..9 over 5 concerns ab"]),
        (read_version("largest_gap=4 asked=-"), read_version("largest_gap=9 asked=-"), ["changed x a>b largest gap:4..9 concerns ab"]),
        (read_version("largest_gap=4 offered=5"), read_version("largest_gap=9 offered=5"), ["changed x a>b largest gap:4..9 concerns ab"]),
        (read_version("rate=4 asked=5"), read_version("rate=9 asked=5"), ["changed x a>b rate:4..9 concerns ab"]),
        (read_version("largest_gap=4 asked=5"), read_version("largest_gap=? asked=5"), ["changed x a>b largest gap:4..None concerns ab"]),
        (read_version("largest_gap=? asked=5"), read_version("largest_gap=9 asked=5"), ["changed x a>b largest gap:None..9 concerns ab"]),
        (None, read_version("largest_gap=9 asked=5"), ["added x a>b largest gap:-..9 QoS asked:-..5 concerns ab"]),
        # Where the nodes of an end are gone, its figures are guesses.
        (read_version("rate=10"), read_version("rate=5", lacks="sender"), ["changed x a>b rate:10..- concerns ab"]),
        (read_version("rate=10", lacks="sender"), read_version("rate=5", lacks="sender"), ["changed x a>b rate:10..5 concerns ab"]),
        (read_version("rate=10", lacks="sender"), read_version("rate=5"), ["changed x a>b rate:10..5 concerns ab"]),
        (read_version("rate=10 asked=5"), read_version("rate=5 asked=5", lacks="receiver"), ["changed x a>b rate:10..5 QoS asked:5..- concerns ab"]),
        (read_version("rate=10 asked=5", lacks="receiver"), read_version("rate=5 asked=5", lacks="receiver"), ["changed x a>b rate:10..5 concerns ab"]),
        (None, read_version("rate=5", lacks="sender receiver"), ["added x a>b rate:-..5 concerns ab"]),
    ],
)  # fmt: skip
def test_what_changed_of_an_interface(
    old: InterfaceVersion | None, new: InterfaceVersion | None, expected: list[str]
) -> None:
    assert compare(old, new) == expected


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("/old/t", "/new/t", "/new/t"),
        ("/old/t", "/old/t /new/t", "/old/t"),
        ("/old/t", "/other", "/old/t"),
        ("/t", "/t", "/t"),
        ("old.t", "new.t", "old.t"),
    ],
)
def test_a_topic_called_after_a_renamed_element_is_the_same(old: str, new: str, expected: str) -> None:
    matched = SimpleNamespace(rename_in_text=lambda text: text.replace("old", "new"))
    new_versions = {(name, AB): read_version() for name in new.split()}
    assert list(follow_topics({(old, AB): read_version()}, new_versions, matched)) == [(expected, AB)]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("reads", "old", "new", "expected"),
    [
        (("g.i <- x", "g.i <- y"), "x", "y", "y replaced"),
        # One reader has two instead, or two have one each: nobody knows which took its place.
        (("g.i <- x", "g.i <- y z"), "x", "y z", "x"),
        (("g.i <- x, g.j <- x", "g.i <- y, g.j <- z"), "x", "y z", "x"),
        (("g.i <- x, g.j <- x", "g.i <- y, g.j <- y"), "x", "y", "y replaced"),
        (("g.i <- x, g.j <- x", "g.i <- y"), "x", "y", "y replaced"),
        # It is still there, its readers read nothing instead, or something that was there before, or for somebody else.
        (("g.i <- x", "g.i <- y"), "x", "x y", "x"),
        (("g.i <- x", "g.i <- "), "x", "y", "x"),
        (("g.i <- x y", "g.i <- y"), "x y", "y", "x"),
        (("g.i <- x", "g.i <- y"), "x y", "y", "x"),
        (("g.i <- x", "g.i <- y"), "x", "", "x"),
    ],
)
def test_an_output_whose_readers_all_read_a_new_one_is_followed(
    reads: tuple[str, str], old: str, new: str, expected: str
) -> None:
    old_outputs, new_outputs = (some(*(f"output {name}" for name in side.split())) for side in (old, new or "y"))
    old_versions = {("x", AB): read_version()}
    new_versions = {(name, AB): read_version() for name in new.split()}
    followed = follow_readers(old_versions, new_versions, pair(old_outputs, new_outputs, reads))
    assert [f"{name}{' replaced' if version.is_replaced else ''}" for (name, _), version in followed.items()] == [
        expected
    ]


def test_two_outputs_do_not_follow_to_one() -> None:
    versions = pair(some("output w", "output x"), some("output y"), ("g.i <- w, g.j <- x", "g.i <- y, g.j <- y"))
    old_versions = {("w", AB): read_version(), ("x", AB): read_version()}
    followed = follow_readers(old_versions, {("y", AB): read_version()}, versions)
    assert [name for name, _ in followed] == ["y", "x"]


@pytest.mark.parametrize(
    ("is_replaced", "wire", "expected"),
    [(True, "/y", ["changed x a>b topic:/y../x concerns ab"]), (True, "/x", []), (False, "/y", [])],
)
def test_another_topic_counts_where_another_output_took_its_place(
    is_replaced: bool,  # noqa: FBT001
    wire: str,
    expected: list[str],
) -> None:
    old = read_version(wire=wire)
    replaced = InterfaceVersion(
        old.own_id, old.figures, old.wire, has_sender=True, has_receiver=True, is_replaced=is_replaced
    )
    assert compare(replaced, read_version()) == expected


def test_the_same_for_several_pairs_is_one_change() -> None:
    old, new = ({("x", ends): read_version(f"rate={rate}") for ends in (AB, ("a", "c"), ("d", "b"))} for rate in (1, 2))
    new["x", ("d", "b")] = read_version("rate=3")
    changes = merge_pairs(compare_interfaces(old, new))
    assert [write_change(change) for change in changes] == [
        "changed x a>b+c rate:1..2 concerns abc",
        "changed x d>b rate:1..3 concerns bd",
    ]


def test_what_could_not_be_read_is_not_compared() -> None:
    whole: Any = SimpleNamespace(architecture=SimpleNamespace(unread_keys=frozenset()))
    part: Any = SimpleNamespace(architecture=SimpleNamespace(unread_keys=frozenset({"groups"})))
    for sides in ((whole, part), (part, whole)):
        assert find_boundary_changes(*sides, MatchedIds(), None, pair({}, {})) == ()


@pytest.mark.parametrize("waiting", [({"r"}, set[str]()), (set[str](), {"r"}), ({"r"}, {"r"})])
def test_with_errors_of_linking_only_what_changed_counts(checked: Checked, waiting: tuple[set[str], set[str]]) -> None:
    """`x` is larger, `y` is gone, `z` is given by another partner, `w` is new."""
    text = (
        "partners: {p: P, q: Q, r: R}\n"
        "types: {T: {message: std_msgs/msg/Int8, size: 1 kB}, U: {message: std_msgs/msg/Int8, size: 1 kB}}\n"
        "groups: {g: {owner: p, components: {a: {timing: {rate: 1 Hz}, outputs: {x: T, y: U, w: U}},"
        " c: {outputs: {z: U}}, b: {owner: q, inputs: {x: a.x, y: a.y, z: c.z}}}}}\n"
        "nodes: {na: a, nb: b, nc: c}\n"
    )
    after = text.replace("size: 1 kB", "size: 2 kB", 1).replace("y: a.y", "w: a.w").replace("c: {", "c: {owner: r, ")
    analyses = [analyse_architecture(checked(each)) for each in (text, after)]
    before, later = (
        ArchitectureVersion(checked(each), analysis=analysis)
        for each, analysis in zip((text, after), analyses, strict=True)
    )
    old_rules, new_rules = map(frozenset, waiting)
    waiting_sides = replace(before, waiting_rules=old_rules), replace(later, waiting_rules=new_rules)
    matched, timing, versions = MatchedIds(), TimingPair(*analyses), pair({}, {})
    assert [write_change(change) for change in find_boundary_changes(*waiting_sides, matched, timing, versions)] == [
        "changed g.a.x p>q size:1000..2000 traffic:1000..2000 concerns pq",
    ]
    assert [write_change(change) for change in find_boundary_changes(before, later, matched, timing, versions)] == [
        "added g.a.w p>q rate:-..1 largest gap:-..1000 size:-..1000 traffic:-..1000 QoS offered:-..None QoS asked:-..None concerns pq",
        "changed g.a.x p>q size:1000..2000 traffic:1000..2000 concerns pq",
        "removed g.a.y p>q concerns pq",
        "changed g.c.z r>q concerns pqr",
    ]


def test_one_of_several_readers_that_goes_says_nothing_of_the_one_that_stays() -> None:
    def ask(*nodes: str) -> InterfaceVersion:
        values: dict[FigureKey, ComparedFigure] = {FigureKey("QoS asked", node): Qos(depth=3) for node in nodes}
        return InterfaceVersion("", values, WireNames("topic", ("/x",)), has_sender=True, has_receiver=True)

    def name(old: InterfaceVersion, new: InterfaceVersion) -> list[tuple[str, str, bool]]:
        (change,) = compare_interfaces({("x", AB): old}, {("x", AB): new})
        return [(*each.key, each.after is None) for each in change.figures]

    assert name(ask("m", "n"), ask("n")) == [("QoS asked", "m", True)]
    assert name(ask("n"), ask("m", "n")) == [("QoS asked", "m", False)]
    # One on each side is the same end under another name.
    assert compare(ask("m"), ask("n")) == []
