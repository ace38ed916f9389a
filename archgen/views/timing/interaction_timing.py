"""Timing between activities in documents: edges whose readers keep another pace or overrun queues; servers and callers."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import replace
from archgen.timing.analysis import EdgeFit, ServiceLoad
from archgen.timing.figures.timing_values import TimingValue
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Inlines, Paragraph, Table, drop_empty_columns
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup


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
    notable_edges = sorted((edge for edge in shown_edges if edge.loss.value or edge.beat.value), key=_loss_order)
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
        columns = (
            Column("From", 1.6),
            Column("Topic", 2),
            Column("To", 1.6),
            Column("Not read", 0.8, "right"),
            Column("Times read", 0.7, "right"),
            Column("Beat", 0.8, "right"),
            Column("Burst", 0.8, "right"),
            Column("Queue", 0.6, "right"),
        )
        rows = tuple(_edge_row(timing_lookup, edge) for edge in notable_edges)
        table = Table("table:edges", "Topics whose readers keep another pace", columns, rows, wide=True)
        yield drop_empty_columns(table)


def _is_any_shown(lookup: Lookup, timing_lookup: TimingLookup, *activity_ids: str) -> bool:
    """Whether any of the activities runs in a shown node."""
    activities = timing_lookup.analysis.system.activities
    return any(lookup.scope.shows_node(activities[name].node) for name in activity_ids if name in activities)


def _loss_order(edge: EdgeFit) -> tuple[object, ...]:
    """Return the sort key of an edge: greatest loss first, then the ids, for a stable order."""
    return (-(edge.loss.value or 0), edge.arc.source, edge.arc.topic, edge.arc.target)


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
    columns = (
        Column("Server", 1.2),
        Column("Callers", 0.6, "right"),
        Column("Answers all of them within", 1, "right"),
        Column("A caller that waits for its answers responds within", 2.4),
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
