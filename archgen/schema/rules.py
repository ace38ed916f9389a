"""The rules of reading: what can be wrong with a file by itself."""

from __future__ import annotations

from archgen.diagnostic import Rule, Severity


def _rule(name: str, doc: str) -> Rule:
    return Rule(name, Severity.ERROR, doc, fixed=True)


RULES: tuple[Rule, ...] = ()
