"""The rules about types with fields."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES = (
    Rule("unknown-field-type", Severity.ERROR, "A field has a type that nobody knows.", fixed=True),
    Rule("circular-fields", Severity.ERROR, "A type holds itself by its fields.", fixed=True),
    Rule(
        "conflicting-message",
        Severity.ERROR,
        "A type with fields defines no message, or one that is defined elsewhere.",
        fixed=True,
    ),
    Rule(
        "unbound-generic",
        Severity.ERROR,
        "A generic type is used without the types that it is made for, or with a wrong number of them.",
        fixed=True,
    ),
)
