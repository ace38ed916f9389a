"""Timing tables in documents: activities by period, rates and responses, loads of hosts, links and topics."""

from __future__ import annotations

from archgen.source import Span
from archgen.timing.analysis import Pace
from archgen.timing.system import Activity
from archgen.views import figures, loads, paces, words
from archgen.views.index import Index
from archgen.views.shapes import (
    Column,
    Inlines,
    Table,
    Text,
    without_empty_columns,
)
from archgen.views.shapes import Pace as Step
from archgen.views.timed import Timed

TIERS = {
    "declared": "declared, assumed to hold",
    "dedicated": "own core assumed",
    "host": "any scheduler that never idles",
    "priorities": "by fixed priorities",
    "executor": "single-threaded executor",
    "cores": "several cores",
    "unknown": "",
}
"""How a response time was found, in words; see `Tier` in the timing analysis."""
_SHORT = {**TIERS, "declared": "declared", "dedicated": "own core", "host": "any scheduler", "priorities": "priorities"}
"""Shorter words for the table of all activities, where a longer line in each row makes the table a page longer."""
_VERDICTS = {
    "schedulable": "in time",
    "overload": "overloaded",
    "undecided": "not decided by load alone",
    "unknown": "unknown",
}
_QUIET = Text("unknown", muted=True)


def figure(text: str) -> Inlines:
    """Return a table cell for a formatted figure; an unknown figure is muted, an empty one stays empty."""
    return (_QUIET,) if text == figures.UNKNOWN else words.text(text) if text else ()


def steps(view: Index, timed: Timed) -> Table | None:
    """Count the shown activities on each step of the period scale, and name them."""
    shown = [each for each in timed.analysis.system.activities.values() if view.scope.node(each.node)]
    # Every step in the order of the scale, so that the rows need no sorting; empty steps are dropped below.
    found: dict[Step, list[Inlines]] = {step: [] for step in paces.NAMES}
    for each in shown:
        found[paces.step(timed.analysis.paces.get(each.id))].append(named(timed, each.id))
    rows = tuple(
        (words.text(paces.NAMES[step]), words.text(str(len(names))), words.joined(names))
        for step, names in found.items()
        if names
    )
    columns = (Column("Period", 0.8), Column("Activities", 0.5, "right"), Column("Which", 4))
    return Table("table:periods", "Activities by period", columns, rows) if rows else None


def elements(view: Index, timed: Timed) -> Table | None:
    """List every shown activity: behaviour, rate, longest gap and response, and where the figures come from."""
    rows = tuple(
        _element(timed, activity, timed.origins.get(activity.id, ()))
        for activity in timed.analysis.system.activities.values()
        if view.scope.node(activity.node)
    )
    columns = (
        Column("Activity", 1.5),
        Column("Behaviour", 0.8),
        Column("Rate", 0.8, "right"),
        Column("Longest gap", 0.8, "right"),
        Column("Where the rate is from", 1.7),
        Column("Response", 0.9, "right"),
        Column("How it was found", 1.3),
    )
    return (
        Table("table:timing", "Behaviour, rate and response of every activity", columns, rows, wide=True)
        if rows
        else None
    )


def _element(timed: Timed, activity: Activity, origin: tuple[str, ...]) -> tuple[Inlines, ...]:
    # Activities without any rate are still listed, by the behaviour that was written.
    pace = timed.analysis.paces.get(activity.id, Pace(activity.behaviour))
    response = timed.analysis.responses.get(activity.id)
    return (
        named(timed, activity.id),
        words.text(words.BEHAVIOURS[pace.behaviour]) if pace.behaviour else (_QUIET,),
        figure(_rate(pace)),
        # What runs on demand or once has no longest gap: nothing promises a next activation.
        figure(figures.duration(pace.gap)) if pace.behaviour not in {"on_demand", "once"} else (),
        source(timed, activity, pace, origin),
        figure(figures.duration(response.worst)) if response else (_QUIET,),
        words.text(_SHORT[response.tier]) if response and _SHORT[response.tier] else (),
    )


def _rate(pace: Pace) -> str:
    """Format a rate; empty where having none is no gap in the knowledge."""
    if pace.behaviour == "once" or (pace.behaviour == "on_demand" and pace.rate.value is None):
        return ""
    return figures.rate(pace.rate)


