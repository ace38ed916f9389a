"""Charts of chains: the terms of a chain against its deadline. Charts of hosts are in `load_charts`."""

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
"""Kinds of term in the order in which they follow each other in time; fields of `Term`."""


def all_charts(view: Index) -> tuple[Chart, ...]:
    """Make the charts of all chains and hosts with something in scope; none without a timing analysis."""
    timed = view.timed
    return () if timed is None else (*_chains(view, timed), *loads.charts(view, timed))


def _chains(view: Index, timed: Timed) -> Iterator[Chart]:
    """Yield the chart of each chain that runs through a shown activity."""
    for result in timed.chains:
        shown = view.scope.nodes is None or not all(outside(view, timed, term.activity) for term in result.terms)
        if result.terms and shown and result.id in view.architecture.chains:
            yield chain(view, timed, result)


def chain(view: Index, timed: Timed, result: ChainResult) -> Chart:
    """Draw the terms of a chain's bound below each other, and their sum against the deadline."""
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
    """Yield a bar for each step, starting where the known part of the steps before it ends."""
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
        # An unknown part has no length; all that follows then begins too early, which the hatched piece shows.
        start += known(term)


def known(term: Term) -> Fraction:
    """Add up the known parts of a step, in ns."""
    return sum((value.value or Fraction(0) for value in (term.sampling, term.response, term.link)), Fraction(0))


_KINDS = {"sampling": "waits", "response": "responds within", "link": "on the network"}


def _stretch(kind: str, value: Value) -> Stretch:
    """Draw one part of a step."""
    length = None if value.value is None else as_float(value.value / _MS)
    said = figures.duration(value)
    return Stretch(length, kind, said, f"{_KINDS[kind]}: {said}")  # type: ignore[arg-type]


def _added(values: tuple[Value, ...]) -> str:
    """Format what a step adds: the sum of what is known, and "+ ?" where more is unknown."""
    known = [value for value in values if value.value is not None]
    total = sum((value.value or Fraction(0) for value in known), Fraction(0))
    # A part with a sign before it bounds from one side only; a zero sum of such parts says nothing.
    partial = len(known) < len(values) or any(figures.side(value) for value in known)
    if partial and not total:
        return figures.UNKNOWN
    return f"+ {figures.duration(Value(total))}{' + ?' if len(known) < len(values) else ''}"


def _sum(result: ChainResult) -> Bar:
    """Draw the bound; without a complete one a hatched piece follows."""
    length = None if result.bound.value is None else as_float(result.bound.value / _MS)
    sure = () if length is None else (Stretch(length, result.verdict, "", f"bound: {figures.duration(result.bound)}"),)
    more = () if result.bound.complete and length is not None else (Stretch(None, "open", "?", "no bound is known"),)
    return Bar("Reaction at the latest", (*sure, *more), figures.duration(result.bound), strong=True)


def _best(result: ChainResult) -> Bar:
    """Draw the best case."""
    length = None if result.best.value is None else as_float(result.best.value / _MS)
    stretch = Stretch(length, "best", "", f"best case: {figures.least(result.best)}")
    return Bar("At the earliest", (stretch,), figures.least(result.best))


def verdict(result: ChainResult, timed: Timed) -> str:
    """Describe in one sentence whether a chain meets its deadline, and by how much."""
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
    """Format an exact duration in ns."""
    return figures.duration(Value(value))


def _legend(result: ChainResult) -> Iterator[str]:
    """Yield the kinds of segment that this chart has."""
    for kind in _TERMS:
        if any(getattr(term, kind).value for term in result.terms):
            yield kind
    if any(_unknown(term) for term in result.terms) or not result.bound.complete:
        yield "unknown"


def _unknown(term: Term) -> bool:
    """Whether any part of a step is unknown."""
    return any(value.value is None for value in (term.sampling, term.response, term.link))
