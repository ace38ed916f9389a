"""The limits of references: how many pairs of ports they make, and how many names are guessed among."""

from __future__ import annotations

import pytest

from archgen.compose import expand_project
from archgen.diagnostics.source_span import NO_SPAN
from archgen.link import input_wiring
from archgen.link.element_outline import build_outline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import PortEdge
from archgen.schema import normalise_document
from archgen.syntax import yaml_parser


def test_pairs_are_counted_up_to_the_limit_and_no_further() -> None:
    """Half a million pairs are within it: the last reference that fits brings its outputs, the next one brings none."""
    document, _ = yaml_parser.parse_yaml(
        "a.yaml", "groups: {g: {components: {a: {outputs: {o: T, p: T}}, r: {inputs: {i: g.a, j: g.a, k: g.a}}}}}"
    )
    assert document is not None
    normalise_document(document)
    for already, brought in ((499_998, [2, 0, 0]), (499_999, [0, 0, 0]), (499_996, [2, 2, 0])):
        outline = build_outline(expand_project(document.root))
        spans = {
            "group": {"g": NO_SPAN},
            "component": dict.fromkeys(outline.components, NO_SPAN),
            "output": {"g.a.o": NO_SPAN, "g.a.p": NO_SPAN},
            "input": {},
            "node": {},
        }
        resolver = ReferenceResolver(spans, {}, [])
        wiring = input_wiring.InputWiring(outline, resolver, {})
        wiring.edges = [PortEdge("x", "y", NO_SPAN)] * already
        ports = [wiring.declare_input("g.r", entry) for entry in outline.inputs["g.r"].values()]
        assert [sum(len(c.outputs) for c in port.connections) for port in ports] == brought
        assert [d.message for d in resolver.diagnostics] == [
            "up to here references make more than 500,000 pairs of output and input; the rest is left out"
        ]


class _ManyNames(list[str]):
    """A few names that count as many."""

    def __init__(self, names: list[str], count: int) -> None:
        super().__init__(names)
        self.count_claimed = count

    def __len__(self) -> int:
        return self.count_claimed


@pytest.mark.parametrize(("count", "guess"), [(299_999, "camera"), (300_000, "camera"), (300_001, None)])
def test_names_are_guessed_until_the_budget_is_spent(count: int, guess: str | None) -> None:
    resolver = ReferenceResolver({kind: {} for kind in ("group", "component", "output", "input", "node")}, {}, [])
    assert resolver.guesser.guess_name("camra", _ManyNames(["camera"], count)) == guess
    left = 300_000 - count if guess else 0
    assert resolver.guesser.guess_name("lidr", _ManyNames(["lidar"], left)) == "lidar"
    assert resolver.guesser.guess_name("lidr", ["lidar"]) is None


def test_a_budget_that_is_overdrawn_is_spent() -> None:
    resolver = ReferenceResolver({kind: {} for kind in ("group", "component", "output", "input", "node")}, {}, [])
    assert resolver.guesser.guess_name("camra", _ManyNames(["camera"], 300_001)) is None
    assert resolver.guesser.guess_name("camra", ["camera"]) is None
