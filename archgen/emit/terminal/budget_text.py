"""The budget of a chain for people: how much each element, each host and all together may take, and whose it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen.diagnostics.text_columns import TextRow, align_rows
from archgen.emit.data import timing_json
from archgen.emit.terminal.chain_remedies import describe_slack
from archgen.emit.terminal.figure_text import format_figure
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.figures import figure_wording
from archgen.timing.search.chain_budgets import ChainBudget, FactorBudget, FigureBudget, PartnerShare

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
        rows = [_share_row(share, partner_titles) for share in sort_shares(budget.shared.shares)]
        yield from align_rows([header, *rows], width)
    if budget.untried:
        yield f"not tried, as {len(budget.untried)} figures are too many: {figure_wording.join_first_names(budget.untried)}"


def sort_shares(shares: tuple[PartnerShare, ...]) -> list[PartnerShare]:
    """Return shares by partner, what is on the chain first, and else in their order."""
    return sorted(shares, key=lambda share: (not share.owners, share.owners, not share.on_chain))


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
