"""Elements become model objects: owners beside the first, roles, statuses, waypoints, limits of what is read."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.syntax import yaml_parser
from tests.linking import link_table

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]


def link_unchecked(text: str) -> Architecture:
    """Link a text that the schema has not seen: what it refuses must not get into the model either."""
    document, _ = yaml_parser.parse_yaml("a.yaml", text)
    assert document is not None
    architecture, _ = link_table(document.root)
    return architecture


def test_owners_beside_the_first_are_kept_in_order(linked: Linked) -> None:
    architecture, _ = linked("""
partners: {one: , two: , three: }
groups: {g: {owner: [one, two, three, one], components: {c: , d: {title: D, owner: [three, two]}}}}
nodes: {n: {implements: [g.d, g.c]}, m: {implements: g.c, owner: [two, one]}}
""")
    group, nodes = architecture.groups["g"], architecture.nodes
    assert (group.owner, group.co_owners) == ("one", ("two", "three"))
    assert [(c.owner, c.co_owners) for c in group.components.values()] == [
        ("one", ("two", "three")),
        ("three", ("two",)),
    ]
    assert (nodes["n"].owner, nodes["n"].co_owners) == ("three", ("two", "one"))
    assert (nodes["m"].owner, nodes["m"].co_owners) == ("two", ("one",))


@pytest.mark.parametrize("role", ["source", "filter", "sink", "reactive"])
def test_roles(linked: Linked, role: str) -> None:
    component = linked(f"groups: {{g: {{components: {{c: {{role: {role}}}}}}}}}")[0].components["g.c"]
    assert (component.role, component.role_at.column) == (role, 37)


def test_words_that_the_schema_refuses_stay_out_of_the_model() -> None:
    architecture = link_unchecked("""
groups: {g: {components: {c: {role: other, inputs: {i: }, timing: {behaviour: often, trigger: some}}}}}
nodes: {n: {implements: [c], status: other, kind: [other]}}
types: {T: {message: std_msgs/msg/Empty, status: other}}
""")
    component, node = architecture.components["g.c"], architecture.nodes["n"]
    assert component.timing is not None
    assert (component.role, component.timing.behaviour, component.timing.trigger) == (None, None, None)
    assert (node.status, node.kinds) == (None, ("node",))
    assert architecture.types["T"].status is None


@pytest.mark.parametrize(("digits", "count"), [(40, Fraction(10**39)), (41, None)])
def test_a_number_of_calls_has_no_more_than_forty_digits(digits: int, count: Fraction | None) -> None:
    number = "1" + "0" * (digits - 1)
    text = f"groups: {{g: {{components: {{c: {{inputs: {{i: }}, timing: {{calls: {{i: '{number}'}}}}}}}}}}}}"
    timing = link_unchecked(text).components["g.c"].timing
    assert timing is not None
    assert timing.calls.get("g.c.i") == count


@pytest.mark.parametrize("number", ["many", "1/0"])
def test_what_is_no_number_of_calls_is_left_out(number: str) -> None:
    text = f"groups: {{g: {{components: {{c: {{inputs: {{i: }}, timing: {{calls: {{i: {number}}}}}}}}}}}}}"
    timing = link_unchecked(text).components["g.c"].timing
    assert timing is not None
    assert timing.calls == {}


def test_the_statuses_and_sizes_of_types(linked: Linked) -> None:
    architecture, _ = linked("""
types:
  Plan: {message: my_msgs/srv/Plan, status: planned, comment: Later, size: 2 kB}
  Goal: {message: my_msgs/msg/Goal, status: existing}
  Loop: my_msgs/msg/Loop
