"""Tables of what is used together and of what is used in turn: fused inputs, resources, measured execution times."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.frozen import replace
from archgen.timing.analysis import EdgeFit, ServiceLoad
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.timing_system import Activity
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Fact, Inlines, Paragraph, Table, Text, drop_empty_columns, make_columns
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

if TYPE_CHECKING:
    from archgen.timing.chains.fused_inputs import FusedInputs

_VERDICT_WORDS = {"bearable": "bearable", "overload": "overloaded", "unknown": "unknown"}


def make_fused_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List the activities that use messages of several inputs together: how old these are, and how far apart."""
    rows = tuple(
        (
            timing_tables.activity_link(timing_lookup, fused.activity),
            inline_text.to_inlines(_describe_fusion(fused)),
            timing_tables.duration_cell(fused.apart),
            inline_text.to_inlines(_describe_ages(fused)),
        )
        for fused in timing_lookup.fused_inputs
        if lookup.scope.shows_node(timing_lookup.analysis.system.activities[fused.activity].node)
    )
    columns = make_columns(
        ("Activity", 1.5), ("Takes", 1.2), ("Apart, at most", 0.8, "right"), ("Age when it begins, at most", 2.5)
    )
    return Table("table:fused", "Messages that are used together", columns, rows) if rows else None


def _describe_fusion(fused: FusedInputs) -> str:
    return "all inputs" if fused.within is None else f"what is at most {format_duration(fused.within)} apart"


def _describe_ages(fused: FusedInputs) -> str:
    return ", ".join(
        f"{key.rpartition('.')[2]} {value_format.display_duration(age)}" for key, age in fused.ages.items()
    )


def make_resource_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List resources such as GPUs with their load, and how long each use takes at most, waiting included."""
    analysis = timing_lookup.analysis
    rows = tuple(
        (
            inline_text.to_inlines(name),
            inline_text.to_inlines(load.host),
            timing_tables.share_cell(load.utilisation),
            inline_text.to_inlines(_VERDICT_WORDS[load.verdict]),
            inline_text.join_inlines(
                (*timing_tables.activity_link(timing_lookup, user), Text(f" {value_format.display_duration(wait)}"))
                for user, wait in load.waits.items()
                if lookup.scope.shows_node(analysis.system.activities[user].node)
            ),
        )
        for name, load in analysis.resources.items()
    )
    columns = make_columns(
        ("Resource", 1), ("Host", 0.8), ("Load", 0.6, "right"), ("Verdict", 0.8), ("Longest use, waiting included", 2.5)
    )
    return Table("table:resources", "Resources that work on one use at a time", columns, rows) if rows else None


def make_measured_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List measured percentiles of execution times beside the longest, on which alone bounds rest."""
    tick = timing_lookup.analysis.system.tick
    rows = tuple(
        (
            timing_tables.activity_link(timing_lookup, activity.id),
            inline_text.to_inlines(describe_percentiles(activity, tick)),
            timing_tables.duration_cell(_find_longest(activity, tick)),
            inline_text.to_inlines("longest seen, not proven" if activity.wcet_measured else "written"),
        )
        for activity in timing_lookup.analysis.system.activities.values()
        if (activity.percentiles or activity.wcet_measured) and lookup.scope.shows_node(activity.node)
    )
    columns = make_columns(
        ("Activity", 1.5), ("Measured", 2), ("Longest", 0.8, "right"), ("Where the longest is from", 1.4)
    )
    return (
        Table("table:measured", "Measured execution times: bounds rest on the longest", columns, rows) if rows else None
    )


def describe_percentiles(activity: Activity, tick: Fraction) -> str:
    """Return the measured percentiles of an execution time: `p50 1 ms, p99 3 ms`."""
    return ", ".join(f"{key} {format_duration(Fraction(ticks * tick))}" for key, ticks in activity.percentiles.items())


def _find_longest(activity: Activity, tick: Fraction) -> TimingValue:
    return TimingValue(None, complete=False) if activity.wcet is None else TimingValue(activity.wcet * tick)


def list_use_facts(timing_lookup: TimingLookup, activity: Activity, suffix: str) -> Iterator[Fact]:
    """Yield what is known of one activity: what it fuses, which resources it uses, how long it was seen to take."""
    analysis = timing_lookup.analysis
    for fused in timing_lookup.fused_inputs:
        if fused.activity == activity.id:
            text = (
                f"{_describe_fusion(fused)}; at most {value_format.display_duration(fused.apart)} apart; age at most: "
            )
            words = inline_text.to_inlines(text + _describe_ages(fused))
            yield Fact("activity", f"Uses together{suffix}", words)
    for resource_id in activity.uses:
        load = analysis.resources.get(resource_id)
        wait = load.waits.get(activity.id) if load else None
        if wait is not None:
            text = f"{value_format.display_duration(wait)} at most for each use, waiting included"
            yield Fact("", f"{resource_id}{suffix}", inline_text.to_inlines(text))
    if activity.percentiles:
        words = inline_text.to_inlines(describe_percentiles(activity, analysis.system.tick))
        yield Fact("", f"Execution time{suffix}, measured", words)


