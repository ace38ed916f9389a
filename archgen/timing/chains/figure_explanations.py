"""The chain of reasoning behind figures: each step a sentence, with the place in the files that it rests on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.timing.analysis import Analysis, ChainResult, EventPace, HostLoad, Reason
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.chains.unfound_bounds import describe_unfound_places, group_by_host
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import is_known_bound, is_unfound, list_assumptions
from archgen.timing.system.timing_system import Activity

_FIGURE_FORMATS: Mapping[str, Callable[[Fraction], str]] = {
    "duration": figure_wording.format_duration,
    "rate": figure_wording.format_rate,
    "share": figure_wording.format_share,
    "size": figure_wording.format_size,
    "traffic": lambda count: f"{figure_wording.format_size(count)}/s",
}


class ReasonLine(NamedTuple):
    """One step of the reasoning; deeper lines support the one above them."""

    depth: int
    text: str
    at: Span = NO_SPAN


def explain_activity(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain an activity: how often it works and how long it takes; then what triggers it, back to the sources."""
    yield from _activity_lines(analysis, name, 0)
    # Each activity is explained once: triggers may form a loop, or reach the same source on many ways.
    explained_ids = {name}
    stack = [(source, 1) for source in _triggering_activities(analysis, name)]
    while stack:
        current, depth = stack.pop()
        if current in explained_ids:
            yield ReasonLine(depth, f"{current}: see above")
            continue
        explained_ids.add(current)
        yield from _activity_lines(analysis, current, depth, rate_only=True)
        stack += ((source, depth + 1) for source in _triggering_activities(analysis, current))


def explain_chain(result: ChainResult) -> Iterator[ReasonLine]:
    """Explain a chain's bound: its terms in order."""
    yield ReasonLine(
        0,
        f"{result.id}: {_format_figure(result.bound)}, the sum of all that follows: what each step waits and takes, and links",
    )
    for term in result.terms:
        if term.link.value != 0:
            yield ReasonLine(1, f"link to {term.activity}: {_format_figure(term.link)}")
        yield ReasonLine(1, f"{term.activity} waits {_format_figure(term.sampling)}: {term.why}", term.at)
        takes_text = f"takes {_format_figure(term.response)} at most"
        if term.response.value is None:
            takes_text = f"takes a time that is not bounded: {_format_figure(term.response)}"
        yield ReasonLine(1, f"{term.activity} {takes_text}")
    for assumption in list_assumptions(result.bound):
        yield ReasonLine(1, f"assumes: {assumption}")


