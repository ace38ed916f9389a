"""Charts of timing: each chain as a waterfall of its terms against the deadline, the load of each host by activity."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import ChainResult, HostLoad, Term
from archgen.timing.value import Value
from archgen.views import figures
from archgen.views.bars import Bar, Chart, Stretch
from archgen.views.index import Index
from archgen.views.timed import Timed
from archgen.views.words import plural

_MOST = 18
"""More activities than this on one host are summed up in one bar."""
_MS = 10**6
_TERMS = ("sampling", "response", "link")


def all_charts(view: Index) -> tuple[Chart, ...]:
    """Make the charts of all chains and hosts."""
    timed = view.timed
    return () if timed is None else (*_chains(view, timed), *_loads(view, timed))


def _chains(view: Index, timed: Timed) -> Iterator[Chart]:
    for result in timed.chains:
        if result.terms and result.id in view.architecture.chains:
            yield chain(view, timed, result)


def chain(view: Index, timed: Timed, result: ChainResult) -> Chart:
    """Draw the terms of a chain's bound, one below the other, and their sum against the deadline."""
    title = view.architecture.chains[result.id].title
    deadline = result.deadline.value if result.deadline else None
    said = verdict(result, timed)
    return Chart(
        f"chains/{result.id}",
        f"{title}: how the time adds up",
        "ms",
        (*_terms(timed, result), _sum(result), _best(result)),
        limit=(_float(deadline / _MS), f"deadline {figures.duration(Value(deadline))}") if deadline else None,
        said=said,
        legend=tuple(_legend(result)),
        alt=f"{title} runs through {', '.join(result.through)}. {said}",
    )


def _float(value: Fraction) -> float:
    return value.numerator / value.denominator


def _terms(timed: Timed, result: ChainResult) -> Iterator[Bar]:
    start = Fraction(0)
    for term in result.terms:
        values = (term.sampling, term.response, term.link)
        known = [value.value for value in values if value.value is not None]
        activity = timed.analysis.system.activities.get(term.activity)
        yield Bar(
            term.activity,
            tuple(_stretch(kind, value) for kind, value in zip(_TERMS, values, strict=True)),
            _added(values),
            _float(start / _MS),
            ref=f"node:{activity.node}" if activity else None,
        )
        start += sum(known, Fraction(0))


_KINDS = {"sampling": "waits", "response": "responds within", "link": "on the network"}


def _stretch(kind: str, value: Value) -> Stretch:
    length = None if value.value is None else _float(value.value / _MS)
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
    length = None if result.bound.value is None else _float(result.bound.value / _MS)
    sure = () if length is None else (Stretch(length, result.verdict, "", f"bound: {figures.duration(result.bound)}"),)
    more = () if result.bound.complete and length is not None else (Stretch(None, "open", "?", "no bound is known"),)
    return Bar("Reaction at the latest", (*sure, *more), figures.duration(result.bound), strong=True)


def _best(result: ChainResult) -> Bar:
    length = None if result.best.value is None else _float(result.best.value / _MS)
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


def _loads(view: Index, timed: Timed) -> Iterator[Chart]:
    loads = {host: load for host, load in timed.analysis.hosts.items() if load.parts}
    if loads:
        yield load_of_all(view, loads)
    for host, load in loads.items():
        yield load_of(view, timed, host, load)


def load_of_all(view: Index, loads: dict[str, HostLoad]) -> Chart:
    """Draw the load of every host against all of its cores, by activity."""
    bars = tuple(
        Bar(
            f"{view.architecture.hosts[host].title} ({plural(load.cores, 'core')})",
            (*_shares(load), *([Stretch(None, "load", "?", _more(load))] if _gaps(load) else [])),
            figures.share(of_cores(load.utilisation, load.cores)),
            mark=_bound(load),
            ref=f"host:{host}",
        )
        for host, load in loads.items()
    )
    return Chart(
        "load",
        f"{view.architecture.project.title}: load of the hosts",
        "%",
        bars,
        limit=(100.0, "all cores busy"),
        legend=(
            "load: activities, the largest first",
            *(["unknown"] if any(map(_gaps, loads.values())) else []),
            *(["mark: rate-monotonic bound"] if any(_bound(load) is not None for load in loads.values()) else []),
        ),
        alt="; ".join(f"{bar.title}: {bar.value}" for bar in bars),
    )


def _shares(load: HostLoad) -> Iterator[Stretch]:
    parts = [(name, value.value) for name, value in load.parts if value.value]
    for at, (name, value) in enumerate(sorted(parts, key=lambda part: -part[1])):
        share = Value(value / load.cores)
        kind = "other_load" if at % 2 else "load"
        yield Stretch(_float(value * 100 / load.cores), kind, name, f"{name}: {figures.share(share)}")  # type: ignore[arg-type]


def of_cores(value: Value, cores: int) -> Value:
    """Turn a number of busy cores into a share of all."""
    found = None if value.value is None else value.value / cores
    return Value(found, value.complete, value.missing, value.assumptions, value.side)


