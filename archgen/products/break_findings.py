"""Breaking changes as findings, for logs, annotations, SARIF and JUnit: whom a change breaks, why, and where it stands."""

from __future__ import annotations

from archgen.compare import Change, Comparison
from archgen.compare.change_spans import find_change_span, find_old_file
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.findings.comparison_rules import BREAKING_CHANGE
from archgen.link.interface_sources import interface_name_of
from archgen.pipeline import CheckedProject
from archgen.views.changes.breaking_verdict import describe_remedy, join_categories
from archgen.views.changes.partner_names import name_each, name_partners


def find_breaks(comparison: Comparison, checked_project: CheckedProject) -> tuple[Diagnostic, ...]:
    """Return a finding for each change that breaks a partner who did not agree, in the order of the comparison.

    `checked_project` is the second version: the findings stand in its files.
    """
    return tuple(
        _describe_break(change, comparison, checked_project) for change in comparison.changes if change.unheard_partners
    )


def _describe_break(change: Change, comparison: Comparison, checked_project: CheckedProject) -> Diagnostic:
    unheard_breaks = [each for each in change.breaks if each.agreement is None]
    reasons = dict.fromkeys(each.reason for each in unheard_breaks)
    categories = join_categories(each.category for each in unheard_breaks)
    partners = name_each(change.unheard_partners, name_partners(comparison))
    return Diagnostic(
        BREAKING_CHANGE.name,
        f"breaks {join_words(partners)} ({categories}): {change.text}; this {join_words(list(reasons))}",
        _find_span(change, comparison, checked_project),
        comparison.break_severity(change),
        help=describe_remedy(change, comparison),
        element=change.element_id,
    )


def _find_span(change: Change, comparison: Comparison, checked_project: CheckedProject) -> Span:
    """Return where the change stands; the whole file of a message, or in which the removed element stood."""
    span = find_change_span(change, comparison)
    if span.file:
        return span
    files = [
        *(
            file
            for file in checked_project.loaded_project.interface_files
            if interface_name_of(file) == change.element_id
        ),
        find_old_file(change, comparison),
    ]
    file = next((file for file in files if checked_project.sources.text_of(file) is not None), None)
    return Span.of_file(file) if file else NO_SPAN
