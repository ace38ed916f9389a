"""Do components, services, callbacks and chains answer in the time that they have, and is what is read as fresh as needed?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, join_first, join_words
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Component, PerformanceIndicator
from archgen.model.deployment import Host
from archgen.timing.analysis import Analysis, ChainTerm, LateRun, ServiceLoad
from archgen.timing.chains.chain_bounds import JudgedChain, find_missed_shares, find_open_chains, find_unmet_chains
from archgen.timing.chains.chain_verdicts import ReadAge, find_read_ages
from archgen.timing.chains.use_case_times import WholeBound, WholeLimit, bound_wholes, list_limits
from archgen.timing.figures import figure_wording
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import is_boundless, is_known_bound, is_unfound
from archgen.timing.system.thread_pools import name_lane
from archgen.timing.system.timing_system import Activity


def slow_component(architecture: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """A component takes longer than it promises: its node than its performance asks for, or what is inside than the
    whole.
    """
    held_up: dict[str, list[_SlowAnswer]] = {}
    for slow_answer in _find_slow_answers(architecture, analysis, margin):
        if slow_answer.is_undisturbed or slow_answer.activity.host is None:
            yield _report_slow_component(slow_answer, margin)
        else:
            held_up.setdefault(slow_answer.activity.host, []).append(slow_answer)
    for host_id, slow_answers in held_up.items():
        if len({slow_answer.component.id for slow_answer in slow_answers}) > 1:
            yield _report_slow_host(architecture.hosts[host_id], slow_answers, margin)
        else:
            yield from (_report_slow_component(slow_answer, margin) for slow_answer in slow_answers)
    yield from _find_slow_wholes(architecture, analysis, margin)


class _SlowAnswer(NamedTuple):
    """An activity that takes longer (ns) than its component promises; `is_undisturbed`: by itself."""

    component: Component
    indicator: PerformanceIndicator
    activity: Activity
    worst_response: Fraction
    is_undisturbed: bool


def _find_slow_answers(architecture: Architecture, analysis: Analysis, margin: Fraction) -> Iterator[_SlowAnswer]:
    """Yield the activities whose responses leave less of the required execution time than the margin."""
    share = 1 - margin
    for activity in analysis.system.activities.values():
        component = architecture.components.get(activity.component or "")
        worst_response = analysis.responses[activity.id].worst.value
        if component is None or worst_response is None:
            continue  # unknown, or unbounded by an overload, which `overloaded-host` reports
        for indicator in component.performance:
            required_time = indicator.execution_time
            if required_time is not None and worst_response > (
                required_time.value if share == 1 else share * required_time.value
            ):
                # Whether the activity alone is too slow, or what runs beside it makes it so: `wcet` is in ticks.
                is_undisturbed = (
                    activity.response is not None or worst_response == (activity.wcet or 0) * analysis.system.tick
                )
                yield _SlowAnswer(component, indicator, activity, worst_response, is_undisturbed)


_MAX_NAMED_ANSWERS = 6
"""So many components are named in the finding about their host."""


def _report_slow_host(host: Host, slow_answers: Sequence[_SlowAnswer], margin: Fraction) -> Diagnostic:
    """Report a host on which several components are held up by what else works there."""
    phrases = [
        f"`{answer.activity.id}` takes up to {format_duration(answer.worst_response)} instead of {answer.indicator.execution_time}"
        for answer in slow_answers[:_MAX_NAMED_ANSWERS]
    ]
    more_count = len(slow_answers) - len(phrases)
    more_text = [f"{more_count} more"] if more_count else []
    return Diagnostic(
        "slow-component",
        f"with all that works on `{host.id}`, {len(slow_answers)} promises may not be kept: {join_words([*phrases, *more_text])}{_describe_margin(margin)}",
        host.at,
        labels=tuple(Label(answer.indicator.at, "asks for less") for answer in slow_answers[:_MAX_NAMED_ANSWERS]),
        help="`archgen timing --why` with one of them shows what gets in its way; or correct what the performances promise",
        element=host.id,
    )


def _report_slow_component(slow_answer: _SlowAnswer, margin: Fraction) -> Diagnostic:
    """Report a response that leaves less of the required execution time than the margin, a share of it."""
    component, indicator, activity, worst_response, is_undisturbed = slow_answer
    span = activity.places.get("wcet" if activity.response is None else "response", activity.at)
    cause = "" if is_undisturbed or activity.host is None else f" with all that works on `{activity.host}`"
    return Diagnostic(
        "slow-component",
        f"`{component.id}` is asked to need at most {indicator.execution_time}, but `{activity.id}` takes up to {format_duration(worst_response)}{cause}{_describe_margin(margin)}",
        indicator.at,
        labels=(Label(span, "takes longer" if is_undisturbed else "takes longer with what gets in its way"),)
        if span != NO_SPAN
        else (),
        help="make the node quicker, or correct what the performance promises"
        if is_undisturbed
        else f"`archgen timing --why {activity.id}` shows what gets in its way; or correct what the performance promises",
        element=component.id,
    )


def _find_slow_wholes(architecture: Architecture, analysis: Analysis, margin: Fraction) -> Iterator[Diagnostic]:
    """Yield what composed components say of how long they take, where the worst way through them takes longer."""
    for shell_id, bound in bound_wholes(analysis, architecture).items():
        for limit in list_limits(architecture.shells[shell_id]):
            duration = bound.duration.value
            # Without a value it is unknown, or unbounded by an overload, which `overloaded-host` reports.
            if duration is not None and duration > (1 - margin) * limit.duration.value:
                yield _report_slow_whole(shell_id, limit, bound, duration, margin)


def _report_slow_whole(
    shell_id: str, limit: WholeLimit, bound: WholeBound, duration: Fraction, margin: Fraction
) -> Diagnostic:
    known_phrase = "" if is_known_bound(bound.duration) else " and more, for not all of its figures are known"
    way = join_first(tuple(f"`{name}`" for name in bound.through))
    return Diagnostic(
        "slow-component",
        f"`{shell_id}` is to need at most {limit.duration} ({limit.name}), but the way through it takes up to {format_duration(duration)}{known_phrase}: {way}{_describe_margin(margin)}",
        limit.at,
        help="make what is inside quicker, or correct what the whole promises",
        element=shell_id,
    )


def slow_service(_: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """A service takes longer, with all its callers waiting, than one of them has before it runs again."""
    examined_pairs: set[tuple[str, str]] = set()
    for arc in analysis.system.arcs:
        if arc.role != "request" or arc.flow != "service" or (arc.source, arc.target) in examined_pairs:
            continue
        examined_pairs.add((arc.source, arc.target))
        load, caller = analysis.services[arc.target], analysis.system.activities[arc.source]
        waiting_time = load.waits[caller.id].value
        # Only periodic callers can be late for their own next activation.
        if waiting_time is None or caller.period is None:
            continue
        caller_period = caller.period * analysis.system.tick
        if waiting_time > (1 - margin) * caller_period:
            server = analysis.system.activities[arc.target]
            yield _report_slow_service(load, caller, server, (waiting_time, caller_period, margin), arc.at)


def _report_slow_service(
    load: ServiceLoad, caller: Activity, server: Activity, figures: tuple[Fraction, Fraction, Fraction], span: Span
) -> Diagnostic:
    """Report a caller that waits too long; `figures` are its waiting time and period (ns), and the margin, a share."""
    waiting_time, caller_period, margin = figures
    callers_phrase = f", with {len(load.callers)} callers" if len(load.callers) > 1 else ""
    return Diagnostic(
        "slow-service",
        f"`{caller.id}` runs every {format_duration(caller_period)}, but waits up to {format_duration(waiting_time)} for `{server.id}`{callers_phrase}{_describe_margin(margin)}",
        span if span != NO_SPAN else caller.at,
        labels=(Label(server.places.get("wcet", server.at), "takes this long for each"),)
        if server.at != NO_SPAN
        else (),
        help="make the service quicker, call it less often (`calls`), or make it an action",
        element=caller.id,
    )


def _describe_margin(margin: Fraction) -> str:
    """Say how much of a time must stay free, where any must."""
    return f"; {format_percentage(margin)} of it must stay free" if margin else ""


def long_callback(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A callback takes longer than the period of another one that waits for the same thread."""
    members_by_thread: dict[str, list[Activity]] = defaultdict(list)
    for activity in analysis.system.activities.values():
        members_by_thread[name_lane(analysis.system, activity)].append(activity)
    for members in members_by_thread.values():
        if len(members) > 1:
            yield from _find_long_callbacks(analysis, members)


