"""Three sentences on a chain that does not surely meet its deadline: by how much, what takes most and why, one thing to do.

Nothing is tried out here: what to do follows from the largest part alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Literal, NamedTuple

from archgen.diagnostics.common_wording import join_words
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.gap_formulas import find_storing_part
from archgen.timing.chains.trigger_arrivals import TriggerArrivals
from archgen.timing.chains.unfound_bounds import find_overloaded_hosts, find_unfound_places
from archgen.timing.figures import figure_wording
from archgen.timing.figures.response_tier import ResponseTier
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import UNLINKED_NOTE, is_boundless
from archgen.timing.system.core_placement import is_missing_cores
from archgen.timing.system.thread_pools import name_lane

_NAMED_LOADS = 3
"""So many of the elements that load a host most are named."""


class ChainAdvice(NamedTuple):
    """What to know about a chain: by how much it may be late, which parts take most, and what to do first."""

    lateness: str
    largest_parts: str
    first_step: str


class _ChainPart(NamedTuple):
    kind: Literal["waits", "takes", "link"]
    term: ChainTerm
    duration: Fraction


def advise_on_chain(analysis: Analysis, result: ChainResult) -> ChainAdvice | None:
    """Return what to know about a chain; None where it has no deadline, or is sure to meet it."""
    if result.deadline is None or result.deadline.value is None or result.verdict == "met" or not result.terms:
        return None
    parts = sorted(_list_parts(result), key=lambda part: -part.duration)
    return ChainAdvice(
        _describe_lateness(analysis, result, result.deadline.value),
        _describe_parts(analysis, parts[:2]),
        _suggest_for_cause(analysis, result) or (_suggest_for_part(analysis, parts[0], result.terms) if parts else ""),
    )


def _list_parts(result: ChainResult) -> Iterator[_ChainPart]:
    for term in result.terms:
        values: tuple[tuple[Literal["waits", "takes", "link"], TimingValue], ...] = (
            ("waits", term.sampling),
            ("takes", term.response),
            ("link", term.link),
        )
        yield from (_ChainPart(kind, term, value.value) for kind, value in values if value.value)


def _describe_lateness(analysis: Analysis, result: ChainResult, deadline: Fraction) -> str:
    """Say by how much a chain may be late, or why nobody can say."""
    bound, best = result.bound.value, result.best.value
    deadline_text = f"its deadline of {_write(deadline)}"
    if result.verdict == "missed" and best is not None and best > deadline:
        return f"It takes at least {_write(best)}, {_write(best - deadline)} longer than {deadline_text} allows."
    hosts = find_overloaded_hosts(analysis, result.terms)
    if hosts:
        return f"It may take any time, whatever its deadline: more is to be done on {join_words(hosts)} than can be."
    if is_boundless(result.bound):
        return f"It may take any time, and so longer than {deadline_text} allows."
    if result.verdict == "open":
        known = f"What is known of it adds up to {_write(bound)}" if bound else "Nothing is known of how long it takes"
        return f"{known}, and figures are missing: nobody can say whether it meets {deadline_text}."
    # Missed although its best case is in time: a simulated run was too late.
    is_seen = result.verdict == "missed"
    if bound is not None and bound > deadline:
        head = "It may take up to" if result.bound.complete else "What is known of it adds up to"
        evidence = "a simulated run was late" if is_seen else "nothing shows that it ever does"
        return f"{head} {_write(bound)}, {_write(bound - deadline)} longer than {deadline_text} allows; {evidence}."
    unsure = (
        f"A simulated run took longer than {deadline_text} allows"
        if is_seen
        else f"Nothing says whether it meets {deadline_text}"
    )
    return f"{unsure}; nobody can say how long it takes at most: no bound was found."


def _describe_parts(analysis: Analysis, parts: list[_ChainPart]) -> str:
    phrases = [_describe_part(analysis, part) for part in parts]
    if not phrases:
        return "Nothing is known of its parts."
    head = "The largest parts: " if len(phrases) > 1 else "The largest part: "
    return f"{head}{'; '.join(phrases)}."


def _describe_part(analysis: Analysis, part: _ChainPart) -> str:
    name, duration = part.term.activity, _write(part.duration)
    if part.kind == "link":
        return f"{duration} on the link to {name}"
    if part.kind == "waits":
        return f"{duration} that {name} lets it wait ({part.term.why})"
    return f"{duration} in {name}, {_describe_response(analysis, name)}"


def _describe_response(analysis: Analysis, name: str) -> str:
    activity, response = analysis.system.activities[name], analysis.responses[name]
    if response.tier == "declared":
        return "as its `response` declares"
    if activity.wcet is None:
        return "of which no execution time is written"
    own_work = activity.wcet * analysis.system.tick
    place = f" on {activity.host}" if activity.host else ""
    if response.worst.value is not None and response.worst.value <= own_work:
        return f"all of it its own work{place}"
    return f"which needs {_write(own_work)} itself; the rest is other work{place} that comes in its way"


def _suggest_for_cause(analysis: Analysis, result: ChainResult) -> str:
    """Suggest what to do about a cause that leaves no bound, empty where there is one."""
    hosts = find_overloaded_hosts(analysis, result.terms)
    if hosts:
        shares = sorted(
            ((share.value, name) for name, share in analysis.hosts[hosts[0]].activity_shares if share.value),
            key=lambda pair: -pair[0],
        )[:_NAMED_LOADS]
        needed = join_words([f"{name} ({figure_wording.format_share(share)} of a core)" for share, name in shares])
        return f"Take work off {hosts[0]}, where {needed} need{'s' if len(shares) == 1 else ''} most."
    if result.bound.missing and not result.bound.complete:
        return _suggest_measuring(analysis, result)
    places = find_unfound_places(analysis, result.terms)
    if places:
        first_place = places[0]
        return _UNFOUND_STEPS.get(first_place.tiers[0], _PIN_STEP).format(
            join_words(list(first_place.activities[:_NAMED_LOADS])), first_place.host or "their host"
        )
    return ""


_PIN_STEP = "Pin {0} to cores of {1} (`core:`), so that less other work comes in the way."
_UNFOUND_STEPS: dict[ResponseTier, str] = {
    "host": "Write priorities for what runs on {1} (`priority:`), or pin {0} to a core (`core:`).",
    "executor": "Give {0} a thread of their own (another container, or more `threads:`).",
    "dedicated": "Let {0} work less often, or for a shorter time (`wcet:`).",
}
"""What to do where no bound was found, by what was analysed there."""


def _suggest_measuring(analysis: Analysis, result: ChainResult) -> str:
    """Suggest to write the first figure that is really missing: responses of neighbours only rest on others."""
    missing = result.bound.missing
    for name in missing:
        step = _suggest_figure(analysis, name)
        if step:
            return f"{step}{_count_others(len(missing) - 1)}."
    values = [value for term in result.terms for value in (term.sampling, term.response)]
    unlinked_ids = [name for value in values if UNLINKED_NOTE in value.assumptions for name in value.missing]
    hosts = dict.fromkeys(
        activity.host for name in unlinked_ids if (activity := analysis.system.activities.get(name)) and activity.host
    )
    return f"Write the link that joins {join_words(list(hosts))} (`links:`)." if hosts else ""


def _count_others(count: int) -> str:
    if count == 0:
        return ""
    return (
        "; one more figure is missing or rests on it"
        if count == 1
        else f"; {count} more figures are missing or rest on it"
    )


def _suggest_figure(analysis: Analysis, name: str) -> str:
    """Suggest to write what is missing of an element; empty where all of it is written."""
    if is_missing_cores(name):
        return f"Write how many {name} there are (`cores:`)"
    if " - " in name:
        return f"Write the link that joins {' and '.join(name.split(' - '))} (`links:`)"
    activity = analysis.system.activities.get(name)
    if activity is None:
        return f"Measure the latency of {name} and write it (`latency:`)" if name in analysis.links else ""
    if activity.wcet is None and activity.response is None:
        return f"Measure the execution time of {name} and write it (`wcet:`)"
    is_unpaced = activity.period is None and activity.behaviour not in {"event", "on_demand", "once"}
    return f"Measure how often {name} works and write it (`rate:`)" if is_unpaced else ""


def _suggest_for_part(analysis: Analysis, part: _ChainPart, terms: Sequence[ChainTerm]) -> str:
    """Suggest what makes the largest part smaller."""
    name = part.term.activity
    if part.kind == "link":
        return f"Send less to {name}, or measure its link and write what it really takes (`latency:`)."
    if part.kind == "waits":
        is_mostly_stored = 2 * find_storing_part(analysis, name, part.duration) > part.duration
        return _suggest_for_storing(analysis, name) if is_mostly_stored else _suggest_for_wait(analysis, name)
    return _suggest_for_run(analysis, part, terms) or _suggest_for_response(analysis, name)


def _suggest_for_storing(analysis: Analysis, name: str) -> str:
    """Suggest what lets the callback that stores what an element reads have its turn sooner."""
    system, activity = analysis.system, analysis.system.activities[name]
    lane = name_lane(system, activity)
    mates = [other.id for other in system.activities.values() if other.id != name and name_lane(system, other) == lane]
    if mates:
        step = f"Let fewer callbacks share a thread with {name} (a container of its own, or more `threads:`)"
    elif activity.host is None:
        step = f"Let {name} work less often, or for a shorter time (`wcet:`)"
    elif system.cores.get(activity.host) == 1 or len(activity.cores) == 1:
        now = f", now {activity.priority}" if activity.priority is not None else ""
        other_way = f"move work off {activity.host} (`host:`)" if not activity.cores else "a core of its own (`core:`)"
        step = f"Give {name} a higher priority than the others there (`priority:`{now}), or {other_way}"
    else:
        step = f"Give {name} a core of its own (`core:`), or a priority above the others there (`priority:`)"
    return f"{step}, so that what it reads is stored sooner; `stored: at_once` only where nothing has to store it."


def _suggest_for_run(analysis: Analysis, part: _ChainPart, terms: Sequence[ChainTerm]) -> str:
    """Suggest what shortens a run of several steps on several cores; empty where there is none, or it is mostly work."""
    name = part.term.activity
    activity, response = analysis.system.activities[name], analysis.responses[name]
    own_work = (activity.wcet or 0) * analysis.system.tick
    steps = _list_run(analysis, part, terms)
    if response.tier not in {"cores", "whole host"} or len(steps) == 1 or 2 * own_work >= part.duration:
        return ""
    return (
        f"Give {join_words(steps)}, which run one after the other, cores of {activity.host} with little else on them "
        "(`core:`), or a priority above the others there (`priority:`)."
    )


def _list_run(analysis: Analysis, part: _ChainPart, terms: Sequence[ChainTerm]) -> list[str]:
    """Return the steps of a chain of which each fires the next on the host of a part, with that of the part."""
    first = last = terms.index(part.term)
    while first and terms[first].activity in analysis.runs:
        first -= 1
    while last + 1 < len(terms) and terms[last + 1].activity in analysis.runs:
        last += 1
    return [term.activity for term in terms[first : last + 1]]


def _suggest_for_wait(analysis: Analysis, name: str) -> str:
    activity = analysis.system.activities[name]
    gap = analysis.paces[name].gap.value
    now = f", now every {_write(gap)} at the latest" if gap is not None else ""
    if activity.behaviour == "periodic":
        other_way = ", or let what it reads fire it (`trigger:`)" if analysis.system.arcs_into.get(name) else ""
        return f"Let {name} work more often (`period:`{now}){other_way}."
    if TriggerArrivals(analysis).waits_for_all(activity):
        return f"Let all that {name} waits for come more often, or let any of it fire {name} (`trigger: any`)."
    if activity.throttle or activity.every > 1:
        return f"Let {name} drop less of what fires it (`{'throttle' if activity.throttle else 'every'}:`)."
    return f"Let what fires {name} come more often, or less late (`jitter:`)."


def _suggest_for_response(analysis: Analysis, name: str) -> str:
    activity, response = analysis.system.activities[name], analysis.responses[name]
    own_work = (activity.wcet or 0) * analysis.system.tick
    if response.tier == "declared":
        return f"Shorten {name}, and what its `response:` declares."
    if response.worst.value is not None and 2 * own_work >= response.worst.value:
        return f"Shorten {name} (`wcet:`, {_write(own_work)}), measured if it is a guess: its own work is most of it."
    if response.tier == "executor":
        return f"Give {name} a thread of its own: a container of its own, or more `threads:`."
    has_one_core = analysis.system.cores.get(activity.host or "") == 1
    other_way = (
        f"move work off {activity.host} (`host:`)" if has_one_core else "pin it to a core with less on it (`core:`)"
    )
    if activity.priority is not None:
        return f"Give {name} a higher priority (`priority:`, now {activity.priority}), or {other_way}."
    if has_one_core or activity.cores:
        return f"Give {name} a priority above the others there (`priority:`), or {other_way}."
    return f"Pin {name} to a core with little else on it (`core:`), or give it a priority (`priority:`)."


def _write(nanoseconds: Fraction) -> str:
    return figure_wording.format_duration(nanoseconds)
