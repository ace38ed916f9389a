"""One chain term by term, the ways between two elements, the budget of a chain, and answers to single questions about
timing (why, what if, what decides), for the terminal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.diagnostics import Span, format_transition, join_first, make_visible
from archgen.diagnostics.text_columns import TextRow, align_rows, format_section
from archgen.emit.data import timing_json
from archgen.emit.terminal import chain_remedies, timing_text
from archgen.emit.terminal.timing_text import describe_slack, format_figure, format_missing
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import BoundedPath
from archgen.timing.chains.chain_sensitivity import ChainSensitivity, UnknownFigure
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.chains.missing_figures import describe_gaps
from archgen.timing.chains.working_lines import ReasonLine
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue, list_assumptions
from archgen.timing.search.chain_budgets import ChainBudget, FactorBudget, FigureBudget, PartnerShare
from archgen.timing.search.proposals import Proposal


def format_chain(  # noqa: PLR0913, PLR0917 - what is shown of one chain
    result: ChainResult,
    analysis: Analysis,
    age: TimingValue,
    published: tuple[Fraction, Fraction] | None = None,
    width: int | None = None,
    proposal: Proposal | None = None,
) -> Iterator[str]:
    """Yield a chain term by term, with the reason and the place of each; `age` is its largest data age."""
    yield f"{result.id}: {' > '.join(result.through)}"
    if result.terms:
        yield from align_rows(_term_rows(result.terms), width)
        yield ""
    rows: list[TextRow] = [
        (
            "largest reaction time = largest data age",
            format_figure(result.bound),
            describe_gaps(result, analysis) or "hold it against the deadline",
        )
    ]
    if age != result.bound:
        rows = [
            (
                "largest reaction time"
                if analysis.system.activities[result.through[0]].behaviour == "periodic"
                else "largest reaction time, from the event on",
                format_figure(result.bound),
                describe_gaps(result, analysis) or "hold it against the deadline",
            ),
            ("largest data age, until the next one replaces it", format_figure(age), format_missing(age)),
        ]
    rows += [
        (
            "reduced reaction time (from the first sample on)",
            format_figure(result.reduced_reaction),
            "hold it against a stopwatch, or a trace that begins with the sample",
        ),
        (
            "reduced data age (when the last element sends)",
            format_figure(result.reduced_age),
            "hold it against the age of the stamps in what the last element sends",
        ),
        ("best case", format_figure(result.best), "the shortest time that a trace may show"),
    ]
    if result.spread is not None:
        spread = figure_wording.format_duration(result.spread)
        rows.append(("best to worst", spread, "how much the end of the chain may jitter (actuation jitter)"))
    if published:
        rows.append(
            (
                "with priorities and implicit communication (Duerr): reaction",
                figure_wording.format_duration(published[0]),
                "",
            )
        )
        rows.append(("    reduced data age", figure_wording.format_duration(published[1]), ""))
    if result.deadline:
        verdict_text = ", ".join(filter(None, (VERDICT_WORDS[result.verdict], timing_text.describe_slack(result))))
        rows.append(("deadline", format_figure(result.deadline), verdict_text))
    rows += [(share.strip(), limit, verdict) for share, _, limit, verdict in timing_text.list_share_rows(result)]
    yield from align_rows(rows, width)
    if result.late_run:
        yield f"  {timing_text.describe_late_run(result)}"
    advice = advise_on_chain(analysis, result)
    if advice is not None:
        yield ""
        yield from (f"  {sentence}" for sentence in advice if sentence)
    if proposal is not None and result.id in proposal.tried[0].late:
        head = f" ({proposal.best.words}: `archgen timing --propose`)" if proposal.best.changes else ""
        yield f"  what would prove it{head}: {chain_remedies.describe_remedy(proposal, result.id)}"
    for assumption in list_assumptions(result.bound) if result.terms else ():
        yield f"  assumes: {assumption}"


def _term_rows(terms: Iterable[ChainTerm]) -> Iterator[TextRow]:
    yield "element", "link", "waits", "response", "why"
    for term in terms:
        place = f" ({term.at})" if term.at.file else ""
        link = format_figure(term.link) if term.link.value != 0 else "-"
        yield term.activity, link, format_figure(term.sampling), format_figure(term.response), f"{term.why}{place}"


def format_ways(
    source: str, target: str, count: int, worst: Iterable[BoundedPath], best: Iterable[BoundedPath]
) -> Iterator[str]:
    """Yield the ways between two elements."""
    yield f"{source} to {target}: {count} way{'s' if count != 1 else ''}"
    if not count:
        yield "  nothing that leaves the first reaches the second; ask the other way round?"
    for title, listed_ways in (("worst", worst), ("best case", best)):
        for number, way in enumerate(listed_ways, 1):
            yield f"  {title} {number}: {format_figure(way.bound)}   {' > '.join(way.through)}"
            if not way.bound.complete:
                yield f"      no bound: {format_missing(way.bound)}"


_FIGURE_WORDS = {"wcet": "execution time", "response": "response", "period": "one every"}
_MS = 10**6


def format_budget(
    result: ChainResult, budget: ChainBudget, partner_titles: Mapping[str, str], width: int | None = None
) -> Iterator[str]:
    """Yield the budget of a chain: each figure alone, each host, and all together by partner."""
    yield (
        f"{result.id}: {format_figure(result.bound)}, deadline {format_figure(result.deadline)}, "
        f"{VERDICT_WORDS[result.verdict]}, {describe_slack(result) or 'no bound'}"
    )
    yield ""
    yield "Each alone, all else as it is written: so much keeps the deadline"
    yield from align_rows([("element", "figure", "written", "at most"), *map(_figure_row, budget.figures)], width)
    if budget.hosts:
        yield ""
        yield "All execution times of a host alone"
        yield from align_rows([(host, _describe_factor(factor)) for host, factor in budget.hosts], width)
    yield ""
    if budget.shared.factor is None:
        yield "No common factor keeps the deadline, however small."
    else:
        yield f"All together, each times {figure_wording.format_number(budget.shared.factor)}: who may take how much"
        header = ("partner", "element", "written", "may take", "")
        rows = [
            _share_row(share, partner_titles)
            for share in sorted(
                budget.shared.shares, key=lambda share: (not share.owners, share.owners, not share.on_chain)
            )
        ]
        yield from align_rows([header, *rows], width)
    if budget.untried:
        yield f"not tried, as {len(budget.untried)} figures are too many: {join_first(budget.untried)}"


def _figure_row(budget: FigureBudget) -> TextRow:
    largest = "any" if budget.is_free else "none keeps it" if budget.largest is None else _write_share(budget.largest)
    written = figure_wording.format_duration(budget.written)
    return budget.activity, _FIGURE_WORDS[budget.key], written, largest


def _describe_factor(budget: FactorBudget) -> str:
    if budget.factor is None:
        return "may grow by any factor" if budget.is_free else "no factor keeps it, however small"
    verb = "may grow by the factor" if budget.factor >= 1 else "must shrink by the factor"
    return f"{verb} {figure_wording.format_number(budget.factor)}"


def _share_row(share: PartnerShare, partner_titles: Mapping[str, str]) -> TextRow:
    owners = ", ".join(partner_titles.get(owner, owner) for owner in share.owners) or "nobody"
    may_take = _write_share(share.may_take) if share.key == "wcet" else f"{_write_share(share.may_take)} (response)"
    return owners, share.activity, _write_share(share.written), may_take, "" if share.on_chain else "beside the chain"


def _write_share(duration: Fraction) -> str:
    """Write a duration exactly: as it is printed it can be set, and still keeps the deadline."""
    return figure_wording.write_exact_duration(duration)


def budget_to_json(result: ChainResult, budget: ChainBudget) -> dict[str, Any]:
    """Return the budget as plain data; durations in ms."""
    return {
        "version": timing_json.VERSION,
        "budget": result.id,
        "bound": timing_json.duration_to_json(result.bound),
        "deadline": timing_json.duration_to_json(result.deadline)["value"] if result.deadline else None,
        "slack": None if result.slack is None else float(result.slack / _MS),
        "verdict": result.verdict,
        "figures": [
            {
                "element": figure.activity,
                "figure": figure.key,
                "written": float(figure.written / _MS),
                "largest": None if figure.largest is None else float(figure.largest / _MS),
                "free": figure.is_free,
            }
            for figure in budget.figures
        ],
        "hosts": {
            host: {"factor": None if factor.factor is None else float(factor.factor), "free": factor.is_free}
            for host, factor in budget.hosts
        },
        "factor": None if budget.shared.factor is None else float(budget.shared.factor),
        "shares": [
            {
                "owners": list(share.owners),
                "element": share.activity,
                "figure": share.key,
                "written": float(share.written / _MS),
                "may_take": float(share.may_take / _MS),
                "on_chain": share.on_chain,
            }
            for share in budget.shared.shares
        ],
        "untried": list(budget.untried),
    }


_ChainResults = Mapping[str, ChainResult]
_AnswerJson = dict[str, Any]


def format_reasoning(lines: Iterable[ReasonLine]) -> Iterator[str]:
    """Yield the lines of a chain of reasoning, each step below what it supports, with its place."""
    for line in lines:
        place = f"   {line.at}" if line.at.file else ""
        yield make_visible(f"{'  ' * line.depth}{line.text}{place}")


def reasoning_to_json(element: str, lines: Iterable[ReasonLine]) -> _AnswerJson:
    """Return a chain of reasoning as plain data."""
    steps = [{"depth": line.depth, "text": line.text, "at": str(line.at) if line.at.file else None} for line in lines]
    return {"version": timing_json.VERSION, "why": element, "steps": steps}


def format_timing_changes(
    old_timing: tuple[Analysis, _ChainResults],
    new_timing: tuple[Analysis, _ChainResults],
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


def _changed_chain_rows(old_chains: _ChainResults, new_chains: _ChainResults) -> Iterator[TextRow]:
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


def sensitivity_to_json(chain: ChainResult, ranking: ChainSensitivity) -> _AnswerJson:
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