def _find_long_callbacks(analysis: Analysis, members: Sequence[Activity]) -> Iterator[Diagnostic]:
    """Yield a finding for each callback of a thread that lets another one miss a tick, with the most frequent of these."""
    # What others fire is due whenever they do: how late it may come is for chains to say.
    timed = [(member.period, member) for member in members if member.behaviour == "periodic" and member.period]
    timed.sort(key=lambda pair: pair[0])
    for slow in members:
        # While it uses a resource, or waits within its declared response, it keeps its thread.
        held = max((slow.wcet or 0) + sum(use.worst for use in slow.uses.values()), slow.response or 0)
        # Components of one node that it runs by one timer are no two callbacks.
        delayed = [
            (period, other)
            for period, other in timed
            if period < held and (other.node, period) != (slow.node, slow.period)
        ]
        if not delayed:
            continue
        period, first = delayed[0]
        more_count = len(delayed) - 1
        more_text = f", and of {more_count} more timer{'s' if more_count > 1 else ''}" if more_count else ""
        period_span = first.places.get("period", first.places.get("rate", NO_SPAN))
        held_text, period_text = (format_duration(Fraction(ticks * analysis.system.tick)) for ticks in (held, period))
        yield Diagnostic(
            "long-callback",
            f"`{slow.id}`, {held_text}, shares the thread of `{first.id}`, which is due every {period_text}{more_text}",
            slow.places.get("response", slow.places.get("wcet", slow.at)),
            labels=(Label(period_span, "due in the meantime"),) if period_span != NO_SPAN else (),
            help=f"`archgen timing --why {first.id}` shows how late it may come, `archgen timing --propose` what helps chains "
            "that are late for it",
            element=slow.node,
        )


