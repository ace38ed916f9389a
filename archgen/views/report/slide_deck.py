"""The slides for a meeting: overview, time, hosts, each partner, what changed, open points; a section for each slide.

What stands in a slide's sections stands side by side. Long tables go on on further slides, which the emitter makes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence

from archgen.diagnostics import join_first
from archgen.model.architecture import Partner
from archgen.timing.analysis import ChainResult
from archgen.views import inline_text
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.pages import dashboard, report_outline
from archgen.views.pages.partner_spreads import make_spread_writer
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.pages.timing_chapter import make_figures
from archgen.views.report import front_pages
from archgen.views.report.changes_page import tell_changes
from archgen.views.report.deliverable import DeliverablePrinter
from archgen.views.report.printed_figures import print_section_figures
from archgen.views.shapes import (
    Block,
    Facts,
    Inlines,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    keep_columns,
    make_columns,
)
from archgen.views.timing import chain_charts, chain_status, element_timing

_MAX_CHAINS = 8
"""Chains with a slide of their own; all are in the table."""
_MAX_STEPS_BESIDE = 10
_MAX_STEPS_BELOW = 5
_MAX_POINTS = 3
"""Rows of one partner among the open points."""
_MAX_TYPES = 3
_TOLD_BESIDE = frozenset({"verdict", "why", "advice", "latest", "requirements", "assumptions"})
"""What the words beside a chain's picture tell already."""
_TITLE_FACTS = ("Number", "Version", "Date", "State", "Revision")


def make_slide_deck(lookup: Lookup, edition: DocumentEdition) -> Outline:
    """Make the outline of the slides: its facts and notices are for the first one, then a section for each slide."""
    maker = _SlideMaker(lookup, edition)
    sections = (
        *maker.tell_changes(),
        *maker.show_overview(),
        *maker.show_chains(),
        *maker.show_hosts(),
        *maker.show_partners(),
        *maker.list_open_points(),
    )
    facts = front_pages.make_title_facts(lookup, edition)
    return Outline(
        title=lookup.architecture.project.title,
        subtitle="Software architecture",
        facts=tuple((name, value) for name, value in facts if name in _TITLE_FACTS),
        notices=report_outline.make_notices(lookup, edition),
        sections=tuple(map(print_section_figures, sections)),
        properties=front_pages.list_properties(lookup, edition),
    )


