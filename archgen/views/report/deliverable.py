"""The report to hand in: what a reviewer reads in a quarter of an hour, of whatever size the architecture is.

Each chapter that the project chose stands here in its short form. Components have their data sheets, lists the workbook.
"""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from archgen.diagnostics import Diagnostic, join_first, join_words
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_advice import advise_on_chain, find_deciding_term, sum_known_parts
from archgen.timing.figures.timing_values import TimingValue
from archgen.views import element_references, inline_text
from archgen.views.agreement import exchange_tables
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.elements.functional_level import first_sentence
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.pages import dashboard, report_outline
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.pages.short_spreads import MANY_PARTNERS
from archgen.views.pages.timing_chapter import make_figures
from archgen.views.report import front_pages
from archgen.views.report.changes_page import print_plainly, tell_changes
from archgen.views.report.data_sheets import number_sheets
from archgen.views.report.printed_figures import print_section_figures
from archgen.views.report.report_drawings import make_report_drawings
from archgen.views.report.requirement_proofs import make_requirements
from archgen.views.sequences import sequence_charts
from archgen.views.sequences.sequence_blocks import make_short_steps
from archgen.views.shapes import (
    Block,
    Bullets,
    Inlines,
    Markdown,
    Meter,
    Outline,
    Paragraph,
    Section,
    Table,
    Text,
    Waterfall,
    drop_empty_columns,
    head_part,
    make_columns,
)
from archgen.views.tables import deployment_tables, finding_tables
from archgen.views.timing import chain_charts, chain_status, element_timing, timing_tables
from archgen.views.timing.chain_waterfall import make_waterfall

_OVERVIEW_HEIGHT = 111.0
"""Of the picture in the summary, in mm: all of that stands on one page."""
_MAX_CHAINS = 16
_MAX_LISTED_CHAINS = 44
"""They fill a page."""
_MAX_ROWS_ABOVE = 8
"""With more chains in the table of all the first one that is told begins a page."""
_MAX_SUMMARY_CHAINS = 3
_MAX_DECISIONS = 2
_MAX_NAMES = 6
"""So many partners who wait for a term are named; the others are counted."""
_MAX_POINTS = 4
"""So many findings of one rule, to one partner, have rows of their own."""
_MAX_NAMED_SHEETS = 250
"""Of more components the list of data sheets has no names."""


def make_deliverable(lookup: Lookup, edition: DocumentEdition) -> Outline:
    """Make the outline of the deliverable, its chapters in the project's order."""
    drawings = make_report_drawings(lookup, edition.drawings, shows_ros=False)
    printer = DeliverablePrinter(lookup, dataclasses.replace(edition, drawings=drawings))
    names = edition.chapter_names
    # The summary is read first, wherever the project has its overview.
    ordered = sorted(names, key=lambda name: name != "overview") if lookup.scope.components is None else names
    sections = [
        *tell_changes(lookup.architecture, edition.changes),
        *(part for name in ordered for part in printer.print_chapter(name)),
    ]
    sections += printer.list_elsewhere()
    return Outline(
        title=lookup.architecture.project.title,
        subtitle="Software architecture",
        facts=(*front_pages.make_title_facts(lookup, edition), *printer.name_companions()),
        notices=report_outline.make_notices(lookup, edition),
        sections=tuple(map(print_section_figures, sections)),
        title_table=front_pages.make_partner_table(lookup, has_chapter="between_partners" in names),
        front_sections=tuple(map(print_section_figures, front_pages.make_front_sections(lookup, edition, None))),
        properties=front_pages.list_properties(lookup, edition),
        lists=(),
        has_large_paper=False,
    )


