"""Answers to single questions about timing: why, what if, what decides a chain."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.diagnostics import Span, format_transition, make_visible
from archgen.diagnostics.text_columns import TextRow, align_rows, format_section
from archgen.emit.data import timing_json
from archgen.emit.terminal.timing_text import format_figure
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_sensitivity import ChainSensitivity, UnknownFigure
from archgen.timing.chains.missing_figures import describe_gaps
from archgen.timing.chains.working_lines import ReasonLine
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue

ChainResults = Mapping[str, ChainResult]
AnswerJson = dict[str, Any]


def format_reasoning(lines: Iterable[ReasonLine]) -> Iterator[str]:
    """Yield the lines of a chain of reasoning, each step below what it supports, with its place."""
    for line in lines:
        place = f"   {line.at}" if line.at.file else ""
        yield make_visible(f"{'  ' * line.depth}{line.text}{place}")


def reasoning_to_json(element: str, lines: Iterable[ReasonLine]) -> AnswerJson:
    """Return a chain of reasoning as plain data."""
    steps = [{"depth": line.depth, "text": line.text, "at": str(line.at) if line.at.file else None} for line in lines]
    return {"version": timing_json.VERSION, "why": element, "steps": steps}


def format_timing_changes(
    old_timing: tuple[Analysis, ChainResults],
    new_timing: tuple[Analysis, ChainResults],
    changed_figures: Iterable[str],
    width: int | None = None,
) -> Iterator[str]:
    """Yield what some changed figures would change: all chains, and the hosts and elements that differ."""
    (old_analysis, old_chains), (new_analysis, new_chains) = old_timing, new_timing
    yield f"With {', '.join(make_visible(text) for text in changed_figures)}:"
    yield ""
    yield from format_section("Chains", _changed_chain_rows(old_chains, new_chains), width)
    yield from format_section("Hosts that differ", _changed_host_rows(old_analysis, new_analysis), width)
    yield from format_section("Elements that differ", _changed_element_rows(old_analysis, new_analysis), width)


def _changed_chain_rows(old_chains: ChainResults, new_chains: ChainResults) -> Iterator[TextRow]:
    for name, old_chain in old_chains.items():
        new_chain = new_chains[name]
        yield (
            name,
            _format_change(old_chain.bound, new_chain.bound),
            _format_difference(old_chain.bound, new_chain.bound),
            format_transition(old_chain.verdict, new_chain.verdict) if old_chain.deadline else "",
        )


def _changed_host_rows(old_analysis: Analysis, new_analysis: Analysis) -> Iterator[TextRow]:
    for name, old_load in old_analysis.hosts.items():
        new_load = new_analysis.hosts[name]
        if old_load != new_load:
            yield (
                name,
                f"load {_format_change(old_load.utilisation, new_load.utilisation, figure_wording.format_share)}",
                format_transition(old_load.verdict, new_load.verdict),
            )


def _changed_element_rows(old_analysis: Analysis, new_analysis: Analysis) -> Iterator[TextRow]:
    for name in old_analysis.system.activities:
        old_rates, new_rates = old_analysis.paces[name], new_analysis.paces[name]
        old_response, new_response = old_analysis.responses[name].worst, new_analysis.responses[name].worst
        phrases = []
        if old_rates.behaviour != new_rates.behaviour:
            phrases.append(format_transition(old_rates.behaviour or "unknown", new_rates.behaviour or "unknown"))
        if old_rates.rate != new_rates.rate:
            phrases.append(f"rate {_format_change(old_rates.rate, new_rates.rate, figure_wording.format_rate)}")
        if old_rates.gap != new_rates.gap:
            phrases.append(f"gap {_format_change(old_rates.gap, new_rates.gap)}")
        if old_response != new_response:
            phrases.append(f"response {_format_change(old_response, new_response)}")
        if phrases:
            yield name, ", ".join(phrases)


def _format_change(
    old_value: TimingValue, new_value: TimingValue, write: Callable[[Fraction], str] = figure_wording.format_duration
) -> str:
    return format_transition(format_figure(old_value, write), format_figure(new_value, write))


def _format_difference(old_value: TimingValue, new_value: TimingValue) -> str:
    # The difference of two incomplete sums says nothing about the difference of the true values.
    if (
        old_value.value is None
        or new_value.value is None
        or not (old_value.complete and new_value.complete)
        or old_value.value == new_value.value
    ):
        return ""
    sign = "+" if new_value.value > old_value.value else "-"
    return f"({sign}{figure_wording.format_duration(abs(new_value.value - old_value.value))})"


def format_sensitivity(
    chain: ChainResult, analysis: Analysis, ranking: ChainSensitivity, width: int | None = None
) -> Iterator[str]:
    """Yield a ranking of what decides a chain."""
    if not chain.terms:
        yield f"{chain.id}: {format_figure(chain.bound)}   {describe_gaps(chain, analysis)}"
        return
    gaps_text = describe_gaps(chain, analysis)
    yield f"{chain.id}: {format_figure(chain.bound)}{f'   {gaps_text}' if gaps_text else ''}"
    yield ""
    if ranking.gains:
        yield "Improved by 10 %, each figure takes off"
        rows = (
            (figure_wording.format_duration(gain.gain), gain.figure, f"now {gain.written}", _format_span(gain.at))
            for gain in ranking.gains
        )
        yield from align_rows(rows, width)
    elif not ranking.gaps:
        yield "No single figure, improved by 10 %, shortens the chain."
    if ranking.untried:
        yield f"  {ranking.untried} more figures of elements on the same hosts were not tried"
    if ranking.gaps:
        yield ""
        yield "Not known; to be measured in this order"
        gap_rows = (
            (
                _format_lack(gap),
                f"in {gap.terms} term{'s' if gap.terms != 1 else ''}",
                f"of {gap.chains} chain{'s' if gap.chains != 1 else ''}",
                f"works every {figure_wording.format_duration(gap.plausible)}" if gap.plausible else "",
            )
            for gap in ranking.gaps
        )
        yield from align_rows(gap_rows, width)


def _format_lack(gap: UnknownFigure) -> str:
    first, is_pair, second = gap.element.partition(" - ")
    return f"a link between {first} and {second}" if is_pair else f"{gap.what} of {gap.element}"


def _format_span(span: Span) -> str:
    return str(span) if span.file else ""


def sensitivity_to_json(chain: ChainResult, ranking: ChainSensitivity) -> AnswerJson:
    """Return the ranking as plain data; gains in ms."""
    return {
        "version": timing_json.VERSION,
        "sensitivity": chain.id,
        "bound": timing_json.duration_to_json(chain.bound),
        "gains": [
            {
                "figure": gain.figure,
                "written": gain.written,
                "gain": float(gain.gain / 10**6),
                "at": _format_span(gain.at) or None,
            }
            for gain in ranking.gains
        ],
        "unknown": [
            {"element": gap.element, "what": gap.what, "terms": gap.terms, "chains": gap.chains} for gap in ranking.gaps
        ],
        "untried": ranking.untried,
    }
