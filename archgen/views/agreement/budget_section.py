"""Who may take how much: for the chains between two partners, what the elements of both may take before one is late."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from archgen.timing.analysis import ChainResult
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.search.chain_budgets import PartnerShare, SharedBudget
from archgen.views import inline_text
from archgen.views.agreement.agreement_content import AgreementContent
from archgen.views.agreement.interface_record import InterfaceRecord
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.shapes import Column, Inlines, Paragraph, Section, Table, Text
from archgen.views.timing import value_format

BudgetFinder = Callable[[ChainResult], SharedBudget | None]
"""Finds what all elements of a chain may take together; None where there is no budget."""
_LEAD = (
    "How long each element of the two on a chain that crosses from one to the other may take, if everything on the chain and "
    "on its hosts grows alike. Who keeps to it keeps the deadlines, as long as all others do. Elements that stand on several "
    "chains are bound by the smallest figure."
)


def find_crossing_budgets(records: Iterable[InterfaceRecord], find_budget: BudgetFinder) -> dict[str, SharedBudget]:
    """Return the budgets of the chains that lead over some interfaces, by chain."""
    crossing_chains = {chain.id: chain for record in records for chain in record.terms.chains}
    budgets = {chain_id: find_budget(chain) for chain_id, chain in crossing_chains.items()}
    return {chain_id: budget for chain_id, budget in budgets.items() if budget is not None}


def write_budget_section(content: AgreementContent) -> Iterator[Section]:
    """Write the table of what each element of the two may take; nothing where no chain has a budget."""
    rows = [row for chain_id, budget in content.budgets.items() for row in _chain_rows(content, chain_id, budget)]
    if rows:
        columns = (
            Column("Chain", 1.3),
            Column("Partner", 0.8),
            Column("Element", 1.4),
            Column("Written", 0.6, "right"),
            Column("May take", 0.7, "right"),
        )
        table = Table("table:budgets", "Who may take how much", columns, tuple(rows), numbered=False)
        yield Section("page:budgets", "Execution times", (Paragraph(inline_text.to_inlines(_LEAD)), table))


def _chain_rows(content: AgreementContent, chain_id: str, budget: SharedBudget) -> Iterator[tuple[Inlines, ...]]:
    own_shares = [share for share in budget.shares if share.on_chain and set(share.owners) & set(content.pair)]
    for number, share in enumerate(own_shares):
        yield (
            () if number else _chain_cell(content, chain_id, budget),
            inline_text.to_inlines(join_owner_titles(content.lookup, share.owners)),
            inline_text.to_inlines(Text(share.activity, code=True)),
            inline_text.to_inlines(value_format.display_duration(TimingValue(share.written))),
            inline_text.to_inlines(_write_share(share)),
        )


def _chain_cell(content: AgreementContent, chain_id: str, budget: SharedBudget) -> Inlines:
    chain = content.lookup.architecture.chains[chain_id]
    parts = [f"{chain.deadline} in all"] if chain.deadline else []
    parts += [f"all times {figure_wording.format_number(budget.factor)}"] if budget.factor is not None else []
    return inline_text.join_lines([inline_text.to_inlines(chain.title), (Text(", ".join(parts), muted=True),)])


def _write_share(share: PartnerShare) -> str:
    """Write a share as it can be set: exact, so that it still keeps the deadline."""
    return figure_wording.write_exact_duration(share.may_take)
