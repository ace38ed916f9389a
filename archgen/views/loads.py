"""Charts of load: all hosts by activity, and each host activity by activity."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import HostLoad
from archgen.timing.value import Value
from archgen.views import figures
from archgen.views.bars import Bar, Chart, Stretch
from archgen.views.index import Index
from archgen.views.timed import Timed
from archgen.views.words import plural

_MOST = 18
"""A host with more activities gets one bar for all that do not fit."""
AROUND = "Grey names stand outside of the selected part."
"""Note below a chart with bars outside of the selection."""


def outside(view: Index, timed: Timed, name: str) -> bool:
    """Whether an activity lies outside of the shown part; False for unknown ids."""
    activity = timed.analysis.system.activities.get(name)
    return activity is not None and not view.scope.node(activity.node)


def as_float(value: Fraction) -> float:
    """Turn an exact value into a float for drawing."""
    return value.numerator / value.denominator


def charts(view: Index, timed: Timed) -> Iterator[Chart]:
    """Yield the chart of all hosts with something shown, then one chart for each of them."""
    loads = {
        host: load
        for host, load in timed.analysis.hosts.items()
        # One shown activity is enough: the host is then charted with all of its load, since the limit applies to all.
        if load.parts and not all(outside(view, timed, name) for name, _ in load.parts)
    }
    if loads:
        yield load_of_all(view, loads)
    for host, load in loads.items():
        yield load_of(view, timed, host, load)


def load_of_all(view: Index, loads: dict[str, HostLoad]) -> Chart:
    """Draw the load of every host as a share of all its cores, split by activity."""
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
    """Yield the known parts of a load, largest first, alternating between two shades so that neighbours differ."""
    parts = [(name, value.value) for name, value in load.parts if value.value]
    for at, (name, value) in enumerate(sorted(parts, key=lambda part: -part[1])):
        share = Value(value / load.cores)
        kind = "other_load" if at % 2 else "load"
        yield Stretch(as_float(value * 100 / load.cores), kind, name, f"{name}: {figures.share(share)}")  # type: ignore[arg-type]


def of_cores(value: Value, cores: int) -> Value:
    """Turn a number of busy cores into a share of all cores; what is known about the value stays."""
    found = None if value.value is None else value.value / cores
    return Value(found, value.complete, value.missing, value.assumptions, value.side)


def _bound(load: HostLoad) -> float | None:
    """Return the rate-monotonic bound in percent; None where it is unknown or the host has several cores."""
    found = load.rate_monotonic_bound.value
    # The bound is a theorem about one core.
    return as_float(found * 100) if found is not None and load.cores == 1 else None


def _gaps(load: HostLoad) -> bool:
    """Whether the load of any activity is unknown."""
    return any(value.value is None for _, value in load.parts)


def _more(load: HostLoad) -> str:
    """Name the activities whose load is unknown."""
    return "not known: " + ", ".join(name for name, value in load.parts if value.value is None)


def load_of(view: Index, timed: Timed, host: str, load: HostLoad) -> Chart:
    """Draw the load of one host, activity by activity, largest first, and their sum."""
    # Unknown loads come last: their bars have no length.
    ordered = sorted(load.parts, key=lambda part: (part[1].value is None, -(part[1].value or 0)))
    # One fewer than fits, because the bar for the remaining ones needs a row, too.
    shown = ordered if len(ordered) <= _MOST else ordered[: _MOST - 1]
    total = of_cores(load.utilisation, load.cores)
    steps = tuple(_steps(view, timed, load, shown, ordered[len(shown) :]))
    return Chart(
        f"load/{host}",
        f"{view.architecture.hosts[host].title}: load by activity",
        "%",
        (*steps, _total(load, total), *_places(load)),
        limit=(100.0, "all cores busy" if load.cores > 1 else "busy all the time"),
        said=load_verdict(load),
        legend=(
            *(["unknown"] if _gaps(load) else []),
            *(["mark: rate-monotonic bound"] if _bound(load) is not None else []),
        ),
        notes=(AROUND,) if any(bar.around for bar in steps) else (),
        alt=f"{view.architecture.hosts[host].title}: {figures.share(total)} of {plural(load.cores, 'core')}. "
        + load_verdict(load),
    )


def _steps(
    view: Index, timed: Timed, load: HostLoad, shown: list[tuple[str, Value]], rest: list[tuple[str, Value]]
) -> Iterator[Bar]:
    """Yield a bar for each listed activity, starting where the one before ends, and one for the remaining ones."""
    start = Fraction(0)
    for name, value in shown:
        share = of_cores(value, load.cores)
        activity = timed.analysis.system.activities.get(name)
        ref = f"node:{activity.node}" if activity else None
        yield Bar(
            name,
            (_part(share, name),),
            figures.share(share),
            as_float(start * 100),
            ref=ref,
            around=outside(view, timed, name),
        )
        # Bars stand end to end, so the last one ends at the sum below them.
        start += share.value or 0
    if rest:
        left = sum((value.value or Fraction(0) for _, value in rest), Fraction(0)) / load.cores
        gap = any(value.value is None for _, value in rest)
        share = Value(left, not gap)
        unknown = (Stretch(None, "load", "?", _more(load)),) if gap else ()
        yield Bar(
            f"{len(rest)} more", (_part(share, "the rest"), *unknown), figures.share(share), as_float(start * 100)
        )


def _part(share: Value, name: str) -> Stretch:
    length = None if share.value is None else as_float(share.value * 100)
    return Stretch(length, "load", "", f"{name}: {figures.share(share)}")


def _total(load: HostLoad, total: Value) -> Bar:
    """Draw the sum, coloured by the verdict; unknown parts follow as a hatched piece."""
    kinds = {"schedulable": "met", "overload": "missed"}
    length = None if total.value is None else as_float(total.value * 100)
    parts = (Stretch(length, kinds.get(load.verdict, "open"), "", figures.share(total)),)  # type: ignore[arg-type]
    more = (Stretch(None, "open", "?", _more(load)),) if length is not None and _gaps(load) else ()
    return Bar("Together", (*parts, *more), figures.share(total), mark=_bound(load), strong=True)


def _places(load: HostLoad) -> Iterator[Bar]:
    """Yield a bar for each pinned core and for the cores that all else shares, each compared with itself."""
    if len(load.places) < 2:  # noqa: PLR2004 - one place is the host
        return
    # Pinned cores have a blank in their name (`pc core 7`), the shared ones do not and come last. Length before text,
    # so that core 10 follows core 9.
    for name, cores, used in sorted(load.places, key=lambda place: (" " not in place[0], len(place[0]), place[0])):
        share = of_cores(used, cores)
        full = used.value is not None and used.value >= cores
        known = None if share.value is None else as_float(share.value * 100)
        title = _place(name, cores)
        tooltip = f"{title}: {figures.share(share)} of {plural(cores, 'core')}"
        stretches: tuple[Stretch, ...] = (Stretch(known, "missed" if full else "best", "", tooltip),)
        if known is not None and not used.complete:
            stretches += (Stretch(None, "open", "?", tooltip),)
        yield Bar(title, stretches, figures.share(share))


def _place(name: str, cores: int) -> str:
    """Name the cores of a place: `core 7`, or those that all else shares."""
    return name.partition(" ")[2] or f"the other {plural(cores, 'core')}"


def load_verdict(load: HostLoad) -> str:
    """Describe in one sentence how a host copes with its load."""
    said = figures.share(of_cores(load.utilisation, load.cores))
    cores = plural(load.cores, "core")
    if load.verdict == "overload":
        # A host may be overloaded although its total is below 100 %: one pinned core is enough, so it is named.
        full = [
            _place(name, count) for name, count, used in load.places if used.value is not None and used.value >= count
        ]
        where = f" ({', '.join(full)})" if full and len(load.places) > 1 else ""
        return f"Overloaded{where}: {said} of {cores}."
    if load.verdict == "schedulable":
        return f"In time: {said} of {cores}, and everything is done before it is due again."
    unknown = sum(value.value is None for _, value in load.parts)
    # Nothing at all is known, so there is no figure to begin the sentence with.
    if unknown and said == figures.UNKNOWN:
        return f"The load is not known: that of {plural(unknown, 'activity')} is missing."
    if unknown:
        return f"{said[0].upper()}{said[1:]} of {cores}; the load of {plural(unknown, 'activity')} is not known."
    return f"{said} of {cores}: below full load, so response times decide."
