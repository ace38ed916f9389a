"""A comparison for the terminal: changes by group, then chains, findings, and who should look at it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compare import ChainChange, Change, Comparison
from archgen.diagnostic import Diagnostic, Severity
from archgen.findings import diff_verdict
from archgen.findings.escape import plain_line, visible
from archgen.views.changes import telling

_SIGNS = {"added": "+", "removed": "-", "changed": "~", "renamed": ">", "moved": ">"}
_COLOURS = {"added": "32", "removed": "31", "changed": "33", "renamed": "36", "moved": "36"}


def render(found: Comparison, *, colour: bool = False) -> Iterator[str]:
    """Yield the lines of a comparison."""
    if found.narrowed:
        yield from breaking(found, colour=colour)
        yield from diff_verdict.lines(found)
        return
    if found.empty:
        yield "no changes"
        return
    yield from breaking(found, colour=colour)
    for part in telling.parts([change for change in found.changes if not change.breaks], found):
        yield _paint(visible(part.heading), "1", colour=colour)
        for change in part.changes:
            yield from _change(change, colour=colour)
        yield ""
    yield from _chains(found.chains, colour=colour)
    judged = (("New findings", found.new), ("Cured findings", found.cured), ("Silenced findings", found.silenced))
    for heading, findings in judged:
        yield from _findings(heading, findings, colour=colour)
    yield visible(telling.summary(found))


def breaking(found: Comparison, *, colour: bool) -> Iterator[str]:
    """Yield the changes that break a partner, with the reasons."""
    breaking = [change for change in found.changes if change.breaks]
    if not breaking:
        return
    yield _paint("Breaking changes", "1", colour=colour)
    # One cause often breaks several changes: its reason is written once, then "as above".
    said = set[str]()
    for change in breaking:
        yield from _change(change, colour=colour)
        reasons = dict.fromkeys(each.why for each in change.breaks)
        for why in reasons:
            if why not in said:
                yield visible(f"      {why}")
        if not said.isdisjoint(reasons):
            yield "      as above" if said.issuperset(reasons) else "      and as above"
        said |= reasons.keys()
        accepted = telling.accepted(change, found)
        if accepted:
            yield visible(f"      {accepted}")
    yield ""


def _change(change: Change, *, colour: bool) -> Iterator[str]:
    sign = _paint(_SIGNS[change.kind], _COLOURS[change.kind], colour=colour)
    breaks = _paint(f"breaks {visible(', '.join(change.broken))}: ", "1;31", colour=colour) if change.breaks else ""
    yield f"  {sign} {breaks}{visible(change.text)}"


def _chains(chains: Sequence[ChainChange], *, colour: bool) -> Iterator[str]:
    if not chains:
        return
    yield _paint("Latency of chains", "1", colour=colour)
    for each in chains:
        grown, deadline, verdict = telling.grown(each), telling.deadline(each), telling.verdict(each)
        grown = f" ({grown})" if grown else ""
        deadline = f", deadline {deadline}" + (f": {verdict}" if verdict else "") if deadline else ""
        yield visible(f"  {each.id}: {telling.bound(each.before)} → {telling.bound(each.after)}{grown}{deadline}")
    yield ""


def _findings(heading: str, findings: Sequence[Diagnostic], *, colour: bool) -> Iterator[str]:
    if not findings:
        return
    strong = {Severity.ERROR: "1;31", Severity.WARNING: "1;33", Severity.NOTE: "1;36"}
    yield _paint(heading, "1", colour=colour)
    for each in findings:
        severity = each.severity or Severity.ERROR
        place = f" ({each.span})" if each.span.file else ""
        yield f"  {_paint(f'{severity}[{each.rule}]', strong[severity], colour=colour)}: {visible(each.message + place)}"
    yield ""


def _paint(text: str, code: str, *, colour: bool) -> str:
    return f"\x1b[{code}m{text}\x1b[0m" if colour else plain_line(text)
