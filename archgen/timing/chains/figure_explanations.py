"""The chain of reasoning behind figures: each step a sentence, with the place in the files that it rests on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.diagnostics.common_wording import join_first
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm, EventPace, HostLoad, Reason
from archgen.timing.chains.missing_figures import describe_unfound_places, group_by_host
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.chains.working_lines import (
    ReasonLine,
    WorkingLines,
    list_gap_formulas,
    list_lateness_formulas,
    list_wait_formulas,
    multiply_rate,
)
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue, is_known_bound, is_unfound, list_assumptions
from archgen.timing.load.host_loads import activity_share
from archgen.timing.load.response_terms import ResponseTerms
from archgen.timing.rates.link_traffic import find_sending_rate, work_out_link
from archgen.timing.system.timing_system import Activity

_FIGURE_FORMATS: Mapping[str, Callable[[Fraction], str]] = {
    "duration": figure_wording.format_duration,
    "rate": figure_wording.format_rate,
    "share": figure_wording.format_share,
    "size": figure_wording.format_size,
    "traffic": lambda count: f"{figure_wording.format_size(count)}/s",
}


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


def explain_chain(result: ChainResult, analysis: Analysis) -> Iterator[ReasonLine]:
    """Explain a chain's bound: its terms in order, and their sum."""
    yield ReasonLine(
        0,
        f"{result.id}: {_format_figure(result.bound)}, the sum of all that follows: what each step waits and takes, and links",
    )
    parts: list[Fraction] = []
    run_names: list[str] = []
    for term in result.terms:
        if term.link.value != 0:
            yield ReasonLine(1, f"link to {term.activity}: {_format_figure(term.link)}")
        yield ReasonLine(1, f"{term.activity} waits {_format_figure(term.sampling)}: {term.why}", term.at)
        wait = term.sampling.value
        for formula, words in list_wait_formulas(analysis, term.activity, wait) if wait else ():
            yield ReasonLine(2, f"{formula}: {words}")
        takes_text = f"takes {_format_figure(term.response)} at most"
        if term.response.value is None:
            takes_text = f"takes a time that is not bounded: {_format_figure(term.response)}"
        yield ReasonLine(1, f"{term.activity} {takes_text}{_describe_run(analysis, term, run_names)}")
        run_names.append(term.activity)
        parts += [value.value for value in (term.link, term.sampling, term.response) if value.value]
    if result.bound.value is not None and sum(parts) == result.bound.value and len(parts) > 1:
        total = " + ".join(figure_wording.format_duration(part) for part in parts)
        yield ReasonLine(1, f"{total} = {figure_wording.format_duration(result.bound.value)}")
    if any(term.response.value for term in result.terms):
        yield ReasonLine(1, "why an element takes so long: --why ELEMENT")
    for assumption in list_assumptions(result.bound):
        yield ReasonLine(1, f"assumes: {assumption}")


def _describe_run(analysis: Analysis, term: ChainTerm, names_before: Sequence[str]) -> str:
    """Say of which run the time of a step is the rest; empty where it is the step's own response."""
    own, response = analysis.responses[term.activity].worst, term.response.value
    if response is None or response == own.value or not names_before:
        return ""
    known_runs = ((analysis.runs, "on its core "), ({**analysis.runs, **analysis.host_runs}, "over hosts and links "))
    for runs, place in known_runs:
        run, before = runs.get(term.activity), runs.get(names_before[-1])
        start = before.worst.value if before else analysis.responses[names_before[-1]].worst.value
        link = (term.link.value or 0) if runs is not analysis.runs else 0
        if run is None or run.worst.value is None or start is None or run.worst.value - start - link != response:
            continue
        whole, counted, rest = map(figure_wording.format_duration, (run.worst.value, start + link, response))
        return (
            f": with what fires it {place}{whole}, of which {counted} are counted already: {whole} - {counted} = {rest}"
        )
    return ""


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
            if pace.rate.value and load.size.value is not None:
                product = figure_wording.format_size(pace.rate.value * load.size.value)
                size = figure_wording.format_size(load.size.value)
                yield ReasonLine(2, f"{multiply_rate(pace.rate, size, product)}/s")
            yield from _reason_lines(pace.reasons, 2)
            yield from _reason_lines(analysis.paces[writer[0]].reasons, 2)


