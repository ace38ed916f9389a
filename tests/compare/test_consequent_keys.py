"""Keys that differ only because something else changed."""

from __future__ import annotations

import pytest

from archgen.compare.changed_keys import ElementPair, is_consequence
from archgen.compare.normal_values import ElementTitle
from archgen.compare.version_pair import ComparedElement
from tests.compare.elements import by_key, element, with_values


def follows(
    key: str,
    old: ComparedElement,
    new: ComparedElement,
    before: tuple[ComparedElement, ...] = (),
    after: tuple[ComparedElement, ...] = (),
) -> bool:
    return is_consequence(key, ElementPair(old, new, by_key(*before), by_key(*after)))


def title(text: str, *, generated: bool = False) -> ElementTitle:
    return ElementTitle(text, generated)


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        (("g.cam", title("Cam", generated=True)), ("g.eye", title("Eye", generated=True)), True),
        (("g.cam", title("Cam")), ("g.eye", title("Eye", generated=True)), True),  # a written title that repeats the id
        (("g.cam", title("CAM")), ("g.eye", title("eye")), True),
        (("g.cam", title("Lens")), ("g.eye", title("Eye", generated=True)), False),
        (("g.cam", title("Cam")), ("g.eye", title("Lens")), False),
        (("g.cam", title("Lens")), ("g.eye", title("Lens")), True),
        (("g.cam", title("Lens")), ("g.cam", title("Cam", generated=True)), False),
        (("g.cam", title("CAM")), ("g.cam", title("Cam", generated=True)), False),  # with the same id the letters count
        (("g.cam", title("x", generated=True)), ("g.cam", title("y", generated=True)), True),
    ],
)
def test_titles(old: tuple[str, ElementTitle], new: tuple[str, ElementTitle], same: bool) -> None:  # noqa: FBT001
    sides = [element("component g.eye", own_id=own_id, title=text) for own_id, text in (old, new)]
    assert follows("title", sides[0], sides[1]) is same


def test_a_title_in_one_version_only_is_news() -> None:
    assert not follows("title", element("host a", title=title("A")), element("host a"))
    assert not follows("title", element("host a"), element("host a", title=title("A")))


@pytest.mark.parametrize(
    ("kind", "key", "referred"),
    [("node", "implements", "component"), ("component", "requirements", "requirement"), ("chain", "requirements", "requirement"), ("requirement", "use_cases", "use_case"), ("link", "connects", "host")],
)  # fmt: skip
def test_what_was_removed_is_no_longer_named(kind: str, key: str, referred: str) -> None:
    both, one = (with_values(f"{kind} n", {key: frozenset(names)}) for names in ("xy", "x"))
    none, other = element(f"{kind} n"), with_values(f"{kind} n", {key: frozenset("z")})
    gone, there = (element(f"{referred} x"),), (element(f"{referred} x"), element(f"{referred} y"))
    assert follows(key, both, one, there, gone)
    assert not follows(key, both, one, there, there)
    assert not follows(key, one, both, gone, there)
    assert not follows(key, both, other, there, ())
    assert follows(key, both, none, there, ())
    assert not follows(key, both, none, there, gone)
    assert not follows(key, none, one, (), ())
    assert not follows(key, one, one, there, ())


def test_ports_are_elements_of_their_own() -> None:
    some, none, unknown = (element("component g.a", inputs=value) for value in ("some", "none", None))
    assert follows("inputs", some, none)
    assert follows("inputs", unknown, some)
    assert not follows("inputs", none, unknown)
    assert not follows("outputs", some, none)  # its value is absent on both sides


def test_timing_comes_and_goes_with_the_node() -> None:
    mapped = element("component g.a", mapped=True, timing__rate="1 Hz")
    bare, other = element("component g.a"), element("component g.a", timing__rate="2 Hz")
    assert follows("timing.rate", mapped, bare)
    assert follows("timing.rate", bare, mapped)
    assert not follows("timing.rate", mapped, other)
    assert not follows("timing.rate", other, bare)
    assert not follows("role", mapped, bare)
    assert follows("mapped", mapped, bare)


def test_a_node_may_move_into_a_container_on_its_host() -> None:
    box, bin_ = element("container box", host="pc"), element("container bin", host="arm")
    alone, inside = element("node n", host="pc"), element("node n", container="box")
    assert follows("host", alone, inside, (box, bin_), (box, bin_))
    assert follows("host", inside, alone, (box, bin_), (box, bin_))
    assert not follows("host", alone, element("node n", container="bin"), (box, bin_), (box, bin_))
    assert not follows("host", alone, element("node n"), (), ())
    assert not follows("host", alone, element("node n", host="arm"), (), ())
    assert not follows("container", alone, inside, (box,), (box,))
    assert not follows("package", alone, alone)


