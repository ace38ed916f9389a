"""One chain term by term, the ways between two elements, and the budget of a chain, for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.diagnostics import join_first
from archgen.diagnostics.text_columns import TextRow, align_rows
from archgen.emit.data import timing_json
from archgen.emit.terminal import chain_remedies, timing_text
from archgen.emit.terminal.timing_text import describe_slack, format_figure, format_missing
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import BoundedPath
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.chains.missing_figures import describe_gaps
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
