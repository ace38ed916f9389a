"""Say once what is wrong in a component type, and which of its instances have it; of a shipped type say it at them."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from archgen.analyses import NO_LONGER_LOOKED_FOR
from archgen.diagnostics import Diagnostic, Label, Span, join_words, keep_first
from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component

_MAX_NAMED = 3
"""So many further instances are named."""


class _TypePlaces:
    """Whether a place lies in a component type. Types are written beside each other, never in one another."""

    def __init__(self, type_spans: Iterable[Span]) -> None:
        self._spans: dict[str, list[Span]] = {}
        for span in sorted(type_spans, key=_start_of):
            self._spans.setdefault(span.file, []).append(span)

    def __contains__(self, span: Span) -> bool:
        spans = self._spans.get(span.file, [])
        index = bisect_right(spans, _start_of(span), key=_start_of) - 1
        return index >= 0 and _start_of(span) <= (spans[index].end_line, spans[index].end_column)


def _start_of(span: Span) -> tuple[int, int]:
    return span.line, span.column


def gather_instance_findings(
    diagnostics: Iterable[Diagnostic],
    architecture: Architecture,
    type_spans: Sequence[Span],
    shipped_spans: frozenset[Span] = frozenset(),
) -> list[Diagnostic]:
    """Return the findings with those that stand in a component type joined, each with the places of its instances.

    `type_spans` are where component types are written. All that ships with archgen counts as written in
    `shipped_spans`: what is found there is moved to the component that has it.
    """
    if shipped_spans:
        diagnostics = [_leave_shipped_place(each, architecture, shipped_spans) for each in diagnostics]
        type_spans = [span for span in type_spans if span not in shipped_spans]
    if not type_spans:
        return list(diagnostics)
    type_places = _TypePlaces(type_spans)
    gathered: dict[tuple[str, Span], list[Diagnostic]] = {}
    others: list[Diagnostic] = []
    for diagnostic in diagnostics:
        if diagnostic.span in type_places and _find_component(architecture, diagnostic.element):
            gathered.setdefault((diagnostic.rule, diagnostic.span), []).append(diagnostic)
        else:
            labels = tuple(dict.fromkeys(label for label in diagnostic.labels if label.span != diagnostic.span))
            others.append(replace(diagnostic, labels=labels) if len(labels) < len(diagnostic.labels) else diagnostic)
    return [*others, *(_join_findings(same, architecture, type_places) for same in gathered.values())]


def _leave_shipped_place(
    diagnostic: Diagnostic, architecture: Architecture, shipped_spans: frozenset[Span]
) -> Diagnostic:
    """Return a finding at the component that it is about, without labels at what nobody can change."""
    labels = tuple(label for label in diagnostic.labels if label.span not in shipped_spans)
    component = _find_component(architecture, diagnostic.element) if diagnostic.span in shipped_spans else None
    span = component.at if component else diagnostic.span
    if span == diagnostic.span and len(labels) == len(diagnostic.labels):
        return diagnostic
    return replace(diagnostic, span=span, labels=labels)


def _join_findings(same: Sequence[Diagnostic], architecture: Architecture, type_places: _TypePlaces) -> Diagnostic:
    instances = list({each.id: each for each in _list_instances(same, architecture, type_places)}.values())
    if not instances:
        return same[0]
    first, further = instances[0], instances[1:]
    text = f"in the instance `{first.id}`"
    if further:
        text += f", and in {join_words(keep_first([f'`{each.id}`' for each in further], _MAX_NAMED))}"
    return replace(same[0], labels=(*same[0].labels, Label(first.at, text)))


def _list_instances(
    same: Sequence[Diagnostic], architecture: Architecture, type_places: _TypePlaces
) -> Iterator[Component]:
    """Yield the instances that stand in no type themselves, around what findings are about."""
    for diagnostic in same:
        component = _find_component(architecture, diagnostic.element)
        while component and component.parent and component.at in type_places:
            component = architecture.shells.get(component.parent)
        if component and component.at not in type_places:
            yield component


def _find_component(architecture: Architecture, element_id: str | None) -> Component | None:
    """Return the component, composed or not, that an id means, or whose port or node it means."""
    node = architecture.nodes.get(element_id or "")
    names = (*node.wholes, *node.implements)[:1] if node else (element_id or "", (element_id or "").rpartition(".")[0])
    for name in names:
        component = architecture.find_component(name)
        if component:
            return component
    return None


MAX_FINDINGS_PER_RULE = 1_000
"""Nobody reads more, and a stranger's 50 kB of policies can make 300,000 findings of 300 bytes each."""


def limit_findings(findings: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the first findings of each rule, in their order; one more says how many of the rule are left out.

    That one stands where the first finding that is left out would, and keeps its severity.
    """
    totals = Counter(finding.rule for finding in findings)
    bounded_rules = {finding.rule for finding in findings if finding.message == NO_LONGER_LOOKED_FOR}
    if all(total <= MAX_FINDINGS_PER_RULE for total in totals.values()):
        return tuple(findings)
    seen = Counter[str]()
    kept: list[Diagnostic] = []
    for finding in findings:
        seen[finding.rule] += 1
        if seen[finding.rule] <= MAX_FINDINGS_PER_RULE:
            kept.append(finding)
        elif seen[finding.rule] == MAX_FINDINGS_PER_RULE + 1:
            left_out = totals[finding.rule] - MAX_FINDINGS_PER_RULE
            at_least = "at least " if finding.rule in bounded_rules else ""
            message = f"{at_least}{left_out:,} more findings of this rule, from here on, are left out"
            kept.append(
                replace(finding, message=message, labels=(), help="mend some of the others first", element=None)
            )
    return tuple(kept)
