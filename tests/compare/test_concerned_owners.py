"""Whose elements a change touches: the owner's, and those at the other end."""

from __future__ import annotations

import pytest

from archgen.compare import Change
from archgen.compare.compared_elements import ComparedElement
from archgen.compare.concerned_owners import find_concerned_owners
from tests.compare.elements import by_key, element, pair

WORLD = by_key(
    element("output a.c.x", owner="A", type="T"),
    element("output a.c.y", owner="A", type="U"),
    element("input b.d.i", owner="B", type="U"),
    element("component c.e", owner="C", requirements=frozenset({"R"})),
    element("component d.f", owner="D", requirements=frozenset({"S"})),
    element("type T", message="m/msg/M"),
    element("type U", message="m/msg/N"),
    element("requirement R"),
    element("message m/msg/M"),
    element("host pc"),
    element("host arm"),
    element("link lan", connects=frozenset({"pc"})),
    element("link wan"),
    element("container box", host="pc"),
    element("container bin", host="arm"),
    element("node n", owner="N", host="pc"),
    element("node m", owner="M", container="box"),
    element("node o", owner="O", host="arm"),
    element("chain c", through=("c.e", "n", "a.c.x", "gone")),
    element("chain nothing"),
    element("port n.publishes.x", owner="N", refs="a.c.x"),
    element("group g", owner="G"),
    element("component a.c", owner="A", refs="a.c"),
    element("node sender", owner="N", refs="a.c c.e"),
    element("policy p"),
    element("project robot"),
)
READS = "b.d.i <- a.c.x"


@pytest.mark.parametrize(
    ("change", "owners"),
    [
        ("group g", "G"),
        ("policy p", ""),
        ("project robot distro", "A B C D G M N O"),
        ("project robot title", ""),
        ("connection b.d.i", "A B"),
        ("output a.c.x", "A B"),
        ("output a.c.x type", "A B"),
        ("output a.c.x description", "A B"),
        ("output a.c.x tags", "A"),
        ("output a.c.y type", "A"),
        ("component a.c timing.rate", "A B"),
        ("component a.c timing.wcet", "A"),
        ("component a.c timing.outputs.x.conditional", "A B"),
        ("component a.c timing.outputs.y.conditional", "A"),
        ("component c.e timing.rate", "C"),
        ("node sender timing.rate", "B N"),
        ("node sender timing.outputs.x.max_gap", "B N"),
        ("input b.d.i type", "B"),
        ("port n.publishes.x qos", "B N"),
        ("chain c deadline", "A C N"),
        ("chain nothing deadline", ""),
        ("host pc cores", "M N"),
        ("host arm cores", "O"),
        ("container box threads", "M"),
        ("container bin threads", ""),
        ("link lan bandwidth", "M N"),
        ("link wan bandwidth", ""),
        ("type T size", "A B"),
        ("type U size", "A B"),
        ("requirement R title", "C"),
        ("message m/msg/M fields", "A B"),
        ("node n host", "N"),
        ("host gone", ""),
    ],
)
def test_owners(change: str, owners: str) -> None:
    kind, name, *key = change.split(" ")
    changes = [Change("changed", kind, name, key=key[0] if key else None)]
    assert find_concerned_owners(changes, pair(WORLD, WORLD, (READS, READS))) == tuple(owners.split())
    # One version is enough: who read it before is concerned as much as who reads it now.
    assert find_concerned_owners(changes, pair(WORLD, {}, (READS, ""))) == tuple(owners.split())
    assert find_concerned_owners(changes, pair({}, WORLD, ("", READS))) == tuple(owners.split())


def test_a_type_called_like_a_requirement_concerns_nobody_who_serves_that() -> None:
    world = by_key(element("component c.e", owner="C", requirements=frozenset({"R"})), element("type R"))
    assert find_concerned_owners([Change("changed", "type", "R", key="size")], pair(world, world)) == ()


def test_parts_and_what_was_removed_under_its_old_id() -> None:
    old = ComparedElement("output", "a.new.x", "a.old.x", {}, owner="A")
    versions = pair(by_key(old, element("group g", owner="G")), {})
    removed = Change("removed", "output", "a.old.x")
    assert find_concerned_owners([Change("removed", "group", "g", parts=(removed,))], versions) == ("A", "G")
    # Only what was removed has an old id: the same id of anything else is that of the second version.
    assert find_concerned_owners([Change("changed", "output", "a.old.x", key="type")], versions) == ()
    assert find_concerned_owners([Change("removed", "output", "a.other.x")], versions) == ()
