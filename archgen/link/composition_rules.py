"""The rules about components inside of components and what connects them."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
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
)
