"""The chapter "Between partners": a spread for each partner with what it gives, takes, promises and still owes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from archgen.diagnostics import join_first
from archgen.frozen import dataclass
from archgen.model.architecture import Partner
from archgen.model.component import Component
from archgen.model.partner_interfaces import components_at_ends
from archgen.timing.chains.element_flows import ElementFlow
from archgen.timing.figures.timing_values import largest_value
from archgen.views import element_references, inline_text
from archgen.views.agreement import exchange_tables
from archgen.views.agreement.exchange_tables import PartnerExchange, gather_exchanges
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.agreement.promise_rows import QOS_OFFERED
from archgen.views.elements.functional_level import first_sentence
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.pages.short_spreads import MANY_PARTNERS, MAX_SHORT_ROWS, list_short_blocks
from archgen.views.reliance import partner_impact
from archgen.views.reliance.partner_impact import PartnerImpact
from archgen.views.shapes import (
    Block,
    Bullets,
    Inlines,
    Paragraph,
    Section,
    Table,
    Text,
    drop_empty_columns,
    head_part,
    make_columns,
)
from archgen.views.timing import chain_status, timing_tables, value_format

if TYPE_CHECKING:
    from archgen.views.changes.site_changes import SiteChanges

CHAPTER_ANCHOR = "page:partners"
_MAX_MATRIX_PARTNERS = 10
_MAX_ROWS = 44
"""More flows or components than these are told together: of one giver and taker, then of one partner."""
_MAX_GRAVE_ROWS = 12
_MAX_NAMES = 6
"""So many partners are named in a cell; the others are counted."""


@dataclass(frozen=True, slots=True)
class _Flow:
    """What a partner gives or takes by one output: with whom, at which ends, and how it is promised."""

    partners: tuple[str, ...]
    givers: tuple[str, ...]
    takers: tuple[str, ...]
    """Ids of components."""
    types: tuple[str, ...]
    topics: tuple[str, ...]
    terms: tuple[InterfaceTerms, ...]
    flows: tuple[ElementFlow, ...]
    """Those to the takers, as far as timing knows them."""


def make_partner_chapter(lookup: Lookup, changes: SiteChanges | None = None, *, folds: bool = True) -> Section | None:
    """Make the chapter; None where no partner gives another anything. Long lists are told together where it `folds`."""
    writer = make_spread_writer(lookup, changes, folds=folds)
    if writer is None:
        return None
    sections = tuple(map(writer.write_spread, writer.partners))
    return Section(CHAPTER_ANCHOR, "Between partners", tuple(writer.write_overview()), sections, page_break=True)


def make_spread_writer(
    lookup: Lookup, changes: SiteChanges | None = None, *, folds: bool = True
) -> SpreadWriter | None:
    """Make what writes the spreads; None where no partner gives another anything."""
    exchanges = gather_exchanges(lookup)
    return SpreadWriter(lookup, exchanges, changes, folds=folds) if exchanges else None


class SpreadWriter:
    """Writes the spreads; what all of them need is gathered once."""

    def __init__(
        self, lookup: Lookup, exchanges: Sequence[PartnerExchange], changes: SiteChanges | None, *, folds: bool
    ) -> None:
        """Gather the flows by output, and the interfaces by who gives and who takes them."""
        self.lookup, self.exchanges, self.changes, self.folds = lookup, exchanges, changes, folds
        architecture = lookup.architecture
        interfaces = [terms for exchange in exchanges for terms in exchange.interfaces]
        self.given, self.taken = (_group_by(interfaces, side) for side in (0, 1))
        self.partners = [each for each in architecture.partners.values() if each.id in {*self.given, *self.taken}]
        self.is_short = folds and len(self.partners) > MANY_PARTNERS
        self.row_limit = MAX_SHORT_ROWS if self.is_short else _MAX_ROWS
        self.impacts: dict[str, PartnerImpact] = {}
        self.components: dict[str, list[Component]] = {}
        for component in architecture.components.values():
            for owner in component.owners if lookup.scope.shows_component(component.id) else ():
                self.components.setdefault(owner, []).append(component)
        self.flows: dict[str, list[ElementFlow]] = {}
        finder = lookup.timing.flows if lookup.timing else None
        for activity in lookup.timing.analysis.system.activities if lookup.timing and finder else ():
            for flow in finder.list_given([activity]) if finder else ():
                for key in dict.fromkeys((flow.arc.output, flow.arc.topic)):
                    self.flows.setdefault(key, []).append(flow)

    def write_overview(self) -> Iterator[Block]:
        """Yield the matrix of who gives whom how much, and a line for each partner."""
        architecture = self.lookup.architecture
        if 1 < len(self.partners) <= _MAX_MATRIX_PARTNERS:
            counts = {
                (direction[0], direction[1]): str(len(exchange.list_given(direction[0])) or "·")
                for exchange in self.exchanges
                for direction in (exchange.pair, exchange.pair[::-1])
            }
            columns = make_columns(("Gives", 1.4), *((each.title, 1, "right") for each in self.partners))
            rows = tuple(
                (
                    inline_text.to_inlines(Text(giver.title, strong=True)),
                    *(inline_text.to_inlines(counts.get((giver.id, taker.id), "")) for taker in self.partners),
                )
                for giver in self.partners
            )
            yield Table(
                "table:partner_matrix", "Interfaces from the partner of the row to that of the column", columns, rows
            )
        rows = tuple(
            (
                inline_text.partner_link(architecture, partner.id),
                inline_text.to_inlines(str(len(self.components.get(partner.id, ())))),
                inline_text.to_inlines(_count_interfaces(self.given.get(partner.id, ()), 1)),
                inline_text.to_inlines(_count_interfaces(self.taken.get(partner.id, ()), 0)),
                *(
                    _count_promised(self.given.get(partner.id, ()), keys)
                    for keys in (exchange_tables.PACE_TERMS, exchange_tables.QOS_TERMS)
                ),
                _count_open(self.given.get(partner.id, ())),
            )
            for partner in self.partners
        )
        columns = make_columns(
            ("Partner", 1.4),
            ("Components", 0.8, "right"),
            ("Gives", 1.2),
            ("Takes", 1.2),
            ("Rates promised", 0.8, "right"),
            ("QoS promised", 0.8, "right"),
            ("Owes", 0.8, "right"),
        )
        yield Table("table:partner_sums", "What each partner gives, takes, promises and still owes", columns, rows)

    def write_spread(self, partner: Partner) -> Section:
        """Write the section of a partner."""
        shorts = self._list_short_blocks(partner) if self.is_short else None
        parts = (
            ("Gives", self._list_flow_blocks(partner, 0)),
            ("Takes", self._list_flow_blocks(partner, 1)),
            (f"Deadlines that rest on {partner.title}", self.list_deadline_blocks(partner)),
            ("Its components", self._list_component_blocks(partner)),
            ("Still to be settled", self.list_open_blocks(partner)),
            ("If it is late", self.list_impact_blocks(partner)),
            ("What changed for it", self.list_change_blocks(partner)),
        )
        chosen = (("", shorts), parts[4], parts[6]) if shorts else parts
        blocks = tuple(block for title, part in chosen for block in head_part(title, part))
        lead = " ".join((partner.description or "").split())
        lead = f"{lead.rstrip('.')}. " if lead else ""
        own = self.components.get(partner.id, ())
        groups = {component.group: None for component in own}
        titles = [self.lookup.architecture.groups[each].title for each in groups]
        places = f" in {join_first(titles, 3)}" if titles else ""
        names = f": {join_first([component.title for component in own], self.row_limit)}" if shorts and own else ""
        words = f"{lead}{count_noun(len(own), 'component')}{places}{names}."
        return Section(
            f"partner:{partner.id}",
            partner.title,
            (Paragraph(inline_text.to_inlines(words)), *blocks),
        )

    def _list_short_blocks(self, partner: Partner) -> Iterator[Block]:
        sides = []
        for side, verb in enumerate(("Gives", "Takes")):
            rows, words = self.fold_rows((self.given, self.taken)[side].get(partner.id, ()), side)
            sides.append((verb, [self.write_flow(row, side) for row in rows], words))
        yield from list_short_blocks(partner, sides, self.list_deadline_rows(partner), self.list_impact_blocks(partner))

    def _list_flow_blocks(self, partner: Partner, side: int) -> Iterator[Block]:
        interfaces = (self.given, self.taken)[side].get(partner.id, ())
        if not interfaces:
            yield Paragraph(inline_text.to_inlines(Text("Nothing.", muted=True)))
            return
        rows, words = self.fold_rows(interfaces, side)
        if words:
            yield Paragraph(inline_text.to_inlines(Text(f"{words} The workbook has each.", muted=True)))
        columns = make_columns(
            ("What, by" if side == 0 else "What, for", 1.6),
            ("To" if side == 0 else "From", 1.6),
            ("Topic", 1.3),
            ("Rate", 0.8, "right"),
            ("Gap ≤", 0.7, "right"),
            ("Age ≤", 0.65, "right"),
            ("Promised", 0.7),
            ("Open", 0.7),
        )
        verb = "gives" if side == 0 else "takes"
        anchor = f"table:{verb}/{partner.id}"
        cells = tuple(self.write_flow(row, side) for row in rows)
        yield drop_empty_columns(Table(anchor, f"{partner.title} {verb}", columns, cells, numbered=False, dense=True))

    def fold_rows(self, interfaces: Sequence[InterfaceTerms], side: int) -> tuple[list[_Flow], str]:
        """Return the rows of what is given or taken, no more than there is room for, and what is told together."""
        rows, words = self.gather_rows(interfaces, side), ""
        for together in ("giver and taker", "partner") if self.folds else ():
            if len(rows) > self.row_limit:
                rows, words = self.gather_rows(interfaces, side, together), f"those of one {together}"
        if self.folds and len(rows) > self.row_limit:
            heaviest = set(sorted(range(len(rows)), key=lambda at: -len(rows[at].terms))[: self.row_limit - 1])
            rest = [terms for at, row in enumerate(rows) if at not in heaviest for terms in row.terms]
            rows = [*(rows[at] for at in sorted(heaviest)), self._make_flow(rest, 1 - side)]
            words += f", and those of {len(rows[-1].partners)} partners with few,"
        count = count_noun(len(interfaces), "interface")
        return rows, f"{count}; {words} are told together with the highest figures." if words else ""

    def gather_rows(self, interfaces: Iterable[InterfaceTerms], side: int, together: str = "output") -> list[_Flow]:
        """Return a row for each output, for each giver with its takers, or for each partner."""
        rows: dict[tuple[str, ...], list[InterfaceTerms]] = {}
        for terms in interfaces:
            key: tuple[str, ...] = (terms.interface.key if together == "output" else terms.interface.pair[1 - side],)
            if together == "giver and taker":
                ends = components_at_ends(self.lookup.architecture, terms.interface)
                key = (*key, *(each.id for components in ends for each in components))
            rows.setdefault(key, []).append(terms)
        return [self._make_flow(each, 1 - side) for each in rows.values()]

    def _make_flow(self, terms: Sequence[InterfaceTerms], other: int) -> _Flow:
        ends = [components_at_ends(self.lookup.architecture, each.interface) for each in terms]
        flows = [flow for each in terms for flow in self._find_flows(each)]
        return _Flow(
            tuple(dict.fromkeys(each.interface.pair[other] for each in terms)),
            tuple(dict.fromkeys(component.id for givers, _ in ends for component in givers)),
            tuple(dict.fromkeys(component.id for _, takers in ends for component in takers)),
            tuple(dict.fromkeys(each.interface.type or each.title for each in terms)),
            tuple(dict.fromkeys(name for each in terms for name in each.interface.topic_names)),
            tuple(terms),
            tuple(flows),
        )

    def _find_flows(self, terms: InterfaceTerms) -> Iterator[ElementFlow]:
        """Yield what timing knows of an interface: its flows to nodes of the taker."""
        takers = {endpoint.node for endpoint in terms.interface.taker_endpoints}
        activities = self.lookup.timing.analysis.system.activities if self.lookup.timing else {}
        for flow in self.flows.get(terms.interface.key, ()):
            if activities[flow.arc.target].node in takers and flow.arc.role == "data":
                yield flow

    def write_flow(self, row: _Flow, side: int) -> tuple[Inlines, ...]:
        """Return the cells of a row."""
        partners = (self._name_partners(row.partners),)
        what = join_first(list(row.types), 2)
        own, others = (row.givers, row.takers) if side == 0 else (row.takers, row.givers)
        own_lines = filter(None, ((Text(what, strong=True),), self._name_ends(own)))
        other_lines = filter(None, (*partners, self._name_ends(others)))
        topics: Inlines = (Text(row.topics[0], code=True),) if len(row.topics) == 1 else ()
        if len(row.topics) > 1:
            topics = inline_text.to_inlines(Text(count_noun(len(row.topics), "topic"), muted=True))
        rates = largest_value(flow.pace.rate for flow in row.flows) if row.flows else None
        return (
            inline_text.join_lines(own_lines),
            inline_text.join_lines(other_lines),
            topics,
            timing_tables.figure_cell(value_format.display_rate(rates), rates) if rates else (),
            timing_tables.duration_cell(largest_value(flow.pace.gap for flow in row.flows)) if row.flows else (),
            timing_tables.duration_cell(largest_value(flow.age for flow in row.flows)) if row.flows else (),
            inline_text.to_inlines(", ".join(_list_promised(row.terms))),
            exchange_tables.list_open_words(row.terms),
        )

    def _name_partners(self, partner_ids: Iterable[str]) -> Inlines:
        links = [inline_text.partner_link(self.lookup.architecture, each) for each in partner_ids]
        return inline_text.join_first(links, _MAX_NAMES // (2 if self.is_short else 1) if self.folds else len(links))

    def _name_ends(self, component_ids: Sequence[str]) -> Inlines:
        """Name the first of some components, and count the others."""
        if not component_ids:
            return ()
        title = self.lookup.architecture.components[component_ids[0]].title
        more = f" +{len(component_ids) - 1}" if len(component_ids) > 1 else ""
        return (Text(f"{title}{more}", muted=True),)

    def list_deadline_rows(self, partner: Partner) -> Iterator[tuple[Inlines, ...]]:
        """Yield the deadlines that rest on a partner, with its share, the worst first."""
        for each in self.find_impact(partner).chains:
            result = each.result
            if result.id in self.lookup.architecture.chains:
                title = self.lookup.architecture.chains[result.id].title
                yield (
                    inline_text.to_inlines(Text(title, ref=f"chain:{result.id}")),
                    inline_text.to_inlines(f"{each.own_steps} of {len(result.terms)}"),
                    timing_tables.duration_cell(each.own_time),
                    timing_tables.duration_cell(result.bound),
                    timing_tables.deadline_cell(result),
                    chain_status.verdict_chip(result),
                )

    def find_impact(self, partner: Partner) -> PartnerImpact:
        """Return what rests on a partner, as `archgen impact` and the site tell it."""
        if partner.id not in self.impacts:
            late = partner_impact.find_parts_of(self.lookup, partner)
            self.impacts[partner.id] = partner_impact.find_impact(self.lookup, self.exchanges, late)
        return self.impacts[partner.id]

    def list_deadline_blocks(self, partner: Partner) -> Iterator[Table]:
        """Yield the table of the deadlines that rest on a partner."""
        columns = make_columns(
            ("Chain", 2.2),
            ("Its steps", 0.7, "right"),
            ("Its share", 0.8, "right"),
            ("At the latest", 0.8, "right"),
            ("Deadline", 0.8, "right"),
            ("Verdict", 0.7),
        )
        if rows := list(self.list_deadline_rows(partner)):
            caption = f"Deadlines that rest on {partner.title}"
            cells = tuple(self._cut_rows(rows, len(columns)))
            yield Table(f"table:deadlines/{partner.id}", caption, columns, cells, numbered=False, dense=True)

    def _cut_rows(self, rows: Sequence[tuple[Inlines, ...]], width: int) -> Iterator[tuple[Inlines, ...]]:
        """Yield the first rows, which are the gravest, and a row that says how many more there are."""
        limit = _MAX_GRAVE_ROWS // (3 if self.is_short else 1) if self.folds else len(rows)
        yield from rows[:limit]
        if len(rows) > limit:
            yield (Text(f"{len(rows) - limit} more stand in the workbook", muted=True),), *(() for _ in range(1, width))

    def _list_component_blocks(self, partner: Partner) -> Iterator[Block]:
        own = self.components.get(partner.id, [])
        caption = f"Components of {partner.title}"
        if self.folds and len(own) > self.row_limit:
            titles = join_first([component.title for component in own], self.row_limit)
            yield Paragraph(inline_text.to_inlines(f"{titles}. Each has a data sheet."))
            return
        rows = tuple(
            (
                inline_text.to_inlines(inline_text.component_link(component)),
                inline_text.to_inlines(first_sentence(component.functionality) or ""),
                self._name_states(component),
                self._name_hosts(component),
            )
            for component in own
        )
        columns = make_columns(("Component", 1.3), ("What it does", 3), ("State", 0.7), ("Host", 1))
        if rows:
            yield drop_empty_columns(
                Table(f"table:owned/{partner.id}", caption, columns, rows, numbered=False, dense=True)
            )

    def _name_states(self, component: Component) -> Inlines:
        nodes = self.lookup.nodes_of.get(component.id, ())
        states = dict.fromkeys(filter(None, (component.status, *(node.status for node in nodes))))
        return inline_text.to_inlines(", ".join(states))

    def _name_hosts(self, component: Component) -> Inlines:
        hosts = dict.fromkeys(node.host for node in self.lookup.nodes_of.get(component.id, ()) if node.host)
        return inline_text.join_inlines(inline_text.host_link(self.lookup.architecture, host) for host in hosts)

    def list_open_blocks(self, partner: Partner) -> Iterator[Block]:
        """Yield what a partner and others have still to settle."""
        rows = list(self._cut_rows(list(self._list_grave_rows(partner)), 3))
        for name, sides in (("owes", self.given), ("is owed", self.taken)):
            for term, interfaces in exchange_tables.group_open_terms(sides.get(partner.id, ())).items():
                place = 1 if name == "owes" else 0
                others = dict.fromkeys(each.interface.pair[place] for each in interfaces)
                types = list(dict.fromkeys(each.interface.type or each.title for each in interfaces))
                rows.append(
                    (
                        self._name_partners(others),
                        inline_text.to_inlines(Text(name, status="open" if name == "owes" else None)),
                        inline_text.to_inlines(f"{exchange_tables.shorten_name(term)} of {join_first(types, 4)}"),
                    )
                )
        columns = make_columns(("With", 1.2), ("State", 0.7), ("What", 3))
        if rows:
            caption = f"What {partner.title} and others have still to settle"
            yield Table(f"table:owes/{partner.id}", caption, columns, tuple(rows), numbered=False, dense=True)
        else:
            yield Paragraph(inline_text.to_inlines("Nothing: every term of its interfaces is settled."))

    def _list_grave_rows(self, partner: Partner) -> Iterator[tuple[Inlines, ...]]:
        """Yield each contradiction and each late chain once, with all partners that it is shared with."""
        shared: dict[tuple[Inlines, Inlines], list[str]] = {}
        for exchange in self.exchanges:
            if partner.id in exchange.pair:
                other = exchange.pair[0] if exchange.pair[1] == partner.id else exchange.pair[1]
                for chip, sentence, _ in exchange_tables.list_grave_points(exchange):
                    shared.setdefault((chip, sentence), []).append(other)
        for (chip, sentence), partners in shared.items():
            yield self._name_partners(partners), chip, sentence

    def list_impact_blocks(self, partner: Partner) -> Iterator[Paragraph]:
        """Say what rests on a partner: deadlines, requirements that nobody else serves, use cases, who reads from it."""
        impact = self.find_impact(partner)
        alone = [each.requirement.id for each in impact.requirements if not each.others]
        deadlines = count_noun(len(impact.chains) + len(impact.free_chains), "deadline")
        use_cases = count_noun(impact.use_case_count, "use case")
        wait = "waits" if len(impact.waiting) == 1 else "wait"
        sentences = [
            f"{len(impact.chains)} of {deadlines}" if impact.chains else "",
            f"{count_noun(len(alone), 'requirement')} that nobody else serves ({join_first(alone, 6)})"
            if alone
            else "",
            f"{len(impact.use_cases)} of {use_cases}" if impact.use_cases else "",
            f"{count_noun(len(impact.readers), 'component')} that read from it" if impact.readers else "",
            f"{count_noun(len(impact.waiting), 'partner')} that {wait} for it" if impact.waiting else "",
        ]
        if found := [sentence for sentence in sentences if sentence]:
            yield Paragraph(inline_text.to_inlines(f"It rests on {partner.title}: {'; '.join(found)}."))

    def list_change_blocks(self, partner: Partner) -> Iterator[Block]:
        """Yield what changed for a partner."""
        if self.changes is None:
            return
        lines = self.changes.list_boundary_lines(partner.id)
        if lines:
            items = tuple(
                element_references.link_names(self.lookup.architecture, line.text) for line in lines[:_MAX_ROWS]
            )
            yield Bullets(items)
        else:
            yield Paragraph(inline_text.to_inlines(f"Nothing since {self.changes.since}."))


def _group_by(interfaces: Iterable[InterfaceTerms], side: int) -> Mapping[str, list[InterfaceTerms]]:
    grouped: dict[str, list[InterfaceTerms]] = {}
    for terms in interfaces:
        grouped.setdefault(terms.interface.pair[side], []).append(terms)
    return grouped


def _count_interfaces(interfaces: Sequence[InterfaceTerms], other: int) -> str:
    """Count interfaces and partners: `19 to 5 partners`; as the matrix does, an output to two partners is two of them."""
    partners = {terms.interface.pair[other] for terms in interfaces}
    count, way = len(interfaces), "to" if other else "from"
    return f"{count} {way} {count_noun(len(partners), 'partner')}" if count else "·"


def _count_promised(interfaces: Sequence[InterfaceTerms], keys: tuple[str, ...]) -> Inlines:
    promised, total = exchange_tables.count_promised(interfaces, keys)
    return inline_text.to_inlines(f"{promised} of {total}") if total else ()


def _count_open(interfaces: Sequence[InterfaceTerms]) -> Inlines:
    count = sum(len(terms.open_points) for terms in interfaces)
    return (Text(count_noun(count, "term"), status="open") if count else Text("nothing", status="met"),)


def _list_promised(terms: Iterable[InterfaceTerms]) -> list[str]:
    names = (
        "QoS" if row.name == QOS_OFFERED else row.name.title.lower()
        for each in terms
        for row in each.promise_rows
        if row.promised and row.name.key in (*exchange_tables.PACE_TERMS, *exchange_tables.QOS_TERMS)
    )
    return list(dict.fromkeys(names))
