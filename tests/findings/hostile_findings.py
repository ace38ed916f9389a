"""Findings whose every text tries to be more than text."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN, Span
from tests.hostile import TEXTS

HOSTILE = TEXTS | {
    "lines": "a\nb\r\nc\r::error::d",
    "xml": "]]> -- <!-- <![CDATA[ x ]]> &amp; &#0; <failure/> \"'",
    "controls": "\0\x01\x08\x0b\x1b[31m\x7f\x85\ufffe\uffff",
    "surrogates": "\ud800 \udfff \ud83d",
    "directions": "\u202eabc\u202c \u2066x\u2069 \u200f \u061c",
    "links": "[a](1) [b](javascript:c) {0} {{x}} `d` ![e](f)",
    "brackets": "[" * 50_000 + "](",
    "backticks": "`" * 50_001,
    "large": "wide " * 20_000,
}


def hostile_findings(text: str) -> list[Diagnostic]:
    """Put a text wherever a finding has one: message, help, element, labels, file names."""
    at, there = Span("archgen.yaml", 1, 2, 1, 3), Span(text[:200], 2, 1, 4, 1)
    labels = (Label(at, text), Label(there, text), Label(NO_SPAN, text))
    findings = (
        Diagnostic("unread-output", text, at, Severity.ERROR, labels, text, text),
        Diagnostic("unread-output", text, there, Severity.WARNING, labels, text, None),
        Diagnostic("unfed-input", text, NO_SPAN, Severity.NOTE, (), None, text),
    )
    return [*findings, *findings]
