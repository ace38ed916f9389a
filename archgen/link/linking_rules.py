"""The rules of linking that more than one of its modules reports."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    # About references.
    Rule("unknown-reference", Severity.ERROR, "A reference names nothing.", fixed=True),
    Rule("ambiguous-reference", Severity.ERROR, "A reference can mean several elements.", fixed=True),
    Rule("hidden-reference", Severity.WARNING, "A complete path hides another element that the same words may mean."),
    # About components inside of components and what connects them.
    Rule(
        "reaches-outside",
        Severity.ERROR,
        "Inside of a component type, a reference means something outside of it.",
        fixed=True,
    ),
    Rule("reaches-inside", Severity.WARNING, "A reference reaches past the ports of a composed component."),
    Rule("ambiguous-connection", Severity.WARNING, "`autoconnect` could join an input to several outputs."),
    Rule("several-sources", Severity.WARNING, "`from` of an instance gives one input several outputs."),
    Rule(
        "unused-node", Severity.NOTE, "What a component says of its own node is not used, since another node runs it."
    ),
    Rule(
        "duplicate-port",
        Severity.ERROR,
        "A composed component has an output and a component inside with one id.",
        fixed=True,
    ),
    # About types with fields.
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
    # About variants themselves.
    Rule("unknown-variant", Severity.ERROR, "A variant is built on one that the project does not have.", fixed=True),
    Rule("circular-variant", Severity.ERROR, "Variants are built on one another in a circle.", fixed=True),
    Rule(
        "missing-variant-part",
        Severity.ERROR,
        "A variant drops a key that is not there, changes what it takes out, or names something and changes nothing of it.",
    ),
    Rule("empty-variant-selector", Severity.WARNING, "A word of a variant's `without` selects nothing."),
)
