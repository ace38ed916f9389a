"""What is known of a chain that does not surely meet its deadline: by how much, what takes most and why, what is missing.

Nothing here says what would help: that is known of what was analysed alone (`search.proposals`).
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Literal

from archgen.diagnostics.common_wording import join_words
from archgen.frozen import NamedTuple
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_verdicts import find_lateness
from archgen.timing.chains.missing_figures import (
    describe_overload,
    describe_unfound_places,
    find_overloaded_elements,
    find_overloaded_places,
    find_saturated_links,
    find_unfound_places,
)
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import (
    NO_USE_NOTE,
    REPLACED_WORDS,
    UNLINKED_NOTE,
    TimingValue,
    is_boundless,
    is_known_bound,
)
from archgen.timing.system.core_placement import is_missing_cores

_NAMED_LOADS = 3
"""So many of the elements that load a host most are named."""


class ChainAdvice(NamedTuple):
    """What to know about a chain: by how much it may be late, which parts take most, and what has to be known or to go.

    `first_step` is empty where no figure is missing and no host is overloaded.
    """

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
        describe_lateness(analysis, result, result.deadline.value),
        _describe_parts(analysis, parts[:2]),
        _suggest_for_cause(analysis, result),
    )


def find_deciding_term(result: ChainResult) -> ChainTerm:
    """Return the step to begin with: the first that may take any time, or lacks a figure, else the one that takes most."""
    boundless = (term for term in result.terms if is_boundless(term.link) or is_boundless(term.response))
    missing = (term for term in result.terms if term.activity in result.bound.missing)
    return next(boundless, None) or next(missing, None) or max(result.terms, key=sum_known_parts)


def sum_known_parts(term: ChainTerm) -> Fraction:
    """Add up the known parts of a step, in ns."""
    return sum((value.value or Fraction(0) for value in (term.sampling, term.response, term.link)), Fraction(0))


def _list_parts(result: ChainResult) -> Iterator[_ChainPart]:
    for term in result.terms:
        values: tuple[tuple[Literal["waits", "takes", "link"], TimingValue], ...] = (
            ("waits", term.sampling),
            ("takes", term.response),
            ("link", term.link),
        )
        yield from (_ChainPart(kind, term, value.value) for kind, value in values if value.value)


def describe_lateness(analysis: Analysis, result: ChainResult, deadline: Fraction) -> str:
    """Say by how much a chain may be above its deadline (ns), by what evidence, or why nobody can say."""
    bound, late = result.bound, find_lateness(result)
    deadline_text = f"its deadline of {_write(deadline)}"
    excess = f"{_write(late.duration)}, {_write(late.excess)} longer than {deadline_text} allows" if late else ""
    if late and late.kind in {"at least", "seen"}:
        run_words = f"In a simulated run it took {excess}; {_describe_most(analysis, result)}."
        return f"It takes at least {excess}." if late.kind == "at least" else run_words
    overload = describe_overload(analysis, result.terms)
    if overload:
        return f"It may take any time, whatever its deadline: {overload}."
    if is_boundless(result.bound):
        return f"It may take any time, and so longer than {deadline_text} allows."
    if result.verdict == "open":
        known = (
            f"What is known of it adds up to {_write_least(bound.value)}"
            if bound.value
            else "Nothing is known of how long it takes"
        )
        return f"{known}, and figures are missing: nobody can say whether it meets {deadline_text}."
    if late:
        known, least_excess = _write_least(late.duration), _write_least(late.excess)
        sum_text = (
            f"What is known of its longest time adds up to {known}, {least_excess} longer than {deadline_text} allows"
        )
        head = f"It may take up to {excess}" if late.kind == "at most" else sum_text
        return f"{head}; nothing shows that it ever does."
    return f"Nothing says whether it meets {deadline_text}: {_describe_most(analysis, result)}."


def _write_least(value: Fraction) -> str:
    """Write a time, in ns, that is at least so much: where it is shown with fewer digits, they stay true."""
    text = _write(value)
    if text.startswith("~"):  # rounded to the nearest, which may be more
        (text,) = figure_wording.format_compared([value], figure_wording.format_duration, upwards=False)
    return f">= {text.removeprefix('~')}"


def _describe_most(analysis: Analysis, result: ChainResult) -> str:
    """Say how long a chain takes at most, as far as that is known."""
    bound = result.bound.value
    if bound is not None and is_known_bound(result.bound):
        return f"it never takes more than {_write(bound)}"
    places = find_unfound_places(analysis, result.terms)
    return f"no bound was found{f' {describe_unfound_places(places)}' if places else ''}"


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
    """Say what has to go from an overloaded host, or which figure is to be measured first; empty for neither."""
    for place, place_shares in find_overloaded_places(analysis, result.terms).items():
        shares = sorted(((share.value, name) for name, share in place_shares if share.value), key=lambda pair: -pair[0])
        unit = " of a core" if place in analysis.hosts else ""
        needed = [f"{name} ({figure_wording.format_share(share)}{unit})" for share, name in shares[:_NAMED_LOADS]]
        return f"Take work off {place}, where {join_words(needed)} need{'s' if len(needed) == 1 else ''} most."
    for name, share in find_overloaded_elements(analysis, result.terms).items():
        return (
            f"Let {name} work less often, or make it quicker: it takes {figure_wording.format_share(share)} of a core."
        )
    links = find_saturated_links(result.terms)
    if links:
        topic = max(analysis.links[links[0]].topic_traffic, key=lambda pair: pair[1].value or 0)[0]
        return f"Send less over {links[0]}, most of which is {topic}: less often, or less at once (compressed, for instance)."
    if result.bound.missing and not result.bound.complete:
        return _suggest_measuring(analysis, result)
    if any(text.startswith(NO_USE_NOTE) and REPLACED_WORDS in text for text in result.bound.assumptions):
        return "Let each source send on a topic of its own, or write `memory: each_source` at the input where the program keeps a message of each."
    return ""


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


def _write(nanoseconds: Fraction) -> str:
    return figure_wording.format_duration(nanoseconds)
