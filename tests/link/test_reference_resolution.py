"""References: what a path means, and what is said where it means nothing, or several things."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import input_wiring
from archgen.link.reference_resolution import ReferenceResolver, diagnose_unknown_reference
from archgen.model.architecture import Architecture
from archgen.schema import normalise_document, validate_document
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import ScalarNode
from tests.linking import link_table

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]
Told = Callable[[str], list[str]]

ROBOT = """
groups:
  sensing:
    components:
      camera: {outputs: {image: T, info: T, light: {type: L, medium: physical}, reset: std_srvs/srv/Trigger}}
      lidar: {outputs: {scan: T}}
      fusion: {inputs: {x: %s}, outputs: {fused: T, image: T}}
  arm:
    components:
      camera: {outputs: {close: T}}
      sensing: {outputs: {force: T}}
"""


def brought(architecture: Architecture) -> list[str]:
    return [edge.output for edge in architecture.edges]


@pytest.mark.parametrize(
    ("reference", "outputs"),
    [
        ("arm.camera.close", ["arm.camera.close"]),  # complete
        ("camera.close", ["arm.camera.close"]),  # leading part left out
        ("close", ["arm.camera.close"]),
        ("camera.image", ["sensing.camera.image"]),
        ("camera", ["sensing.camera.image", "sensing.camera.info"]),  # own group first; only what carries messages
        ("arm", ["arm.camera.close", "arm.sensing.force"]),
        ("image", ["sensing.camera.image"]),  # never an output of its own
        ("fusion.image", ["sensing.fusion.image"]),  # a loop on itself
        ("camera.reset", ["sensing.camera.reset"]),  # services and physical outputs one by one
        ("camera.light", ["sensing.camera.light"]),
        ("[close, lidar]", ["arm.camera.close", "sensing.lidar.scan"]),
        ("[camera.image, camera]", ["sensing.camera.image", "sensing.camera.info"]),  # a pair is one edge
    ],
)
def test_a_reference_brings(linked: Linked, reference: str, outputs: list[str]) -> None:
    architecture, found = linked(ROBOT % reference)
    assert found == ()
    assert brought(architecture) == outputs


def test_a_group_brings_all_but_the_readers_own_outputs_and_hides_a_component_of_its_name(
    linked: Linked, told: Told
) -> None:
    architecture, _ = linked(ROBOT % "sensing")
    assert brought(architecture) == ["sensing.camera.image", "sensing.camera.info", "sensing.lidar.scan"]
    assert told(ROBOT % "sensing") == [
        (
            "7:28 hidden-reference: `sensing` is the group `sensing`, which hides the component `arm.sensing` (11:7 hidden)"
            " | write `arm.sensing` if that is meant"
        )
    ]


def test_the_shape_of_a_connection(linked: Linked) -> None:
    architecture, _ = linked(ROBOT % "[camera, close]")
    first, second = architecture.inputs["sensing.fusion.x"].connections
    assert (first.written, first.kind, first.target, first.at.column) == ("camera", "component", "sensing.camera", 29)
    assert (second.written, second.kind, second.target) == ("close", "output", "arm.camera.close")
    assert architecture.connections == (first, second)
    assert [edge.at.column for edge in architecture.edges] == [29, 29, 37]


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        (
            "camrea.image",
            "no component or output named `camrea.image` (5:26 declared here) | did you mean `camera.image`?",
        ),
        ("nothing_like_it", "no group, component or output named `nothing_like_it` | None"),
        ("a.b.c.d", "no output named `a.b.c.d` | None"),
        (
            "lost.place.scan",
            "no output named `lost.place.scan` (6:25 declared here) | did you mean `sensing.lidar.scan`?",
        ),
        (
            "fusion",
            (
                "no other group, component or output named `fusion`"
                " | one word never means the writer itself or its own output: a loop is written `component.output`"
            ),
        ),
        (
            "fused",
            (
                "no other group, component or output named `fused`"
                " | one word never means the writer itself or its own output: a loop is written `component.output`"
            ),
        ),
        (
            "fusion.x",
            (
                "no component or output named `fusion.x`: `sensing.fusion.x` is an input (7:25 an input)"
                " | name the output that the data comes from"
            ),
        ),
    ],
)
def test_an_unknown_reference(told: Told, reference: str, message: str) -> None:
    assert told(ROBOT % reference) == [f"7:28 unknown-reference: {message}"]


def test_an_ambiguous_reference_lists_its_candidates(linked: Linked, told: Told) -> None:
    text = """
groups:
  a: {components: {camera: {outputs: {o: T}}}}
  b: {components: {camera: {outputs: {o: T}}}}
  c: {components: {reader: {inputs: {i: camera}}}}
