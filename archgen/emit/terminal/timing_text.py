"""Timing for people: the summary for the terminal."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.diagnostics import join_first, make_visible
from archgen.diagnostics.text_columns import TextRow, format_section
from archgen.emit.terminal import chain_remedies
from archgen.simulation.drawn_orders import describe_orders
from archgen.timing.analysis import Analysis, ChainResult, HostLoad
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_verdicts import VERDICT_MEANINGS, VERDICT_WORDS
from archgen.timing.chains.figure_explanations import describe_behaviour
from archgen.timing.chains.fused_inputs import find_fused_inputs
from archgen.timing.chains.loop_rounds import LoopRound
from archgen.timing.chains.missing_figures import describe_gaps
from archgen.timing.figures import figure_wording
from archgen.timing.figures.figure_wording import name_unknown_reason
from archgen.timing.figures.timing_values import NO_MATCH_NOTE, TimingValue, is_unfound
from archgen.timing.load.host_loads import list_turn_notes
from archgen.timing.load.host_verdicts import name_host_verdict
from archgen.timing.search.proposals import Proposal
from archgen.timing.system.thread_pools import find_joint_nodes

_CHAINS_TITLE = "Chains: largest reaction time (= largest data age)"
_ADVICE_TITLE = "What is late or not proven to be in time, and why"
_HOSTS_TITLE = "Hosts: load (100 % is one core all the time)"
_LINKS_TITLE = "Links"
_FIRST_TITLES = frozenset({_CHAINS_TITLE, _ADVICE_TITLE, chain_remedies.REMEDY_TITLE, _HOSTS_TITLE, _LINKS_TITLE})
"""What a terminal shows without being asked for more."""


def format_timing(  # noqa: PLR0913 - what is shown of all
    analysis: Analysis,
    chains: Mapping[str, ChainResult],
    loops: Iterable[LoopRound],
    width: int | None = None,
    proposal: Proposal | None = None,
    *,
    is_short: bool = False,
) -> Iterator[str]:
    """Yield the whole picture: chains first, then hosts, links, services, elements, loops. `width` is the terminal's.

    Where it `is_short`, there is what a screen has room for, and how many rows the rest has.
    """
    sections = (
        (_CHAINS_TITLE, _chain_rows(analysis, chains.values())),
        (
            _ADVICE_TITLE,
            _advice_rows(analysis, chains.values()),
        ),
        (chain_remedies.REMEDY_TITLE, chain_remedies.list_remedy_rows(proposal)),
        (_HOSTS_TITLE, _host_rows(analysis)),
        ("Resources: load, and longest time from asking until done", _resource_rows(analysis)),
        (_LINKS_TITLE, _link_rows(analysis)),
        (
            "Services and actions: longest time from a call until it is worked off, for one call of each that calls",
            _service_rows(analysis),
        ),
        (
            "Elements: largest time between two activations (gap), and from an activation to its end (response)",
            _element_rows(analysis),
        ),
        (
            "Messages that are used together: age since each source began, and how far apart these beginnings are",
            _fused_rows(analysis),
        ),
        ("Execution times that were measured: no bound rests on percentiles", _percentile_rows(analysis)),
        ("Loops: latency of one round", _loop_rows(loops)),
        ("What is taken for granted", _assumption_rows(analysis)),
    )
    rows_by_title = {title: list(rows) for title, rows in sections}
    hidden = {title: rows for title, rows in rows_by_title.items() if is_short and rows and title not in _FIRST_TITLES}
    shown = [(title, rows) for title, rows in rows_by_title.items() if title not in hidden]
    lines = [line for title, rows in shown for line in format_section(title, rows, width)]
    yield from lines
    if hidden:
        counts = (f"{title.partition(':')[0]} ({len(rows)})" for title, rows in hidden.items())
        rest = (f"{'; '.join(counts)}: `archgen timing --all`, or into a pipe",)
        yield from format_section("Not shown, for a screen to have room", [rest], width)
        yield from _fault_lines(analysis)
        return
    yield from format_legend(analysis, chains, "\n".join(lines), width)
    yield from _fault_lines(analysis)


def _chain_rows(analysis: Analysis, chains: Iterable[ChainResult]) -> Iterator[TextRow]:
    for result in chains:
        deadline = f"deadline {format_figure(result.deadline)}" if result.deadline else "no deadline"
        yield (
            result.id,
            format_figure(result.bound),
            deadline,
            VERDICT_WORDS[result.verdict] if result.deadline else "",
            describe_slack(result),
            "; ".join(filter(None, (describe_late_run(result), describe_gaps(result, analysis)))),
        )
        yield from list_share_rows(result)


def _advice_rows(analysis: Analysis, chains: Iterable[ChainResult]) -> Iterator[TextRow]:
    """Yield what is known of each chain that does not surely meet its deadline, misses first."""
    for verdict in ("missed", "not proven", "open"):
        for result in chains:
            advice = advise_on_chain(analysis, result) if result.verdict == verdict else None
            if advice is not None:
                yield from zip((result.id, "", ""), (sentence for sentence in advice if sentence), strict=False)


def _host_rows(analysis: Analysis) -> Iterator[TextRow]:
    for name, load in analysis.hosts.items():
        cores = "? cores" if load.cores is None else f"{load.cores} core{'s' if load.cores != 1 else ''}"
        load_text = f"load {format_figure(load.utilisation, figure_wording.format_share)}"
        share = load.share_of_cores
        if load.cores is not None and load.cores > 1 and share is not None and share.value is not None:
            load_text += f" ({figure_wording.format_share(share.value)} of all)"
        missing_text = format_missing(load.utilisation)
        if load.cores is None:
            missing_text = f"how many cores it has is not written{f'; {missing_text}' if missing_text else ''}"
        yield (
            name,
            cores,
            load_text,
            name_host_verdict(load),
            missing_text or _count_unfound(analysis, load) or _describe_unproven(load) or _format_bounds(load),
        )


def _count_unfound(analysis: Analysis, load: HostLoad) -> str:
    """Return for how many elements of a host no bound was found: a low load alone would look as if all were well."""
    names = [name for name, _ in load.activity_shares]
    unfound_ids = [name for name in names if is_unfound(analysis.responses[name].worst)]
    return f"no bound found for {len(unfound_ids)} of {len(names)} elements" if unfound_ids else ""


def _describe_unproven(load: HostLoad) -> str:
    """Say of a host that can do its work which of its elements are not proven to be done in time."""
    if load.verdict != "undecided" or not load.unproven:
        return ""
    return f"the cores can do it; not proven to be done in time: {join_first(load.unproven)}"


def _format_bounds(load: HostLoad) -> str:
    """Return the utilisation bounds of Liu and Layland, on one core."""
    rate_bound, deadline_bound = load.rate_monotonic_bound.value, load.earliest_deadline_bound.value
    if rate_bound is None or deadline_bound is None or len(load.activity_shares) < 2:  # noqa: PLR2004 - one alone needs no order
        return ""
    # Rounded down: a displayed bound that is a little too high would promise too much.
    rounded_down = Fraction(rate_bound * 1000 // 1, 1000)
    return f"priorities by rate are sure to do up to {figure_wording.format_share(rounded_down)}, deadlines up to {figure_wording.format_share(deadline_bound)}"


def _resource_rows(analysis: Analysis) -> Iterator[TextRow]:
    for name, load in analysis.resources.items():
        load_text = f"load {format_figure(load.utilisation, figure_wording.format_share)}"
        yield name, load.order or "any order", load_text, load.verdict, format_missing(load.utilisation)
        for user, _ in load.shares:
            yield f"  {user}", "", "", format_figure(load.waits[user]), format_missing(load.waits[user])


def _fused_rows(analysis: Analysis) -> Iterator[TextRow]:
    for fused in find_fused_inputs(analysis):
        how = (
            "waits for all"
            if fused.within is None
            else f"matches within {figure_wording.format_duration(fused.within)}"
        )
        notes = [text for text in fused.gap.assumptions if text.startswith(NO_MATCH_NOTE)]
        yield fused.activity, how, f"apart {format_figure(fused.apart)}", "", "; ".join(notes)
        for key, age in fused.ages.items():
            yield f"  {key.rpartition('.')[2]}", "", "", f"age {format_figure(age)}", format_missing(age)


def _percentile_rows(analysis: Analysis) -> Iterator[TextRow]:
    for activity in analysis.system.activities.values():
        if activity.percentiles:
            texts = [
                f"{key} {figure_wording.format_duration(Fraction(ticks * analysis.system.tick))}"
                for key, ticks in activity.percentiles.items()
            ]
            longest = (
                f"longest {figure_wording.format_duration(Fraction(activity.wcet * analysis.system.tick))}"
                if activity.wcet is not None
                else ""
            )
            yield activity.id, ", ".join(texts), longest, "as seen" if activity.wcet_measured else ""


def _link_rows(analysis: Analysis) -> Iterator[TextRow]:
    for name, load in analysis.links.items():
        traffic = format_figure(load.traffic, lambda count: f"{figure_wording.format_size(count)}/s")
        share = (
            f"{format_figure(load.share, figure_wording.format_share)} of it"
            if load.share.value is not None
            else "share unknown"
        )
        yield name, traffic, share, format_missing(load.traffic)


def _service_rows(analysis: Analysis) -> Iterator[TextRow]:
    for name, load in analysis.services.items():
        caller_count = len(load.callers)
        yield (
            name,
            f"{caller_count} caller{'s' if caller_count != 1 else ''}",
            format_figure(load.worst),
            format_missing(load.worst),
        )


def _element_rows(analysis: Analysis) -> Iterator[TextRow]:
    for name in analysis.system.activities:
        rates, response = analysis.paces[name], analysis.responses[name]
        behaviour_text = describe_behaviour(analysis.system.activities[name], rates)
        rate, gap = format_figure(rates.rate, figure_wording.format_rate), format_figure(rates.gap)
        yield name, behaviour_text, rate, f"gap {gap}", f"response {format_figure(response.worst)} ({response.tier})"


def _loop_rows(loops: Iterable[LoopRound]) -> Iterator[TextRow]:
    for loop in loops:
        steps = len(loop.through) - 1
        group_note = f"one round of {loop.members} elements that feed one another" if loop.members > steps else ""
        yield " > ".join(loop.through), format_figure(loop.latency), group_note or format_missing(loop.latency)


def _assumption_rows(analysis: Analysis) -> Iterator[TextRow]:
    """Yield what nobody wrote and was taken for granted."""
    clocked = [activity for activity in analysis.system.activities.values() if activity.behaviour == "periodic"]
    unwritten_count = sum("jitter" not in activity.places for activity in clocked)
    if unwritten_count:
        yield (
            f"no jitter is written for {unwritten_count} of {len(clocked)} periodic elements: taken to start exactly by their clocks",
        )
    measured_ids = tuple(activity.id for activity in analysis.system.activities.values() if activity.wcet_measured)
    if measured_ids:
        names = join_first(measured_ids)
        yield (f"the execution time of {names} is the longest that was seen, and not proven",)
    joint_count = len(find_joint_nodes(analysis.system))
    if joint_count:
        subject = "node of several components" if joint_count == 1 else "nodes of several components"
        yield (f"{joint_count} {subject}: one thread{' each' if joint_count > 1 else ''}",)
    values = [each.worst for each in analysis.responses.values()]
    values += [each.worst for each in (*analysis.runs.values(), *analysis.host_runs.values())]
    said = {note for value in (*values, *analysis.storing_waits.values()) for note in value.assumptions}
    fair_notes = [share.assumption for share in analysis.system.fair_shares.values()]
    yield from ((note,) for note in (*fair_notes, *list_turn_notes(analysis.system).values()) if note in said)


def _fault_lines(analysis: Analysis) -> Iterator[str]:
    for ring in analysis.endless:
        yield f"endless: every event circulates for ever in {' > '.join(ring)}"
    for ring in analysis.deadlocked:
        yield f"deadlock: each waits for the other in {' > '.join(ring)}"
    if analysis.diverged:
        yield f"no bound was found for {join_first(analysis.diverged)}"


def format_missing(value: TimingValue) -> str:
    """Return which elements' figures a value lacks."""
    return f"unknown: {join_first(value.missing)}" if value.missing and not value.complete else ""


