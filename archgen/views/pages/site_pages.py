"""The site's pages: one for each element, and those that span the architecture."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics import join_words, order_naturally
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.views import inline_text
from archgen.views.agreement.exchange_tables import list_unsettled
from archgen.views.elements.functional_level import make_component_table
from archgen.views.elements.implementation_level import make_node_blocks
from archgen.views.lookup import Lookup
from archgen.views.pages import (
    context_pages,
    dashboard,
    explorer_page,
    host_pages,
    matrix_pages,
    page_marks,
    page_parts,
    partner_pages,
    reliance_pages,
    requirement_pages,
    timing_chapter,
    variant_chapter,
)
from archgen.views.pages.as_built_page import make_as_built_blocks
from archgen.views.pages.component_pages import ComponentPages
from archgen.views.pages.context_pages import HOME_CRUMB
from archgen.views.pages.message_pages import MessagePages
from archgen.views.pages.page_parts import split_pages
from archgen.views.pages.report_outline import DocumentEdition, make_document_facts, split_title
from archgen.views.pages.timing_chapter import make_figures
from archgen.views.shapes import Block, Bullets, Facts, Figure, Markdown, Page, Paragraph, Section, Text
from archgen.views.tables import (
    deployment_tables,
    finding_tables,
    functional_tables,
    property_tables,
    requirement_tables,
    start_table,
    statistics_tables,
)
from archgen.views.timing.chain_waterfall import WATERFALL_FACTS, make_waterfall
from archgen.views.timing.flow_tables import make_flow_sections
from archgen.views.timing.host_waterfall import make_slack_waterfall


def make_pages(lookup: Lookup, edition: DocumentEdition) -> tuple[Page, ...]:
    """Make every page of the site."""
    page_maker = PageMaker(lookup, edition)
    functional_pages = [
        page_maker.start_page(),
        *page_maker.component_pages().make_pages(),
        *page_maker.chapter_pages(),
        *page_maker.spanning_pages(),
        *page_maker.component_pages().list_type_pages(),
        *page_maker.rule_pages(),
        *matrix_pages.make_matrix_pages(lookup, with_nodes=edition.level == "implementation"),
    ]
    surrounding_pages = [
        *page_maker.message_pages().make_pages(),
        *requirement_pages.make_requirement_pages(lookup),
        *context_pages.make_context_pages(lookup, page_maker.keep_drawn),
        *host_pages.make_host_pages(lookup, page_maker.keep_drawn),
        *partner_pages.make_partner_pages(
            lookup, page_maker.keep_drawn, edition.signed_tags, edition.changes.comparison if edition.changes else None
        ),
    ]
    implementation_pages = (
        [*page_maker.node_pages(), *context_pages.make_topic_pages(lookup)] if edition.level == "implementation" else []
    )
    # Of pages whose paths collide the first one keeps its path, so this order is part of the site's addresses.
    whole_pages = functional_pages + implementation_pages + surrounding_pages
    all_pages = _make_paths_distinct(split_pages(whole_pages))
    marked_pages = page_marks.mark_pages(lookup, all_pages)
    if edition.changes:
        from archgen.views.changes.site_changes import add_changes

        marked_pages = add_changes(marked_pages, edition.changes, edition.drawings)
    return page_parts.place_pages(lookup, marked_pages)


def _make_paths_distinct(pages: Iterable[Page]) -> tuple[Page, ...]:
    """Add numbers to paths that several pages share: the names of two elements may give one file name."""
    # Folded: some systems take `A.html` and `a.html` for one file.
    page_list = tuple(pages)
    own_paths = {page.path.casefold() for page in page_list}
    taken_paths: set[str] = set()
    result = []
    for page in page_list:
        path, number = page.path, 1
        while path.casefold() in taken_paths:
            number += 1
            numbered_path = f"{page.path.removesuffix('.html')}-{number}.html"
            # A page whose own name ends in this number keeps its address.
            path = path if numbered_path.casefold() in own_paths else numbered_path
        taken_paths.add(path.casefold())
        result.append(page if path == page.path else replace(page, path=path))
    return tuple(result)


MAX_HOME_GROUPS = 24
"""More groups are listed on a page of their own, so that the start page stays one to be looked at."""


@dataclass(frozen=True, slots=True)
class PageMaker:
    """Makes the pages; each method returns one page or yields several. Paths of pages may still collide."""

    lookup: Lookup
    edition: DocumentEdition

    @property
    def architecture(self) -> Architecture:
        """Return the architecture."""
        return self.lookup.architecture

    def keep_drawn(self, blocks: Iterable[Block]) -> tuple[Block, ...]:
        """Drop figures that are not among this site's drawings: of another level, or outside of the selection. Of those
        that are left out for their number a note says so.
        """
        return page_parts.keep_drawn(blocks, self.edition)

    def message_pages(self) -> MessagePages:
        """Return the maker of the pages on messages: those of shown types and, with the ROS side, of shown topics."""
        topics = context_pages.shown_topics(self.lookup) if self.edition.level == "implementation" else ()
        return MessagePages(self.lookup, functional_tables.shown_types(self.lookup), topics)

    def start_page(self) -> Page:
        """Make the start page: the state at a glance, the clickable overview, description, title facts, groups."""
        project = self.architecture.project
        blocks: list[Block] = list(make_figures(self.edition.drawings, "overview"))
        blocks += [Markdown(project.description)] if project.description else []
        facts = list(make_document_facts(self.lookup, self.edition))
        if changes := self.edition.changes:
            words = inline_text.message_to_inlines(f"{changes.document.headline}. ")
            facts.append(("What changed", (*words, Text(f"All changes since {changes.since}", ref="page:changes"))))
        elif self.edition.revision:
            command = Text("archgen site --since REVISION", code=True)
            facts.append(("What changed", (command, Text(" says it, here and on the page of each element"))))
        blocks.append(Facts(tuple(facts)))
        if len(self.architecture.groups) <= MAX_HOME_GROUPS:
            blocks += [table] if (table := functional_tables.make_group_table(self.lookup)) else []
        section = Section("page:index", project.title, tuple(blocks))
        return Page(
            "index.html",
            "page:index",
            project.title,
            "overview",
            section,
            lead=self._describe_size(),
            dashboard=dashboard.make_dashboard(self.lookup, self.edition),
        )

    def _describe_size(self) -> str:
        """Describe the size of the architecture on one line; counts of nothing are left out."""
        counted_elements = (
            ("component", self.architecture.components),
            ("composed component", self.architecture.shells),
            ("component type", self.architecture.component_types),
            ("group", self.architecture.groups),
            ("partner", self.architecture.partners),
            ("connection", self.architecture.connections),
            ("node", self.architecture.nodes),
        )
        counts = [inline_text.count_noun(len(elements), noun) for noun, elements in counted_elements if elements]
        return f"Software architecture{f': {join_words(counts)}' if counts else ''}"

    def component_pages(self) -> ComponentPages:
        """Return the maker of the pages of groups, components and component types."""
        shows_nodes = self.edition.level == "implementation"
        return ComponentPages(self.lookup, self.keep_drawn, self._finding_sections, shows_nodes)

    def _lead_with_owners(self, lead: str, owners: Iterable[str]) -> str:
        """Return a page's lead with the titles of the owners behind it."""
        return " · ".join([lead, *(self.architecture.partners[owner].title for owner in owners)])

    def _finding_sections(self, element_id: str, *served_ids: str) -> list[Section]:
        """Return a section with the findings about an element, and about what it serves, or nothing."""
        findings = [each for name in (element_id, *served_ids) for each in self.lookup.findings_of.get(name, ())]
        table = finding_tables.make_finding_table(self.lookup, findings, f"table:findings/{element_id}")
        return [Section(f"findings:{element_id}", "Open points", (table,))] if table else []

    def node_pages(self) -> Iterator[Page]:
        """Make a page for each shown node."""
        for node in sorted(self.lookup.shown_nodes(), key=lambda each: order_naturally(each.id)):
            yield self.make_node_page(node)

    def make_node_page(self, node: Node) -> Page:
        """Make the page of a node."""
        unsettled = list_unsettled(self.lookup, node.implements)
        sections = (
            *make_flow_sections(self.lookup, node, unsettled),
            *self._finding_sections(node.id, *node.implements),
        )
        section = Section(f"node:{node.id}", node.id, make_node_blocks(self.lookup, node), sections)
        kinds = ", ".join(inline_text.NODE_KIND_WORDS[kind] for kind in node.kinds)
        lead = self._lead_with_owners(
            f"{kinds[0].upper()}{kinds[1:]}{f' · {node.status}' if node.status else ''}", node.owners
        )
        crumbs = (HOME_CRUMB, ("Nodes", "page:nodes"))
        return Page(f"nodes/{node.id}.html", section.anchor, node.id, "nodes", section, crumbs, lead)

    def chapter_pages(self) -> Iterator[Page]:
        """Make a page for each chapter that the project wrote."""
        for name, chapter in self.edition.project_chapters.items():
            title, text = split_title(chapter)
            # `shift` 0: the chapter's own headings follow the page's title, which was its first heading.
            section = Section(f"chapter:{name}", title, (Markdown(text, chapter.folder, 0),))
            path = f"chapters/{context_pages.make_page_slug(name.rpartition('.')[0])}.html"
            yield Page(path, section.anchor, title, "chapters", section, (HOME_CRUMB,), "Chapter")

    def rule_pages(self) -> Iterator[Page]:
        """Make a page for each rule that found something: what it found, why that matters, how to mend it."""
        crumbs = (HOME_CRUMB, ("Open points", "page:findings"))
        for name, text in self.edition.rule_pages.items():
            findings = [finding for finding in self.lookup.findings if finding.rule == name]
            table = finding_tables.make_finding_table(self.lookup, findings, f"table:rule/{name}")
            section = Section(f"rule:{name}", name, (*((table,) if table else ()), Markdown(text)))
            yield Page(f"rules/{name}.html", section.anchor, name, "rules", section, crumbs, "Rule")

    def spanning_pages(self) -> Iterator[Page]:
        """Make the pages that span the architecture: tables, progress, timing, views, hosts."""
        components = list(self.lookup.nested_components())
        if components or self.lookup.shown_nodes():
            explorer_blocks = explorer_page.make_explorer_blocks(
                self.lookup, make_figures(self.edition.drawings, "overview")
            )
            yield self._spanning_page("explorer", "Explorer", *explorer_blocks)
        if len(self.architecture.groups) > MAX_HOME_GROUPS:
            yield self._spanning_page("groups", "Groups", functional_tables.make_group_table(self.lookup))
        component_table = make_component_table(
            self.lookup, "table:components", "All components", components, inside_of=""
        )
        yield self._spanning_page(
            "components",
            "Components",
            *make_figures(self.edition.drawings, "components"),
            component_table if components else None,
        )
        shown_connections = functional_tables.shown_connections(self.lookup)
        yield self._spanning_page(
            "connections", "Connections", functional_tables.make_connection_table(self.lookup, shown_connections)
        )
        yield self._spanning_page("types", "Types", functional_tables.make_type_table(self.lookup))
        yield self._spanning_page("messages", "Messages", self.message_pages().make_list())
        requirement_table = requirement_tables.make_requirement_table(
            self.lookup, requirement_tables.shown_requirements(self.lookup)
        )
        yield self._spanning_page(
            "requirements",
            "Requirements and use cases",
            requirement_table,
            requirement_tables.make_free_requirement_table(self.lookup),
        )
        summary = Paragraph(
            inline_text.to_inlines(
                f"archgen finds {finding_tables.describe_severities(self.lookup.findings)} in this architecture."
            )
        )
        chain_points = dashboard.make_chain_points(self.lookup)
        chain_lead = "Chains of effect that are not shown to meet their deadlines, and that no finding is about:"
        chain_blocks = (Paragraph(inline_text.to_inlines(chain_lead)), Bullets(tuple(chain_points)))
        yield self._spanning_page(
            "findings",
            "Open points",
            summary,
            finding_tables.make_owner_table(self.lookup, self.lookup.findings),
            finding_tables.make_finding_table(self.lookup, self.lookup.findings),
            *(chain_blocks if chain_points else ()),
        )
        growth_blocks = statistics_tables.make_growth_blocks(self.edition.history, self.edition.drawings)
        yield self._spanning_page("progress", "Progress", *self.edition.statistics, *growth_blocks)
        if as_built := tuple(make_as_built_blocks(self.lookup, self.edition.seen_robots, self.edition.unread_record)):
            yield self._spanning_page("as_built", "As built", *as_built)
        yield from self.timing_pages()
        view_drawings = [f"views/{name}" for name in self.architecture.views]
        yield self._spanning_page("views", "Views", *make_figures(self.edition.drawings, *view_drawings))
        yield from self.variant_pages()
        if milestones := reliance_pages.make_milestone_table(self.lookup):
            yield self._spanning_page("milestones", "Milestones", milestones)
        if frames := functional_tables.make_frame_table(self.lookup):
            yield self._spanning_page("frames", "Frames", *make_figures(self.edition.drawings, "frames"), frames)
        if sections := property_tables.make_property_sections(self.lookup):
            yield self._listing_page("properties", "Properties", sections)
        if glossary_table := property_tables.make_glossary_table(self.lookup):
            yield self._spanning_page("glossary", "Glossary", glossary_table)
        if self.edition.level == "implementation":
            yield self._spanning_page(
                "nodes",
                "Nodes",
                *make_figures(self.edition.drawings, "ros"),
                *context_pages.make_node_table(self.lookup, self.lookup.shown_nodes()),
            )
            yield self._spanning_page(
                "topics", "Topics, services and actions", *context_pages.make_topic_tables(self.lookup)
            )
            host_tables = (
                deployment_tables.make_host_table(self.lookup),
                deployment_tables.make_link_table(self.lookup),
            )
            yield self._spanning_page(
                "hosts",
                "Hosts and containers",
                *make_figures(self.edition.drawings, "hosts"),
                *host_tables,
            )
            if start_blocks := start_table.make_start_blocks(self.lookup):
                yield self._spanning_page(
                    "start_up",
                    "Start-up",
                    *make_figures(self.edition.drawings, "start_up"),
                    *start_blocks,
                )

    def variant_pages(self) -> Iterator[Page]:
        """Make a page of all variants, and one for each."""
        table = variant_chapter.make_variant_table(self.architecture, self.edition.variants)
        if table is None:
            return
        lead = Paragraph(inline_text.to_inlines(variant_chapter.LEAD))
        yield self._spanning_page("variants", "Variants", lead, table)
        crumbs = (HOME_CRUMB, ("Variants", "page:variants"))
        for section in variant_chapter.make_variant_sections(self.architecture, self.edition.variants):
            yield Page(
                f"variants/{section.subject}.html",
                section.anchor,
                section.title,
                "variants",
                section,
                crumbs,
                "Variant",
            )

    def timing_pages(self) -> Iterator[Page]:
        """Make the pages on timing: one for the whole, one for all chains, and one for each chain."""
        graphs = self.edition.drawings
        if self.lookup.timing is not None and self.edition.level == "implementation":
            blocks = timing_chapter.make_timing_blocks(self.lookup, self.lookup.timing, graphs)
            sections = (
                *page_parts.make_timing_note(self.edition),
                *timing_chapter.make_timing_sections(self.lookup, self.lookup.timing, graphs),
            )
            links = Bullets(tuple(inline_text.to_inlines(Text(s.title, ref=s.anchor)) for s in sections))
            # The links come before the picture of the whole, which is tall.
            figures = [block for block in blocks if isinstance(block, Figure)]
            lead_blocks = [block for block in blocks if not isinstance(block, Figure)]
            page = self._spanning_page("timing", "Timing", *lead_blocks, *([links] if sections else []), *figures)
            yield replace(page, waterfall=make_slack_waterfall(self.lookup, self.lookup.timing))
            # A page for each: together they were as long as 25 screens.
            crumbs = (HOME_CRUMB, ("Timing", "page:timing"))
            for section in sections:
                path = f"timing/{section.subject}.html"
                yield Page(path, section.anchor, section.title, "timing", section, crumbs, "Timing")
        yield self._spanning_page("chains", "Chains of effect", *timing_chapter.make_chain_overview(self.lookup))
        yield from self.chain_pages()

    def chain_pages(self) -> Iterator[Page]:
        """Make a page for each chain."""
        graphs = self.edition.drawings
        crumbs = (HOME_CRUMB, ("Chains of effect", "page:chains"))
        timing_lookup = self.lookup.timing
        for result in timing_lookup.chains if timing_lookup else ():
            if timing_lookup is None or result.id not in self.architecture.chains:
                continue
            waterfall = make_waterfall(self.lookup, timing_lookup, result)
            # The waterfall says the same at a glance; the chart has a page of the report, which has no waterfall.
            late_name = f"chains/{result.id}.late"
            late_pictures = {late_name: graphs[late_name]} if result.id in timing_lookup.late_runs else {}
            shown = (late_pictures, WATERFALL_FACTS) if waterfall else (graphs, ())
            section = timing_chapter.make_chain_section(self.lookup, timing_lookup, result, *shown)
            path, lead = f"chains/{result.id}.html", "Chain of effect"
            yield Page(path, section.anchor, section.title, "chains", section, crumbs, lead, waterfall=waterfall)

    def _listing_page(self, name: str, title: str, sections: tuple[Section, ...]) -> Page:
        """Make a page of sections, without anything before them."""
        section = Section(f"page:{name}", title, (), sections)
        return Page(f"{name}.html", section.anchor, title, "spanning", section, (HOME_CRUMB,))

    def _spanning_page(self, name: str, title: str, *blocks: Block | None, sections: tuple[Section, ...] = ()) -> Page:
        """Make a page for the whole architecture."""
        present_blocks = tuple(block for block in blocks if block is not None)
        # A page without content is made all the same: the crumbs of other pages lead to it.
        placeholder = Paragraph(inline_text.to_inlines(Text("There is nothing here yet.", muted=True)))
        section = Section(f"page:{name}", title, present_blocks or (placeholder,), sections)
        is_empty = not present_blocks and not sections
        return Page(f"{name}.html", section.anchor, title, "spanning", section, (HOME_CRUMB,), is_empty=is_empty)