def _bound(load: HostLoad) -> float | None:
    """Place the bound on the scale; it holds for one core."""
    found = load.rate_monotonic_bound.value
    return _float(found * 100) if found is not None and load.cores == 1 else None


def _gaps(load: HostLoad) -> bool:
    return any(value.value is None for _, value in load.parts)


def _more(load: HostLoad) -> str:
    return "not known: " + ", ".join(name for name, value in load.parts if value.value is None)


def load_of(view: Index, timed: Timed, host: str, load: HostLoad) -> Chart:
    """Draw the load of one host, activity by activity, the largest first, and their sum."""
    ordered = sorted(load.parts, key=lambda part: (part[1].value is None, -(part[1].value or 0)))
    shown = ordered if len(ordered) <= _MOST else ordered[: _MOST - 1]
    total = of_cores(load.utilisation, load.cores)
    return Chart(
        f"load/{host}",
        f"{view.architecture.hosts[host].title}: load by activity",
        "%",
        (*_steps(timed, load, shown, ordered[len(shown) :]), _total(load, total), *_places(load)),
        limit=(100.0, "all cores busy" if load.cores > 1 else "busy all the time"),
        said=load_verdict(load),
        legend=(
            *(["unknown"] if _gaps(load) else []),
            *(["mark: rate-monotonic bound"] if _bound(load) is not None else []),
        ),
        alt=f"{view.architecture.hosts[host].title}: {figures.share(total)} of {plural(load.cores, 'core')}. "
        + load_verdict(load),
    )


def _steps(
    timed: Timed, load: HostLoad, shown: list[tuple[str, Value]], rest: list[tuple[str, Value]]
) -> Iterator[Bar]:
    start = Fraction(0)
    for name, value in shown:
        share = of_cores(value, load.cores)
        activity = timed.analysis.system.activities.get(name)
        ref = f"node:{activity.node}" if activity else None
        yield Bar(name, (_part(share, name),), figures.share(share), _float(start * 100), ref=ref)
        start += share.value or 0
    if rest:
        left = sum((value.value or Fraction(0) for _, value in rest), Fraction(0)) / load.cores
        gap = any(value.value is None for _, value in rest)
        share = Value(left, not gap)
        unknown = (Stretch(None, "load", "?", _more(load)),) if gap else ()
        yield Bar(f"{len(rest)} more", (_part(share, "the rest"), *unknown), figures.share(share), _float(start * 100))


def _part(share: Value, name: str) -> Stretch:
    length = None if share.value is None else _float(share.value * 100)
    return Stretch(length, "load", "", f"{name}: {figures.share(share)}")


def _total(load: HostLoad, total: Value) -> Bar:
    kinds = {"schedulable": "met", "overload": "missed"}
    length = None if total.value is None else _float(total.value * 100)
    parts = (Stretch(length, kinds.get(load.verdict, "open"), "", figures.share(total)),)  # type: ignore[arg-type]
    more = (Stretch(None, "open", "?", _more(load)),) if length is not None and _gaps(load) else ()
    return Bar("Together", (*parts, *more), figures.share(total), mark=_bound(load), strong=True)


def _places(load: HostLoad) -> Iterator[Bar]:
    """Draw the cores to which something is pinned and those that the rest shares, each against itself."""
    if len(load.places) < 2:  # noqa: PLR2004 - one place is the host
        return
    for name, cores, used in sorted(load.places, key=lambda place: (" " not in place[0], len(place[0]), place[0])):
        share = of_cores(used, cores)
        full = used.value is not None and used.value >= cores
        known = None if share.value is None else _float(share.value * 100)
        title = _place(name, cores)
        tooltip = f"{title}: {figures.share(share)} of {plural(cores, 'core')}"
        stretches: tuple[Stretch, ...] = (Stretch(known, "missed" if full else "best", "", tooltip),)
        if known is not None and not used.complete:
            stretches += (Stretch(None, "open", "?", tooltip),)
        yield Bar(title, stretches, figures.share(share))


def _place(name: str, cores: int) -> str:
    """Name a place on a host: `core 7`, or the cores that all else shares."""
    return name.partition(" ")[2] or f"the other {plural(cores, 'core')}"


def load_verdict(load: HostLoad) -> str:
    """Say in a sentence how a host stands."""
    said = figures.share(of_cores(load.utilisation, load.cores))
    cores = plural(load.cores, "core")
    if load.verdict == "overload":
        full = [
            _place(name, count) for name, count, used in load.places if used.value is not None and used.value >= count
        ]
        where = f" ({', '.join(full)})" if full and len(load.places) > 1 else ""
        return f"Overloaded{where}: {said} of {cores}."
    if load.verdict == "schedulable":
        return f"In time: {said} of {cores}, and everything is done before it is due again."
    unknown = sum(value.value is None for _, value in load.parts)
    if unknown and said == figures.UNKNOWN:
        return f"The load is not known: that of {plural(unknown, 'activity')} is missing."
    if unknown:
        return f"{said[0].upper()}{said[1:]} of {cores}; the load of {plural(unknown, 'activity')} is not known."
    return f"{said} of {cores}: below full load, so response times decide."
