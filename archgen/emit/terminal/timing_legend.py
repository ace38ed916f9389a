"""What the words of a timing summary mean: those that it uses, and no others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics.text_columns import TextRow
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_verdicts import VERDICT_MEANINGS, VERDICT_WORDS
from archgen.timing.chains.fused_inputs import find_fused_inputs
from archgen.timing.figures.figure_wording import name_unknown_reason
from archgen.timing.figures.timing_values import TimingValue

_CHAIN_FIGURES = {
    "reaction time": "from a change in the world until the last element has acted on it: what a deadline is about",
    "data age": "how old what the last element sends may be, until its next output replaces it",
    "bound": "what a figure is never above, whatever happens at the same time (`best case`: never below)",
}
_HOST_VERDICTS = {
    "schedulable": "each response is within its deadline (the period where none is written), or the load is so low that it would be with priorities by rate",
    "overload": "more is to be done than the cores (or a resource) can do",
    "undecided": "the cores can do it; not each response is proven to be within its period",
}
_RESOURCE_VERDICTS = {"bearable": "what is asked of a resource is no more than it can do"}
_BEHAVIOURS = {
    "periodic": "works by its own clock",
    "event": "works when something arrives",
    "on_demand": "works when it is called",
    "once": "works once, at the start",
}
_TIERS = {
    "declared": "the response is taken as it is written",
    "dedicated": "no host is written: as if on a core of its own",
    "host": "one core, holds for any order of its work",
    "priorities": "by the priorities that are written",
    "fair": "threads without a priority share the cores as Linux does it",
    "executor": "callbacks of one thread, holds for any order of them",
    "non_preemptive": "by the priorities that are written; what has begun is not interrupted",
    "fifo": "in the order in which things come",
    "ros2_executor": "by the rounds in which an executor of ROS 2 works",
    "edf": "the earliest deadline first",
    "cores": "several cores, holds for any order of their work",
    "whole host": "several cores taken as one, holds for any order of their work",
    "unknown": "an execution time, or the number of cores, is not written",
}
_SIGNS = {
    "~": "rounded to what is shown",
    ">=": "adds up what is known: at least so much, no bound",
    "<=": "at most so much, whatever the figures that are missing may be",
    "(inferred)": "nobody wrote how it works: it follows from what it reads and serves",
}
_FIGURES = {
    "unknown": "figures are missing",
    "unbounded": "there is no largest one: an overload, what works only once, what need not come at all",
    "no bound found": "there may be a bound, but the search found none",
}


def list_legend(analysis: Analysis, chains: Mapping[str, ChainResult], summary: str) -> Iterator[TextRow]:
    """Yield the words that the summary of an analysis uses, each with what it means."""
    verdicts = {result.verdict for result in chains.values() if result.deadline}
    yield from ((VERDICT_WORDS[word], text) for word, text in VERDICT_MEANINGS.items() if word in verdicts)
    if chains:
        yield from _CHAIN_FIGURES.items()
    # Signs are no part of any id: where one stands in the text, it is a sign.
    yield from ((sign, text) for sign, text in _SIGNS.items() if sign in summary)
    host_verdicts: set[str] = {load.verdict for load in analysis.hosts.values()}
    resource_verdicts: set[str] = {load.verdict for load in analysis.resources.values()}
    host_verdicts |= resource_verdicts
    reasons = {*map(name_unknown_reason, _list_shown_values(analysis, chains)), *host_verdicts}
    yield from ((word, text) for word, text in _FIGURES.items() if word in reasons)
    yield from ((word, text) for word, text in _HOST_VERDICTS.items() if word in host_verdicts)
    yield from ((word, text) for word, text in _RESOURCE_VERDICTS.items() if word in resource_verdicts)
    behaviours = {pace.behaviour for pace in analysis.paces.values()}
    yield from ((word, text) for word, text in _BEHAVIOURS.items() if word in behaviours)
    if analysis.hosts:
        yield "load", "rate times execution time, added up: 100 % is one core all the time"
    if any("jitter" in line for line in summary.splitlines()):
        yield "jitter", "how much later than its clock says an element may start"
    if analysis.services:
        yield "caller", "an element that calls the service; the time holds for one call of each"
    if find_fused_inputs(analysis):
        yield "age", "how old a message may be when what uses it begins, since its source began to make it"
        yield "apart", "the largest time between the beginnings at the sources of what is used together"
    if analysis.paces:
        yield "gap", "the largest time between two activations"
        yield "response", "the longest time from an activation to its end, with all that gets in its way"
    tiers = {response.tier for response in analysis.responses.values()}
    yield from ((f"({word})", text) for word, text in _TIERS.items() if word in tiers)


def _list_shown_values(analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[TimingValue]:
    """Yield the figures that the summary prints."""
    yield from (result.bound for result in chains.values())
    yield from (load.worst for load in analysis.services.values())
    yield from (value for link in analysis.links.values() for value in (link.traffic, link.share))
    for name, pace in analysis.paces.items():
        yield from (pace.rate, pace.gap, analysis.responses[name].worst)