def explain_host(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a host's load: what each activity adds."""
    load = analysis.hosts[name]
    yield ReasonLine(
        0, f"{name}: load {_format_figure(load.utilisation, 'share')} of {_count_cores(load)}: {load.verdict}"
    )
    for activity, part in load.activity_shares:
        wcet = analysis.system.activities[activity].wcet
        product = _format_figure(part, "share")
        if part.value and wcet:
            time = figure_wording.format_duration(wcet * analysis.system.tick)
            own_share = activity_share(analysis.system, activity, analysis.paces[activity]).value or Fraction(0)
            product = multiply_rate(analysis.paces[activity].rate, time, figure_wording.format_share(own_share))
            product = f"{'at most ' if part.side == 'at most' else ''}{product}"
            if own_share != part.value:
                product = f"{product}, and {figure_wording.format_share(part.value)} with the messages that it stores"
        yield ReasonLine(1, f"{activity} adds {product}", _span_of_activity(analysis, activity))
    share_of_cores = load.share_of_cores
    if load.cores is not None and load.cores > 1 and load.utilisation.value is not None and share_of_cores is not None:
        total = figure_wording.format_share(load.utilisation.value)
        yield ReasonLine(1, f"{total} / {load.cores} cores = {_format_figure(share_of_cores, 'share')} of all cores")
    for core, count, core_load in load.core_loads if len(load.core_loads) > 1 else ():
        yield ReasonLine(1, f"{core}: {_format_figure(core_load, 'share')} of {count} core{'s' if count != 1 else ''}")


def _count_cores(load: HostLoad) -> str:
    if load.cores is None:
        return "a core, and nobody wrote how many there are"
    return f"{load.cores} core{'s' if load.cores != 1 else ''}"


def explain_resource(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a resource's load: what each activity that uses it adds, and how long it takes from asking until done."""
    load = analysis.resources[name]
    yield ReasonLine(0, f"{name}: load {_format_figure(load.utilisation, 'share')}: {load.verdict}")
    for activity, part in load.shares:
        use_time = analysis.system.activities[activity].uses[name].worst * analysis.system.tick
        product = multiply_rate(
            analysis.paces[activity].rate, figure_wording.format_duration(use_time), _format_figure(part, "share")
        )
        wait = _format_figure(load.waits[activity])
        yield ReasonLine(
            1, f"{activity} adds {product}; from asking until done {wait}", _span_of_activity(analysis, activity)
        )


def explain_link(analysis: Analysis, name: str) -> Iterator[ReasonLine]:
    """Explain a link's traffic: what each topic adds."""
    load = analysis.links[name]
    yield ReasonLine(
        0, f"{name}: {_format_figure(load.traffic, 'traffic')}, {_format_figure(load.share, 'share')} of the bandwidth"
    )
    bandwidth = analysis.system.bandwidths[name]
    if load.traffic.value is not None and bandwidth and load.share.value is not None:
        traffic, speed = (f"{figure_wording.format_size(each)}/s" for each in (load.traffic.value, bandwidth))
        yield ReasonLine(1, f"{traffic} / {speed} = {_format_figure(load.share, 'share')}")
    for part, value in load.topic_traffic:
        yield ReasonLine(1, f"{part} adds {_write_traffic(analysis, name, part, value)}")
    yield ReasonLine(
        0,
        f"{name}: queueing of {_format_figure(load.queueing)} at most; bursts of up to {_format_figure(load.burst, 'size')}",
    )
    working = work_out_link(analysis.state, name, load.queueing, load.burst) if analysis.state else None
    if working is not None and working.terms:
        yield from WorkingLines(analysis.system.tick).explain_link(working, 1)


def _write_traffic(analysis: Analysis, link: str, topic: str, traffic: TimingValue) -> str:
    """Write what a topic adds to a link as a sum of rates times sizes, or as it is where these are not known."""
    total = _format_figure(traffic, "traffic")
    arcs = [arc for arc in analysis.system.arcs if arc.link == link and arc.topic == topic]
    parts: list[str] = []
    known_sum = Fraction(0)
    for arc in arcs:
        rate = find_sending_rate(analysis, arc)
        if rate.value is None or arc.size is None:
            return total
        known_sum += rate.value * arc.size
        parts.append(f"{figure_wording.format_rate(rate.value)} x {figure_wording.format_size(Fraction(arc.size))}")
    if not traffic.value or known_sum != traffic.value:
        return total
    numbers = {part: parts.count(part) for part in parts}
    formula = " + ".join(part if number == 1 else f"{number} x {part}" for part, number in numbers.items())
    return f"{'at most ' if traffic.side == 'at most' else ''}{formula} = {figure_wording.format_size(traffic.value)}/s"


def _activity_lines(analysis: Analysis, name: str, depth: int, *, rate_only: bool = False) -> Iterator[ReasonLine]:
    """Explain the rate of an activity, and its response unless only the rate is wanted."""
    pace, response = analysis.paces[name], analysis.responses[name]
    behaviour_text = describe_behaviour(analysis.system.activities[name], pace)
    text = f"{name}: {behaviour_text}, rate {_format_figure(pace.rate, 'rate')}, largest gap {_format_figure(pace.gap)}"
    yield ReasonLine(depth, text, _span_of_activity(analysis, name))
    yield from _reason_lines(pace.reasons, depth + 1)
    for formula, words in list_gap_formulas(analysis, name):
        yield ReasonLine(depth + 1, f"gap {formula}: {words}")
    if not rate_only:
        response_text = (
            f"response between {_format_figure(response.best)} and {_format_figure(response.worst)} ({response.tier})"
            if not is_unfound(response.worst)
            else _describe_unfound_response(analysis, name)
        )
        yield ReasonLine(depth, f"{name}: {response_text}")
        yield from _reason_lines(response.reasons, depth + 1)
        workings = ResponseTerms(analysis.state) if analysis.state else None
        if workings:
            yield from _list_working_lines(analysis, workings, name, depth + 1)
        for formula, words in list_lateness_formulas(analysis, name):
            yield ReasonLine(depth + 1, f"late {formula}: {words}")
        if workings:
            yield from _list_storing_lines(analysis, workings, name, depth)


def _list_working_lines(analysis: Analysis, workings: ResponseTerms, name: str, depth: int) -> Iterator[ReasonLine]:
    """Explain what a response is made of, and the time of the longest run that ends with the activity."""
    lines = WorkingLines(analysis.system.tick)
    working = workings.find_response(name)
    if working is not None:
        yield from lines.explain_response(working, depth)
    host_run = workings.find_host_run(name)
    if host_run is not None:
        way, run_working = host_run
        time = figure_wording.format_duration((way.delay or 0) * analysis.system.tick)
        text = f"{name}: at most {time} from the event on, over hosts and links, for the way {' > '.join(way.steps)}"
        yield ReasonLine(depth - 1, text)
        yield from lines.explain_response(run_working, depth)
    run = workings.find_run(name)
    if run is not None:
        way, run_working = run
        time = figure_wording.format_duration((way.delay or 0) * analysis.system.tick)
        yield ReasonLine(
            depth - 1,
            f"{name}: at most {time} from the event on that enters the core, for the run {' > '.join(way.steps)}",
        )
        if run_working.window != (working.window if working else None) or run_working.terms != (
            working.terms if working else ()
        ):
            yield from lines.explain_response(run_working, depth)
        else:
            yield ReasonLine(depth, "the same work as above, and nothing is taken off")


def _list_storing_lines(analysis: Analysis, workings: ResponseTerms, name: str, depth: int) -> Iterator[ReasonLine]:
    """Explain how long a message that an activity only reads may wait to be stored."""
    wait = analysis.storing_waits.get(name)
    if wait is None or not wait.value:
        return
    time = figure_wording.format_duration(wait.value)
    yield ReasonLine(
        depth,
        f"{name}: what it only reads may wait {time} to be stored, and is missed by an activation until then",
    )
    working = workings.find_storing_wait(name)
    if working is not None:
        yield from WorkingLines(analysis.system.tick).explain_response(working, depth + 1)
    else:
        yield ReasonLine(depth + 1, "as long as its thread or its cores may be busy with other work")


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
    return (ReasonLine(depth, reason.text, reason.at) for reason in reasons)


def _triggering_activities(analysis: Analysis, name: str) -> list[str]:
    """Return what fires an activity, the last first; nothing where its own clock does."""
    arrivals = TriggerArrivals(analysis)
    arcs = analysis.system.arcs_into.get(name, ())
    return list(
        dict.fromkeys(arc.source for arc in reversed(arcs) if arrivals.fires_reader(arc) and arc.source != name)
    )


def _span_of_activity(analysis: Analysis, name: str) -> Span:
    activity = analysis.system.activities.get(name)
    return activity.at if activity else NO_SPAN


def _format_figure(value: TimingValue, kind: str = "duration") -> str:
    """Format a figure with the sign of its side, or what is missing of it."""
    if value.value is None:
        missing_text = f" ({join_first(value.missing)})" if value.missing else ""
        return f"{figure_wording.name_unknown_reason(value)}{missing_text}"
    format_value = _FIGURE_FORMATS[kind]
    if is_known_bound(value):
        return ("<= " if value.side == "at most" else "") + format_value(value.value)
    return f">= {format_value(value.value)}"


def explain_word(analysis: Analysis, chains: Mapping[str, ChainResult], word: str) -> tuple[ReasonLine, ...]:
    """Explain what a complete id names: a chain, host, link, resource, topic or activity; nothing for any other word."""
    if word in chains:
        return tuple(explain_chain(chains[word], analysis))
    for kind, explain_element in (
        (analysis.hosts, explain_host),
        (analysis.links, explain_link),
        (analysis.resources, explain_resource),
        (analysis.topics, explain_topic),
    ):
        if word in kind:
            return tuple(explain_element(analysis, word))
    return tuple(explain_activity(analysis, word)) if word in analysis.system.activities else ()