def format_figure(value: TimingValue | None, write: Callable[[Fraction], str] = figure_wording.format_duration) -> str:
    """Format a value: `202 ms`, `>= 468 ms`, `unknown`, `unbounded (overload)`."""
    if value is None:
        return ""
    if value.value is None:
        reason = figure_wording.name_unknown_reason(value)
        return f"unbounded ({reason})" if reason == "overload" else reason
    sign = "" if value.complete else {"at least": ">= ", "at most": "<= "}.get(value.side, ">= ")
    return sign + write(value.value)


_MOST_LINES = 10
_CHAIN_FIGURES = {
    "reaction time": "from a change in the world until the last element has acted on it: what a deadline is about",
    "data age": "how old what the last element sends may be, until its next output replaces it",
}
_SIGNS = {
    "~": "rounded to what is shown",
    ">=": "what is known adds up to so much: no bound",
    "<=": "at most so much, whatever is missing",
    "(inferred)": "nobody wrote how it works",
}
_FIGURES = {
    "unknown": "figures are missing",
    "unbounded": "there is no largest one (overload, what works once, what need not come)",
    "no bound found": "the search found none; there may be one",
}
_BEHAVIOURS = {
    "periodic": "works by its own clock",
    "event": "when something arrives",
    "on_demand": "when it is called",
    "once": "at the start",
}
_TIERS = {
    "declared": "as it is written",
    "dedicated": "no host is written: a core of its own",
    "host": "one core in any order",
    "priorities": "by priority",
    "fair": "Linux shares the cores",
    "executor": "one thread in any order",
    "non_preemptive": "by priority, without interruption",
    "fifo": "first come, first served",
    "ros2_executor": "by the rounds of ROS 2",
    "edf": "the earliest deadline first",
    "cores": "several cores in any order",
    "whole host": "several cores taken as one, in any order",
    "whole way": "ways over hosts and links as wholes, in any order",
    "unknown": "an execution time, or the number of cores, is not written",
}


