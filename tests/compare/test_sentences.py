"""Sentences about connections, whole elements, renames and ports, from versions made by hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import pytest

from archgen.compare import Change
from archgen.compare.change_sentences import describe_change, describe_connection, describe_port_change, describe_rename
from archgen.compare.element_sentences import describe_element_change
from archgen.compare.key_phrases import limit_effects, shown_id, tick_names
from archgen.compare.normal_values import ElementTitle
from archgen.compare.version_pair import RewiredInput, VersionPair, find_rewired_inputs
from tests.compare.conftest import Told
from tests.compare.elements import by_key, element, pair, some, with_values

ALL = ("input g.i", "input g.j", "output g.x", "output g.y", "output g.z")


def wired(before: str, after: str, gone: str = "", new: str = "") -> list[str]:
    """Describe every rewired input; all ports are in both versions but those that are gone or new."""
    old = some(*(key for key in ALL if key not in new.split(", ")))
    versions = pair(old, some(*(key for key in ALL if key not in gone.split(", "))), (before, after))
    rewired = find_rewired_inputs(versions.connections_before, versions.connections_after)
    return [describe_connection(each, versions) for each in rewired]


@pytest.mark.parametrize(
    ("before", "after", "gone", "new", "text"),
    [
        ("g.i <- g.x", "g.i <- g.y", "", "", "`g.i` now reads `g.y` instead of `g.x`; nobody reads `g.x` any more; nobody read `g.y` before"),
        ("g.i <- g.x, g.j <- g.x g.y", "g.i <- g.y, g.j <- g.x g.y", "", "", "`g.i` now reads `g.y` instead of `g.x`"),
        ("g.i <- g.x", "g.i <- g.y", "", "output g.y", "`g.i` now reads `g.y` instead of `g.x`; nobody reads `g.x` any more"),
        ("g.i <- g.x", "g.i <- g.y", "output g.x", "", "`g.i` now reads `g.y` instead of `g.x`; nobody read `g.y` before"),
        ("g.i <- g.x", "", "", "", "`g.i` no longer reads `g.x`; it has no source any more; nobody reads `g.x` any more"),
        ("g.i <- g.x", "", "output g.x", "", "`g.i` no longer reads `g.x`, which was removed; it has no source any more"),
        ("g.i <- g.x g.y", "", "output g.x, output g.y", "", "`g.i` no longer reads `g.x` and `g.y`, which were removed; it has no source any more"),
        ("g.i <- g.x g.y", "", "output g.x", "", "`g.i` no longer reads `g.x` and `g.y`; it has no source any more; nobody reads `g.y` any more"),
        ("g.i <- g.x g.y, g.j <- g.x", "g.i <- g.y, g.j <- g.x", "", "", "`g.i` no longer reads `g.x`"),
        ("", "g.i <- g.x", "", "", "`g.i` now reads `g.x`, its first source; nobody read `g.x` before"),
        ("", "g.i <- g.x g.y", "", "output g.x, output g.y", "`g.i` now reads `g.x` and `g.y`, its first sources"),
        ("", "g.i <- g.x", "", "input g.i, output g.x", "`g.i` reads `g.x`"),
        ("g.i <- g.x", "g.i <- g.x g.y", "", "output g.y", "`g.i` now also reads `g.y`"),
        ("g.i <- g.x", "g.i <- g", "output g.x", "", "`g.i` no longer reads `g.x`: `g` has no output any more"),
        ("g.i <- g.x", "g.i <- g h", "output g.x", "", "`g.i` no longer reads `g.x`: `g` and `h` have no output any more"),
        ("g.i <- g.x", "", "input g.i", "", "`g.x` is no longer read by anybody: its only reader `g.i` was removed"),
        ("g.i <- g.x, g.j <- g.x", "", "input g.i, input g.j", "", "`g.x` is no longer read by anybody: `g.i` was removed, and nobody else reads it now"),
        ("g.i <- g.x, g.j <- g.x", "g.j <- g.x", "input g.i", "", "`g.i`, which read `g.x`, was removed"),
        ("g.i <- g.x", "", "input g.i, output g.x", "", "`g.i`, which read `g.x`, was removed"),
        ("g.i <- g.x g.y", "", "input g.i", "", "`g.x` is no longer read by anybody: its only reader `g.i` was removed; `g.y` is no longer read by anybody: its only reader `g.i` was removed"),
    ],
)  # fmt: skip
def test_connections(before: str, after: str, gone: str, new: str, text: str) -> None:
    assert wired(before, after, gone, new)[0] == text


def test_what_an_input_gained_and_lost() -> None:
    rewired = RewiredInput("i", frozenset({"a", "b"}), frozenset({"b", "c"}))
    assert (rewired.lost_sources, rewired.gained_sources) == ({"a"}, {"c"})


def test_the_surplus_is_counted() -> None:
    assert tick_names("abcdef") == "`a`, `b`, `c`, `d`, `e` and `f`"
    assert tick_names("abcdefg") == "`a`, `b`, `c`, `d`, `e` and 2 more"
    assert limit_effects(list("abc")) == list("abc")
    assert list(limit_effects(list("abcd"))) == ["a", "b", "c", "and 1 more such effect"]
    assert list(limit_effects(list("abcde"))) == ["a", "b", "c", "and 2 more such effects"]


def test_readers_know_removed_elements_by_their_old_ids() -> None:
    versions = pair(by_key(element("input g.b", own_id="g.a"), element("input g.c", own_id="g.o")), some("input g.c"))
    assert shown_id("input", "g.b", versions) == "g.a"
    assert shown_id("input", "g.c", versions) == "g.c"
    assert shown_id("input", "g.d", versions) == "g.d"


def part(kind: str, key: str) -> Change:
    element_kind, name = key.split(" ")
    return Change("added" if kind == "+" else "removed", element_kind, name)


def whole(sign: str, key: str, parts: str, versions: VersionPair, values: Mapping[str, object] | None = None) -> str:
    """Describe an element that was added (+) or removed (-) with parts."""
    change = part(sign, key)
    parts_of = tuple(part(sign, each) for each in parts.split(", ") if each)
    change = Change(change.kind, change.element_kind, change.element_id, parts=parts_of)
    return describe_element_change(change, with_values(key, values or {}), versions)


NOTHING = pair({}, {})
PORTS = ("input g.i", "output g.x", "output g.y")


@pytest.mark.parametrize(
    ("sign", "key", "values", "text"),
    [
        ("+", "partner tum", {}, "partner `tum` is added; what it agrees on stands in `review/tum.yaml`"),
        ("+", "host pc", {}, "host `pc` is added"),
        ("-", "host pc", {}, "host `pc` is removed"),
        ("+", "use_case UC", {"title": ElementTitle("See", generated=False)}, "use case `UC` (See) is added"),
        ("+", "use_case UC", {"title": ElementTitle("UC", generated=True)}, "use case `UC` is added"),
        ("+", "message a/msg/B", {}, "message definition `a/msg/B` is added"),
        ("+", "node n", {"implements": frozenset("ba"), "host": "pc"}, "node `n` is added; it implements `a` and `b` and runs on `pc`"),
        ("-", "node n", {"host": "pc"}, "node `n` is removed"),
        ("+", "node n", {"container": "box"}, "node `n` is added; it runs in the container `box`"),
        ("+", "type T", {"message": "a/msg/B"}, "type `T` is added; it is `a/msg/B`"),
        ("+", "chain c", {"through": ("b", "a"), "deadline": "1 s"}, "chain `c` is added; it leads through `b` and `a` and must end within `1 s`"),
        ("+", "requirement R", {"use_cases": frozenset({"U"})}, "requirement `R` is added; it belongs to `U`"),
        ("+", "link l", {"connects": frozenset("ba")}, "link `l` is added; it connects `a` and `b`"),
        ("+", "policy p", {"forbid.from": "a`", "forbid.to": "b"}, "policy `p` is added; nothing may lead from `a'` to `b`"),
    ],
)  # fmt: skip
def test_elements(sign: str, key: str, values: dict[str, object], text: str) -> None:
    assert whole(sign, key, "", NOTHING, values) == text


def test_parts_are_counted() -> None:
    assert (
        whole("+", "group g", "component g.a, component g.b, input g.a.i", NOTHING)
        == "group `g` is added with 2 components and 1 input"
    )
    changed = Change("removed", "group", "g", parts=(Change("added", "component", "g.a"),))
    assert describe_element_change(changed, element("group g"), NOTHING) == "group `g` is removed"


@pytest.mark.parametrize(
    ("what", "parts", "reads", "sides", "text"),
    [
        # Who reads what is added, and what it reads.
        ("+ output g.x", "connection g.i", ("", "g.i <- g.x"), ("input g.i", "input g.i, output g.x"), "output `g.x` is added; `g.i` gets its first source"),
        ("+ output g.x", "connection g.i", ("g.i <- g.y", "g.i <- g.x g.y"), ("input g.i, output g.y", "input g.i, output g.x, output g.y"), "output `g.x` is added; `g.i` gets another source"),
        ("- output g.x", "connection g.i", ("g.i <- g.x", ""), ("input g.i, output g.x", "input g.i"), "output `g.x` is removed; `g.i` has no source any more"),
        ("- output g.x", "connection g.i", ("g.i <- g.x g.y", "g.i <- g.y"), ("input g.i, output g.x, output g.y", "input g.i, output g.y"), "output `g.x` is removed; `g.i` loses one of its sources"),
        ("+ input g.i", "connection g.i", ("", "g.i <- g.x"), ("output g.x", "input g.i, output g.x"), "input `g.i` is added; `g.x` is read for the first time"),
        ("+ input g.i", "connection g.i", ("g.j <- g.x", "g.i <- g.x, g.j <- g.x"), ("output g.x, input g.j", "input g.i, input g.j, output g.x"), "input `g.i` is added; it reads `g.x`"),
        ("- input g.i", "connection g.i", ("g.i <- g.x, g.j <- g.x", "g.j <- g.x"), ("output g.x, input g.j, input g.i", "input g.j, output g.x"), "input `g.i` is removed; it read `g.x`"),
        ("- input g.i", "connection g.i", ("g.i <- g.x", ""), ("output g.x, input g.i", "output g.x"), "input `g.i` is removed; `g.x` is no longer read by anybody"),
        ("- component g.a", "input g.i, connection g.i", ("g.i <- g.x, g.j <- g.x", "g.j <- g.x"), ("output g.x, input g.j, input g.i, component g.a", "input g.j, output g.x"), "component `g.a` is removed with 1 input"),
        ("+ component g.a", "input g.i, connection g.i, output g.y", ("", "g.i <- g.y"), ("", "input g.i, output g.y, component g.a"), "component `g.a` is added with 1 input and 1 output"),
    ],
)  # fmt: skip
def test_effects(what: str, parts: str, reads: tuple[str, str], sides: tuple[str, str], text: str) -> None:
    sign, _, key = what.partition(" ")
    before, after = (some(*filter(None, side.split(", "))) for side in sides)
    assert whole(sign, key, parts, pair(before, after, reads)) == text


def test_a_reader_may_be_given_by_its_old_id() -> None:
    old = by_key(
        element("input g.b.h", own_id="g.a.h"),
        element("host g.b", own_id="g.a.i"),
        element("input g.b.i", own_id="g.a.i"),
        element("output g.x"),
    )
    versions = pair(old, some("output g.x"), ("g.b.i <- g.x", ""))
    change = Change("removed", "input", "g.a.i", parts=(Change("removed", "connection", "g.a.i"),))
    assert describe_element_change(change, old["input", "g.b.i"], versions) == (
        "input `g.a.i` is removed; `g.x` is no longer read by anybody"
    )


def test_a_new_input_may_have_the_id_that_another_one_had() -> None:
    versions = pair(
        by_key(element("input g.c.i", own_id="g.b.i"), element("output g.x"), element("output g.y")),
        some("input g.b.i", "input g.c.i", "output g.x", "output g.y"),
        ("g.c.i <- g.x", "g.b.i <- g.y, g.c.i <- g.x"),
    )
    assert whole("+", "input g.b.i", "connection g.b.i", versions) == (
        "input `g.b.i` is added; `g.y` is read for the first time"
    )


def test_components_that_a_removed_node_leaves() -> None:
    other = by_key(element("node m", implements=frozenset({"g.b"})), element("component g.a"), element("component g.b"))
    versions = pair(by_key(element("node n")), other)
    values = {"implements": frozenset({"g.a", "g.b", "g.gone"})}
    assert whole("-", "node n", "", versions, values) == "node `n` is removed; no node implements `g.a` any more"
    assert whole("+", "node n", "", versions, values) == "node `n` is added; it implements `g.a`, `g.b` and `g.gone`"
    assert whole("-", "node n", "", versions, {"implements": frozenset({"g.b"})}) == "node `n` is removed"
    assert whole("-", "container n", "", versions, values) == "container `n` is removed"


SERVING = ({"R": frozenset({"g.a", "g.b"}), "S": frozenset({"g.b"})}, {"S": frozenset({"g.c"})})


def test_requirements_that_nobody_serves_any_more() -> None:
    versions = pair(some("requirement R"), some("requirement R", "requirement S"), serving=SERVING)
    assert whole("-", "component g.a", "", versions) == "component `g.a` is removed; no component serves `R` any more"
    assert whole("-", "component g.b", "", versions) == "component `g.b` is removed"  # the first one says it
    assert whole("-", "group g", "", versions) == "group `g` is removed; no component serves `R` any more"
    assert whole("-", "host g", "", versions) == "host `g` is removed"
    gone = pair(some("requirement R"), {}, serving=SERVING)
    assert whole("-", "component g.a", "", gone) == "component `g.a` is removed"
    assert whole("-", "requirement R", "", gone) == "requirement `R` is removed; it was served by `g.a` and `g.b`"
    assert whole("+", "requirement R", "", gone) == "requirement `R` is added"
    assert whole("-", "requirement T", "", gone) == "requirement `T` is removed"
    assert whole("-", "component R", "", gone) == "component `R` is removed"


@pytest.mark.parametrize(
    ("kind", "key", "old", "sure", "text"),
    [
        ("renamed", "component g.eye", "g.cam", 0.9, "component `g.cam` is called `eye` now"),
        ("renamed", "component g.eye", "g.cam", 0.85, "component `g.cam` is called `eye` now"),
        ("renamed", "component g.eye", "g.cam", 0.84, "component `g.cam` is called `eye` now (recognised with 84 % confidence)"),
        ("renamed", "type a.b", "c.d", 1.0, "type `c.d` is called `a.b` now"),
        ("renamed", "use_case U", "V", 1.0, "use case `V` is called `U` now"),
        ("moved", "component h.cam", "g.cam", 1.0, "component `g.cam` moved to the group `h`"),
        ("moved", "component h.eye", "g.cam", 1.0, "component `g.cam` moved to the group `h` and is called `eye` now"),
    ],
)  # fmt: skip
def test_renames(kind: str, key: str, old: str, sure: float, text: str) -> None:
    element_kind, name = key.split(" ")
    change = Change("moved" if kind == "moved" else "renamed", element_kind, name, old_id=old, confidence=sure)
    assert describe_rename(change, NOTHING) == text


@pytest.mark.parametrize(
    ("key", "unnamed", "text"),
    [
        ("component h.a", "h.a.x", "; `/g/a/x` becomes `/h/a/x`"),
        ("component h.a", "h.a.x h.a.y", "; `/g/a/x` becomes `/h/a/x`, and 1 more such names follow"),
        ("output h.a.y", "h.a.x h.a.y", "; `/g/a/y` becomes `/h/a/y`"),
        ("component h.a", "h.b.x h.a.new", ""),
        ("host h.a", "h.a.x", ""),
        ("group h", "h.a.x", "; `/g/a/x` becomes `/h/a/x`"),
    ],
)
def test_names_that_follow_a_rename(key: str, unnamed: str, text: str) -> None:
    old = by_key(element("output h.a.x", own_id="g.a.x"), element("output h.a.y", own_id="g.a.y"))
    kind, name = key.split(" ")
    change = Change("renamed", kind, name, old_id="g.a")
    sentence = describe_rename(change, replace(pair(old, {}), unnamed_outputs=frozenset(unnamed.split())))
    assert sentence.partition(" now")[2] == text


def test_what_nodes_say_of_ports() -> None:
    old = element("port n.publishes.x", parent="node n", refs="g.a.x", topic=frozenset({"/b", "/a"}))
    heir = element("port m.publishes.x", parent="node m", refs="g.a.x")
    third = element("port o.publishes.x", parent="node o", refs="g.a.x")
    other = element("port m.publishes.y", parent="node m", refs="g.a.y")
    bare = element("port n.internal.publishes.x", parent="node n")
    lost = "node `n` no longer has `publishes.x` on /a, /b"
    assert describe_port_change("removed", old, pair({}, by_key(other))) == lost
    assert describe_port_change("removed", old, pair({}, by_key(heir, other))) == f"{lost}: `m` has it now"
    assert describe_port_change("removed", old, pair({}, by_key(heir, third))) == lost
    assert describe_port_change("removed", old, pair({}, by_key(old))) == lost
    assert describe_port_change("added", old, pair({}, by_key(heir))) == "node `n` now has `publishes.x` on /a, /b"
    internal = element("port m.internal.publishes.x", parent="node m")
    assert (
        describe_port_change("removed", bare, pair({}, by_key(internal)))
        == "node `n` no longer publishes `x`; no component knows of it"
    )
    heard = element(
        "port n.internal.subscribes.x", parent="node n", topic=frozenset({"/x"}), message="std_msgs/msg/String"
    )
    assert (
        describe_port_change("added", heard, pair({}, {}))
        == "node `n` now subscribes to `/x`, a `std_msgs/msg/String`; no component knows of it"
    )


def changed(key: str, name: str, before: object, after: object) -> Change:
    kind, element_id = key.split(" ")
    return Change("changed", kind, element_id, key=name, before=before, after=after)


def test_whom_a_changed_key_concerns() -> None:
    after = by_key(
        element("output g.a.x", type="T"), element("output g.a.y", type="T"), element("output g.a.z", type="S"),
        element("type T", message="a/msg/B"),
        element("requirement R"),
    )  # fmt: skip
    versions = pair({}, after, ("", "g.i <- g.a.x"), serving=SERVING)
    tell = {
        ("output g.a.x", "type"): "; it is read by `g.i`",
        ("output g.a.y", "type"): "",
        ("output g.a.x", "medium"): "",
        ("type T", "size"): "; `g.a.x` and `g.a.y` carry it",
        ("type S", "message"): "; `g.a.z` carries it",
        ("type U", "message"): "",
        ("type T", "status"): "",
        ("message a/msg/B", "fields"): "; it carries `T`",
        ("message a/msg/C", "fields"): "",
        ("component g.a", "requirements"): "; no component serves `R` any more",
        ("component g.b", "requirements"): "",
        ("component g.a", "tags"): "",
    }
    for (key, name), text in tell.items():
        sentence = describe_change(changed(key, name, "o", "n"), versions)
        assert sentence.partition("; ")[1] + sentence.partition("; ")[2] == text, (key, name)
    gone = pair({}, {}, serving=SERVING)
    assert (
        describe_change(changed("component g.a", "requirements", ["R"], ["S"]), gone) == "`g.a`: requirements `R` → `S`"
    )


def test_what_has_no_output_yet_is_read_by_nobody(told: Told) -> None:
    before = "groups: {g: {components: {a: {inputs: {i: b}}, b: {}}}}\n"
    after = "groups: {g: {components: {b: {}}}}\n"
    assert told(before, after)[-1] == "  removed connection g.a.i: `g.a.i`, which read `g.b`, was removed"
