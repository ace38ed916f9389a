"""What the bound of a chain lacks, in words: figures that nobody wrote, links that are not there, what is overloaded."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.diagnostics.common_wording import join_first, join_words
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import JudgedChain
from archgen.timing.chains.unfound_bounds import (
    describe_unfound_places,
    find_overloaded_places,
    find_saturated_links,
    find_unfound_places,
)
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import NO_MATCH_NOTE, NO_USE_NOTE, UNLINKED_NOTE
from archgen.timing.system.core_placement import is_missing_cores
from archgen.timing.system.timing_system import TimingSystem

_HOST_SEPARATOR = " - "
"""What stands between the names of two hosts that no link joins, where a link's name would stand."""


def describe_gaps(result: ChainResult, analysis: Analysis) -> str:
    """Return what a chain's bound lacks: `no bound: execution time of x, y unknown`; empty where it lacks nothing."""
    overloaded = [*find_overloaded_places(analysis, result.terms), *find_saturated_links(result.terms)]
    if overloaded:
        return f"{join_words(overloaded)} {'is' if len(overloaded) == 1 else 'are'} overloaded"
    if result.bound.complete:
        return ""
    phrases = list_missing_figures(result, analysis)
    unfound_text = describe_unfound_places(find_unfound_places(analysis, result.terms))
    if not phrases:
        return f"{_describe_basis(result)}no bound found {unfound_text}" if unfound_text else "no bound"
    phrases += [f"none found {unfound_text}"] if unfound_text else []
    return f"{_describe_basis(result)}no bound: {'; '.join(phrases)}"


def list_missing_figures(result: ChainResult | JudgedChain, analysis: Analysis) -> list[str]:
    """Return what nobody wrote of a chain whose bound lacks something, a phrase for each quantity."""
    phrases = [*_describe_unknown_figures(result, analysis.system), *_describe_unlinked(result, analysis.system)]
    named_elements = {
        name
        for term in result.terms
        for term_value in (term.sampling, term.response, term.link)
        for name in term_value.missing
    }
    # The bound is the maximum over all ways, the terms are those of one of them.
    elsewhere = tuple(
        name for name in result.bound.missing if name not in named_elements and not is_missing_cores(name)
    )
    if elsewhere and result.terms:
        phrases.append(f"on other ways, figures of {join_first(elsewhere)} unknown")
    notes = (NO_MATCH_NOTE, NO_USE_NOTE)
    return phrases + [text for text in result.bound.assumptions if not result.terms or text.split(":")[0] in notes]


def _describe_unknown_figures(result: ChainResult | JudgedChain, system: TimingSystem) -> Iterable[str]:
    """Yield what figures nobody wrote, and of which elements and links.

    A response is also unknown where that of a neighbour is, or where its search diverged: then the missing names are
    those of elements whose execution time is written.
    """
    timed_names = {a.id for a in system.activities.values() if a.wcet is not None or a.response is not None}
    paced_names = {a.id for a in system.activities.values() if a.period is not None}
    links = _list_missing(term.link for term in result.terms)
    responses = _list_missing(term.response for term in result.terms)
    # An unknown latency makes the waiting time unknown as well: it is named once, as a latency.
    periods = [
        name
        for name in _list_missing(term.sampling for term in result.terms)
        if name not in links and name not in paced_names and name in system.activities
    ]
    times = [name for name in responses if name not in timed_names and name in system.activities]
    cores = [name for name in dict.fromkeys([*responses, *links, *result.bound.missing]) if is_missing_cores(name)]
    latencies = dict.fromkeys([*links, *(name for name in responses if name not in system.activities)])
    link_names = [name for name in latencies if _HOST_SEPARATOR not in name and not is_missing_cores(name)]
    for quantity, names in (("period or rate", periods), ("execution time", times), ("latency", link_names)):
        if names:
            yield f"{quantity} of {join_first(tuple(names))} unknown"
    yield from (f"{name} not written" for name in cores)


def _describe_unlinked(result: ChainResult | JudgedChain, system: TimingSystem) -> Iterable[str]:
    """Yield which hosts no link joins, where a message between them is on the way, or a response depends on one."""
    pairs = [name.split(_HOST_SEPARATOR) for name in _list_missing(term.link for term in result.terms)]
    unlinked_pairs = dict.fromkeys(tuple(sorted(pair)) for pair in pairs if len(pair) > 1)
    yield from (f"no link joins {' and '.join(pair)}" for pair in unlinked_pairs)
    values = [value for term in result.terms for value in (term.sampling, term.response)]
    names = _list_missing(value for value in values if UNLINKED_NOTE in value.assumptions)
    hosts = dict.fromkeys(
        activity.host for name in names if (activity := system.activities.get(name)) and activity.host
    )
    if hosts and not unlinked_pairs:
        yield f"no link joins {join_words(list(hosts))}"


def _list_missing(values: Iterable[TimingValue]) -> list[str]:
    return list(dict.fromkeys(name for value in values for name in value.missing if not value.complete))


def _describe_basis(result: ChainResult) -> str:
    if result.bound.value is None:
        return ""
    values = [value for term in result.terms for value in (term.response, term.link)]
    return "(what is known) " if any(value.value for value in values) else "(periods only) "
