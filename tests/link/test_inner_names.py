"""A name means what is composed around its writer before anything else, from the inside to the outside."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link.reference_resolution import ReferenceResolver, find_inner_component

IDS = ("g.arm", "g.arm.motor", "g.arm.hand", "g.arm.hand.motor", "g.arm.hand.tip", "g.motor", "g.base")


@pytest.mark.parametrize(
    ("text", "writer", "found"),
    [
        ("motor", "g.arm.hand.tip", "g.arm.hand.motor"),
        ("motor", "g.arm.hand.motor", "g.arm.motor"),
        ("motor", "g.arm", "g.arm.motor"),
        ("hand.tip", "g.arm.motor", "g.arm.hand.tip"),
        # A group is looked up as everywhere.
        ("base", "g.arm.motor", None),
        ("motor", "g.base", None),
        ("nothing", "g.arm.hand.tip", None),
    ],
)
def test_the_innermost_one_is_meant(text: str, writer: str, found: str | None) -> None:
    kinds: dict[str, dict[str, Span]] = {kind: {} for kind in ("group", "output", "input", "node")}
    resolver = ReferenceResolver({**kinds, "component": dict.fromkeys(IDS, NO_SPAN)}, {}, [])
    assert find_inner_component(text, resolver, writer) == found