def format_legend(
    analysis: Analysis, chains: Mapping[str, ChainResult], summary: str, width: int | None
) -> Iterator[str]:
    """Yield the section of words below a summary. In a narrow terminal the last ones give way to the name of their page."""
    rows = list(_list_words(analysis, chains, summary))
    lines = list(format_section("Words", rows, width))
    while len(lines) > _MOST_LINES + 2 and rows:  # the title, and an empty line
        rows.pop()
        lines = list(format_section("Words", [*rows, ("...", "docs/timing.md has the others")], width))
    yield from lines


def _list_words(analysis: Analysis, chains: Mapping[str, ChainResult], summary: str) -> Iterator[TextRow]:
    """Yield the words with what they mean, those of verdicts first; words of one kind share a row."""
    verdicts = {result.verdict for result in chains.values() if result.deadline}
    yield from ((VERDICT_WORDS[word], text) for word, text in VERDICT_MEANINGS.items() if word in verdicts)
    if chains:
        yield from _CHAIN_FIGURES.items()
    reasons = {
        *map(name_unknown_reason, _list_shown_values(analysis, chains)),
        *(load.verdict for load in analysis.hosts.values()),
    }
    yield from _join_words(_FIGURES, reasons)
    # Signs are no part of any id: where one stands in the text, it is a sign.
    yield from _join_words(_SIGNS, {sign for sign in _SIGNS if sign in summary})
    tiers = {response.tier for response in analysis.responses.values()}
    yield from _join_words({f"({word})": text for word, text in _TIERS.items()}, {f"({word})" for word in tiers})
    yield from _join_words(_BEHAVIOURS, {pace.behaviour for pace in analysis.paces.values()})


