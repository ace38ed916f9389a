"""Whose elements a change touches: the owner's, and those at the other end."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.compare import Change, PartnerBreak
from archgen.compare.concerned_owners import find_concerned_owners
from archgen.compare.version_pair import ComparedElement
from tests.compare.elements import by_key, element, pair

WORLD = by_key(
    element("output a.c.x", owner="A", type="T"),
    element("output a.c.y", owner="A", type="U"),
    element("input b.d.i", owner="B", type="U"),
    element("component c.e", owner="C", co_owners=frozenset({"K"}), requirements=frozenset({"R"})),
    element("component d.f", owner="D", requirements=frozenset({"S"})),
    element("type T", message="m/msg/M"),
    element("type U", message="m/msg/N"),
    element("requirement R"),
    element("message m/msg/M"),
    element("host pc"),
    element("host arm"),
    element("link lan", connects=frozenset({"pc"})),
    element("link wan"),
    element("link own", owner="L"),
    element("container box", host="pc"),
    element("container bin", host="arm"),
    element("node n", owner="N", host="pc"),
    element("node m", owner="M", container="box"),
    element("node o", owner="O", host="arm"),
    element("chain c", through=("c.e", "n", "a.c.x", "gone")),
    element("chain nothing"),
    element("port n.publishes.x", owner="N", refs="a.c.x"),
    element("group g", owner="G"),
    element("group a"),
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
        ("group a owner", "B"),
        ("component a.c owner", "A B"),
        ("component a.c title", "A"),
        ("node sender co_owners", "B N"),
        ("component c.e title", "C K"),
        ("chain c title", ""),
        ("host pc title", ""),
        ("policy p", ""),
        ("project robot distro", "A B C D G K L M N O"),
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
        ("component c.e timing.rate", "C K"),
        ("node sender timing.rate", "B N"),
        ("node sender timing.outputs.x.max_gap", "B N"),
        ("input b.d.i type", "B"),
        ("port n.publishes.x qos", "B N"),
        ("chain c deadline", "A C K N"),
        ("chain nothing deadline", ""),
        ("host pc cores", "M N"),
        ("host arm cores", "O"),
        ("container box threads", "M"),
        ("container bin threads", ""),
        ("link lan bandwidth", "M N"),
        ("link wan bandwidth", ""),
        ("type T size", "A B"),
        ("type U size", "A B"),
        ("requirement R title", "C K"),
        ("message m/msg/M fields", "A B"),
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


@pytest.mark.parametrize(("kind", "name"), [("component", "a.c"), ("group", "a"), ("output", "a.c.x")])
@pytest.mark.parametrize("change_kind", ["renamed", "moved"])
def test_who_reads_what_has_another_name_or_place_is_concerned(change_kind: str, kind: str, name: str) -> None:
    change = Change(change_kind, kind, name, old_id="a.old")  # type: ignore[arg-type]
    assert "B" in find_concerned_owners([change], pair(WORLD, WORLD, (READS, READS)))


def test_who_has_a_node_on_the_host_that_another_comes_to_is_concerned() -> None:
    before = WORLD | by_key(element("node o", owner="O", host="other"))
    change = Change("changed", "node", "o", key="host")
    after = WORLD | by_key(element("node o", owner="O", container="box"))
    assert find_concerned_owners([change], pair(before, after)) == ("M", "N", "O")
    # Where it left there is more room than before.
    assert find_concerned_owners([change], pair(WORLD, WORLD)) == ("O",)


def test_a_link_concerns_those_whose_data_crosses_it_where_timing_knows() -> None:
    users = replace(pair(WORLD, WORLD), link_users={"lan": frozenset({"A"})})
    assert find_concerned_owners([Change("changed", "link", "lan", key="bandwidth")], users) == ("A",)
    assert find_concerned_owners([Change("changed", "link", "lan", key="title")], users) == ()
    assert find_concerned_owners([Change("added", "link", "wan")], users) == ()
    # Who answers for it is concerned whatever crosses it.
    assert find_concerned_owners([Change("changed", "link", "own", key="title")], users) == ("L",)


def test_the_owner_of_a_group_is_concerned_by_what_comes_into_it_and_leaves_it() -> None:
    old = ComparedElement("component", "new.c", "old.c", {}, parent_key=("group", "old"), owner="A")
    new = ComparedElement("component", "new.c", "new.c", {}, parent_key=("group", "new"), owner="A")
    groups = by_key(element("group old", owner="O"), element("group new", owner="N"))
    change = Change("moved", "component", "new.c", old_id="old.c")
    assert find_concerned_owners([change], pair(groups | by_key(old), groups | by_key(new))) == ("A", "N", "O")


def test_who_loses_something_is_concerned() -> None:
    change = Change("changed", "chain", "gone", key="deadline", breaks=(PartnerBreak("Z", "relaxes it"),))
    assert find_concerned_owners([change], pair(WORLD, WORLD)) == ("Z",)


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
