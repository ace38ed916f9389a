"""Timing tables in documents: activities by period, rates and responses, loads of hosts, links and topics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction

from archgen.frozen import replace
from archgen.timing.analysis import ChainResult, EventPace, HostLoad
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.load.host_verdicts import name_host_verdict
from archgen.timing.load.work_terms import WorkTerm
from archgen.timing.system.timing_system import Activity
from archgen.views import element_references, inline_text, timing_words
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import PeriodStep as Step
from archgen.views.shapes import Column, Inlines, Status, Table, Text, drop_empty_columns, make_columns
from archgen.views.timing import load_charts, value_format
from archgen.views.timing.timing_lookup import TimingLookup

TIER_WORDS = {
    "declared": "declared, assumed to hold",
    "dedicated": "own core assumed",
    "host": "any order of execution",
    "priorities": "by fixed priorities",
    "non_preemptive": "by priorities, without preemption",
    "fifo": "first in, first out",
    "edf": "earliest deadline first",
    "fair": "fair shares of the cores",
    "executor": "single-threaded executor",
    "ros2_executor": "by rounds of the executor",
    "cores": "several cores",
    "whole host": "several cores as one",
    "whole way": "ways over hosts as wholes",
    "unknown": "",
}
"""How a response time was found, in words; see `Tier` in the timing analysis."""
_SHORT_TIER_WORDS = {
    **TIER_WORDS,
    "declared": "declared",
    "dedicated": "own core",
    "host": "any order",
    "priorities": "priorities",
}
"""Shorter words for the table of all activities, where a longer line in each row makes the table a page longer."""
LOAD_STATES: Mapping[str, Status] = {
    "overload": "missed",
    "undecided": "not proven",
    "unknown": "open",
    "schedulable": "met",
}
"""The states that verdicts on loads are shown as, the worst first."""
_SHOWN_PARTS = 6
_NAMED_OTHERS = 3
_MISSING_CORES = Text("not written", muted=True)
_MUTED_UNKNOWN = Text("unknown", muted=True)


def figure_cell(text: str, value: TimingValue) -> Inlines:
    """Return a table cell for a figure and its text; an unknown figure is muted, an empty one stays empty."""
    if text == value_format.UNKNOWN_FIGURE:
        return (_MUTED_UNKNOWN,)
    return (Text(text, sort_number=None if value.value is None else str(value.value)),) if text else ()


def lower_bound_cell(value: TimingValue) -> Inlines:
    """Return a table cell for a duration that is at least so much: a best case, a deadline."""
    return tuple(replace(run, is_lower=True) for run in figure_cell(value_format.display_lower_bound(value), value))


def duration_cell(value: TimingValue) -> Inlines:
    """Return a table cell for the upper bound of a duration."""
    return figure_cell(value_format.display_duration(value), value)


def deadline_cell(result: ChainResult, *, is_narrow: bool = False) -> Inlines:
    """Return a table cell for all deadlines of a chain: `400 ms, 95 % in 150 ms`; in a narrow column one below the other."""
    always = lower_bound_cell(result.deadline) if result.deadline else ()
    shares = [f"{each.name} in {format_duration(each.limit)}" for each in result.shares]
    if is_narrow:
        return (*always, *(Text(each, line_break=bool(always or at)) for at, each in enumerate(shares)))
    return (*always, Text(f"{', ' if always else ''}{', '.join(shares)}")) if shares else always


def describe_response(timing_lookup: TimingLookup, activity: Activity) -> Inlines:
    """Describe within what time an activity responds, how that was found, and of what it is the sum."""
    response = timing_lookup.analysis.responses[activity.id]
    tier = TIER_WORDS[response.tier]
    words = f"within {value_format.display_duration(response.worst)}{f' ({tier})' if tier else ''}"
    parts = _list_response_parts(timing_lookup, activity)
    return (Text(words), *((Text(": "), *inline_text.join_first(parts, _SHOWN_PARTS)) if len(parts) > 1 else ()))


def _list_response_parts(timing_lookup: TimingLookup, activity: Activity) -> list[Inlines]:
    """Return whose work a response is the sum of, its own first, then the most; of what is no plain sum its own work and the rest."""
    tick, response = timing_lookup.analysis.system.tick, timing_lookup.analysis.responses[activity.id].worst.value
    working = timing_lookup.response_terms.find_response(activity.id) if timing_lookup.response_terms else None
    if working is None or response is None or activity.wcet is None:
        return []
    times, beside = (_sum_parts(terms) for terms in (working.terms, working.beside_terms))
    own = activity.wcet
    if sum(times.values()) + working.blocked_time == working.window == working.value:
        own, ranked = times.pop(activity.id, 0), sorted(times, key=lambda name: (-times[name], name))
        parts = [(Text(_write_time(times[name] * tick)), *activity_link(timing_lookup, name)) for name in ranked]
        busy_names = sorted(beside, key=lambda name: (-beside[name], name))
        links = [activity_link(timing_lookup, name) for name in busy_names]
        lead = f"{_write_time(working.blocked_time * tick)}in which others may come first: "
        blocked = [(Text(lead), *inline_text.join_first(links, _NAMED_OTHERS))] if working.blocked_time else []
        return [(Text(f"{_write_time(own * tick)}of its own"),), *blocked, *parts]
    rest = response - own * tick
    words = f"{_write_time(rest)}in which others come first (archgen timing --why {activity.id})"
    return [(Text(f"{_write_time(own * tick)}of its own"),), (Text(words),)] if rest > 0 else []


def _sum_parts(terms: Iterable[WorkTerm]) -> dict[str, int]:
    """Add up what terms cost, by whose work it is."""
    times: dict[str, int] = {}
    for term in terms:
        for name, cost in term.parts:
            times[name] = times.get(name, 0) + term.events.number * cost
    return times


def _write_time(nanoseconds: Fraction) -> str:
    return f"{value_format.display_duration(TimingValue(nanoseconds))} "


def share_cell(value: TimingValue) -> Inlines:
    """Return a table cell for a share."""
    return figure_cell(value_format.display_share(value), value)


def byte_cell(value: TimingValue) -> Inlines:
    """Return a table cell for a number of bytes."""
    return figure_cell(value_format.display_bytes(value), value)


def traffic_cell(value: TimingValue) -> Inlines:
    """Return a table cell for bytes per second."""
    return figure_cell(value_format.display_traffic(value), value)


def make_period_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """Count the shown activities on each step of the period scale, and name them."""
    shown_activities = [
        activity
        for activity in timing_lookup.analysis.system.activities.values()
        if lookup.scope.shows_node(activity.node)
    ]
    # Every step in the order of the scale, so that the rows need no sorting; empty steps are dropped below.
    links_by_step: dict[Step, list[Inlines]] = {step: [] for step in value_format.PERIOD_STEP_WORDS}
    for activity in shown_activities:
        links_by_step[value_format.find_period_step(timing_lookup.analysis.paces.get(activity.id))].append(
            activity_link(timing_lookup, activity.id)
        )
    rows = tuple(
        (
            inline_text.to_inlines(
                Text(value_format.PERIOD_STEP_WORDS[step], sort_number=value_format.longest_period(step))
            ),
            inline_text.to_inlines(str(len(activity_links))),
            inline_text.join_inlines(activity_links),
        )
        for step, activity_links in links_by_step.items()
        if activity_links
    )
    columns = (Column("Period", 0.8), Column("Activities", 0.5, "right"), Column("Which", 4))
    return Table("table:periods", "Activities by period", columns, rows) if rows else None


def make_activity_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List every shown activity: behaviour, rate, longest gap and response, and where the figures come from."""
    rows = tuple(
        _activity_row(lookup, timing_lookup, activity, timing_lookup.rate_origins.get(activity.id, ()))
        for activity in timing_lookup.analysis.system.activities.values()
        if lookup.scope.shows_node(activity.node)
    )
    columns = make_columns(
        ("Activity", 1.5),
        ("Behaviour", 0.8),
        ("Rate", 0.8, "right"),
        ("Longest gap", 0.8, "right"),
        ("Source of the rate", 1.7),
        ("Response", 0.9, "right"),
        ("How it was found", 1.3),
    )
    return (
        Table("table:timing", "Behaviour, rate and response of every activity", columns, rows, wide=True)
        if rows
        else None
    )


