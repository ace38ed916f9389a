"""A comparison for the terminal: changes by group, then chains, findings, and who should look at it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare import ChainChange, Change, Comparison
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.safe_text import defuse_command, make_visible
from archgen.emit.terminal import comparison_verdict
from archgen.views.changes import change_wording

_TERMINAL_SIGNS = {"added": "+", "removed": "-", "changed": "~", "renamed": ">", "moved": ">"}
_SIGN_COLOURS = {"added": "32", "removed": "31", "changed": "33", "renamed": "36", "moved": "36"}


def write_comparison_lines(comparison: Comparison, *, colour: bool = False) -> Iterator[str]:
    """Yield the lines of a comparison."""
    if comparison.only_breaking:
        yield from write_breaking_changes(comparison, colour=colour)
        yield from comparison_verdict.verdict_lines(comparison)
        return
    if comparison.is_empty:
        yield "no changes"
        return
    yield from write_breaking_changes(comparison, colour=colour)
    for change_group in change_wording.group_changes(
        [change for change in comparison.changes if not change.breaks], comparison
    ):
        yield _paint_text(make_visible(change_group.heading), "1", colour=colour)
        for change in change_group.changes:
            yield from _change_lines(change, colour=colour)
        yield ""
    yield from _chain_lines(comparison.chains, colour=colour)
    headed_findings = (
        ("New findings", comparison.new_findings),
        ("Cured findings", comparison.cured_findings),
        ("Silenced findings", comparison.silenced_findings),
    )
    for heading, findings in headed_findings:
        yield from _finding_lines(heading, findings, colour=colour)
    yield make_visible(change_wording.summarize_comparison(comparison))


def write_breaking_changes(comparison: Comparison, *, colour: bool) -> Iterator[str]:
    """Yield the changes that break a partner, with the reasons."""
    breaking_changes = [change for change in comparison.changes if change.breaks]
    if not breaking_changes:
        return
    yield _paint_text("Breaking changes", "1", colour=colour)
    # One cause often breaks several changes: its reason is written once, then "as above".
    told_reasons = set[str]()
    for change in breaking_changes:
        yield from _change_lines(change, colour=colour)
        change_reasons = dict.fromkeys(partner_break.reason for partner_break in change.breaks)
        for reason in change_reasons:
            if reason not in told_reasons:
                yield make_visible(f"      {reason}")
        if not told_reasons.isdisjoint(change_reasons):
            yield "      as above" if told_reasons.issuperset(change_reasons) else "      and as above"
        told_reasons |= change_reasons.keys()
        acceptance = change_wording.describe_acceptance(change, comparison)
        if acceptance:
            yield make_visible(f"      {acceptance}")
    yield ""


def _change_lines(change: Change, *, colour: bool) -> Iterator[str]:
    sign = _paint_text(_TERMINAL_SIGNS[change.kind], _SIGN_COLOURS[change.kind], colour=colour)
    breaks_note = (
        _paint_text(f"breaks {make_visible(', '.join(change.broken_partners))}: ", "1;31", colour=colour)
        if change.breaks
        else ""
    )
    yield f"  {sign} {breaks_note}{make_visible(change.text)}"


def _chain_lines(chains: Sequence[ChainChange], *, colour: bool) -> Iterator[str]:
    if not chains:
        return
    yield _paint_text("Latency of chains", "1", colour=colour)
    for chain_change in chains:
        grown, deadline, verdict = (
            change_wording.format_growth(chain_change),
            change_wording.format_deadline(chain_change),
            change_wording.format_verdict(chain_change),
        )
        grown = f" ({grown})" if grown else ""
        deadline = f", deadline {deadline}" + (f": {verdict}" if verdict else "") if deadline else ""
        yield make_visible(
            f"  {chain_change.id}: {change_wording.format_bound(chain_change.before)} → {change_wording.format_bound(chain_change.after)}{grown}{deadline}"
        )
    yield ""


def _finding_lines(heading: str, findings: Sequence[Diagnostic], *, colour: bool) -> Iterator[str]:
    if not findings:
        return
    severity_colours = {Severity.ERROR: "1;31", Severity.WARNING: "1;33", Severity.NOTE: "1;36"}
    yield _paint_text(heading, "1", colour=colour)
    for finding in findings:
        severity = finding.severity or Severity.ERROR
        place_note = f" ({finding.span})" if finding.span.file else ""
        yield f"  {_paint_text(f'{severity}[{finding.rule}]', severity_colours[severity], colour=colour)}: {make_visible(finding.message + place_note)}"
    yield ""


def _paint_text(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else defuse_command(text)
