"""What is shown of a project while somebody types: what a quick check finds, with what only a whole one could judge as it was.

Rules of timing, variants, and rules that wait for a slip to be mended lag behind: their findings stay, moved with their lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache

from archgen.analyses import TIMING_RULE_NAMES
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.findings.variant_findings import MISSING_RULES, UNUSED_RULES
from archgen.frozen import replace
from archgen.model.variant import BASE_NAME
from archgen.pipeline import CheckedProject
from archgen.syntax.mended_text import measure_common_lines, split_lines


def join_quick_findings(
    checked_project: CheckedProject, shown: Iterable[Diagnostic], shown_sources: SourceTexts, cursor: tuple[str, int]
) -> tuple[Diagnostic, ...]:
    """Return the findings to show after a check without timing and variants; `shown` are those that are shown until now, of
    the files as they were then. What is new in the line of the cursor comes later: half a word is no slip yet.
    """
    lagging_rules = checked_project.waiting_rules | TIMING_RULE_NAMES | {"unused-ignore"}
    if checked_project.architecture.variants:
        lagging_rules |= UNUSED_RULES | MISSING_RULES
    moved = list(_move_findings(shown, shown_sources, checked_project.sources))
    by_identity = {_identify(finding): finding for finding in moved}
    quick: dict[Diagnostic, None] = {}
    for finding in checked_project.findings:
        known = by_identity.get(_identify(finding))
        if finding.rule not in lagging_rules and (known or (finding.span.file, finding.span.line) != cursor):
            variants = (known.variants, known.absent_variants) if known else ((), ())
            quick[replace(finding, variants=variants[0], absent_variants=variants[1])] = None
    kept = (
        finding
        for finding in moved
        if finding.rule in lagging_rules or (finding.variants and BASE_NAME not in finding.variants)
    )
    return tuple(sorted({**quick, **dict.fromkeys(kept)}, key=lambda finding: finding.sort_key))


def keep_waiting_findings(
    checked_project: CheckedProject, shown: Iterable[Diagnostic], shown_sources: SourceTexts
) -> tuple[Diagnostic, ...]:
    """Return the findings of a whole check, with those that are shown of rules that wait for a slip to be mended."""
    if not checked_project.waiting_rules:
        return checked_project.findings
    moved = _move_findings(shown, shown_sources, checked_project.sources)
    kept = (finding for finding in moved if finding.rule in checked_project.waiting_rules)
    findings = dict.fromkeys((*checked_project.findings, *kept))
    return tuple(sorted(findings, key=lambda finding: finding.sort_key))


def _identify(finding: Diagnostic) -> tuple[str, str, str | None]:
    return finding.rule, finding.message, finding.element


def _move_findings(
    findings: Iterable[Diagnostic], old_sources: SourceTexts, new_sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield findings of older texts at the lines where the same is written now; without those of lines that are gone."""

    @cache
    def measure_shift(file: str) -> tuple[int, int, int]:
        return _measure_shift(old_sources.text_of(file), new_sources.text_of(file))

    def move_span(span: Span) -> Span | None:
        first_gone, first_below, lines_down = measure_shift(span.file)
        if span.line >= first_below:
            return span._replace(line=span.line + lines_down, end_line=span.end_line + lines_down)
        return span if span.line < first_gone else None

    for finding in findings:
        span = move_span(finding.span)
        if span is not None:
            labels = tuple(label._replace(span=move_span(label.span) or label.span) for label in finding.labels)
            yield replace(finding, span=span, labels=labels)


def _measure_shift(old_text: str | None, new_text: str | None) -> tuple[int, int, int]:
    """Return the first line that is gone, the first one below these, and by how many lines that is further down."""
    if old_text is None or new_text is None or old_text == new_text:
        return 0, 0, 0
    old_lines, new_lines = split_lines(old_text), split_lines(new_text)
    _, below = measure_common_lines(old_lines, new_lines)
    first_below = len(old_lines) - below + 1
    return min(first_below, len(new_lines) - below + 1), first_below, len(new_lines) - len(old_lines)