def _activity_row(
    lookup: Lookup, timing_lookup: TimingLookup, activity: Activity, origin_ids: tuple[str, ...]
) -> tuple[Inlines, ...]:
    # Activities without any rate are still listed, by the behaviour that was written.
    pace = timing_lookup.analysis.paces.get(activity.id, EventPace(activity.behaviour))
    response = timing_lookup.analysis.responses.get(activity.id)
    return (
        activity_link(timing_lookup, activity.id),
        inline_text.to_inlines(timing_words.BEHAVIOUR_WORDS[pace.behaviour]) if pace.behaviour else (_MUTED_UNKNOWN,),
        figure_cell(_format_shown_rate(pace), pace.rate),
        # What runs on demand or once has no longest gap: nothing promises a next activation.
        duration_cell(pace.gap) if pace.behaviour not in {"on_demand", "once"} else (),
        describe_rate_source(lookup, timing_lookup, activity, pace, origin_ids),
        duration_cell(response.worst) if response else (_MUTED_UNKNOWN,),
        inline_text.to_inlines(_SHORT_TIER_WORDS[response.tier])
        if response and _SHORT_TIER_WORDS[response.tier]
        else (),
    )


def _format_shown_rate(pace: EventPace) -> str:
    """Format a rate; empty where having none is no gap in the knowledge."""
    if pace.behaviour == "once" or (pace.behaviour == "on_demand" and pace.rate.value is None):
        return ""
    return value_format.display_rate(pace.rate)


