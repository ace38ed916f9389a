"""What the navigation marks: the groups and lists in which something is open, wrong, or a deadline is missed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal

from archgen.diagnostics import Diagnostic
from archgen.frozen import replace
from archgen.views.lookup import Lookup
from archgen.views.shapes import Page
from archgen.views.timing import chain_status, timing_verdicts

Mark = Literal["open", "missed", "error"]
_RANKS: Mapping[Mark, int] = {"open": 0, "missed": 1, "error": 2}


def mark_pages(lookup: Lookup, pages: Iterable[Page]) -> tuple[Page, ...]:
    """Return the pages with their marks, and chains with their verdicts."""
    chains = {f"chain:{result.id}": result for result in lookup.timing.chains} if lookup.timing else {}
    marks: dict[str, Mark] = {}
    for anchor, mark in _list_marks(lookup):
        marks[anchor] = max(mark, marks.get(anchor, mark), key=_RANKS.__getitem__)
    return tuple(
        replace(
            page,
            mark=marks.get(page.anchor),
            verdict=chain_status.chain_chip(chains[page.anchor]) if page.anchor in chains else (),
        )
        if page.anchor in marks or page.anchor in chains
        else page
        for page in pages
    )


def _list_marks(lookup: Lookup) -> Iterator[tuple[str, Mark]]:
    """Yield anchors with a mark; one may come several times."""
    architecture = lookup.architecture
    if lookup.findings:
        yield "page:findings", _judge_findings(lookup.findings)
    for element_id, findings in lookup.findings_of.items():
        mark = _judge_findings(findings)
        yield from ((f"group:{group}", mark) for group in _groups_of(lookup, element_id))
        if element_id in architecture.requirements:
            yield "page:requirements", mark
    for result in timing_verdicts.list_troubled_chains(lookup):
        mark = "missed" if result.verdict == "missed" else "open"
        yield f"chain:{result.id}", mark
        yield "page:chains", mark
        # Whoever could mend it: all on the way of what is late, else those whose figures are missing.
        names = (
            [term.activity for term in result.terms]
            if result.verdict in {"missed", "not proven"}
            else result.bound.missing
        )
        for name in names:
            activity = lookup.timing.analysis.system.activities.get(name) if lookup.timing else None
            yield from (
                (f"group:{group}", mark)
                for group in (_groups_of(lookup, activity.component or activity.node) if activity else [])
            )


def _judge_findings(findings: Sequence[Diagnostic]) -> Mark:
    return "error" if any(finding.severity == "error" for finding in findings) else "open"


def _groups_of(lookup: Lookup, element_id: str) -> list[str]:
    """Return the groups that an element belongs to: itself, its component's, or those that a node implements."""
    architecture = lookup.architecture
    if element_id in architecture.groups:
        return [element_id]
    node = architecture.nodes.get(element_id)
    component_ids = node.implements if node else (element_id,)
    components = (architecture.components.get(name) or architecture.shells.get(name) for name in component_ids)
    return list(dict.fromkeys(component.group for component in components if component))
