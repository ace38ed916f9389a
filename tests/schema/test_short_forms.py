"""Short forms become the normal form, places kept."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.language.language_tables import KEYS
from archgen.schema import fold_type_name, normalise_document, validate_document
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode, YamlDocument, node_to_data
from tests.language_samples import SCHEMA, complete_project, read_data


def normal(text: str) -> tuple[YamlDocument, tuple[Diagnostic, ...]]:
    """Read, validate and normalise text that is right."""
    document, found = yaml_parser.parse_yaml("f", text)
    assert document is not None, found
    assert validate_document(document) == ()
    return document, normalise_document(document)


@pytest.mark.parametrize(
    ("short", "full"),
    [
        ("partners: {p: CERTH}", {"partners": {"p": {"title": "CERTH"}}}),
        ("requirements: {R-1: x, R-2: }", {"requirements": {"R-1": {"title": "x"}, "R-2": {}}}),
        ("use_cases: {UC-4: x}", {"use_cases": {"UC-4": {"title": "x"}}}),
        ("groups: {g: G, h: }", {"groups": {"g": {"title": "G"}, "h": {}}}),
        ("groups: {g: {components: {c: C, d: }}}", {"groups": {"g": {"components": {"c": {"title": "C"}, "d": {}}}}}),
        ("nodes: {n: a.b}", {"nodes": {"n": {"implements": ["a.b"]}}}),
        ("nodes: {n: [a, b]}", {"nodes": {"n": {"implements": ["a", "b"]}}}),
        ("nodes: {n: {implements: a, kind: driver}}", {"nodes": {"n": {"implements": ["a"], "kind": ["driver"]}}}),
        (
            "nodes: {n: {publishes: {a: /x, b: [/x, /y], c: {topic: /z, qos: sensor_data}, d: }}}",
            {"nodes": {"n": {"publishes": {"a": {"topic": ["/x"]}, "b": {"topic": ["/x", "/y"]}, "c": {"topic": ["/z"], "qos": {"profile": "sensor_data"}}, "d": {}}}}},
        ),
        ("nodes: {n: {serves: {a: /x}, calls: {b: {name: /y}}}}", {"nodes": {"n": {"serves": {"a": {"name": "/x"}}, "calls": {"b": {"name": "/y"}}}}}),
        ("nodes: {n: {internal: {publishes: {a: ~/x}, calls: {b: c}}}}", {"nodes": {"n": {"internal": {"publishes": {"a": {"topic": ["~/x"]}}, "calls": {"b": {"name": "c"}}}}}}),
        ("nodes: {n: {parameters: {a: , b: {c: ~}}, host: }}", {"nodes": {"n": {"parameters": {"a": None, "b": {"c": None}}}}}),
        ("types: {A: pkg/msg/B, C: }", {"types": {"A": {"message": "pkg/msg/B"}, "C": {}}}),
        ("hosts: {h: PC}", {"hosts": {"h": {"title": "PC"}}}),
        ("containers: {c: h}", {"containers": {"c": {"host": "h"}}}),
        ("links: {l: [a, b]}", {"links": {"l": {"connects": ["a", "b"]}}}),
        ("links: {l: {latency: 1 ms}, m: {latency: {best: 1 ms}}}", {"links": {"l": {"latency": {"best": "1 ms", "worst": "1 ms"}}, "m": {"latency": {"best": "1 ms"}}}}),
        ("chains: {c: [a, b]}", {"chains": {"c": {"through": ["a", "b"]}}}),
        ("views: {v: tag:safety}", {"views": {"v": {"show": "tag:safety"}}}),
        ("groups:\nproject: {id: x, version: }", {"project": {"id": "x"}}),
    ],
)  # fmt: skip
def test_short_forms(short: str, full: object) -> None:
    assert node_to_data(normal(short)[0].root) == full


@pytest.mark.parametrize(
    ("short", "full"),
    [
        ("inputs: {a: x.y, b: [x, y], c: {from: z}, d: }", {"inputs": {"a": {"from": ["x.y"]}, "b": {"from": ["x", "y"]}, "c": {"from": ["z"]}, "d": {}}}),
        ("inputs: {}", {"inputs": {}}),
        ("inputs: ", {}),
        ("outputs: {a: Point cloud, b: 3, c: }", {"outputs": {"a": {"type": "Point cloud"}, "b": {"type": 3}, "c": {}}}),
        ("performance: {accuracy: 90 %, execution_time: 3 ms}", {"performance": {"overall": {"accuracy": "90 %", "execution_time": "3 ms"}}}),
        ("performance: {recall: {accuracy: a}, execution_time: 3 ms, x: }", {"performance": {"overall": {"execution_time": "3 ms"}, "recall": {"accuracy": "a"}, "x": {}}}),
        ("performance: {accuracy: {accuracy: a}}", {"performance": {"accuracy": {"accuracy": "a"}}}),
        ("timing: {rate: , outputs: {a: {conditional: }}}", {"timing": {"outputs": {"a": {}}}}),
    ],
)  # fmt: skip
def test_short_forms_in_a_component(short: str, full: object) -> None:
    document, found = normal(f"groups: {{g: {{components: {{c: {{{short}}}}}}}}}")
    assert found == ()
    assert node_to_data(document.root) == {"groups": {"g": {"components": {"c": full}}}}


def test_places_stay() -> None:
    document, _ = normal("nodes:\n  n: a.b\n")
    nodes = document.root.get("nodes")
    assert isinstance(nodes, MappingNode)
    node = nodes.entries["n"]
    assert node.key_span == Span("f", 2, 3, 2, 4)
    assert isinstance(node.value, MappingNode)
    assert node.value.span == node.value.entries["implements"].value.span == Span("f", 2, 6, 2, 9)


def test_an_indicator_written_twice() -> None:
    _, found = normal("groups: {g: {components: {c: {performance: {accuracy: a, overall: {accuracy: b}}}}}}")
    assert [(d.rule, d.message, d.span.column, d.labels[0].span.column) for d in found] == [
        ("conflicting-values", "`accuracy` of the indicator `overall` is written twice", 55, 78)
    ]


def test_names_of_types_are_folded() -> None:
    document, found = normal("types: {Point   cloud: a/B, 'Cafe\u0301': c/D, Point cloud: e/F}")
    assert node_to_data(document.root) == {"types": {"Point cloud": {"message": "a/B"}, "Caf\xe9": {"message": "c/D"}}}
    assert [(d.rule, d.message) for d in found] == [("duplicate-key", "the type `Point cloud` is written twice")]
    assert fold_type_name(" a  b ") == "a b"


WHOLE_LANGUAGE = Path(__file__).with_name("language.yaml").read_text(encoding="utf-8")
APART = {
    **dict.fromkeys(
        ("parameter", "parameter_declaration"), "a declaration or a set: what its keys mean is not in the schema"
    ),
    **dict.fromkeys(("rules", "layout", "variant_changes"), "names and sections, no keys"),
}
"""Kinds whose samples are not put together."""


def sample_all_keys() -> str:
    """Give the language once more, with a sample of each key that the text leaves out."""
    keys = {kind: SCHEMA["$defs"][kind]["properties"] for kind in KEYS.keys() & SCHEMA["$defs"].keys() - APART.keys()}
    # An output leads to an input of the project, and no sample is one.
    keys["output"] = keys["output"].keys() - {"to"}
    return json.dumps(complete_project(read_data(WHOLE_LANGUAGE), keys))


@pytest.mark.parametrize("text", [WHOLE_LANGUAGE, sample_all_keys()], ids=["written", "sampled"])
def test_the_whole_language_is_right_and_normalising_twice_changes_nothing(text: str) -> None:
    document, found = normal(text)
    assert found == ()
    once = node_to_data(document.root)
    assert validate_document(document) == ()
    assert normalise_document(document) == ()
    assert node_to_data(document.root) == once