def describe_rate_source(
    lookup: Lookup, timing_lookup: TimingLookup, activity: Activity, pace: EventPace, origin_ids: tuple[str, ...]
) -> Inlines:
    """Return where a rate was written, or the activities it is inferred from."""
    if not pace.inferred:
        span = activity.places.get("period") or activity.places.get("rate") or activity.at
        place = element_references.place_run(lookup, span)
        return inline_text.to_inlines("written", *([Text(" "), place] if place else []))
    if pace.rate.value is None or not origin_ids:
        return ()
    return inline_text.to_inlines("from ", *link_origins(timing_lookup, origin_ids))


def link_origins(timing_lookup: TimingLookup, origin_ids: tuple[str, ...]) -> Inlines:
    """Link the activities that a rate is inferred from: `a, b and others`."""
    # `find_rate_origins` returns one more than is named here, which is how "and others" is known.
    producers = inline_text.join_inlines(activity_link(timing_lookup, name) for name in origin_ids[:3])
    return (*producers, *([Text(" and others")] if len(origin_ids) > 3 else []))  # noqa: PLR2004


def activity_link(timing_lookup: TimingLookup, activity_id: str) -> Inlines:
    """Link an activity to its node, by the activity's id."""
    activity = timing_lookup.analysis.system.activities.get(activity_id)
    return inline_text.to_inlines(Text(activity_id, ref=f"node:{activity.node}" if activity else None, code=True))


def rank_hosts(timing_lookup: TimingLookup) -> list[tuple[str, HostLoad]]:
    """Return the hosts with their loads: the worst verdict first, then the greatest share of the cores."""
    ranks = list(LOAD_STATES)
    return sorted(
        timing_lookup.analysis.hosts.items(),
        key=lambda item: (
            ranks.index(item[1].verdict),
            -(load_charts.share_of_cores(item[1].utilisation, item[1].cores).value or 0),
        ),
    )


