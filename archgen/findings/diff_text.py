"""A comparison for people: changes by group, then chains, findings, and who should look at it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from archgen.compare import ChainChange, Change, Comparison
from archgen.diagnostic import Diagnostic, Severity
from archgen.findings import diff_verdict
from archgen.findings.escape import plain_line, visible
from archgen.timing.analysis import ChainResult
from archgen.timing.sums import boundless
from archgen.timing.wording import duration

_SIGNS = {"added": "+", "removed": "-", "changed": "~", "renamed": ">", "moved": ">"}
_COLOURS = {"added": "32", "removed": "31", "changed": "33", "renamed": "36", "moved": "36"}
_SECTIONS = {
    "project": "Project",
    "chapter": "Chapters",
    "partner": "Partners",
    "use_case": "Use cases",
    "requirement": "Requirements",
    "type": "Types",
    "message": "Message definitions",
    "node": "Nodes",
    "port": "Nodes",
    "host": "Hosts",
    "container": "Containers",
    "link": "Links",
    "chain": "Chains",
    "policy": "Policies",
    "view": "Views",
}
"""The headings of what stands in no group, in their order."""


def render(found: Comparison, *, colour: bool = False) -> Iterator[str]:
    """Give the lines of a comparison."""
    if found.narrowed:
        yield from breaking(found, colour=colour)
        yield from diff_verdict.lines(found)
        return
    if found.empty:
        yield "no changes"
        return
    yield from breaking(found, colour=colour)
    for heading, changes in _sections([change for change in found.changes if not change.breaks], found):
        yield _paint(visible(heading), "1", colour=colour)
        for change in changes:
            yield from _change(change, colour=colour)
        yield ""
    yield from _chains(found.chains, colour=colour)
    judged = (("New findings", found.new), ("Cured findings", found.cured), ("Silenced findings", found.silenced))
    for heading, findings in judged:
        yield from _findings(heading, findings, colour=colour)
    yield summary(found)


def summary(found: Comparison) -> str:
    """Count what changed, and name whom it concerns: `3 changes (1 added, 2 removed), 1 new finding; concerns certh`."""
    kinds = Counter(str(change.kind) for change in found.changes)
    counts = ", ".join(f"{kinds[kind]} {kind}" for kind in _SIGNS if kinds[kind])
    words = [_counted(len(found.changes), "change") + (f" ({counts})" if counts else "")]
    words += [_counted(len(found.new), "new finding")] if found.new else []
    words += [_counted(len(found.cured), "cured finding")] if found.cured else []
    words += [_counted(len(found.silenced), "silenced finding")] if found.silenced else []
    concerns = f"; concerns {', '.join(found.owners)}" if found.owners else ""
    broken = sorted({partner for change in found.changes for partner in change.broken})
    breaks = f"; breaks {', '.join(broken)}" if broken else ""
    return visible(", ".join(words) + concerns + breaks)


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def breaking(found: Comparison, *, colour: bool) -> Iterator[str]:
    """Give the changes that break a partner, with the reasons."""
    breaking = [change for change in found.changes if change.breaks]
    if not breaking:
        return
    yield _paint("Breaking changes", "1", colour=colour)
    for change in breaking:
        yield from _change(change, colour=colour)
        for why in dict.fromkeys(each.why for each in change.breaks):
            yield visible(f"      {why}")
        if change.accepted is not None:
            older = found.before.architecture.review.accepted.get(change.element)
            entry = " (by an entry that was there before)" if older and older.reason == change.accepted else ""
            yield visible(f"      accepted{entry}: {change.accepted}")
    yield ""


def _sections(every: Sequence[Change], found: Comparison) -> Iterator[tuple[str, Sequence[Change]]]:
    """Put changes under the group that they stand in, then those that stand in none by sort."""
    groups = {**found.before.architecture.groups, **found.after.architecture.groups}
    held: dict[str, list[Change]] = {}
    for change in every:
        held.setdefault(_section(change), []).append(change)
    for name in ("", *_SECTIONS.values()):
        if name == "":
            for group in sorted(name for name in held if name.startswith("group ")):
                title = groups[group[6:]].title if group[6:] in groups else ""
                yield f"{group[6:]}: {title}" if title else group[6:], held.pop(group)
        elif name in held:
            yield name, held.pop(name)


def _section(change: Change) -> str:
    return _SECTIONS.get(change.sort) or f"group {change.element.partition('.')[0]}"


def _change(change: Change, *, colour: bool) -> Iterator[str]:
    sign = _paint(_SIGNS[change.kind], _COLOURS[change.kind], colour=colour)
    breaks = _paint(f"breaks {visible(', '.join(change.broken))}: ", "1;31", colour=colour) if change.breaks else ""
    yield f"  {sign} {breaks}{visible(change.text)}"


def _chains(chains: Sequence[ChainChange], *, colour: bool) -> Iterator[str]:
    if not chains:
        return
    yield _paint("Latency of chains", "1", colour=colour)
    for each in chains:
        deadline = f", deadline {duration(each.deadline.value)}" if each.deadline and each.deadline.value else ""
        verdict = f" ({each.after.verdict})" if each.after and deadline else ""
        yield visible(f"  {each.id}: {_bound(each.before)} → {_bound(each.after)}{_grown(each)}{deadline}{verdict}")
    yield ""


def _bound(result: ChainResult | None) -> str:
    if result is None:
        return "not there"
    if boundless(result.bound):
        return "no bound"
    if result.bound.value is None:
        return "unknown"
    return ("" if result.bound.complete else "at least ") + duration(result.bound.value)


def _grown(each: ChainChange) -> str:
    old, new = (side.bound.value if side else None for side in (each.before, each.after))
    if old is None or new is None or old == new:
        return ""
    return f" ({'+' if new > old else '-'}{duration(abs(new - old))})"


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