class DeliverablePrinter:
    """Makes the chapters in their short form; the report gives it an edition with drawings of its own."""

    def __init__(self, lookup: Lookup, edition: DocumentEdition) -> None:
        """Keep what chapters are made from."""
        self.lookup, self.edition, self.architecture = lookup, edition, lookup.architecture

    def print_chapter(self, name: str) -> Iterator[Section]:
        """Yield the sections of a chapter in their short form; none of what stands in data sheets and workbook."""
        if name in _ELSEWHERE:
            return
        if make_section := _SHORT_CHAPTERS.get(name):
            yield from make_section(self)
            return
        for section in report_outline.make_chapter(self.lookup, self.edition, name):
            yield dataclasses.replace(print_plainly(section), appendix=False)

    def make_summary(self) -> Iterator[Section]:
        """Yield the summary: counts, the picture of the groups, whether it reacts in time, what is decided next."""
        lookup, edition = self.lookup, self.edition
        if lookup.scope.components is not None:
            yield from report_outline.make_chapter(lookup, edition, "overview")
            return
        project, glance = self.architecture.project, dashboard.make_dashboard(lookup, edition)
        words: list[Block] = [Markdown(edition.settings.summary)] if edition.settings.summary else []
        if not words and project.description:
            words = [Paragraph(inline_text.read_marks(first_sentence(project.description) or ""))]
        cells = tuple(front_pages.stack_figure(figure) for figure in glance.figures)
        figures = Table("table:figures", "", make_columns(*("" for _ in cells)), (cells,), numbered=False)
        pictures = [
            dataclasses.replace(each, max_height=_OVERVIEW_HEIGHT, numbered=False)
            for each in make_figures(edition.drawings, "overview")
        ]
        parts = (
            *head_part(self._head_chains(), self.list_worst_chains("table:worst_chains", _MAX_SUMMARY_CHAINS)),
            *head_part("What is decided next", self._list_next_points()),
        )
        blocks = (*words, *([figures] if cells else []), *pictures, *parts)
        yield Section("page:index", "Summary", blocks, page_break=True)

    def list_results(self) -> list[ChainResult]:
        """Return the chains of the project, worst first."""
        results = self.lookup.timing.chains if self.lookup.timing else ()
        return [each for each in results if each.id in self.architecture.chains]

    def list_worst_chains(self, anchor: str, count: int) -> Iterator[Block]:
        """Yield the table of the first chains, each with its verdict and its largest part."""
        rows = tuple(
            (
                inline_text.to_inlines(Text(self.architecture.chains[result.id].title, ref=f"chain:{result.id}")),
                timing_tables.duration_cell(result.bound),
                timing_tables.deadline_cell(result),
                chain_status.chain_meter(result),
                chain_status.verdict_chip(result),
                self._name_largest_part(result),
            )
            for result in self.list_results()[:count]
        )
        columns = make_columns(
            ("Chain", 2.0),
            ("At the latest", 0.8, "right"),
            ("Deadline", 0.7, "right"),
            ("Used", 0.8),
            ("Verdict", 0.7),
            ("Largest part, whose", 1.8),
        )
        if rows:
            yield drop_empty_columns(Table(anchor, "Chains, worst first", columns, rows, numbered=False, dense=True))

    def _head_chains(self) -> str:
        rest = Counter(result.verdict for result in self.list_results()[_MAX_SUMMARY_CHAINS:])
        counts = ", ".join(f"{count} more {verdict}" for verdict, count in rest.items())
        return "Does it react in time?" + (f" The worst first; {counts}" if counts else "")

    def _name_largest_part(self, result: ChainResult) -> Inlines:
        if not result.terms or self.lookup.timing is None:
            return ()
        term = find_deciding_term(result)
        names, title = self.name_owners(term.activity), self._title_activity(term.activity)
        return inline_text.to_inlines(f"{title}, {names}" if names else title)

    def _title_activity(self, activity_id: str) -> str:
        """Return the title of the one component that an activity works for, else the node's."""
        activities = self.lookup.timing.analysis.system.activities if self.lookup.timing else {}
        activity = activities.get(activity_id)
        node = self.architecture.nodes.get(activity.node) if activity else None
        if node is None or activity is None:
            return activity_id
        components = [each for each in node.implements if activity.component in {None, each, each.rpartition(".")[2]}]
        return self.architecture.components[components[0]].title if len(components) == 1 else node.title

    def _list_next_points(self) -> Iterator[Block]:
        points = [self._phrase_point(finding) for finding in self._rank_findings()[:_MAX_DECISIONS]]
        if points := [*points, *dashboard.make_chain_points(self.lookup)][:_MAX_DECISIONS]:
            yield Bullets(tuple(points))

    def _rank_findings(self) -> list[Diagnostic]:
        return sorted(self.lookup.findings, key=lambda each: -each.effective_severity.rank)

    def _phrase_point(self, finding: Diagnostic) -> Inlines:
        who = element_references.answering_cell(self.lookup, finding.element, finding.span)
        words = element_references.link_message(self.architecture, finding)
        # Where nobody can be named it is a question.
        joint = Text(": " if any(run.ref for run in who) else " ")
        return (*(dataclasses.replace(run, strong=True) for run in who), *((joint,) if who else ()), *words)

    def make_use_cases(self) -> Iterator[Section]:
        """Yield the chapter of use cases, each on about half a page."""
        if self.lookup.scope.components is not None or not self.lookup.steps.by_use_case:
            return
        sections = tuple(
            Section(
                f"use_case:{use_case_id}", self._title_use_case(use_case_id), tuple(self._tell_use_case(use_case_id))
            )
            for use_case_id in self.lookup.steps.by_use_case
        )
        yield Section("page:use_cases", "Use cases", (), sections, page_break=True)

    def _title_use_case(self, use_case_id: str) -> str:
        use_case = self.architecture.use_cases[use_case_id]
        return f"{use_case.id} {use_case.title}" if use_case.title != use_case.id else use_case.id

    def _tell_use_case(self, use_case_id: str) -> Iterator[Block]:
        use_case = self.architecture.use_cases[use_case_id]
        text = " ".join((use_case.description or "").split())
        total = sequence_charts.explain_total(self.lookup, use_case_id)
        runs = [Text(f"{text} ")] if text else []
        runs += [Text(f"{total[:1].upper()}{total[1:]}.", strong=True)] if total else []
        if runs:
            yield Paragraph(tuple(runs))
        yield make_short_steps(self.lookup, use_case)
        requirements = [each.id for each in self.architecture.requirements.values() if use_case_id in each.use_cases]
        note = f"Requirements: {', '.join(requirements)}." if requirements else ""
        if note:
            yield Paragraph(inline_text.to_inlines(Text(note, muted=True)))

    def make_chains(self) -> Iterator[Section]:
        """Yield the chapter of chains, two to a page, the worst first."""
        results = self.list_results()
        if not results or self.lookup.timing is None or self.lookup.scope.components is not None:
            return
        sections = tuple(
            Section(
                f"chain:{result.id}",
                self.architecture.chains[result.id].title,
                tuple(self._tell_chain(result)),
                page_break=index % 2 == 0 and (index > 0 or len(results) > _MAX_ROWS_ABOVE),
            )
            for index, result in enumerate(results[:_MAX_CHAINS])
        )
        lead = "From what the robot senses to what it does, the worst first. The first bar ends with the deadline. Pale: waits until it is read; dark: works; grey: on a link; hatched: nobody knows."
        if len(results) > _MAX_CHAINS:
            listed = f", the first {_MAX_LISTED_CHAINS} listed" if len(results) > _MAX_LISTED_CHAINS else ""
            lead += f" Of {len(results)} chains the first {_MAX_CHAINS} are told{listed}; the workbook has all."
        blocks = (Paragraph(inline_text.to_inlines(lead)), *self.list_worst_chains("table:chains", _MAX_LISTED_CHAINS))
        yield Section("page:chains", "Chains of effect", blocks, sections, page_break=True)

    def _tell_chain(self, result: ChainResult) -> Iterator[Block]:
        timing = self.lookup.timing
        if timing is None:
            return
        verdict = chain_charts.describe_chain_verdict(result, timing)
        head, mark, rest = verdict.partition(": " if verdict.startswith(("Met: ", "Open: ")) else ". ")
        status = chain_status.find_status(result)
        yield Paragraph(
            (Text(f"{head}{mark.strip()}", status=status), Text(" "), *inline_text.message_to_inlines(rest))
        )
        if waterfall := make_waterfall(self.lookup, timing, result):
            yield self._draw_steps(result, waterfall)
            if waterfall.remark:
                yield Paragraph(inline_text.to_inlines(Text(waterfall.remark, muted=True)))
        facts = tuple((title, words) for title, words in self.list_chain_facts(result) if words)
        runs = [run for title, words in facts for run in (Text(f"{title}: ", strong=True), *words, Text(" "))]
        if runs:
            yield Paragraph(tuple(runs))

    def _draw_steps(self, result: ChainResult, waterfall: Waterfall) -> Table:
        """Make the table of a chain's steps, with whose they are, what they take, and when in the time of all."""
        whole = (*timing_tables.duration_cell(result.bound),)
        if result.deadline:
            whole = (*whole, Text(" of "), *timing_tables.deadline_cell(result))
        meter = Meter(1, result.verdict)
        first = ((Text("All of it", strong=True),), (), whole, (Text("", meter=meter, pieces=waterfall.total),))
        rows: list[tuple[Inlines, ...]] = [first] if waterfall.total else []
        for term, step in zip(result.terms, waterfall.steps, strict=True):
            unknown = any(value.value is None for value in (term.sampling, term.response, term.link))
            time = TimingValue(sum_known_parts(term), not unknown)
            rows.append(
                (
                    inline_text.to_inlines(self._title_activity(term.activity)),
                    inline_text.to_inlines(self.name_owners(term.activity)),
                    timing_tables.duration_cell(time) if time.value or not term.counted_at else (),
                    (Text("", pieces=step.pieces),)
                    if time.value or not term.counted_at
                    else (Text(f"counted with {self._title_activity(term.counted_at)}", muted=True),),
                )
            )
        columns = make_columns(("Step", 1.6), ("Whose", 0.9), ("Takes", 0.9, "right"), ("When", 3))
        title = self.architecture.chains[result.id].title
        return drop_empty_columns(
            Table(f"table:chain/{result.id}", title, columns, tuple(rows), numbered=False, dense=True)
        )

    def name_owners(self, activity_id: str) -> str:
        """Return the partners who own what an activity does, as people call them."""
        owners = element_references.list_activity_owners(self.lookup, activity_id)
        partners = self.architecture.partners
        return ", ".join(partners[each].title if each in partners else each for each in owners)

    def list_chain_facts(self, result: ChainResult, max_assumptions: int = 3) -> Iterator[tuple[str, Inlines]]:
        """Yield what a chain's time comes from, and what to do, each below its heading."""
        timing, chain = self.lookup.timing, self.architecture.chains[result.id]
        if timing is None:
            return
        requirements = inline_text.join_inlines((Text(name, ref=f"requirement:{name}"),) for name in chain.requirements)
        yield "Rests on it", (*requirements, Text(".")) if requirements else ()
        advice = advise_on_chain(timing.analysis, result)
        yield "Why", element_timing.link_names(self.lookup, timing, advice.largest_parts) if advice else ()
        yield "What to do", inline_text.message_to_inlines(advice.first_step) if advice else ()
        assumptions = list(dict.fromkeys(element_timing.describe_assumptions(timing, result)))
        yield (
            "Taken for granted",
            inline_text.to_inlines(f"{join_first(assumptions, max_assumptions)}.") if assumptions else (),
        )

    def make_deployment(self) -> Iterator[Section]:
        """Yield the chapter of hosts and links, without the picture of all nodes."""
        if self.edition.level == "functional":
            return
        hosts = deployment_tables.make_host_table(self.lookup)
        links = deployment_tables.make_link_table(self.lookup)
        tables = [dataclasses.replace(each, numbered=False, dense=True) for each in (hosts, links) if each]
        blocks: tuple[Block, ...] = (*make_figures(self.edition.drawings, "hosts"), *tables)
        if blocks:
            yield Section("page:hosts", "Hosts and links", blocks, page_break=True)

    def make_variants(self) -> Iterator[Section]:
        """Yield the chapter of variants, without what differs in each: the table counts it."""
        for section in report_outline.make_chapter(self.lookup, self.edition, "variants"):
            yield dataclasses.replace(section, sections=(), page_break=False)

    def make_open_points(self) -> Iterator[Section]:
        """Yield the chapter of open points, by who must act: findings, chains, terms that a partner owes others."""
        found: dict[tuple[str, ...], list[tuple[Diagnostic, Inlines]]] = {}
        heads: dict[tuple[str, ...], Inlines] = {}
        for finding in self._rank_findings():
            who = element_references.answering_cell(self.lookup, finding.element, finding.span)
            key = tuple(run.ref or "" for run in who if run.ref) or ("",)
            heads.setdefault(key, who if key != ("",) else (Text("Nobody yet"),))
            question = (Text(f" {who[0].text}", muted=True),) if who and key == ("",) else ()
            found.setdefault(key, []).append((finding, question))
        owed = self._list_owed_terms()
        rows: list[tuple[Inlines, ...]] = []
        for key in sorted(dict.fromkeys((*found, *owed)), key=lambda each: (each != ("",), *self._rank_partner(each))):
            who = heads.get(key) or inline_text.join_inlines(map(self._link_partner, key))
            for index, cells in enumerate((*self._fold_findings(found.get(key, [])), *owed.get(key, ()))):
                rows.append((tuple(dataclasses.replace(run, strong=True) for run in who) if not index else (), *cells))
        lead = f"The check finds {finding_tables.describe_severities(self.lookup.findings)}."
        points = dashboard.make_chain_points(self.lookup)
        blocks: list[Block] = [Paragraph(inline_text.to_inlines(lead)), *([Bullets(tuple(points))] if points else [])]
        if rows:
            columns = make_columns(("Who", 0.9), ("What", 3), ("Rests on it, or how grave", 1.3), ("Where", 1.3))
            table = Table("table:open_points", "Open points", columns, tuple(rows), numbered=False, dense=True)
            blocks.append(drop_empty_columns(table))
        if rows or points:
            yield Section("page:findings", "Open points, by who must act", tuple(blocks), page_break=True)

    def _rank_partner(self, key: tuple[str, ...]) -> tuple[str, ...]:
        order = {f"partner:{name}": f"{at:04}" for at, name in enumerate(self.architecture.partners)}
        return tuple(order.get(name, name) for name in key)

    def _link_partner(self, reference: str) -> Inlines:
        return inline_text.partner_link(self.architecture, reference.removeprefix("partner:"))

    def _fold_findings(self, found: Sequence[tuple[Diagnostic, Inlines]]) -> Iterator[tuple[Inlines, ...]]:
        """Yield a row for each finding; of many of one rule the first ones, and how many more there are."""
        by_rule: dict[str, list[tuple[Diagnostic, Inlines]]] = {}
        for finding, question in found:
            by_rule.setdefault(finding.rule, []).append((finding, question))
        for rule, findings in by_rule.items():
            for finding, question in findings[:_MAX_POINTS]:
                yield (
                    (*element_references.link_message(self.architecture, finding), *question),
                    self._tell_weight(finding),
                    element_references.place_cell(self.lookup, finding),
                )
            if len(findings) > _MAX_POINTS:
                more = f"{len(findings) - _MAX_POINTS} more of the rule {rule}"
                yield inline_text.to_inlines(Text(more, muted=True)), (), ()

    def _tell_weight(self, finding: Diagnostic) -> Inlines:
        """Say what rests on the element of a finding: deadlines and requirements, else only how grave it is."""
        element = finding.element or ""
        component = element if element in self.architecture.components else element.rpartition(".")[0]
        nodes = {element, *(node.id for node in self.lookup.nodes_of.get(component, ()))}
        activities = self.lookup.timing.analysis.system.activities if self.lookup.timing else {}
        chains = [
            result
            for result in self.list_results()
            if result.deadline
            and (
                element == result.id
                or any(activities[term.activity].node in nodes for term in result.terms if term.activity in activities)
            )
        ]
        words = [count_noun(len(chains), "deadline")] if chains else []
        served = (
            [use.text for use in self.architecture.components[component].requirements if use.is_id]
            if component in self.architecture.components
            else []
        )
        words += [join_first(served, 3)] if served else []
        return inline_text.to_inlines(", ".join(words)) if words else finding_tables.severity_chip(finding)

    def _list_owed_terms(self) -> Mapping[tuple[str, ...], list[tuple[Inlines, ...]]]:
        """Return what each partner owes others at their interfaces: a row for each term."""
        given: dict[str, list[InterfaceTerms]] = {}
        for exchange in exchange_tables.gather_exchanges(self.lookup):
            for terms in exchange.interfaces:
                given.setdefault(terms.interface.pair[0], []).append(terms)
        owed: dict[tuple[str, ...], list[tuple[Inlines, ...]]] = {}
        limit = _MAX_NAMES // (2 if len(self.architecture.partners) > MANY_PARTNERS else 1)
        for giver, interfaces in given.items():
            for name, open_interfaces in exchange_tables.group_open_terms(interfaces).items():
                types = list(dict.fromkeys(each.interface.type or each.title for each in open_interfaces))
                takers = dict.fromkeys(each.interface.pair[1] for each in open_interfaces)
                what = f"{exchange_tables.shorten_name(name)} of {count_noun(len(open_interfaces), 'interface')}: {join_first(types, 3)}"
                waiting = inline_text.join_first(list(map(self._link_partner, takers)), limit)
                row = (inline_text.to_inlines(what), (*waiting, Text(" wait" if len(takers) > 1 else " waits")), ())
                owed.setdefault((f"partner:{giver}",), []).append(row)
        return owed

    def name_companions(self) -> Iterator[tuple[str, Inlines]]:
        """Yield the lines of the title page on what changed, and on the documents beside this one."""
        if changes := self.edition.changes:
            yield f"Since {changes.since}", inline_text.message_to_inlines(changes.document.headline)
        sheets = count_noun(len(self.architecture.components), "page")
        yield (
            "With it",
            inline_text.to_inlines(f"data sheets ({sheets}, sorted by partner) and the workbook of all lists"),
        )

    def list_elsewhere(self) -> Iterator[Section]:
        """Yield the last chapter: which data sheets there are, and what the workbook has."""
        numbers = number_sheets(self.lookup)
        rows = []
        for partner_title, sheets in numbers.items():
            first, last = sheets[0][0], sheets[-1][0]
            span = first if first == last else f"{first} to {last}"
            names = inline_text.join_inlines((inline_text.component_link(component),) for _, component in sheets)
            words = (
                names
                if sum(map(len, numbers.values())) <= _MAX_NAMED_SHEETS
                else (Text(count_noun(len(sheets), "component")),)
            )
            rows.append((inline_text.to_inlines(Text(partner_title, strong=True)), inline_text.to_inlines(span), words))
        columns = make_columns(("Partner", 1), ("Sheets", 0.7), ("Components", 4))
        blocks: list[Block] = []
        if rows:
            lead = (
                "Each component has a data sheet of a page, sorted by partner: `archgen report --document data-sheets`."
            )
            anchors = ()
            blocks = [
                Paragraph(inline_text.message_to_inlines(lead)),
                Table("table:sheets", "Data sheets", columns, tuple(rows), anchors, numbered=False, dense=True),
            ]
        counts = [
            count_noun(count, noun)
            for count, noun in (
                (len(self.architecture.connections), "connection"),
                (len(self.architecture.topics), "topic"),
                (len(self.architecture.types), "type"),
                (len(self.lookup.findings), "finding"),
            )
            if count
        ]
        if counts:
            sentence = f"The workbook has all lists: {join_words(counts)}, rates, loads and parameters: `archgen report --document workbook`."
            blocks.append(Paragraph(inline_text.message_to_inlines(sentence)))
        if blocks:
            yield Section("page:sheets", "Data sheets and lists", tuple(blocks), page_break=True)


_ELSEWHERE = frozenset({"groups", "types", "connections", "properties", "statistics", "timing", "start_up", "views"})
"""Chapters that stand in the data sheets, in the workbook or on the site."""
_SHORT_CHAPTERS: Mapping[str, Callable[[DeliverablePrinter], Iterable[Section]]] = {
    "overview": DeliverablePrinter.make_summary,
    "use_cases": DeliverablePrinter.make_use_cases,
    "chains": DeliverablePrinter.make_chains,
    "variants": DeliverablePrinter.make_variants,
    "deployment": DeliverablePrinter.make_deployment,
    "requirements": lambda printer: make_requirements(printer.lookup),
    "open_points": DeliverablePrinter.make_open_points,
}
