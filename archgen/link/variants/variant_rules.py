"""The rules about variants themselves."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    Rule("unknown-variant", Severity.ERROR, "A variant is built on one that the project does not have.", fixed=True),
    Rule("circular-variant", Severity.ERROR, "Variants are built on one another in a circle.", fixed=True),
    Rule(
        "missing-variant-part", Severity.ERROR, "A variant drops a key that is not there, or changes what it takes out."
    ),
    Rule("empty-variant-selector", Severity.WARNING, "A word of a variant's `without` selects nothing."),
)