class _SlideMaker:
    """Makes the slides in their order."""

    def __init__(self, lookup: Lookup, edition: DocumentEdition) -> None:
        self.lookup, self.edition, self.architecture = lookup, edition, lookup.architecture
        self.printer = DeliverablePrinter(lookup, edition)

    def show_overview(self) -> Iterator[Section]:
        """Yield the picture of the groups, below the figures that say how the architecture stands."""
        cells = tuple(map(front_pages.stack_figure, dashboard.make_dashboard(self.lookup, self.edition).figures))
        figures = Table("table:figures", "How it stands", make_columns(*("" for _ in cells)), (cells,))
        pictures = make_figures(self.edition.drawings, "overview")
        blocks: tuple[Block, ...] = (figures, *pictures) if cells else pictures
        if blocks:
            yield Section("slide:overview", "The architecture at a glance", blocks)

    def show_chains(self) -> Iterator[Section]:
        """Yield the table of all chains, then the picture of each of the first ones beside what it says."""
        results = self.printer.list_results()
        if not results:
            return
        lead = "From what the robot senses to what it does, the worst first."
        if len(results) > _MAX_CHAINS:
            lead += f" The first {_MAX_CHAINS} of {len(results)} have a slide of their own."
        blocks = (
            Paragraph(inline_text.to_inlines(lead)),
            *self.printer.list_worst_chains("table:chains", len(results)),
        )
        yield Section("slide:chains", "Does it react in time?", blocks)
        for result in results[:_MAX_CHAINS]:
            yield from self._show_chain(result)

    def _show_chain(self, result: ChainResult) -> Iterator[Section]:
        """Yield the picture of a chain beside its verdict, what rests on it and what to do; below it its steps.

        Below a picture of many steps is no room for them: beside it stands whose each is; how long it takes, the picture says.
        More than fit beside it have a slide of their own.
        """
        if self.lookup.timing is None:
            return
        chain, anchor = self.architecture.chains[result.id], f"slide:chains/{result.id}"
        pictures = tuple(make_figures(self.edition.drawings, f"chains/{result.id}"))
        verdict = Text(
            chain_charts.describe_chain_verdict(result, self.lookup.timing), status=chain_status.find_status(result)
        )
        told, *_, table = element_timing.make_chain_blocks(self.lookup, self.lookup.timing, result, _TOLD_BESIDE)
        stands_beside = bool(pictures) and len(result.terms) > _MAX_STEPS_BELOW
        facts = dict(self.printer.list_chain_facts(result, max_assumptions=1 if stands_beside else 3))
        if chain.requirements:
            links = (inline_text.requirement_link(self.architecture, name) for name in chain.requirements)
            facts["Rests on it"] = inline_text.join_inlines(links, "; ")
        if isinstance(told, Facts) and not stands_beside:
            facts |= dict(told.rows[1:])
        lines = [Paragraph((Text(f"{name}: ", strong=True), *words)) for name, words in facts.items() if words]
        stands_apart = bool(pictures) and len(result.terms) > _MAX_STEPS_BESIDE
        is_short = stands_beside and not stands_apart
        steps = (self._list_steps(result, table, is_short=is_short),) if isinstance(table, Table) else ()
        words = (Paragraph((verdict,)), *lines, *(steps if is_short or not pictures else ()))
        if not pictures:
            yield Section(anchor, chain.title, words)
            return
        parts = (Section(f"{anchor}/picture", "", pictures), Section(f"{anchor}/words", "", words))
        yield Section(anchor, chain.title, () if stands_beside else steps, parts)
        if stands_apart:
            yield Section(f"{anchor}/steps", f"{chain.title}: its steps", steps)

    def _list_steps(self, result: ChainResult, table: Table, *, is_short: bool) -> Table:
        """Return the table of what a chain waits for, with whose each step is in place of where it is written."""
        owners = [(inline_text.to_inlines(self.printer.name_owners(term.activity)),) for term in result.terms]
        rows = tuple((row[0], *whose, *row[1:-1]) for row, whose in zip(table.rows, owners, strict=True))
        columns = make_columns(
            ("Step", 2.1),
            ("Whose", 1.1),
            ("Waits", 0.6, "right"),
            ("Responds", 0.8, "right"),
            ("Link", 0.5, "right"),
            ("Why", 4.4),
        )
        whole = dataclasses.replace(table, columns=columns, rows=rows)
        return keep_columns(whole, range(2)) if is_short else whole

    def show_hosts(self) -> Iterator[Section]:
        """Yield the picture of the hosts, and of what crosses their links."""
        if pictures := make_figures(self.edition.drawings, "hosts"):
            yield Section("slide:hosts", "Hosts and links", tuple(pictures))

    def show_partners(self) -> Iterator[Section]:
        """Yield who gives whom how much, then a slide for each partner."""
        writer = make_spread_writer(self.lookup, self.edition.changes)
        if writer is None:
            return
        yield Section("slide:partners", "What partners give each other", tuple(writer.write_overview())[-1:])
        for partner in writer.partners:
            sides = (
                self._list_exchanges(writer.given.get(partner.id, ()), partner, "Gives", 1),
                self._list_exchanges(writer.taken.get(partner.id, ()), partner, "Takes", 0),
                _shorten_tables(writer.list_deadline_blocks(partner)),
            )
            left = [block for part in sides for block in part]
            right = [*writer.list_impact_blocks(partner), *_shorten_tables(writer.list_open_blocks(partner))]
            if self.edition.changes:
                right += [_head(f"Since {self.edition.changes.since}"), *writer.list_change_blocks(partner)]
            parts = (
                Section(f"slide:partners/{partner.id}/flows", "", tuple(left)),
                Section(f"slide:partners/{partner.id}/open", "", tuple(right)),
            )
            yield Section(
                f"slide:partners/{partner.id}", partner.title, (), tuple(each for each in parts if each.blocks)
            )

    def _list_exchanges(
        self, interfaces: Sequence[InterfaceTerms], partner: Partner, verb: str, other: int
    ) -> Iterator[Block]:
        """Yield a row for each other partner: what flows, and how many terms are open."""
        by_partner: dict[str, list[InterfaceTerms]] = {}
        for terms in interfaces:
            by_partner.setdefault(terms.interface.pair[other], []).append(terms)
        rows = []
        for name, each in by_partner.items():
            count = sum(len(terms.open_points) for terms in each)
            types = list(dict.fromkeys(terms.interface.type or terms.title for terms in each))
            state = Text(count_noun(count, "term"), status="open") if count else Text("none", status="met")
            what = inline_text.to_inlines(join_first(types, _MAX_TYPES))
            rows.append((inline_text.partner_link(self.architecture, name), what, (state,)))
        columns = make_columns((f"{verb} {'to' if other else 'from'}", 1), ("What", 2.2), ("Open", 0.7, "right"))
        if rows:
            yield Table(f"table:{verb}/{partner.id}", f"{partner.title}: {verb.lower()}", columns, tuple(rows))

    def tell_changes(self) -> Iterator[Section]:
        """Yield what changed since the version that is compared: the headline, then each kind of change."""
        for section in tell_changes(self.architecture, self.edition.changes):
            parts = [block for part in section.sections for block in (_head(part.title), *part.blocks)]
            yield dataclasses.replace(section, anchor="slide:changes", blocks=(*section.blocks, *parts), sections=())

    def list_open_points(self) -> Iterator[Section]:
        """Yield the open points by who must act: the gravest of each partner, and how many more he has."""
        for section in self.printer.make_open_points():
            blocks = [_cut_points(each) if isinstance(each, Table) else each for each in section.blocks]
            yield dataclasses.replace(section, anchor="slide:open_points", blocks=tuple(blocks))


def _head(words: str) -> Paragraph:
    return Paragraph(inline_text.to_inlines(Text(words, strong=True)))


def _shorten_tables(blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield blocks, tables below their captions: what stands above them on paper does not on a slide."""
    for block in blocks:
        if isinstance(block, Table):
            yield _head(block.caption)
        yield block


def _cut_points(table: Table) -> Table:
    """Return the table of open points with the first rows of each partner alone; its first column says who."""
    kept: list[tuple[Inlines, ...]] = []
    places = range(len(table.rows))
    starts = [at for at in places if table.rows[at][0]] or [0]
    for start, end in zip(starts, [*starts[1:], len(table.rows)], strict=True):
        kept += table.rows[start : min(start + _MAX_POINTS, end)]
        if end - start > _MAX_POINTS:
            more = Text(f"{end - start - _MAX_POINTS} more in the report", muted=True)
            kept.append(((), (more,), *(() for _ in table.columns[2:])))
    return dataclasses.replace(table, rows=tuple(kept))