def source(timed: Timed, activity: Activity, pace: Pace, origin: tuple[str, ...]) -> Inlines:
    """Return where a rate was written, or the activities it is inferred from."""
    if not pace.inferred:
        at = place(activity.places.get("period") or activity.places.get("rate") or activity.at)
        return words.text("written", Text(f" {at}", muted=True)) if at else words.text("written")
    if pace.rate.value is None or not origin:
        return ()
    # `find_rate_origins` returns one more than is named here, which is how "and others" is known.
    producers = words.joined(named(timed, name) for name in origin[:3])
    return words.text("from ", *producers, *([" and others"] if len(origin) > 3 else []))  # noqa: PLR2004


def place(at: Span) -> str:
    """Format file and line of a span; empty where nothing was written."""
    return f"{at.file}:{at.line}" if at.file else ""


def named(timed: Timed, name: str) -> Inlines:
    """Link an activity to its node, by the activity's id."""
    activity = timed.analysis.system.activities.get(name)
    return words.text(Text(name, ref=f"node:{activity.node}" if activity else None, code=True))


def hosts(view: Index, timed: Timed) -> Table | None:
    """List hosts with their load, and the bounds that it is compared with."""
    rows = tuple(
        (
            words.text(Text(view.architecture.hosts[name].title, ref=f"host:{name}")),
            words.text(str(load.cores)),
            figure(figures.share(loads.of_cores(load.utilisation, load.cores))),
            # Both bounds hold for a single core only.
            figure(figures.share(load.rate_monotonic_bound)) if load.cores == 1 else (),
            figure(figures.share(load.earliest_deadline_bound)) if load.cores == 1 else (),
            words.text(_VERDICTS[load.verdict]),
            words.text(figures.missing(load.utilisation, timed.analysis, 3)),
        )
        for name, load in timed.analysis.hosts.items()
    )
    columns = (
        Column("Host", 1.2),
        Column("Cores", 0.5, "right"),
        Column("Load of all cores", 0.9, "right"),
        Column("Rate-monotonic bound", 0.8, "right"),
        Column("Earliest-deadline bound", 0.8, "right"),
        Column("Verdict", 1.1),
        Column("Missing", 1.6),
    )
    return tidy(Table("table:load", "Load of the hosts", columns, rows)) if rows else None


def links(view: Index, timed: Timed) -> Table | None:
    """List links with the traffic they carry."""
    rows = tuple(
        (
            words.text(Text(view.architecture.links[name].title, ref=f"link:{name}")),
            figure(figures.traffic(load.traffic)),
            figure(figures.share(load.share)),
            figure(figures.amount(load.burst)),
            figure(figures.duration(load.queueing)),
            words.text(figures.missing(load.traffic, timed.analysis, 3)),
        )
        for name, load in timed.analysis.links.items()
    )
    columns = (
        Column("Link", 1.2),
        Column("Traffic", 0.9, "right"),
        Column("Share", 0.7, "right"),
        Column("Burst", 0.8, "right"),
        Column("Longest queueing", 0.9, "right"),
        Column("Missing", 1.5),
    )
    return tidy(Table("table:traffic", "Traffic on links", columns, rows)) if rows else None


def topics(view: Index, timed: Timed) -> Table | None:
    """List topics with their message size and traffic."""
    shown = [name for name in timed.analysis.topics if name in view.architecture.topics and _shown(view, name)]
    found = timed.analysis.topics
    rows = tuple(
        (
            words.text(words.topic_link(name)),
            figure(figures.amount(found[name].size)),
            figure(figures.traffic(found[name].published)),
            figure(figures.traffic(found[name].delivered)),
        )
        for name in shown
    )
    columns = (
        Column("Topic", 2.2),
        Column("Message", 0.8, "right"),
        Column("Published", 0.9, "right"),
        Column("Delivered", 0.9, "right"),
    )
    return Table("table:bandwidth", "Traffic of topics", columns, rows) if rows else None


def _shown(view: Index, name: str) -> bool:
    """Whether a shown node writes or reads a topic."""
    topic = view.architecture.topics[name]
    return any(view.scope.node(endpoint.node) for endpoint in (*topic.writers, *topic.readers))


def tidy(table: Table) -> Table:
    """Drop the columns in which every cell is blank."""
    # `drop_empty_columns` looks for empty tuples, but a missing figure is a run of empty text.
    rows = tuple(tuple(() if blank(cell) else cell for cell in row) for row in table.rows)
    return without_empty_columns(Table(table.anchor, table.caption, table.columns, rows))


def blank(cell: Inlines) -> bool:
    """Whether a cell shows nothing."""
    return all(not part.text for part in cell)