def make_edge_blocks(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Block]:
    """List the edges whose readers keep another pace than their sources, the greatest loss first, and count those whose rates are unknown.

    Edges to readers on demand are left out: they want the newest sample only, so nothing is lost on the way to them.
    """
    on_demand_ids = {name for name, pace in timing_lookup.analysis.paces.items() if pace.behaviour == "on_demand"}
    all_edges = [
        edge
        for edge in timing_lookup.analysis.edges
        if _is_any_shown(lookup, timing_lookup, edge.arc.source, edge.arc.target)
    ]
    shown_edges = [edge for edge in all_edges if edge.arc.target not in on_demand_ids]
    # Greatest loss first, then the ids.
    notable_edges = sorted(
        (edge for edge in shown_edges if edge.loss.value or edge.beat.value),
        key=lambda edge: (-(edge.loss.value or 0), edge.arc.source, edge.arc.topic, edge.arc.target),
    )
    unknown_count = sum(edge.loss.value is None for edge in shown_edges)
    if not notable_edges and not unknown_count:
        return
    counted_edges = f"{inline_text.count_noun(len(shown_edges), 'edge')} whose readers are not asked on demand"
    sentences = [
        f"Of {counted_edges}, {len(notable_edges) or 'none'} are read less or more often than published, or in another rhythm."
    ]
    sentences += [f"Of {unknown_count} the rates are not known."] if unknown_count else []
    if notable_edges:
        sentences.append(
            "A reader that samples takes the newest and leaves the rest: that is a loss only where every sample counts. "
            "In the time of a beat the age of what is read runs through all values once. "
            "A queue is named where more can come before its reader looks than it holds."
        )
    yield Paragraph(inline_text.to_inlines(" ".join(sentences)))
    if notable_edges:
        columns = make_columns(
            ("From", 1.6),
            ("Topic", 2),
            ("To", 1.6),
            ("Not read", 0.8, "right"),
            ("Times read", 0.7, "right"),
            ("Beat", 0.8, "right"),
            ("Burst", 0.8, "right"),
            ("Queue", 0.6, "right"),
        )
        rows = tuple(_edge_row(timing_lookup, edge) for edge in notable_edges)
        table = Table("table:edges", "Topics whose readers keep another pace", columns, rows, wide=True)
        yield drop_empty_columns(table)


def _is_any_shown(lookup: Lookup, timing_lookup: TimingLookup, *activity_ids: str) -> bool:
    """Whether any of the activities runs in a shown node."""
    activities = timing_lookup.analysis.system.activities
    return any(lookup.scope.shows_node(activities[name].node) for name in activity_ids if name in activities)


def _edge_row(timing_lookup: TimingLookup, edge: EdgeFit) -> tuple[Inlines, ...]:
    """Make the row of an edge; cells that would only say that all is well stay empty."""
    arc, reread_factor = edge.arc, edge.rereads.value
    # The queue is only worth a column where more samples can arrive between two reads than it holds.
    queue_overflows = arc.depth and edge.queue.value and edge.queue.value > arc.depth
    return (
        _plain_activity_link(timing_lookup, arc.source),
        inline_text.to_inlines(inline_text.topic_link(arc.topic)),
        _plain_activity_link(timing_lookup, arc.target),
        _unbroken_figure(value_format.display_share(_bound_conditional_loss(edge.loss)), edge.loss)
        if edge.loss.value
        else (),
        timing_tables.figure_cell(value_format.display_number(reread_factor, 1), edge.rereads)
        if reread_factor and reread_factor != 1
        else (),
        _unbroken_figure(value_format.display_duration(edge.beat), edge.beat) if edge.beat.value else (),
        timing_tables.figure_cell(value_format.display_number(edge.queue.value), edge.queue)
        if queue_overflows and edge.queue.value
        else (),
        inline_text.count_to_inlines(arc.depth) if queue_overflows else (),
    )


def _plain_activity_link(timing_lookup: TimingLookup, activity_id: str) -> Inlines:
    """Link an activity in plain type, which is narrower than code type: the row has eight columns."""
    return tuple(replace(part, code=False) for part in timing_tables.activity_link(timing_lookup, activity_id))


def _unbroken_figure(text: str, value: TimingValue) -> Inlines:
    """Keep a figure and its unit on one line: a break in a narrow column costs a line in every row."""
    return timing_tables.figure_cell(text.replace(" ", "\u00a0"), value)


def _bound_conditional_loss(value: TimingValue) -> TimingValue:
    """Mark a loss as an upper bound where the output is conditional."""
    # The rate of a conditional output is itself an upper bound, so of what is really sent at most this share is lost.
    # The word is the start of an assumption that the rate analysis writes.
    is_bound = any(text.startswith("conditional") for text in value.assumptions)
    return replace(value, side="at most") if is_bound else value


def make_service_blocks(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Block]:
    """List servers with their callers: the time to answer all of them, and the callers' responses if they wait."""
    rows = tuple(
        _service_row(timing_lookup, server, load)
        for server, load in timing_lookup.analysis.services.items()
        if load.callers and _is_any_shown(lookup, timing_lookup, server, *load.callers)
    )
    columns = make_columns(
        ("Server", 1.2),
        ("Callers", 0.6, "right"),
        ("Answers all of them within", 1, "right"),
        ("A caller that waits for its answers responds within", 2.4),
    )
    if rows:
        yield Table("table:services-load", "Servers and their callers, one call each at once", columns, rows)


def _service_row(timing_lookup: TimingLookup, server_id: str, load: ServiceLoad) -> tuple[Inlines, ...]:
    wait_lines = [
        inline_text.to_inlines(
            *timing_tables.activity_link(timing_lookup, caller),
            ": ",
            *timing_tables.duration_cell(load.synchronous_responses[caller]),
        )
        for caller in load.callers
    ]
    return (
        timing_tables.activity_link(timing_lookup, server_id),
        inline_text.to_inlines(str(len(load.callers))),
        timing_tables.duration_cell(load.worst),
        inline_text.join_lines(wait_lines),
    )