"""
    assert told(text) == [
        (
            "5:41 ambiguous-reference: `camera` can mean `a.camera` or `b.camera` (3:20 `a.camera`, 4:20 `b.camera`)"
            " | write more of the path, such as `a.camera`"
        )
    ]
    architecture, _ = linked(text)
    assert architecture.edges == ()
    assert architecture.inputs["c.reader.i"].from_written
    assert architecture.suspected_ids == {"a.camera", "b.camera"}


def test_of_very_many_candidates_the_first_are_listed_and_the_rest_counted(told: Told) -> None:
    groups = "".join(f"  g{n}: {{components: {{camera: }}}}\n" for n in range(30))
    (line,) = told(f"groups:\n{groups}  z: {{components: {{reader: {{inputs: {{i: camera}}}}}}}}\n")
    assert "`g7.camera` or 22 more (" in line


def test_references_that_make_too_many_pairs_are_told_and_bring_nothing(
    linked: Linked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(input_wiring, "MAX_PAIRS", 10)
    components = "".join(f"      c{n}: {{inputs: {{i: g}}, outputs: {{o: T}}}}\n" for n in range(5))
    architecture, (only,) = linked(f"groups:\n  g:\n    components:\n{components}")
    assert (only.rule, only.span.line, only.help) == (
        "too-large",
        6,
        "name single outputs or components where whole groups are named",
    )
    assert len(architecture.edges) == 8
    assert all(port.connections for port in architecture.inputs.values())


def test_what_an_unresolved_reference_most_likely_meant_is_a_suspect(linked: Linked) -> None:
    assert linked(ROBOT % "camrea.image")[0].suspected_ids == {"sensing.camera.image"}


def test_what_a_file_that_could_not_be_read_may_declare_is_not_called_unknown() -> None:
    document, _ = yaml_parser.parse_yaml("a.yaml", ROBOT % "radar")
    assert document is not None
    assert (validate_document(document), normalise_document(document)) == ((), ())
    architecture, found = link_table(document.root, lost_keys=frozenset({"radar"}))
    assert found == ()
    assert (architecture.unread_keys, architecture.partial) == (frozenset({"radar"}), False)


NODES = """
groups:
  g:
    components:
      a: {inputs: {i: , j: }, outputs: {o: T}}
      b: {inputs: {i: b2}, outputs: {o: T, p: T}}
      b2: {outputs: {q: T}}
nodes:
  n: {implements: [a, b], %s}
"""


@pytest.mark.parametrize(
    ("uses", "ports"),
    [
        ("publishes: {p: }, subscribes: {j: }", ["g.b.p", "g.a.j"]),
        ("publishes: {a.o: , g.b.o: }", ["g.a.o", "g.b.o"]),
        ("serves: {p: }, calls: {b.i: }", ["g.b.p", "g.b.i"]),
    ],
)
def test_keys_of_nodes_are_ports_of_what_they_implement(linked: Linked, uses: str, ports: list[str]) -> None:
    architecture, found = linked(NODES % uses)
    assert found == ()
    assert [use.port for use in architecture.nodes["n"].uses] == ports


@pytest.mark.parametrize(
    ("uses", "message"),
    [
        (
            "publishes: {o: }",
            (
                "9:39 ambiguous-reference: `o` can mean `a.o` or `b.o` (5:41 `g.a.o`, 6:38 `g.b.o`)"
                " | write `component.port` where several components of a node have a port of this name"
            ),
        ),
        (
            "publishes: {b.pp: }",
            "9:39 unknown-reference: no output named `b.pp` in `g.a` or `g.b` (6:44 declared here) | did you mean `b.p`?",
        ),
        (
            "publishes: {j: }",
            "9:39 unknown-reference: no output named `j` in `g.a` or `g.b` (5:25 an input) | `j` is an input",
        ),
        (
            "calls: {nothing: }",
            (
                "9:35 unknown-reference: no input named `nothing` in `g.a` or `g.b`"
                " (5:7 declared here, 6:7 declared here) | there are `i` and `j`"
            ),
        ),
        (
            "timing: {trigger: [p]}",
            "9:46 unknown-reference: no input named `p` in `g.a` or `g.b` (6:44 an output) | `p` is an output",
        ),
        (
            "timing: {calls: {p: 1}}",
            "9:44 unknown-reference: no input named `p` in `g.a` or `g.b` (6:44 an output) | `p` is an output",
        ),
        (
            "timing: {outputs: {j: {conditional: true}}}",
            "9:46 unknown-reference: no output named `j` in `g.a` or `g.b` (5:25 an input) | `j` is an input",
        ),
    ],
)
def test_keys_that_name_no_port(told: Told, uses: str, message: str) -> None:
    assert told(NODES % uses) == [message]


def test_an_unresolved_implements_makes_no_further_noise(told: Told) -> None:
    assert told(
        "groups: {g: {components: {camera: {outputs: {o: T}}}}}\nnodes: {n: {implements: camra, publishes: {o: }}}"
    ) == ["2:25 unknown-reference: no component named `camra` (1:27 declared here) | did you mean `camera`?"]


CHAIN = """
groups:
  g: {components: {lidar: {outputs: {scan: T}}, brake: {inputs: {scan: lidar}}}}
  h: {components: {driver: }}