""")
    plan, goal, loop = architecture.types.values()
    assert [plan.status, goal.status, loop.status] == ["planned", "existing", None]
    assert (plan.comment, str(plan.size), goal.comment, goal.size) == ("Later", "2 kB", None, None)


def test_types_that_nobody_declared_come_by_name_whether_messages_or_not(linked: Linked) -> None:
    text = "groups: {g: {components: {c: {outputs: {a: a_msgs/msg/A, m: b type, z: z_msgs/msg/Z, p: Pose}}}}}"
    assert list(linked(text)[0].types) == ["Pose", "a_msgs/msg/A", "b type", "z_msgs/msg/Z"]


def test_titles_of_use_cases_and_requirements_are_their_ids_where_none_is_written(linked: Linked) -> None:
    architecture, _ = linked(
        "use_cases: {UC-1: {title: Fetch it}, UC-2: {description: D}}\nrequirements: {R-1: {title: Sees}, R-2: {tags: [a]}}"
    )
    assert [(u.title, u.description) for u in architecture.use_cases.values()] == [("Fetch it", None), ("UC-2", "D")]
    assert [(r.title, r.tags) for r in architecture.requirements.values()] == [("Sees", ()), ("R-2", ("a",))]


def test_waypoints_that_cannot_be_resolved_are_kept_apart(linked: Linked) -> None:
    architecture, _ = linked("""
groups: {g: {components: {a: {outputs: {o: T}}, b: B}}}
chains: {c: {through: [a, nowhere, a.o, elsewhere, b]}}
""")
    chain = architecture.chains["c"]
    assert [(w.kind, w.id, w.at.column) for w in chain.through] == [
        ("component", "g.a", 24),
        ("output", "g.a.o", 36),
        ("component", "g.b", 52),
    ]
    assert chain.unresolved == ("nowhere", "elsewhere")


def test_accepted_changes_have_a_reason(linked: Linked) -> None:
    review = linked("""
review:
  main: trunk
  breaking: warning
  accepted:
    {a.b: agreed, a.c: {key: qos}, a.d: {reason: moved, key: from}, a.e: [{reason: two}, {reason: three, key: qos}]}
  backends: [wiki]
  passes: [tag_cameras]
""")[0].review
    assert (review.main, str(review.breaking), review.backends) == ("trunk", "warning", ("wiki",))
    assert review.passes == ("tag_cameras",)
    assert [(c.element, c.reason, c.key, c.at.column) for c in review.accepted] == [
        ("a.b", "agreed", None, 6),
        ("a.d", "moved", "from", 36),
        ("a.e", "two", None, 75),
        ("a.e", "three", "qos", 90),
    ]
    assert linked("")[0].review.breaking is None


def test_the_names_of_a_node(linked: Linked) -> None:
    architecture, _ = linked("nodes: {n: {name: other, namespace: /a}, m: {namespace: b}, o: }")
    assert [node.full_name for node in architecture.nodes.values()] == ["/a/other", "/b/m", "/o"]


def test_an_entry_of_a_node_is_internal_only_below_internal(linked: Linked) -> None:
    node = linked("nodes: {n: {publishes: {a: }, internal: {serves: {b: {name: /c}}}}}")[0].nodes["n"]
    assert [(use.use, use.key, use.internal, use.topics) for use in node.uses] == [
        ("publishes", "a", False, ()),
        ("serves", "b", True, ("/c",)),
    ]


def test_a_node_whose_components_are_unknown_has_no_ports_of_its_own() -> None:
    """Only a node without `implements` names ports freely."""
    timing = "timing: {trigger: [x], outputs: {y: {conditional: true}}}"
    free, bound = link_unchecked(
        f"nodes: {{free: {{{timing}}}, bound: {{implements: [nothing], {timing}}}}}"
    ).nodes.values()
    assert (list(free.timing[""].outputs), free.timing[""].trigger is None) == (["y"], False)
    assert (list(bound.timing[""].outputs), bound.timing[""].trigger) == ([], None)


def test_requirements_with_a_blank_are_sentences(linked: Linked) -> None:
    (component,) = linked('groups: {g: {components: {c: {title: C, requirements: [R-1, " R-2 ", be quick]}}}}')[
        0
    ].components.values()
    assert [(r.text, r.is_id) for r in component.requirements] == [("R-1", True), ("R-2", True), ("be quick", False)]