def late_chain(architecture: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """A chain misses its deadline, or nothing proves that it meets it."""
    if not any(chain.deadline_text for chain in architecture.chains.values()):
        return
    for chain, share, best in find_missed_shares(analysis, architecture):
        yield Diagnostic(
            "late-chain",
            f"the chain `{chain.id}` misses its deadline of {figure_wording.format_duration(share.limit)} for {share.name} of its "
            f"reactions: each takes at least {figure_wording.format_duration(best.value or 0)}",
            chain.deadline_places[share.name],
            help=f"`archgen timing --sensitivity {chain.id}` shows which figure shortens it most",
            element=chain.id,
        )
    unmet_chains = list(find_unmet_chains(analysis, architecture, margin))
    late_runs = _find_late_runs(architecture, analysis, unmet_chains)
    for late_result in unmet_chains:
        chain_id, chain = late_result.chain.id, late_result.chain
        late_run = late_runs.get(chain_id)
        deadline = f"its deadline of {chain.deadline}"
        verdict_text = (
            f"the chain `{chain_id}` misses {deadline}"
            if late_result.verdict == "missed" or late_run
            else f"nothing proves that the chain `{chain_id}` meets {deadline}"
            + (f" with a margin of {format_percentage(margin)}" if margin else "")
        )
        yield Diagnostic(
            "late-chain",
            f"{verdict_text}: {_describe_run(chain_id, late_run) if late_run else _describe_bound(analysis, late_result)}",
            chain.at,
            labels=(_label_largest_part(architecture, analysis, late_result),),
            help=f"`archgen timing --sensitivity {chain_id}` shows which figure shortens it most",
            element=chain_id,
        )


def _find_late_runs(
    architecture: Architecture, analysis: Analysis, unmet_chains: Sequence[JudgedChain]
) -> Mapping[str, LateRun]:
    """Return the runs that show chains late that bounds alone do not prove to be, by chain."""
    if all(each.verdict == "missed" for each in unmet_chains):
        return {}
    # Imported here because the simulator takes time to load, and of most projects all chains are proven.
    from archgen.simulation.chain_witnesses import judge_chains

    return {key: result.late_run for key, result in judge_chains(analysis, architecture).items() if result.late_run}


def _describe_run(chain_id: str, run: LateRun) -> str:
    return f"it took {format_duration(run.longest)} in a simulated run (`{run.write_command(chain_id)}`)"


def _describe_bound(analysis: Analysis, late_chain: JudgedChain) -> str:
    """Describe how long a chain takes, or why nobody can say."""
    from archgen.timing.chains.missing_figures import describe_overload, find_unfound_places

    bound, deadline = late_chain.bound, late_chain.chain.deadline
    if is_boundless(bound):
        overload = describe_overload(analysis, late_chain.terms, "`")
        return f"it may take any time, for {overload}" if overload else "it may take any time"
    if late_chain.verdict == "missed" and late_chain.best.value is not None:
        return f"it takes at least {figure_wording.format_duration(late_chain.best.value)}"
    if bound.value is None or (deadline is not None and bound.value <= deadline.value and is_unfound(bound)):
        places = find_unfound_places(analysis, late_chain.terms)
        hosts = join_words([f"`{place.host}`{place.load_text}" for place in places if place.host])
        return f"no bound was found on {hosts}" if hosts else "no bound was found"
    suffix = "" if is_known_bound(bound) else " and more, for not all of its figures are known"
    return f"it may take {figure_wording.format_duration(bound.value)}{suffix}"


def _label_largest_part(architecture: Architecture, analysis: Analysis, late_chain: JudgedChain) -> Label:
    """Return a label at what takes the largest part of a chain's time.

    Where a host has too much to do, or leaves no bound to find, the label is at the host: the figures of the elements
    that happen to run there may all be innocent.
    """
    from archgen.timing.chains.missing_figures import find_overloaded_places, find_saturated_links, find_unfound_places

    for link_id in find_saturated_links(late_chain.terms):
        return Label(architecture.links[link_id].at, "more is sent over it than it carries")
    for overloaded in find_overloaded_places(analysis, late_chain.terms):
        needing = [
            analysis.system.activities[term.activity] for term in late_chain.terms if is_boundless(term.response)
        ]
        running = [f"`{activity.id}`" for activity in needing if overloaded in (activity.host, *activity.uses)]
        verb, here = ("run", "here") if overloaded in analysis.hosts else ("need", "it")
        element = architecture.hosts.get(overloaded) or architecture.resources.get(overloaded)
        span = element.at if element else needing[0].at
        return Label(
            span,
            f"has more to do than it can, and {join_words(running)} {verb}{'s' if len(running) == 1 else ''} {here}",
        )
    for place in find_unfound_places(analysis, late_chain.terms):
        if place.host is not None:
            names = join_words([f"`{name}`" for name in place.activities])
            return Label(architecture.hosts[place.host].at, f"no bound was found for {names} here")
    largest_term = max(late_chain.terms, key=_term_weight)
    activity = analysis.system.activities[largest_term.activity]
    parts = [largest_term.sampling.value, largest_term.response.value, largest_term.link.value]
    is_own_work = None not in parts and parts[1] == max(parts)  # type: ignore[type-var]  # no None among them
    span = activity.places.get("wcet", largest_term.at) if is_own_work else largest_term.at
    return Label(span, f"the largest part: {largest_term.activity}, {_format_term(largest_term)}")


def _term_weight(term: ChainTerm) -> tuple[bool, object]:
    """Return a sort key: unbounded terms above all others, then the known parts of the sum (ns)."""
    is_endless = is_boundless(term.sampling) or is_boundless(term.response)
    return (is_endless, sum((v.value for v in (term.sampling, term.response, term.link) if v.value is not None), 0))


def _format_term(term: ChainTerm) -> str:
    """Format a term of a chain as its waiting, its response and its link; parts of 0 are left out."""
    contributions = (("waits", term.sampling), ("takes", term.response), ("link", term.link))
    phrases = [
        f"{word} {figure_wording.format_duration(value.value) if value.value is not None else figure_wording.name_unknown_reason(value)}"
        for word, value in contributions
        if value.value != 0
    ]
    return ", ".join(phrases) or "no time"


def open_chain(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """Nobody can say whether a chain meets its deadline: figures are missing."""
    from archgen.timing.chains.missing_figures import list_missing_figures

    if all(chain.deadline is None for chain in architecture.chains.values()):
        return
    for result in find_open_chains(analysis, architecture):
        chain = result.chain
        gaps = "; ".join(list_missing_figures(result, analysis)) or "no bound was found"
        yield Diagnostic(
            "open-chain",
            f"nobody can say whether the chain `{chain.id}` meets its deadline of {chain.deadline}: {gaps}",
            chain.at,
            help=f"write what is missing, if only a guess; `archgen timing --chain {chain.id}` shows what is known",
            element=chain.id,
        )


def stale_input(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """What an element reads at an input may be older than the input's `freshness` allows."""
    for read_age in find_read_ages(analysis):
        if read_age.state == "broken":
            yield _report_age(analysis, read_age)


def _report_age(analysis: Analysis, read_age: ReadAge) -> Diagnostic:
    arc, age = read_age.arc, read_age.age
    reader, source = analysis.system.activities[arc.target], analysis.system.activities[arc.source]
    port = arc.input.rpartition(".")[2]
    limit_text = figure_wording.format_duration(read_age.limit)
    if is_boundless(age):
        age_text = f"is sent once or need not come at all, so that it may be of any age at `{reader.id}`"
    elif is_unfound(age) or age.value is None or not is_known_bound(age):
        age_text = f"may be of any age at `{reader.id}`, for no bound was found"
    else:
        age_text = f"may be {figure_wording.format_duration(age.value)} old when `{reader.id}` reads it"
    return Diagnostic(
        "stale-input",
        f"what `{source.id}` sends to `{port}` {age_text}: its freshness is {limit_text}",
        arc.at if arc.at != NO_SPAN else reader.at,
        labels=(Label(source.at, f"`{source.id}` sends it"),) if source.at != NO_SPAN else (),
        help="let the source send more often, or let what it sends fire the reader",
        element=reader.id,
    )


RULES = (
    (
        slow_component,
        Severity.WARNING,
        (RuleOption("margin", 0, 0, 99, "The share of the execution time that must stay free."),),
    ),
    (
        slow_service,
        Severity.WARNING,
        (RuleOption("margin", 0, 0, 99, "The share of the caller's period that must stay free."),),
    ),
    (long_callback, Severity.WARNING),
    (
        late_chain,
        Severity.WARNING,
        (RuleOption("margin", 0, 0, 99, "The share of the deadline that must stay free."),),
    ),
    (open_chain, Severity.NOTE),
    (stale_input, Severity.WARNING),
)