def _join_words(meanings: Mapping[str, str], used: Collection[str | None]) -> Iterator[TextRow]:
    """Yield one row for the words of a kind that are used, the first in front of the others."""
    first, *others = [(word, text) for word, text in meanings.items() if word in used] or [("", "")]
    if first[0]:
        yield first[0], "; ".join((first[1], *(f"{word}: {text}" for word, text in others)))


def _list_shown_values(analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[TimingValue]:
    """Yield the figures that the summary prints."""
    yield from (result.bound for result in chains.values())
    yield from (load.worst for load in analysis.services.values())
    yield from (value for link in analysis.links.values() for value in (link.traffic, link.share))
    for name, pace in analysis.paces.items():
        yield from (pace.rate, pace.gap, analysis.responses[name].worst)


def describe_slack(result: ChainResult) -> str:
    """Return how much of its deadline a chain's bound leaves, or by how much it is above it: `252.1 ms left`."""
    if result.slack is None:
        return ""
    text = figure_wording.format_duration(abs(result.slack))
    return f"{text} left" if result.slack >= 0 else f"{text} above it"


def list_share_rows(result: ChainResult) -> Iterator[TextRow]:
    """Yield the deadlines of shares of a chain's reactions, and what bounds say of them."""
    for each in result.shares:
        verdict = (
            VERDICT_WORDS[each.verdict] if each.verdict != "open" else "only `archgen simulate` and recordings judge it"
        )
        yield f"  {each.name} of reactions", "", f"deadline {figure_wording.format_duration(each.limit)}", verdict


def describe_late_run(result: ChainResult) -> str:
    """Return how to see a chain late, empty where no run is known."""
    run = result.late_run
    if run is None:
        return ""
    orders_text = describe_orders(run.orders)
    longest_text = figure_wording.format_duration(run.longest)
    return make_visible(
        f"seen in `{run.write_command(result.id)}`: {longest_text}{f' ({orders_text})' if orders_text else ''}"
    )
