"""The rules about component types and their instances."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    Rule("unknown-port", Severity.ERROR, "An instance writes about a port that its type does not have.", fixed=True),
    Rule(
        "unknown-component",
        Severity.ERROR,
        "An instance writes about a component inside that its type does not have.",
        fixed=True,
    ),
    Rule(
        "changed-reference",
        Severity.ERROR,
        "A reference to a component type (`same_as`) writes what the type decides.",
        fixed=True,
    ),
    Rule("circular-types", Severity.ERROR, "A component type is made from itself, or holds itself.", fixed=True),
    Rule("abstract-type", Severity.ERROR, "A component is an instance of an abstract type.", fixed=True),
    Rule("narrower-type", Severity.ERROR, "A type that stands in the place of another has fewer ports.", fixed=True),
    Rule(
        "too-many-elements",
        Severity.ERROR,
        "Instances inside of instances stand for more components than can be written out.",
        fixed=True,
    ),
)