def test_what_a_node_has_from_a_component_that_came_or_went() -> None:
    a, b = element("component g.a"), element("component g.b")
    old, new = (
        ComparedElement("node", "n", "n", {"owner": owner, "co_owners": owner}, component_refs=(component,))
        for owner, component in (("certh", "g.a"), ("sssa", "g.b"))
    )
    for key in ("timing.rate", "owner", "co_owners"):
        assert follows(key, old, new, (a,), (b,))
        assert follows(key, old, new, (a, b), (b,))
        assert follows(key, old, new, (a,), (a, b))
        assert not follows(key, old, new, (a, b), (a, b))
    assert not follows("package", old, new, (a,), (b,))
    assert not follows("owner", element("component g.a", refs="g.a"), element("component g.a", refs="g.b"), (a,), (b,))


def test_inherited_owners() -> None:
    groups = [ComparedElement("group", "g", "g", {"owner": owner, "co_owners": owner}) for owner in ("certh", "sssa")]
    parts = [
        ComparedElement("component", "g.a", "g.a", {"owner": owner, "co_owners": owner}, ("group", "g"))
        for owner in ("certh", "sssa", "tum")
    ]
    for key in ("owner", "co_owners"):
        assert follows(key, parts[0], parts[1], (groups[0],), (groups[1],))
        assert not follows(key, parts[0], parts[2], (groups[0],), (groups[1],))
        assert not follows(key, parts[2], parts[1], (groups[0],), (groups[1],))
        assert not follows(key, parts[0], parts[1], (), (groups[1],))
        assert not follows(key, parts[0], parts[1], (groups[0],), ())
    moved = ComparedElement("component", "g.a", "g.a", parts[1].values, ("group", "h"))
    assert not follows("owner", parts[0], moved, (groups[0],), (groups[1],))
    assert not follows("owner", groups[0], groups[1], (groups[0],), (groups[1],))


def test_a_node_inherits_the_owner_of_its_components() -> None:
    nodes = [
        ComparedElement("node", "n", "n", {"owner": owner}, component_refs=("g.a",)) for owner in ("certh", "sssa")
    ]
    parts = [ComparedElement("component", "g.a", "g.a", {"owner": owner}) for owner in ("certh", "sssa")]
    assert follows("owner", nodes[0], nodes[1], (parts[0],), (parts[1],))
    assert not follows("owner", nodes[0], nodes[1], (parts[0],), (parts[0],))


@pytest.mark.parametrize(
    ("key", "old", "new", "is_news"),
    [
        ("id", None, "robot", False),
        ("id", "robot", None, False),
        ("title", None, "Robot", False),
        ("id", "robot", "car", True),
        ("version", None, "1", True),
        ("chapters", ("a.md", "groups"), ("groups",), False),
        ("chapters", ("groups",), ("a.md", "groups"), False),
        ("chapters", ("a.md", "groups"), ("groups", "a.md"), True),
        ("chapters", ("a.md", "groups", "types"), ("types", "groups"), True),
        ("chapters", ("groups", "types"), ("groups",), True),
        ("chapters", None, ("groups",), True),
        ("chapters", ("groups",), None, True),
    ],
)
def test_the_project(key: str, old: object, new: object, is_news: bool) -> None:  # noqa: FBT001
    sides = [with_values("project robot", {key: value} if value is not None else {}) for value in (old, new)]
    assert follows(key, sides[0], sides[1]) is not is_news


def test_only_a_project_goes_without_a_name_and_ports_are_reported_themselves() -> None:
    assert not follows("title", element("host a", title="A"), element("host a"))
    assert follows("carried", element("port n.publishes.x", carried=True), element("port n.publishes.x"))
    assert not follows("topic", element("port n.publishes.x", topic="/a"), element("port n.publishes.x"))


@pytest.mark.parametrize(
    ("old", "new", "present", "follows_removal"),
    [
        ("g.a g.b g.c", "g.a g.c", "component g.a, component g.c", True),
        ("g.a n g.c", "g.a g.c", "component g.a, component g.c", True),
        ("g.a n g.c", "g.a g.c", "component g.a, node n, component g.c", False),
        ("g.a g.b g.c", "g.c g.a", "component g.a, component g.c", False),
        ("g.a g.b", "g.a g.d", "component g.a, component g.d", False),
        ("g.a g.b", "g.b g.a", "component g.a, component g.b", False),
    ],
)
def test_a_chain_that_leads_past_what_was_removed(old: str, new: str, present: str, follows_removal: bool) -> None:  # noqa: FBT001
    before, after = (with_values("chain c", {"through": tuple(text.split())}) for text in (old, new))
    assert follows("through", before, after, after=tuple(map(element, present.split(", ")))) is follows_removal
