"""The pages on what rests on a partner and what he has to do, and the table of milestones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from archgen.frozen import replace
from archgen.model.architecture import Partner
from archgen.model.selector_evaluation import list_needs
from archgen.views import inline_text
from archgen.views.agreement.exchange_tables import PartnerExchange
from archgen.views.lookup import Lookup
from archgen.views.pages.context_pages import HOME_CRUMB, make_page_slug
from archgen.views.pages.page_parts import PARTS_KIND
from archgen.views.reliance import impact_outline, partner_impact, partner_tasks
from archgen.views.shapes import (
    Block,
    Dashboard,
    DashboardCard,
    KeyFigure,
    Outline,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    make_columns,
)

if TYPE_CHECKING:  # a site that is compared with nothing loads no comparison
    from archgen.compare import Comparison

_CARD_WIDTHS = {"requirements": 6, "waiting": 6, "tasks": 8, "awaited": 4, "planned": 6, "milestones": 6}
"""Of twelve, by the name of a section; the others take all."""


def make_reliance_pages(
    lookup: Lookup, exchanges: Sequence[PartnerExchange], comparison: Comparison | None
) -> Iterator[Page]:
    """Make two pages for each partner who owns components. Of a part of the project nothing is said."""
    if lookup.scope.components is not None:
        return
    needs = list_needs(lookup.architecture)
    for partner in lookup.architecture.partners.values():
        late = partner_impact.find_parts_of(lookup, partner)
        if not late.components:
            continue
        impact = partner_impact.find_impact(lookup, exchanges, late, needs)
        outline, figures = (
            impact_outline.make_impact_outline(lookup, impact),
            impact_outline.list_figures(lookup, impact),
        )
        page = _make_page(partner, "late", outline, figures, "impact")
        yield replace(page, waterfall=impact_outline.make_use_case_waterfall(lookup, impact))
        tasks = partner_tasks.find_tasks(lookup, exchanges, impact, comparison)
        outline, figures = partner_tasks.make_task_outline(lookup, tasks), partner_tasks.list_task_figures(tasks)
        yield _make_page(partner, "todo", outline, figures, "todo")


def link_reliance_pages(lookup: Lookup, partner_id: str) -> Iterator[Paragraph]:
    """Yield the links from a partner's page to the two, where there are these."""
    links = (Text("What is to do", ref=f"todo:{partner_id}"), Text("If they are late", ref=f"late:{partner_id}"))
    if lookup.scope.components is None:
        yield Paragraph(inline_text.join_inlines(((link,) for link in links), " · "))


def _make_page(partner: Partner, kind: str, outline: Outline, figures: Iterator[KeyFigure], verb: str) -> Page:
    """Return the page of a document, a card for each section; use cases stand in bars of their own."""
    section = Section(f"{kind}:{partner.id}", outline.title)
    cards = tuple(
        DashboardCard(each.title, tuple(blocks), _CARD_WIDTHS.get(each.subject, 12), remark, kind="wraps")
        for each in outline.sections
        if each.anchor != impact_outline.USE_CASES_ANCHOR
        for blocks, remark in (_move_blocks(each, section.anchor),)
    )
    # A figure leads to its table.
    own_figures = tuple(
        replace(figure, ref=f"table:{figure.ref.replace(':', '-')}/{section.anchor}") for figure in figures
    )
    crumbs = (HOME_CRUMB, (partner.title, f"partner:{partner.id}"))
    lead = f"{outline.subtitle} · archgen {verb} --partner {partner.id}"
    path = f"{kind}/{make_page_slug(partner.id)}.html"
    dashboard = Dashboard(own_figures, cards)
    return Page(path, section.anchor, outline.title, PARTS_KIND, section, crumbs, lead, dashboard=dashboard)


def _move_blocks(section: Section, page_anchor: str) -> tuple[list[Block], str]:
    """Return the blocks of a section with anchors of the page's own, and the caption of its table, which a card hides."""
    tables = [block.caption for block in section.blocks if isinstance(block, Table)]
    blocks = [
        replace(block, anchor=f"{block.anchor}/{page_anchor}") if isinstance(block, Table) else block
        for block in section.blocks
    ]
    return blocks, tables[0] if tables else ""


def make_milestone_table(lookup: Lookup) -> Table | None:
    """List the milestones by their days: what each needs, whose that is, and how many nodes of it are planned."""
    architecture = lookup.architecture
    needs = list_needs(architecture)
    rows = []
    for each in needs:
        owners = dict.fromkeys(owner for name in each.components for owner in architecture.components[name].owners)
        nodes = {node.id: node for name in each.components for node in lookup.nodes_of.get(name, ())}
        planned = [node for node in nodes.values() if node.status == "planned"]
        rows.append(
            (
                inline_text.to_inlines(each.milestone.title),
                inline_text.to_inlines(each.milestone.date or "no day named"),
                inline_text.to_code(each.milestone.needs),
                inline_text.to_inlines(inline_text.count_noun(len(each.components), "component")),
                inline_text.join_inlines(inline_text.partner_link(architecture, owner) for owner in owners),
                inline_text.join_inlines((inline_text.node_link(node),) for node in planned),
            )
        )
    columns = make_columns(
        ("Milestone", 1.5), ("Day", 0.8), ("Needs", 1.5), ("Which is", 0.8), ("Of", 1.5), ("Still planned", 1.5)
    )
    anchors = tuple(f"milestone:{each.milestone.id}" for each in needs)
    return Table("table:milestones", "Milestones by their days", columns, tuple(rows), anchors) if rows else None