def make_load_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List hosts with their load, and the bounds that it is compared with."""
    rows = tuple(
        (
            inline_text.to_inlines(Text(lookup.architecture.hosts[name].title, ref=f"host:{name}")),
            inline_text.count_to_inlines(load.cores) if load.cores else (_MISSING_CORES,),
            share_cell(load_charts.share_of_cores(load.utilisation, load.cores)),
            # Both bounds hold for a single core only.
            share_cell(load.rate_monotonic_bound) if load.cores == 1 else (),
            share_cell(load.earliest_deadline_bound) if load.cores == 1 else (),
            inline_text.to_inlines(Text(name_host_verdict(load), status=LOAD_STATES[load.verdict])),
            inline_text.to_inlines(value_format.describe_missing(load.utilisation, timing_lookup.analysis, 3)),
        )
        for name, load in rank_hosts(timing_lookup)
    )
    columns = make_columns(
        ("Host", 1.2),
        ("Cores", 0.5, "right"),
        ("Load of all cores", 0.9, "right"),
        ("Rate-monotonic bound", 0.8, "right"),
        ("Earliest-deadline bound", 0.8, "right"),
        ("Verdict", 1.1),
        ("Figures missing", 1.6),
    )
    return drop_blank_columns(Table("table:load", "Load of the hosts", columns, rows)) if rows else None


def make_traffic_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List links with the traffic they carry."""
    rows = tuple(
        (
            inline_text.to_inlines(Text(lookup.architecture.links[name].title, ref=f"link:{name}")),
            traffic_cell(load.traffic),
            share_cell(load.share),
            byte_cell(load.burst),
            duration_cell(load.queueing),
            inline_text.to_inlines(value_format.describe_missing(load.traffic, timing_lookup.analysis, 3)),
        )
        for name, load in timing_lookup.analysis.links.items()
    )
    columns = make_columns(
        ("Link", 1.2),
        ("Traffic", 0.9, "right"),
        ("Share", 0.7, "right"),
        ("Burst", 0.8, "right"),
        ("Longest queueing", 0.9, "right"),
        ("Figures missing", 1.5),
    )
    return drop_blank_columns(Table("table:traffic", "Traffic on links", columns, rows)) if rows else None


def make_bandwidth_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List topics with their message size and traffic, the most that is delivered first, what is unknown last."""
    topic_loads = timing_lookup.analysis.topics
    topic_names = sorted(
        (name for name in topic_loads if name in lookup.architecture.topics and _is_topic_shown(lookup, name)),
        key=lambda name: -(topic_loads[name].delivered.value or 0),
    )
    rows = tuple(
        (
            inline_text.to_inlines(inline_text.topic_link(name)),
            byte_cell(topic_loads[name].size),
            traffic_cell(topic_loads[name].published),
            traffic_cell(topic_loads[name].delivered),
        )
        for name in topic_names
    )
    columns = make_columns(
        ("Topic", 2.2), ("Message", 0.8, "right"), ("Published", 0.9, "right"), ("Delivered", 0.9, "right")
    )
    return Table("table:bandwidth", "Traffic of topics", columns, rows) if rows else None


def _is_topic_shown(lookup: Lookup, topic_name: str) -> bool:
    """Whether a shown node writes or reads a topic."""
    topic = lookup.architecture.topics[topic_name]
    return any(lookup.scope.shows_node(endpoint.node) for endpoint in (*topic.writers, *topic.readers))


def drop_blank_columns(table: Table) -> Table:
    """Drop the columns in which every cell is blank."""
    # `drop_empty_columns` looks for empty tuples, but a missing figure is a run of empty text.
    rows = tuple(tuple(() if is_blank(cell) else cell for cell in row) for row in table.rows)
    return drop_empty_columns(Table(table.anchor, table.caption, table.columns, rows))


def is_blank(cell: Inlines) -> bool:
    """Whether a cell shows nothing."""
    return all(not part.text for part in cell)
