"""Policies as they are declared: flows, required sources, and what is accepted."""

from __future__ import annotations

from collections.abc import Callable

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link.declare.section_declaration import declare_policies
from archgen.link.mapping_values import EMPTY_MAPPING
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import Architecture, SourceDemand

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]

ROBOT = "groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}\n"


def test_a_policy_forbids_or_requires_or_both(linked: Linked) -> None:
    architecture, found = linked(
        ROBOT
        + "policies: {p: {require: {of: b, inputs_from: a, guarded_by: guard}}, q: {forbid: {from: a, to: b}}, "
        + "r: {require: {of: b}}, s: {require: {of: a, inputs_from: b}, forbid: {from: a}}}"
    )
    assert found == ()
    assert {name: (each.forbid_from, each.forbid_to, each.require) for name, each in architecture.policies.items()} == {
        "p": ("", "", SourceDemand("b", "a", "guard")),
        "q": ("a", "b", None),
        "s": ("", "", SourceDemand("a", "b")),
    }
    assert architecture.policies["p"].require is not None
    assert architecture.policies["p"].require.of_at.line == 2


def test_what_is_accepted_is_an_input_by_any_path(linked: Linked) -> None:
    policy = "policies: {{p: {{forbid: {{from: a, to: b}}, accepted: {{{}: why}}}}}}"
    architecture, found = linked(ROBOT + policy.format("b.i"))
    assert (found, architecture.policies["p"].accepted) == ((), {"g.b.i": "why"})
    assert architecture.policies["p"].accepted_places["g.b.i"].line == 2
    architecture, found = linked(ROBOT + policy.format("b.k"))
    assert ([each.rule for each in found], architecture.policies["p"].accepted) == (["unknown-reference"], {})


def test_without_policies_nothing_is_declared() -> None:
    resolver = ReferenceResolver({}, {}, [])
    assert declare_policies(EMPTY_MAPPING, resolver) == {}
