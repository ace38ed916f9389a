"""Answers to single questions about timing: why, what if, what decides a chain, designed against measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.findings import timing_json
from archgen.findings.escape import visible
from archgen.findings.timing_text import Row, figure, table
from archgen.timing import wording
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.measured import Comparison
from archgen.timing.sensitivity import Sensitivity
from archgen.timing.value import Value
from archgen.timing.why import Line

Chains = Mapping[str, ChainResult]
Plain = dict[str, Any]


def why(lines: Iterable[Line]) -> Iterator[str]:
    """Yield the lines of a chain of reasoning, each step below what it supports, with its place."""
    for line in lines:
        place = f"   {line.at}" if line.at.file else ""
        yield visible(f"{'  ' * line.depth}{line.text}{place}")


def why_json(element: str, lines: Iterable[Line]) -> Plain:
    """Return a chain of reasoning as plain data."""
    steps = [{"depth": line.depth, "text": line.text, "at": str(line.at) if line.at.file else None} for line in lines]
    return {"version": timing_json.VERSION, "why": element, "steps": steps}


def changes(
    present: tuple[Analysis, Chains], changed: tuple[Analysis, Chains], written: Iterable[str]
) -> Iterator[str]:
    """Yield what some changed figures would change: all chains, and the hosts and elements that differ."""
    (before, chains), (after, others) = present, changed
    yield f"With {', '.join(visible(text) for text in written)}:"
    yield ""
    rows = list(_chain_rows(chains, others))
    if rows:
        yield "Chains"
        yield from table(rows)
        yield ""
    for title, made in (("Hosts", _host_rows(before, after)), ("Elements", _element_rows(before, after))):
        rows = list(made)
        if rows:
            yield f"{title} that differ"
            yield from table(rows)
            yield ""


def _chain_rows(before: Chains, after: Chains) -> Iterator[Row]:
    for name, now in before.items():
        then = after[name]
        verdicts = now.verdict if now.verdict == then.verdict else f"{now.verdict} -> {then.verdict}"
        yield name, _beside(now.bound, then.bound), _difference(now.bound, then.bound), verdicts if now.deadline else ""


def _host_rows(before: Analysis, after: Analysis) -> Iterator[Row]:
    for name, now in before.hosts.items():
        then = after.hosts[name]
        if now != then:
            verdicts = now.verdict if now.verdict == then.verdict else f"{now.verdict} -> {then.verdict}"
            yield name, f"load {_beside(now.utilisation, then.utilisation, wording.share)}", verdicts


def _element_rows(before: Analysis, after: Analysis) -> Iterator[Row]:
    for name in before.system.activities:
        here, there = before.paces[name], after.paces[name]
        response, other = before.responses[name].worst, after.responses[name].worst
        said = []
        if here.behaviour != there.behaviour:
            said.append(f"{here.behaviour or 'unknown'} -> {there.behaviour or 'unknown'}")
        if here.rate != there.rate:
            said.append(f"rate {_beside(here.rate, there.rate, wording.rate)}")
        if here.gap != there.gap:
            said.append(f"gap {_beside(here.gap, there.gap)}")
        if response != other:
            said.append(f"response {_beside(response, other)}")
        if said:
            yield name, ", ".join(said)


def _beside(now: Value, then: Value, write: Callable[[Fraction], str] = wording.duration) -> str:
    here, there = figure(now, write), figure(then, write)
    return here if here == there else f"{here} -> {there}"


def _difference(now: Value, then: Value) -> str:
    # The difference of two incomplete sums says nothing about the difference of the true values.
    if now.value is None or then.value is None or not (now.complete and then.complete) or now.value == then.value:
        return ""
    sign = "+" if then.value > now.value else "-"
    return f"({sign}{wording.duration(abs(then.value - now.value))})"


def sensitivity(chain: ChainResult, found: Sensitivity) -> Iterator[str]:
    """Yield a ranking of what decides a chain."""
    yield f"{chain.id}: {figure(chain.bound)}"
    yield ""
    if found.gains:
        yield "Improved by 10 %, each figure takes off"
        yield from table((wording.duration(g.gain), g.figure, f"now {g.written}", _at(g.at)) for g in found.gains)
    elif not found.gaps:
        yield "No single figure, improved by 10 %, shortens the chain."
    if found.untried:
        yield f"  {found.untried} more figures of elements on the same hosts were not tried"
    if found.gaps:
        yield ""
        yield "Not known; to be measured in this order"
        yield from table(
            (
                f"{gap.what} of {gap.element}",
                f"in {gap.terms} term{'s' if gap.terms != 1 else ''}",
                f"of {gap.chains} chain{'s' if gap.chains != 1 else ''}",
                f"works every {wording.duration(gap.plausible)}" if gap.plausible else "",
            )
            for gap in found.gaps
        )


def _at(at: object) -> str:
    return str(at) if getattr(at, "file", "") else ""


def sensitivity_json(chain: ChainResult, found: Sensitivity) -> Plain:
    """Return the ranking as plain data; gains in ms."""
    return {
        "version": timing_json.VERSION,
        "sensitivity": chain.id,
        "bound": timing_json.time(chain.bound),
        "gains": [
            {"figure": g.figure, "written": g.written, "gain": float(g.gain / 10**6), "at": _at(g.at) or None}
            for g in found.gains
        ],
        "unknown": [
            {"element": gap.element, "what": gap.what, "terms": gap.terms, "chains": gap.chains} for gap in found.gaps
        ],
        "untried": found.untried,
    }


def measured(compared: Iterable[Comparison]) -> Iterator[str]:
    """Yield designed beside measured figures, and the outliers by name."""
    rows = list(compared)
    if rows:
        yield from table([("id", "figure", "designed", "measured", ""), *map(_measured_row, rows)])
    outliers = [row for row in rows if row.verdict == "outlier"]
    yield ""
    figures = f"{len(rows)} figure{'s' if len(rows) != 1 else ''} measured"
    if not outliers:
        yield f"{figures}, no outliers" if rows else "nothing was measured that could be compared"
    else:
        yield f"{figures}, {len(outliers)} outlier{'s' if len(outliers) != 1 else ''}:"
        yield from (visible(f"  {row.id}: {row.key} {row.why}") for row in outliers)


def _measured_row(row: Comparison) -> Row:
    write = wording.rate if row.key == "rate" else wording.duration
    ratio = f" ({wording.number(100 * row.ratio)} %)" if row.ratio is not None else ""
    mark = "OUTLIER" if row.verdict == "outlier" else row.verdict
    return row.id, row.key, figure(row.designed, write), write(row.measured) + ratio, mark


def measured_json(compared: Iterable[Comparison]) -> Plain:
    """Return the comparison as plain data: rates in Hz, durations in ms."""
    return {
        "version": timing_json.VERSION,
        "measured": [
            {
                "id": row.id,
                "figure": row.key,
                "designed": (timing_json.quantity if row.key == "rate" else timing_json.time)(row.designed),
                "measured": float(row.measured if row.key == "rate" else row.measured / 10**6),
                "verdict": row.verdict,
                "why": row.why or None,
            }
            for row in compared
        ],
    }
