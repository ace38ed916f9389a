"""The rules about finding a project's files."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

RULES: tuple[Rule, ...] = (
    Rule(
        "ignored-file",
        Severity.NOTE,
        "A file below the project's folder that may be a part of it is not read.",
    ),
    Rule("missing-library", Severity.ERROR, "A library that archgen.yaml names cannot be read.", fixed=True),
    Rule("missing-source", Severity.WARNING, "A pattern in `sources` or `ros.interfaces` matches no file."),
    Rule(
        "wrong-pass",
        Severity.ERROR,
        "A pass of the project, rules in a file of its folder `passes`, cannot be read or comes to no end.",
    ),
)