nodes:
  lidar: {implements: lidar}
  driver: {implements: brake}
chains:
  c: {through: %s}
"""


def test_a_chain_goes_through_nodes_components_and_outputs(linked: Linked, told: Told) -> None:
    text = CHAIN % "[lidar, lidar.scan, brake, driver]"
    points = linked(text)[0].chains["c"].through
    assert [(point.kind, point.id) for point in points] == [
        ("node", "lidar"),  # a node's id is complete; that it hides the component which it implements, nobody minds
        ("output", "g.lidar.scan"),
        ("component", "g.brake"),
        ("node", "driver"),
    ]
    assert told(text) == [
        (
            "9:43 hidden-reference: `driver` is the node `driver`, which hides the component `h.driver` (4:20 hidden)"
            " | write `h.driver` if that is meant"
        )
    ]


def test_a_chain_takes_no_group(told: Told) -> None:
    assert told(CHAIN % "[g]") == [
        (
            "9:17 unknown-reference: no node, component or output named `g`: it is a group (3:3 the group)"
            " | name its components"
        )
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "partners: {certh: }\ngroups: {g: {title: G, owner: cert}}",
            "2:31 unknown-reference: no partner named `cert` (1:12 declared here) | did you mean `certh`?",
        ),
        (
            "hosts: {pc: }\nnodes: {n: {host: px}}",
            "2:19 unknown-reference: no host named `px` (1:9 declared here) | did you mean `pc`?",
        ),
        (
            "nodes: {n: {container: c}}",
            "1:24 unknown-reference: no container named `c` | declare it in the section `containers`",
        ),
        ("containers: {c: pc}", "1:17 unknown-reference: no host named `pc` | declare it in the section `hosts`"),
        ("links: {l: [pc]}", "1:13 unknown-reference: no host named `pc` | declare it in the section `hosts`"),
        (
            "requirements: {R-1: {use_cases: [UC-9]}}",
            "1:34 unknown-reference: no use case named `UC-9` | declare it in the section `use_cases`",
        ),
    ],
)
def test_plain_ids(told: Told, text: str, message: str) -> None:
    assert told(text) == [message]


def test_requirements_of_components_are_kept_known_or_not(linked: Linked) -> None:
    architecture, found = linked('groups: {g: {components: {c: {title: C, requirements: [R-9, "Works in the dark"]}}}}')
    assert found == ()
    assert [(use.text, use.is_id) for use in architecture.components["g.c"].requirements] == [
        ("R-9", True),
        ("Works in the dark", False),
    ]


def test_a_group_where_components_are_asked_for(told: Told) -> None:
    group = "groups: {g: {components: {c: }}}\n"
    said = "it is a group (1:10 the group) | name its components"
    assert told(f"{group}nodes: {{n: {{implements: g}}}}") == [
        f"2:25 unknown-reference: no component named `g`: {said}"
    ]
    assert told(f"{group}chains: {{x: {{through: [g]}}}}") == [
        f"2:24 unknown-reference: no node, component or output named `g`: {said}"
    ]


def test_a_chain_through_a_node_named_as_its_component_hides_nothing(told: Told) -> None:
    # The chain knows what the node implements, wherever its section stands.
    assert (
        told("""
chains: {c: {through: [camera]}}
groups: {g: {components: {camera: {outputs: {x: std_msgs/msg/Empty}}}}}
nodes: {camera: {implements: g.camera}}
""")
        == []
    )


def test_after_the_suspects_are_taken_no_reference_is_resolved() -> None:
    resolver = ReferenceResolver({"component": {}}, {"host": {}}, [])
    assert resolver.finish_resolving() == frozenset()
    with pytest.raises(RuntimeError, match="after the suspects were taken"):
        resolver.resolve_plain_id(None, "host", "n")


def test_a_guess_that_stands_nowhere_has_no_label() -> None:
    reference = ScalarNode("camra", "camra", Span("a.yaml", 3, 5, 3, 10))
    declared = Span("b.yaml", 1, 1, 1, 7)
    told = diagnose_unknown_reference(reference, "node", "camera", declared, "x")
    assert ([label.span for label in told.labels], told.help) == ([declared], "did you mean `camera`?")
    assert diagnose_unknown_reference(reference, "node", "camera", NO_SPAN, "x").labels == ()
    assert diagnose_unknown_reference(reference, "node", None, declared, "x").labels == ()
