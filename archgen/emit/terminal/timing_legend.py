"""What the words of a timing summary mean: those that it uses and nobody knows, in ten lines at most."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from archgen.diagnostics.text_columns import TextRow, format_section
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_verdicts import VERDICT_MEANINGS, VERDICT_WORDS
from archgen.timing.figures.figure_wording import name_unknown_reason
from archgen.timing.figures.timing_values import TimingValue

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
