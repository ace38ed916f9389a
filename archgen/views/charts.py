"""Charts of timing: each chain as a waterfall of its terms against the deadline; those of hosts are in `loads`."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import ChainResult, Term
from archgen.timing.value import Value
from archgen.views import figures, loads
from archgen.views.bars import Bar, Chart, Stretch
from archgen.views.index import Index
from archgen.views.loads import as_float, outside
from archgen.views.timed import Timed

_MS = 10**6
_TERMS = ("sampling", "response", "link")


def all_charts(view: Index) -> tuple[Chart, ...]:
    """Make the charts of all chains and hosts that run through, or run, something of what is shown."""
    timed = view.timed
    return () if timed is None else (*_chains(view, timed), *loads.charts(view, timed))


def _chains(view: Index, timed: Timed) -> Iterator[Chart]:
    for result in timed.chains:
        shown = view.scope.nodes is None or not all(outside(view, timed, term.activity) for term in result.terms)
        if result.terms and shown and result.id in view.architecture.chains:
            yield chain(view, timed, result)


def chain(view: Index, timed: Timed, result: ChainResult) -> Chart:
    """Draw the terms of a chain's bound, one below the other, and their sum against the deadline."""
    title = view.architecture.chains[result.id].title
    deadline = result.deadline.value if result.deadline else None
    said, terms = verdict(result, timed), tuple(_terms(view, timed, result))
    return Chart(
        f"chains/{result.id}",
        f"{title}: how the time adds up",
        "ms",
        (*terms, _sum(result), _best(result)),
        limit=(as_float(deadline / _MS), f"deadline {figures.duration(Value(deadline))}") if deadline else None,
        said=said,
        legend=tuple(_legend(result)),
        notes=(loads.AROUND,) if any(bar.around for bar in terms) else (),
        alt=f"{title} runs through {', '.join(result.through)}. {said}",
    )


def _terms(view: Index, timed: Timed, result: ChainResult) -> Iterator[Bar]:
    start = Fraction(0)
    for term in result.terms:
        values = (term.sampling, term.response, term.link)
        activity = timed.analysis.system.activities.get(term.activity)
        yield Bar(
            term.activity,
            tuple(_stretch(kind, value) for kind, value in zip(_TERMS, values, strict=True)),
            _added(values),
            as_float(start / _MS),
            ref=f"node:{activity.node}" if activity else None,
            around=outside(view, timed, term.activity),
        )
        start += known(term)


def known(term: Term) -> Fraction:
    """Add up what is known of a step."""
    return sum((value.value or Fraction(0) for value in (term.sampling, term.response, term.link)), Fraction(0))


_KINDS = {"sampling": "waits", "response": "responds within", "link": "on the network"}


def _stretch(kind: str, value: Value) -> Stretch:
    length = None if value.value is None else as_float(value.value / _MS)
    said = figures.duration(value)
    return Stretch(length, kind, said, f"{_KINDS[kind]}: {said}")  # type: ignore[arg-type]


def _added(values: tuple[Value, ...]) -> str:
    """Write what a step adds: the sum of what is known, and that there is more."""
    known = [value for value in values if value.value is not None]
    total = sum((value.value or Fraction(0) for value in known), Fraction(0))
    partial = len(known) < len(values) or any(figures.side(value) for value in known)
    if partial and not total:
        return figures.UNKNOWN
    return f"+ {figures.duration(Value(total))}{' + ?' if len(known) < len(values) else ''}"


def _sum(result: ChainResult) -> Bar:
    length = None if result.bound.value is None else as_float(result.bound.value / _MS)
    sure = () if length is None else (Stretch(length, result.verdict, "", f"bound: {figures.duration(result.bound)}"),)
    more = () if result.bound.complete and length is not None else (Stretch(None, "open", "?", "no bound is known"),)
    return Bar("Reaction at the latest", (*sure, *more), figures.duration(result.bound), strong=True)


def _best(result: ChainResult) -> Bar:
    length = None if result.best.value is None else as_float(result.best.value / _MS)
    stretch = Stretch(length, "best", "", f"best case: {figures.least(result.best)}")
    return Bar("At the earliest", (stretch,), figures.least(result.best))


def verdict(result: ChainResult, timed: Timed) -> str:
    """Say in a sentence whether a chain is in time, and what decides it."""
    bound, deadline = result.bound, result.deadline
    lack = figures.missing(bound, timed.analysis, 4)
    if result.verdict == "open":
        said = figures.duration(bound) + (f"; no bound: {lack}" if lack else "")
        return f"Open: {said}." if deadline or lack else f"At the latest after {said}; it has no deadline."
    if deadline is None or deadline.value is None or bound.value is None:
        return f"{result.verdict.capitalize()}: {figures.duration(bound)}."
    spare = deadline.value - bound.value
    asked = f"deadline of {figures.duration(deadline)}"
    if result.verdict == "met":
        return f"Met: at the latest after {figures.duration(bound)}, {_spare(spare)} before the {asked}."
    return f"Missed: up to {figures.duration(bound)}, {_spare(-spare)} after the {asked}."


def _spare(value: Fraction) -> str:
    return figures.duration(Value(value))


def _legend(result: ChainResult) -> Iterator[str]:
    for kind in _TERMS:
        if any(getattr(term, kind).value for term in result.terms):
            yield kind
    if any(_unknown(term) for term in result.terms) or not result.bound.complete:
        yield "unknown"


def _unknown(term: Term) -> bool:
    return any(value.value is None for value in (term.sampling, term.response, term.link))