def explain_topic(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a topic's traffic."""
    load = analysis.topics[name]
    published = (
        f"{_format_figure(load.published, 'traffic')} published, {_format_figure(load.delivered, 'traffic')} delivered"
    )
    yield ReasonLine(0, f"{name}: {published}, each message {_format_figure(load.size, 'size')}")
    for writer in dict.fromkeys((arc.source, arc.output) for arc in analysis.system.arcs if arc.topic == name):
        pace = analysis.outputs.get(writer)
        if pace is not None:
            yield ReasonLine(
                1,
                f"{writer[0]} publishes at {_format_figure(pace.rate, 'rate')}, largest gap {_format_figure(pace.gap)}",
            )
            yield from _reason_lines(pace.reasons, 2)
            yield from _reason_lines(analysis.paces[writer[0]].reasons, 2)


def explain_host(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a host's load: what each activity adds."""
    load = analysis.hosts[name]
    yield ReasonLine(
        0, f"{name}: load {_format_figure(load.utilisation, 'share')} of {_count_cores(load)}: {load.verdict}"
    )
    for activity, part in load.activity_shares:
        yield ReasonLine(1, f"{activity} adds {_format_figure(part, 'share')}", _span_of_activity(analysis, activity))


def _count_cores(load: HostLoad) -> str:
    return "a core, and nobody wrote how many there are" if load.cores is None else f"{load.cores} cores"


def explain_link(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a link's traffic: what each topic adds."""
    load = analysis.links[name]
    yield ReasonLine(
        0, f"{name}: {_format_figure(load.traffic, 'traffic')}, {_format_figure(load.share, 'share')} of the bandwidth"
    )
    yield ReasonLine(
        1, f"queueing of {_format_figure(load.queueing)} at most for a burst of {_format_figure(load.burst, 'size')}"
    )
    for part, value in load.topic_traffic:
        yield ReasonLine(1, f"{part} adds {_format_figure(value, 'traffic')}")


def _activity_lines(analysis: Analysis, name: str, depth: int, *, rate_only: bool = False) -> Iterator[ReasonLine]:
    """Explain the rate of an activity, and its response unless only the rate is wanted."""
    pace, response = analysis.paces[name], analysis.responses[name]
    behaviour_text = describe_behaviour(analysis.system.activities[name], pace)
    text = f"{name}: {behaviour_text}, rate {_format_figure(pace.rate, 'rate')}, largest gap {_format_figure(pace.gap)}"
    yield ReasonLine(depth, text, _span_of_activity(analysis, name))
    yield from _reason_lines(pace.reasons, depth + 1)
    if not rate_only:
        response_text = (
            f"response between {_format_figure(response.best)} and {_format_figure(response.worst)} ({response.tier})"
            if not is_unfound(response.worst)
            else _describe_unfound_response(analysis, name)
        )
        yield ReasonLine(depth, f"{name}: {response_text}")
        yield from _reason_lines(response.reasons, depth + 1)


def _describe_unfound_response(analysis: Analysis, name: str) -> str:
    """Describe a response for which no bound was found, with what was analysed."""
    response = analysis.responses[name]
    at_least = f"response of at least {_format_figure(response.best)}; " if response.best.value is not None else ""
    return f"{at_least}no bound found {describe_unfound_places(group_by_host(analysis, [name]))}"


def describe_behaviour(activity: Activity, pace: EventPace) -> str:
    """Return the name of a behaviour, marked where it is inferred (a written period is as good as a behaviour)."""
    inferred_mark = activity.behaviour_inferred and activity.period is None and pace.behaviour
    return f"{pace.behaviour or 'unknown'}{' (inferred)' if inferred_mark else ''}"


def _reason_lines(reasons: Iterable[Reason], depth: int) -> Iterator[ReasonLine]:
    """Yield reasons as lines of one depth."""
    return (ReasonLine(depth, reason.text, reason.at) for reason in reasons)


def _triggering_activities(analysis: Analysis, name: str) -> list[str]:
    """Return what fires an activity, the last first; nothing where its own clock does."""
    arrivals = TriggerArrivals(analysis)
    arcs = analysis.system.arcs_into.get(name, ())
    return list(
        dict.fromkeys(arc.source for arc in reversed(arcs) if arrivals.fires_reader(arc) and arc.source != name)
    )


def _span_of_activity(analysis: Analysis, name: str) -> Span:
    """Return where an activity is written."""
    activity = analysis.system.activities.get(name)
    return activity.at if activity else NO_SPAN


def _format_figure(value: TimingValue, kind: str = "duration") -> str:
    """Format a figure with the sign of its side, or what is missing of it."""
    if value.value is None:
        missing_text = f" ({figure_wording.join_first_names(value.missing)})" if value.missing else ""
        return f"{figure_wording.name_unknown_reason(value)}{missing_text}"
    format_value = _FIGURE_FORMATS[kind]
    if is_known_bound(value):
        return ("<= " if value.side == "at most" else "") + format_value(value.value)
    return f">= {format_value(value.value)}"


def explain_word(analysis: Analysis, chains: Mapping[str, ChainResult], word: str) -> tuple[ReasonLine, ...]:
    """Explain what a complete id names: a chain, host, link, topic or activity; nothing for any other word."""
    if word in chains:
        return tuple(explain_chain(chains[word]))
    for kind, explain_element in (
        (analysis.hosts, explain_host),
        (analysis.links, explain_link),
        (analysis.topics, explain_topic),
    ):
        if word in kind:
            return tuple(explain_element(analysis, word))
    return tuple(explain_activity(analysis, word)) if word in analysis.system.activities else ()
