"""What the words of a timing summary mean: those that it uses, and no others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics.text_columns import TextRow
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.figures.figure_wording import name_unknown_reason
from archgen.timing.figures.timing_values import TimingValue

_CHAIN_VERDICTS = {
    "met": "the bound is not above the deadline",
    "missed": "it can happen: the best case is above the deadline, a run was seen, or there is no bound at all",
    "not proven": "the bound is above the deadline, or none was found; the chain may still be in time",
    "open": "figures are missing",
}
_HOST_VERDICTS = {
    "schedulable": "each response is within the period, or the load is so low that it would be with priorities by rate",
    "overload": "more is to be done than the cores can do",
    "undecided": "the cores can do it; not each response is proven to be within its period",
}
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
    "executor": "callbacks of one thread, holds for any order of them",
    "non_preemptive": "by the priorities that are written; what has begun is not interrupted",
    "fifo": "in the order in which things come",
    "ros2_executor": "by the rounds in which an executor of ROS 2 works",
    "edf": "the earliest deadline first",
    "cores": "several cores, holds for any order of their work",
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
    yield from ((VERDICT_WORDS[word], text) for word, text in _CHAIN_VERDICTS.items() if word in verdicts)
    # Signs are no part of any id: where one stands in the text, it is a sign.
    yield from ((sign, text) for sign, text in _SIGNS.items() if sign in summary)
    host_verdicts = {load.verdict for load in analysis.hosts.values()}
    reasons = {*map(name_unknown_reason, _list_shown_values(analysis, chains)), *host_verdicts}
    yield from ((word, text) for word, text in _FIGURES.items() if word in reasons)
    yield from ((word, text) for word, text in _HOST_VERDICTS.items() if word in host_verdicts)
    behaviours = {pace.behaviour for pace in analysis.paces.values()}
    yield from ((word, text) for word, text in _BEHAVIOURS.items() if word in behaviours)
    if analysis.paces:
        yield "gap", "the largest time between two activations"
        yield "response", "the longest time from an activation to its end, with all that gets in its way"
    tiers = {response.tier for response in analysis.responses.values()}
    yield from ((f"({word})", text) for word, text in _TIERS.items() if word in tiers)


def _list_shown_values(analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[TimingValue]:
    """Yield the figures that the summary prints."""
    yield from (result.bound for result in chains.values())
    yield from (load.worst for load in analysis.services.values())
    for name, pace in analysis.paces.items():
        yield from (pace.rate, pace.gap, analysis.responses[name].worst)
