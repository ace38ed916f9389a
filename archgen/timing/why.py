"""The chain of reasoning behind figures: each step a sentence, with the place in the files that it rests on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from archgen.source import NOWHERE, Span
from archgen.timing import wording
from archgen.timing.analysis import Analysis, ChainResult, Pace, Reason
from archgen.timing.arrivals import Arrivals
from archgen.timing.sums import known
from archgen.timing.system import Activity
from archgen.timing.value import Value

_WRITERS: Mapping[str, Callable[[Fraction], str]] = {
    "duration": wording.duration,
    "rate": wording.rate,
    "share": wording.share,
    "size": wording.size,
    "traffic": lambda count: f"{wording.size(count)}/s",
}


class Line(NamedTuple):
    """One step of the reasoning; deeper lines support the one above them."""

    depth: int
    text: str
    at: Span = NOWHERE


def of_activity(analysis: Analysis, name: str) -> Iterator[Line]:
    """Explain an activity: how often it works and how long it takes; then what triggers it, back to the sources."""
    yield from _activity(analysis, name, 0)
    # Each activity is explained once: triggers may form a loop, or reach the same source on many ways.
    shown = {name}
    stack = [(source, 1) for source in _triggering(analysis, name)]
    while stack:
        here, depth = stack.pop()
        if here in shown:
            yield Line(depth, f"{here}: see above")
            continue
        shown.add(here)
        yield from _activity(analysis, here, depth, rate_only=True)
        stack += ((source, depth + 1) for source in _triggering(analysis, here))


def of_chain(result: ChainResult) -> Iterator[Line]:
    """Explain a chain's bound: its terms in order."""
    yield Line(0, f"{result.id}: {_said(result.bound)} = S0 + R0 + sum of (link + S + R) along the chain")
    for term in result.terms:
        if term.link.value != 0:
            yield Line(1, f"link to {term.activity}: {_said(term.link)}")
        yield Line(1, f"{term.activity} waits {_said(term.sampling)}: {term.why}", term.at)
        yield Line(1, f"{term.activity} takes {_said(term.response)} at most")
    for assumption in result.bound.assumptions:
        yield Line(1, f"assumes: {assumption}")


def of_topic(analysis: Analysis, name: str) -> Iterator[Line]:
    """Explain a topic's traffic."""
    load = analysis.topics[name]
    published = f"{_said(load.published, 'traffic')} published, {_said(load.delivered, 'traffic')} delivered"
    yield Line(0, f"{name}: {published}, each message {_said(load.size, 'size')}")
    for writer in dict.fromkeys((arc.source, arc.output) for arc in analysis.system.arcs if arc.topic == name):
        pace = analysis.outputs.get(writer)
        if pace is not None:
            yield Line(1, f"{writer[0]} publishes at {_said(pace.rate, 'rate')}, largest gap {_said(pace.gap)}")
            yield from _reasons(pace.reasons, 2)
            yield from _reasons(analysis.paces[writer[0]].reasons, 2)


def of_host(analysis: Analysis, name: str) -> Iterator[Line]:
    """Explain a host's load: what each activity adds."""
    load = analysis.hosts[name]
    yield Line(0, f"{name}: load {_said(load.utilisation, 'share')} of {load.cores} cores: {load.verdict}")
    for activity, part in load.parts:
        yield Line(1, f"{activity} adds {_said(part, 'share')}", _place(analysis, activity))


def of_link(analysis: Analysis, name: str) -> Iterator[Line]:
    """Explain a link's traffic: what each topic adds."""
    load = analysis.links[name]
    yield Line(0, f"{name}: {_said(load.traffic, 'traffic')}, {_said(load.share, 'share')} of the bandwidth")
    yield Line(1, f"queueing of {_said(load.queueing)} at most for a burst of {_said(load.burst, 'size')}")
    for part, value in load.parts:
        yield Line(1, f"{part} adds {_said(value, 'traffic')}")


def _activity(analysis: Analysis, name: str, depth: int, *, rate_only: bool = False) -> Iterator[Line]:
    """Explain the rate of an activity, and its response unless only the rate is wanted."""
    pace, response = analysis.paces[name], analysis.responses[name]
    how = behaviour(analysis.system.activities[name], pace)
    text = f"{name}: {how}, rate {_said(pace.rate, 'rate')}, largest gap {_said(pace.gap)}"
    yield Line(depth, text, _place(analysis, name))
    yield from _reasons(pace.reasons, depth + 1)
    if not rate_only:
        takes = f"response between {_said(response.best)} and {_said(response.worst)} ({response.tier})"
        yield Line(depth, f"{name}: {takes}")
        yield from _reasons(response.reasons, depth + 1)


def behaviour(activity: Activity, pace: Pace) -> str:
    """Return the name of a behaviour, marked where it is inferred (a written period is as good as a behaviour)."""
    inferred = activity.behaviour_inferred and activity.period is None and pace.behaviour
    return f"{pace.behaviour or 'unknown'}{' (inferred)' if inferred else ''}"


def _reasons(reasons: Iterable[Reason], depth: int) -> Iterator[Line]:
    """Yield reasons as lines of one depth."""
    return (Line(depth, reason.text, reason.at) for reason in reasons)


def _triggering(analysis: Analysis, name: str) -> list[str]:
    """Return what fires an activity, the last first; nothing where its own clock does."""
    arrivals = Arrivals(analysis)
    arcs = analysis.system.into.get(name, ())
    return list(dict.fromkeys(arc.source for arc in reversed(arcs) if arrivals.fires(arc) and arc.source != name))


def _place(analysis: Analysis, name: str) -> Span:
    """Return where an activity is written."""
    activity = analysis.system.activities.get(name)
    return activity.at if activity else NOWHERE


def _said(value: Value, kind: str = "duration") -> str:
    """Format a figure with the sign of its side, or what is missing of it."""
    if value.value is None:
        missing = f" ({wording.listed(value.missing)})" if value.missing else ""
        return f"{wording.reason(value)}{missing}"
    write = _WRITERS[kind]
    if known(value):
        return ("<= " if value.side == "at most" else "") + write(value.value)
    return f">= {write(value.value)}"


def explain(analysis: Analysis, chains: Mapping[str, ChainResult], word: str) -> tuple[Line, ...]:
    """Explain what a complete id names: a chain, host, link, topic or activity; nothing for any other word."""
    if word in chains:
        return tuple(of_chain(chains[word]))
    for kind, explained in ((analysis.hosts, of_host), (analysis.links, of_link), (analysis.topics, of_topic)):
        if word in kind:
            return tuple(explained(analysis, word))
    return tuple(of_activity(analysis, word)) if word in analysis.system.activities else ()
