"""Findings in the protocol's words: the text is that of `archgen check`."""

from __future__ import annotations

from collections.abc import Callable

from lsprotocol import types
from pygls.workspace import PositionCodec

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.safe_text import make_visible
from archgen.findings.variant_findings import UNUSED_RULES, phrase_absence
from archgen.lsp.text_positions import FindLine, to_range
from archgen.pipeline import index_all_rules
from archgen.resources import HOME_URL

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}
_DEPRECATION_RULES = frozenset({"deprecated-use", "expired-use"})
_UNNEEDED_RULES = UNUSED_RULES - {"uncovered-requirement"}


def to_message(
    finding: Diagnostic, find_line: FindLine, to_uri: Callable[[str], str], codec: PositionCodec
) -> types.Diagnostic:
    """Return a finding as the protocol has it."""
    parts = [finding.message, phrase_absence(finding), f"help: {finding.help}" if finding.help else None]
    tags = [types.DiagnosticTag.Unnecessary] if finding.rule in _UNNEEDED_RULES else []
    tags += [types.DiagnosticTag.Deprecated] if finding.rule in _DEPRECATION_RULES else []
    related = [
        types.DiagnosticRelatedInformation(
            types.Location(to_uri(label.span.file), to_range(label.span, find_line, codec)), make_visible(label.text)
        )
        for label in finding.labels
        if label.span.file
    ]
    rule = index_all_rules().get(finding.rule)
    has_page = rule is not None and not rule.origin
    return types.Diagnostic(
        range=to_range(finding.span, find_line, codec),
        message="\n".join(make_visible(part) for part in parts if part),
        severity=_SEVERITIES[finding.effective_severity],
        code=finding.rule,
        code_description=types.CodeDescription(f"{HOME_URL}/blob/main/docs/rules/{finding.rule}.md")
        if has_page
        else None,
        source="archgen",
        tags=tags or None,
        related_information=related or None,
    )
