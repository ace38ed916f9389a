"""How often and how much an interface carries, and which chains pass through it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.model.node import Endpoint
from archgen.timing import activities
from archgen.timing.analysis import ChainResult, Pace
from archgen.timing.sizes import MessageSize
from archgen.timing.system import Arc, System
from archgen.timing.value import Value
from archgen.views import figures, paces, words
from archgen.views.agreement.interfaces import Interface
from archgen.views.index import Index
from archgen.views.shapes import Inlines, Text
from archgen.views.timed import Timed

Fact = tuple[str, Inlines]
_TIERS = {"declared": "declared", "dedicated": "derived, a core of its own assumed"}
_PARTS = {
    "topic": (("Size", ""),),
    "service": (("Size of a request", "_Request"), ("Size of an answer", "_Response")),
    "action": (("Size of a goal", "_Goal"), ("Size of a result", "_Result"), ("Size of feedback", "_Feedback")),
}


def facts(view: Index, named: activities.Names, interface: Interface) -> Iterator[Fact]:
    """Yield rate, largest gap, size and traffic; for a service or action, how soon it answers."""
    if interface.flow == "physical":
        return
    timed = view.timed
    ends = [end for end in interface.givers if view.architecture.nodes[end.node].written]
    if timed is not None:
        for end in ends or interface.givers:
            suffix = f" of {end.node}" if len(ends) > 1 else ""
            yield from _paced(timed, activities.owner(view.architecture, named, end), end, suffix)
    for name, part in _PARTS[interface.flow]:
        size = _size(view, interface, part)
        if size.bytes is not None:
            yield name, words.text(_sized(size))
        elif interface.flow == "topic":
            yield name, words.spoken(f"not known: {size.why}", muted=True)
    if timed is not None and interface.flow == "topic":
        yield "Traffic", _traffic(timed, interface)


def _paced(timed: Timed, activity: str, end: Endpoint, suffix: str) -> Iterator[Fact]:
    if end.flow == "topic":
        pace = timed.analysis.outputs.get((activity, activities.key(end)), Pace(None))
        yield f"Rate{suffix}", _rate(timed, activity, pace)
        if pace.behaviour not in {"once", "on_demand"}:
            yield f"Largest gap{suffix}", _gap(pace)
        return
    response = timed.analysis.responses.get(activity)
    if response is None or response.worst.value is None:
        yield f"Answers within{suffix}", words.UNKNOWN
    else:
        kind = _TIERS.get(response.tier, "derived")
        yield f"Answers within{suffix}", words.text(figures.duration(response.worst), Text(f" ({kind})", muted=True))


def _rate(timed: Timed, activity: str, pace: Pace) -> Inlines:
    said = paces.said(pace)
    if said == "?":
        return words.UNKNOWN
    if pace.rate.value is None:
        return words.text(said)
    if not pace.inferred:
        return words.text(said, Text(" (written)", muted=True))
    origins = figures.from_words(timed.origins.get(activity, ()))
    return words.text(said, Text(f" (derived{f' {origins}' if origins else ''})", muted=True))


def _gap(pace: Pace) -> Inlines:
    said = figures.duration(pace.gap)
    return (
        words.UNKNOWN
        if pace.gap.value is None and said == figures.UNKNOWN
        else words.text(said, Text(" (derived)", muted=True))
    )


def _size(view: Index, interface: Interface, part: str) -> MessageSize:
    message = f"{interface.message}{part}" if interface.message else None
    return view.message_size(message, None if part else interface.type)


def _sized(size: MessageSize) -> str:
    amount = figures.amount(Value(Fraction(size.bytes or 0)))
    return f"{'' if size.exact else 'at most '}{amount} ({'written' if size.written else 'computed'})"


def _traffic(timed: Timed, interface: Interface) -> Inlines:
    loads = ((name, timed.analysis.topics.get(name)) for name in interface.names)
    said = [
        f"{figures.traffic(load.published)}{f' on {name}' if len(interface.names) > 1 else ''}"
        for name, load in loads
        if load and load.published.value is not None
    ]
    return words.text(", ".join(said)) if said else words.UNKNOWN


def chains(view: Index, named: activities.Names, interface: Interface) -> Iterator[ChainResult]:
    """Yield the chains that lead over the interface from giver to taker."""
    if view.timed is None:
        return
    keys = {activities.key(end) for end in interface.givers}
    taking = {activities.owner(view.architecture, named, end) for end in interface.takers}
    system = view.timed.analysis.system
    for result in view.timed.chains:
        steps = zip(result.through, result.through[1:], strict=False)
        arcs = (arc for before, after in steps for arc in _joining(system, before, after))
        if any({arc.source, arc.target} & taking and {arc.output, arc.input} & keys for arc in arcs):
            yield result


def _joining(system: System, before: str, after: str) -> list[Arc]:
    """Return what joins two steps of a chain: topics; services and actions only if there is no topic."""
    found = [arc for arc in system.out_of.get(before, ()) if arc.target == after]
    return [arc for arc in found if arc.role == "data"] or found
