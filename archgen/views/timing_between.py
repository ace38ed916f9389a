"""Timing between activities in documents: edges that lose samples, beat or overrun queues; servers and callers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.timing.analysis import EdgePace, ServiceLoad
from archgen.timing.value import Value
from archgen.views import figures, timing, words
from archgen.views.index import Index
from archgen.views.shapes import Block, Column, Inlines, Paragraph, Table, without_empty_columns
from archgen.views.timed import Timed


def edges(view: Index, timed: Timed) -> Iterator[Block]:
    """List the edges that lose samples or beat, the greatest loss first, and count those whose rates are unknown.

    Edges to readers on demand are left out: they want the newest sample only, so nothing is lost on the way to them.
    """
    asks = {name for name, pace in timed.analysis.paces.items() if pace.behaviour == "on_demand"}
    every = [edge for edge in timed.analysis.edges if _shown(view, timed, edge.arc.source, edge.arc.target)]
    shown = [edge for edge in every if edge.arc.target not in asks]
    found = sorted((edge for edge in shown if edge.loss.value or edge.beat.value), key=_order)
    unknown = sum(edge.loss.value is None for edge in shown)
    if not found and not unknown:
        return
    edges = f"{words.plural(len(shown), 'edge')} whose readers are not asked on demand"
    said = [f"Of {edges}, {len(found) or 'none'} lose samples or beat."]
    said += [f"Of {unknown} the rates are not known."] if unknown else []
    if found:
        said.append(
            "A reader that samples takes the newest and leaves the rest: that is a loss only where every sample counts. "
            "In the time of a beat the age of what is read runs through all values once. "
            "A queue is named where more can come before its reader looks than it holds."
        )
    yield Paragraph(words.text(" ".join(said)))
    if found:
        columns = (
            Column("From", 1.6),
            Column("Topic", 2),
            Column("To", 1.6),
            Column("Lost", 0.8, "right"),
            Column("Times read", 0.7, "right"),
            Column("Beat", 0.8, "right"),
            Column("Come at once", 0.8, "right"),
            Column("Queue", 0.6, "right"),
        )
        rows = tuple(_edge(timed, edge) for edge in found)
        table = Table("table:edges", "Edges that lose samples or beat", columns, rows, wide=True)
        yield without_empty_columns(table)


def _shown(view: Index, timed: Timed, *names: str) -> bool:
    """Whether any of the activities runs in a shown node."""
    activities = timed.analysis.system.activities
    return any(view.scope.node(activities[name].node) for name in names if name in activities)


def _order(edge: EdgePace) -> tuple[object, ...]:
    """Return the sort key of an edge: greatest loss first, then the ids, for a stable order."""
    return (-(edge.loss.value or 0), edge.arc.source, edge.arc.topic, edge.arc.target)


def _edge(timed: Timed, edge: EdgePace) -> tuple[Inlines, ...]:
    """Make the row of an edge; cells that would only say that all is well stay empty."""
    arc, again = edge.arc, edge.rereads.value
    # The queue is only worth a column where more samples can arrive between two reads than it holds.
    short = arc.depth and edge.queue.value and edge.queue.value > arc.depth
    return (
        _named(timed, arc.source),
        words.text(words.topic_link(arc.topic)),
        _named(timed, arc.target),
        _whole(figures.share(_upto(edge.loss))) if edge.loss.value else (),
        words.text(figures.number(again, 1)) if again and again != 1 else (),
        _whole(figures.duration(edge.beat)) if edge.beat.value else (),
        words.text(figures.number(edge.queue.value)) if short and edge.queue.value else (),
        words.text(str(arc.depth)) if short else (),
    )


def _named(timed: Timed, name: str) -> Inlines:
    """Link an activity in plain type, which is narrower than code type: the row has eight columns."""
    return tuple(replace(part, code=False) for part in timing.named(timed, name))


def _whole(figure: str) -> Inlines:
    """Keep a figure and its unit on one line: a break in a narrow column costs a line in every row."""
    return words.text(figure.replace(" ", "\u00a0"))


def _upto(value: Value) -> Value:
    """Mark a loss as an upper bound where the output is conditional."""
    # The rate of a conditional output is itself an upper bound, so of what is really sent at most this share is lost.
    # The word is the start of an assumption that the rate analysis writes.
    bounded = any(text.startswith("conditional") for text in value.assumptions)
    return replace(value, side="at most") if bounded else value


def services(view: Index, timed: Timed) -> Iterator[Block]:
    """List servers with their callers: the time to answer all of them, and the callers' responses if they wait."""
    rows = tuple(
        _service(timed, server, load)
        for server, load in timed.analysis.services.items()
        if load.callers and _shown(view, timed, server, *load.callers)
    )
    columns = (
        Column("Server", 1.2),
        Column("Callers", 0.6, "right"),
        Column("Answers all of them within", 1, "right"),
        Column("A caller that waits for its answers responds within", 2.4),
    )
    if rows:
        yield Table("table:services-load", "Servers and their callers, one call each at once", columns, rows)


def _service(timed: Timed, server: str, load: ServiceLoad) -> tuple[Inlines, ...]:
    waits = [
        words.text(*timing.named(timed, caller), ": ", *timing.figure(figures.duration(load.synchronous[caller])))
        for caller in load.callers
    ]
    return (
        timing.named(timed, server),
        words.text(str(len(load.callers))),
        timing.figure(figures.duration(load.worst)),
        words.lines(waits),
    )
