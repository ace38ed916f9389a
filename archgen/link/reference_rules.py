"""The rules about references."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES = (
    Rule("unknown-reference", Severity.ERROR, "A reference names nothing.", fixed=True),
    Rule("ambiguous-reference", Severity.ERROR, "A reference can mean several elements.", fixed=True),
    Rule("hidden-reference", Severity.WARNING, "A complete path hides another element that the same words may mean."),
)
