"""The site's pages on partners: each one, who owes whom what, each pair with its agreement, and each interface."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from archgen.model.architecture import Partner
from archgen.model.partner_interfaces import PartnerPair
from archgen.views import inline_text
from archgen.views.agreement import exchange_tables
from archgen.views.agreement.exchange_tables import PartnerExchange, gather_exchanges, pair_title
from archgen.views.agreement.interface_record import InterfaceRecord, SignedTag, write_signature_table
from archgen.views.agreement.interface_sections import SectionWriter
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.elements.functional_level import make_component_table
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.matrix_shapes import Matrix
from archgen.views.pages.context_pages import HOME_CRUMB, FigureFilter, make_node_table, make_page, make_page_slug
from archgen.views.pages.matrix_pages import make_partner_matrix
from archgen.views.pages.reliance_pages import link_reliance_pages, make_reliance_pages
from archgen.views.shapes import (
    Block,
    Dashboard,
    DashboardCard,
    Facts,
    Inlines,
    KeyFigure,
    Markdown,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    make_columns,
)

MAX_INTERFACE_PAGES = 2_000
"""With more interfaces than these a site has pages for pairs only: it would be ten times as large."""
_OVERVIEW_TITLE = "Who owes whom"
_OVERVIEW_CRUMB = (_OVERVIEW_TITLE, "page:partners")
_PROMISE_NOTE = (
    "Promised is what the giving partner has stated. Derived is what follows from other figures of the design: nobody "
    "promises it."
)

if TYPE_CHECKING:  # a site that is compared with nothing loads no comparison
    from archgen.compare import Comparison


def make_partner_pages(
    lookup: Lookup,
    keep_drawn: FigureFilter,
    signed_tags: Mapping[PartnerPair, tuple[SignedTag, ...]] | None = None,
    comparison: Comparison | None = None,
) -> Iterator[Page]:
    """Make the page of each partner, with what he has to do and what rests on him; where partners give each other
    something, also who owes whom, pairs, interfaces.

    `signed_tags` record what was signed, newest first; `comparison` is with an earlier version.
    """
    exchanges = gather_exchanges(lookup)
    if exchanges:
        yield _overview_page(lookup, exchanges)
    for partner in lookup.architecture.partners.values():
        own_exchanges = [exchange for exchange in exchanges if partner.id in exchange.pair]
        yield _partner_page(lookup, partner, own_exchanges, keep_drawn)
    yield from make_reliance_pages(lookup, exchanges, comparison)
    has_interface_pages = sum(len(exchange.interfaces) for exchange in exchanges) <= MAX_INTERFACE_PAGES
    for exchange in exchanges:
        tags = (signed_tags or {}).get(exchange.pair, ())
        yield _pair_page(lookup, exchange, tags, has_interface_pages=has_interface_pages)
        for terms in exchange.interfaces if has_interface_pages else ():
            yield _interface_page(lookup, exchange, terms, tags)


def pair_reference(pair: Sequence[str]) -> str:
    """Return the anchor of the page on two partners, given in the order in which the project declares them."""
    return f"pair:{pair[0]}:{pair[1]}"


def _overview_page(lookup: Lookup, exchanges: Sequence[PartnerExchange]) -> Page:
    # Who has most to settle comes first.
    ranked = sorted(exchanges, key=lambda exchange: -exchange.open_count)
    rows = tuple(
        (
            (Text(pair_title(lookup, exchange.pair), ref=pair_reference(exchange.pair)),),
            *_count_cells(exchange.pair, exchange),
            *_promised_cells(exchange),
            _open_cell(exchange),
        )
        for exchange in ranked
    )
    columns = make_columns(
        ("Between", 2),
        ("The first gives", 0.8, "right"),
        ("The second gives", 0.8, "right"),
        ("Rates promised", 0.8, "right"),
        ("QoS promised", 0.8, "right"),
        ("Open points", 0.7, "right"),
    )
    table = Table("table:pairs", "Pairs of partners, most open points first", columns, rows)
    count = inline_text.count_noun(sum(len(exchange.interfaces) for exchange in exchanges), "interface")
    lead = f"{count} between {inline_text.count_noun(len(exchanges), 'pair')} of partners"
    section = Section(_OVERVIEW_CRUMB[1], _OVERVIEW_TITLE, (drop_empty_columns(table),))
    return Page(
        "partners.html",
        section.anchor,
        _OVERVIEW_TITLE,
        "partners",
        section,
        (HOME_CRUMB,),
        lead,
        matrix=_make_matrix(lookup, exchanges),
    )


def _make_matrix(lookup: Lookup, exchanges: Sequence[PartnerExchange]) -> Matrix:
    directions = [(direction, exchange) for exchange in exchanges for direction in (exchange.pair, exchange.pair[::-1])]
    counts = {(pair[0], pair[1]): len(exchange.list_given(pair[0])) for pair, exchange in directions}
    references = {(pair[0], pair[1]): pair_reference(exchange.pair) for pair, exchange in directions}
    return make_partner_matrix(lookup, counts, references)


def _count_cells(givers: Iterable[str], exchange: PartnerExchange) -> Iterator[Inlines]:
    for giver in givers:
        yield _make_number(len(exchange.list_given(giver)))


def _make_number(count: int) -> Inlines:
    return (Text(str(count), sort_number=str(count)),)


def _promised_cells(exchange: PartnerExchange) -> Iterator[Inlines]:
    for keys in (exchange_tables.PACE_TERMS, exchange_tables.QOS_TERMS):
        promised, total = exchange_tables.count_promised(exchange.interfaces, keys)
        yield (Text(f"{promised} of {total}", sort_number=f"{promised}/{total}"),) if total else ()


def _open_cell(exchange: PartnerExchange) -> Inlines:
    count = exchange.open_count
    return (Text(str(count), sort_number=str(count), status="open"),) if count else (Text("none", status="met"),)


def _pair_page(
    lookup: Lookup, exchange: PartnerExchange, signed_tags: tuple[SignedTag, ...], *, has_interface_pages: bool
) -> Page:
    """Make the page of two partners: figures, what is open, then what each gives, promised beside derived."""
    title = pair_title(lookup, exchange.pair)
    sections = tuple(_list_direction_sections(lookup, exchange))
    if signed_tags:
        sections += (Section(_signed_reference(exchange.pair), "Signed", (write_signature_table(signed_tags),)),)
    note = Paragraph(inline_text.to_inlines(_PROMISE_NOTE))
    command = Text(f"archgen interfaces --between {exchange.pair[0]} {exchange.pair[1]}", code=True)
    hint = (
        f"With more than {MAX_INTERFACE_PAGES:,} interfaces these have no pages of their own. All their terms are what "
    )
    hint_block = Paragraph(inline_text.to_inlines(hint, command, " writes."), "note")
    blocks = (note,) if has_interface_pages else (note, hint_block)
    section = Section(pair_reference(exchange.pair), title, blocks, sections)
    path = f"partners/{make_page_slug(exchange.pair[0])}/{make_page_slug(exchange.pair[1])}.html"
    table = exchange_tables.make_point_table(lookup, f"points:{exchange.pair[0]}", exchange)
    remark = f"{exchange.open_count} in {inline_text.count_noun(len(exchange.interfaces), 'interface')}"
    settled = Paragraph(
        inline_text.to_inlines("Nothing is open: every term is settled, and nothing contradicts another.")
    )
    dashboard = Dashboard(
        tuple(_list_figures(lookup, exchange)),
        (
            DashboardCard(
                "Open points between the two", (table or settled,), 12, remark if table else "", None, "points"
            ),
        ),
    )
    return Page(
        path,
        section.anchor,
        title,
        "pairs",
        section,
        (HOME_CRUMB, _OVERVIEW_CRUMB),
        "Agreement · " + inline_text.count_noun(len(exchange.interfaces), "interface"),
        dashboard=dashboard,
    )


def _list_figures(lookup: Lookup, exchange: PartnerExchange) -> Iterator[KeyFigure]:
    for giver, taker in (exchange.pair, exchange.pair[::-1]):
        giver_title, taker_title = join_owner_titles(lookup, [giver]), join_owner_titles(lookup, [taker])
        count = len(exchange.list_given(giver))
        note = inline_text.to_inlines(Text(f"interfaces to {taker_title}", muted=True))
        yield KeyFigure(f"{giver_title} gives", str(count), "", note, f"given:{giver}" if count else "")
    for name, keys in (("Rates promised", exchange_tables.PACE_TERMS), ("QoS promised", exchange_tables.QOS_TERMS)):
        promised, total = exchange_tables.count_promised(exchange.interfaces, keys)
        if total:
            left = total - promised
            note = (Text(f"{left} still to be written" if left else "all of them", status="open" if left else "met"),)
            yield KeyFigure(name, str(promised), str(total), note, f"points:{exchange.pair[0]}" if left else "")


def _list_direction_sections(lookup: Lookup, exchange: PartnerExchange) -> Iterator[Section]:
    for giver, taker in (exchange.pair, exchange.pair[::-1]):
        interfaces = exchange.list_given(giver)
        title = f"{join_owner_titles(lookup, [giver])} gives {join_owner_titles(lookup, [taker])}"
        nothing = Paragraph(inline_text.to_inlines(Text("Nothing.", muted=True)))
        table = (
            exchange_tables.make_given_table(lookup, f"table:given/{giver}", title, interfaces) if interfaces else None
        )
        yield Section(f"given:{giver}", title, (table or nothing,))


def _signed_reference(pair: Sequence[str]) -> str:
    return f"signed:{pair[0]}:{pair[1]}"


def _list_interface_facts(
    lookup: Lookup, exchange: PartnerExchange, terms: InterfaceTerms, signed_tags: tuple[SignedTag, ...]
) -> Iterator[tuple[str, Inlines]]:
    """Yield who owns an interface, who reads it, and what was signed of it."""
    sides: dict[bool, list[Inlines]] = {False: [], True: []}
    for end in terms.ends:
        component = (Text(": "), inline_text.component_link(end.component)) if end.component else ()
        sides[end.is_taker].append((*inline_text.owner_links(lookup.architecture, end.owners), *component))
    for name, lines in (("Owner", sides[False]), ("Readers", sides[True])):
        yield name, inline_text.join_lines(dict.fromkeys(lines))
    if signed_tags:
        last_tag = signed_tags[0]
        count = inline_text.count_noun(len(signed_tags), "signature")
        signed = Text(f"{count} of the agreement, the last on {last_tag.date}", ref=_signed_reference(exchange.pair))
        yield "History", inline_text.to_inlines(signed, " as ", Text(last_tag.name, code=True))
    else:
        yield "History", inline_text.to_inlines(Text("no signature of the agreement is recorded", muted=True))


def _interface_page(
    lookup: Lookup, exchange: PartnerExchange, terms: InterfaceTerms, signed_tags: tuple[SignedTag, ...]
) -> Page:
    """Make the page of an interface: what it is, promised and expected, ends, fields, chains, what is open."""
    interface = terms.interface
    record = InterfaceRecord(terms, (interface.key, interface.pair), {})
    # A writer for each page: it writes the fields of a message once, and later refers to them.
    facts = _list_interface_facts(lookup, exchange, terms, signed_tags)
    section = SectionWriter(lookup).write_section(record, exchange_tables.interface_reference(terms), (), facts)
    giver, taker = interface.pair
    path = f"partners/{make_page_slug(giver)}/{make_page_slug(taker)}/{make_page_slug(interface.key)}.html"
    crumbs = (HOME_CRUMB, _OVERVIEW_CRUMB, (pair_title(lookup, exchange.pair), pair_reference(exchange.pair)))
    lead = f"Interface · {join_owner_titles(lookup, [giver])} gives, {join_owner_titles(lookup, [taker])} takes"
    return Page(path, section.anchor, section.title, "interfaces", section, crumbs, lead)


def _partner_page(
    lookup: Lookup, partner: Partner, exchanges: Sequence[PartnerExchange], keep_drawn: FigureFilter
) -> Page:
    """Make a partner's page: contact, what it gives and takes, components, and nodes that it owns or that implement them."""
    blocks: list[Block] = [Markdown(partner.description)] if partner.description else []
    contact = (("Contact", inline_text.to_inlines(partner.contact)),) if partner.contact else ()
    if facts := (*contact, *list_annotation_facts(lookup, partner)):
        blocks.append(Facts(facts))
    if any(partner.id in component.owners for component in lookup.architecture.components.values()):
        blocks += link_reliance_pages(lookup, partner.id)
    if exchanges:
        blocks.append(_exchange_table(lookup, partner, exchanges))
    owned_components = [
        c
        for c in lookup.architecture.components.values()
        if partner.id in c.owners and lookup.scope.shows_component(c.id)
    ]
    if owned_components:
        caption = f"Components of {partner.title}"
        blocks.append(make_component_table(lookup, f"table:owned/{partner.id}", caption, owned_components))
    owned_ids = {component.id for component in owned_components}
    node_ids = {
        node.id for node in lookup.shown_nodes() if partner.id in node.owners or owned_ids & set(node.implements)
    }
    blocks += make_node_table(lookup, [node for node in lookup.shown_nodes() if node.id in node_ids])
    if not blocks:
        blocks.append(Paragraph(inline_text.to_inlines(Text("This partner owns nothing yet.", muted=True))))
    return make_page(Section(f"partner:{partner.id}", partner.title, keep_drawn(blocks)), "partners", None, "Partner")


def _exchange_table(lookup: Lookup, partner: Partner, exchanges: Sequence[PartnerExchange]) -> Table:
    """List with whom a partner has interfaces, most open points first."""
    rows = tuple(
        (
            (
                Text(
                    join_owner_titles(lookup, [_other_of(exchange.pair, partner.id)]), ref=pair_reference(exchange.pair)
                ),
            ),
            *_count_cells((partner.id, _other_of(exchange.pair, partner.id)), exchange),
            _open_cell(exchange),
        )
        for exchange in sorted(exchanges, key=lambda exchange: -exchange.open_count)
    )
    columns = make_columns(
        ("With", 1.4), ("Gives", 0.7, "right"), ("Takes", 0.7, "right"), ("Open points", 0.8, "right")
    )
    return Table(f"table:exchanges/{partner.id}", f"What {partner.title} gives and takes", columns, rows)


def _other_of(pair: PartnerPair, partner: str) -> str:
    return pair[1] if pair[0] == partner else pair[0]
