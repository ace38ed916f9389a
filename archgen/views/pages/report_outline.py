"""The report's outline: chapters of the project and generated ones, in the order that the project asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

from archgen.conformance.seen_record import SeenRobot
from archgen.frozen import dataclass, field, replace
from archgen.model.document_chapters import GENERATED_CHAPTERS, Chapter
from archgen.model.partner_interfaces import PartnerPair
from archgen.model.project_history import History
from archgen.model.report_settings import ReportSettings
from archgen.views import inline_text
from archgen.views.agreement.interface_record import SignedTag
from archgen.views.lookup import Lookup
from archgen.views.pages import timing_chapter, variant_chapter
from archgen.views.pages.component_pages import ReportSections
from archgen.views.pages.partner_spreads import make_partner_chapter
from archgen.views.pages.timing_chapter import make_figures
from archgen.views.pages.variant_chapter import VariantDifference
from archgen.views.picture_shapes import Drawing, GraphKind
from archgen.views.sequences.sequence_blocks import make_use_case_sections
from archgen.views.shapes import Block, Figure, Inlines, Markdown, Outline, Paragraph, Section, Table, Text
from archgen.views.tables import (
    deployment_tables,
    finding_tables,
    functional_tables,
    property_tables,
    requirement_tables,
    start_table,
    statistics_tables,
)

if TYPE_CHECKING:
    from archgen.views.changes.site_changes import SiteChanges

_MAX_PARTNER_LINES = 8
"""More partners stand one behind the other."""

DetailLevel = Literal["functional", "implementation"]
RosPlace = Literal["annex", "inline"]
ReportDocument = Literal["deliverable", "data-sheets", "workbook", "full"]


@dataclass(frozen=True, slots=True)
class DocumentEdition:
    """What a document contains beside the architecture."""

    revision: str = ""
    level: DetailLevel = "implementation"
    ros_place: RosPlace = "annex"
    """Where the report has the ROS side: in an annex, or with each component."""
    settings: ReportSettings = field(default_factory=ReportSettings)
    """What the project says of its report: first pages, lists, paper."""
    date: str = ""
    """The day of the revision, `2026-03-31`; empty where git does not tell."""
    chapter_names: tuple[str, ...] = GENERATED_CHAPTERS
    project_chapters: Mapping[str, Chapter] = field(default_factory=dict)
    drawings: Mapping[str, Drawing] = field(default_factory=dict)
    undrawn_kinds: frozenset[GraphKind] = frozenset()
    """The kinds of pictures that are left out since there are too many of them; the pages say so."""
    statistics: tuple[Table, ...] = ()
    history: History = field(default_factory=History)
    rule_pages: Mapping[str, str] = field(default_factory=dict)
    """The pages of the rules that found something, as CommonMark without their titles, by name."""
    has_errors: bool = False
    """The model has errors; documents show what is sound, and say so."""
    changes: SiteChanges | None = None
    """What changed since an earlier version, where the site is to show it."""
    variants: Mapping[str, VariantDifference] = field(default_factory=dict)
    """What is different in each variant of the project, by its id."""
    document: ReportDocument = "full"
    """Which of the report's documents it is."""
    signed_tags: Mapping[PartnerPair, tuple[SignedTag, ...]] = field(default_factory=dict)
    """The tags that record signatures of two partners, newest first."""
    seen_robots: tuple[SeenRobot, ...] = ()
    """What the project keeps of comparisons with robots."""
    unread_record: str = ""
    """Why that could not be read."""


def make_report(lookup: Lookup, edition: DocumentEdition) -> Outline:
    """Make the outline of the report; appendices move to the end, else the project's order is kept."""
    architecture = lookup.architecture
    sections = [section for name in edition.chapter_names for section in make_chapter(lookup, edition, name)]
    return Outline(
        title=architecture.project.title,
        subtitle="Software architecture",
        facts=tuple(make_document_facts(lookup, edition)),
        notices=make_notices(lookup, edition),
        sections=tuple(section for section in sections if not section.appendix)
        + tuple(section for section in sections if section.appendix),
    )


def make_chapter(lookup: Lookup, edition: DocumentEdition, name: str) -> Sequence[Section]:
    """Return the sections of a chapter: several for `groups`, none where there is nothing to say."""
    if make_sections := _GENERATED_SECTIONS.get(name):
        return make_sections(_ChapterMaker(lookup, edition))
    chapter = edition.project_chapters.get(name)
    if chapter is None:
        return ()
    title, text = split_title(chapter)
    return (Section(f"chapter:{chapter.path}", title, (Markdown(text, chapter.folder),), page_break=True),)


def make_document_facts(lookup: Lookup, edition: DocumentEdition) -> Iterator[tuple[str, Inlines]]:
    """Yield the lines of the title page: version, revision, ROS distribution, partners."""
    project = lookup.architecture.project
    if project.version:
        yield "Version", inline_text.to_inlines(project.version)
    if project.license:
        yield "License", inline_text.to_inlines(project.license)
    if edition.revision:
        yield "Revision", inline_text.to_inlines(edition.revision)
    if lookup.architecture.distro:
        yield "ROS distribution", inline_text.to_inlines(lookup.architecture.distro)
    if lookup.architecture.partners:
        partners = [inline_text.partner_link(lookup.architecture, name) for name in lookup.architecture.partners]
        join = inline_text.join_lines if len(partners) <= _MAX_PARTNER_LINES else inline_text.join_inlines
        yield "Partners", join(partners)


def make_notices(lookup: Lookup, edition: DocumentEdition) -> tuple[Paragraph, ...]:
    """Return what the reader must know first: that only a part or a level is shown, or that there are errors."""
    paragraphs: list[Paragraph] = []
    if lookup.scope.components is not None:
        scope_text = inline_text.to_inlines(
            "This document shows a part of the architecture: ", Text(lookup.scope.selector_text, code=True)
        )
        paragraphs.append(Paragraph(scope_text, "note"))
    if edition.level == "functional":
        paragraphs.append(Paragraph(inline_text.to_inlines("This document shows the functional level only."), "note"))
    if edition.has_errors:
        error_text = f"The architecture has errors ({finding_tables.describe_severities(lookup.findings)}). What is sound is shown all the same."
        paragraphs.append(Paragraph(inline_text.to_inlines(error_text), "error"))
    return tuple(paragraphs)


@dataclass(frozen=True, slots=True)
class _ChapterMaker:
    """Makes the sections of each chapter by the chapter's name."""

    lookup: Lookup
    edition: DocumentEdition

    def make_overview(self) -> list[Section]:
        """Make the overview: what the project says of itself, and its pictures."""
        project = self.lookup.architecture.project
        blocks: list[Block] = [Markdown(project.description)] if project.description else []
        blocks += make_figures(self.edition.drawings, "overview", "components")
        # Anchors are the same as the site's, so that references in shared blocks work in both.
        return [Section("page:index", "Overview", tuple(blocks), page_break=True)] if blocks else []

    def make_between_partners(self) -> list[Section]:
        """Make the chapter of what partners give each other; folded where the document is one to read."""
        chapter = make_partner_chapter(self.lookup, self.edition.changes, folds=self.edition.document != "workbook")
        return [chapter] if chapter else []

    def make_groups(self) -> list[Section]:
        """Make one section for each group, with its components and their nodes; then one for all component types."""
        shows_nodes = self.edition.level == "implementation"
        return ReportSections(self.lookup, self._keep_drawn, shows_nodes).make_sections()

    def _keep_drawn(self, blocks: Iterable[Block]) -> tuple[Block, ...]:
        """Drop figures that are not among this document's drawings."""
        return tuple(b for b in blocks if not isinstance(b, Figure) or b.graph in self.edition.drawings)

    def make_use_cases(self) -> list[Section]:
        """Make the chapter of use cases that have steps; a part of the architecture has none."""
        if self.lookup.scope.components is not None:
            return []
        sections = tuple(
            replace(section, blocks=self._keep_drawn(section.blocks)) for section in make_use_case_sections(self.lookup)
        )
        return [Section("page:use_cases", "Use cases", (), sections, page_break=True)] if sections else []

    def make_frames(self) -> list[Section]:
        """Make the chapter of coordinate frames."""
        blocks = [
            *make_figures(self.edition.drawings, "frames"),
            *_drop_missing(functional_tables.make_frame_table(self.lookup)),
        ]
        return [Section("page:frames", "Frames", tuple(blocks), page_break=True)] if blocks else []

    def make_variants(self) -> list[Section]:
        """Make the chapter of variants: a table of them, and what is different in each."""
        architecture = self.lookup.architecture
        table = variant_chapter.make_variant_table(architecture, self.edition.variants)
        if table is None:
            return []
        lead = Paragraph(inline_text.to_inlines(variant_chapter.LEAD))
        sections = tuple(variant_chapter.make_variant_sections(architecture, self.edition.variants))
        return [Section("page:variants", "Variants", (lead, table), sections, page_break=True)]

    def make_deployment(self) -> list[Section]:
        """Make the chapter of hosts and links."""
        if self.edition.level == "functional":
            return []
        blocks = [
            *make_figures(self.edition.drawings, "hosts", "ros"),
            *_drop_missing(
                deployment_tables.make_host_table(self.lookup), deployment_tables.make_link_table(self.lookup)
            ),
        ]
        return [Section("page:hosts", "Hosts and links", tuple(blocks), page_break=True)] if blocks else []

    def make_start_up(self) -> list[Section]:
        """Make the chapter of the start-up."""
        if self.edition.level == "functional":
            return []
        blocks = (
            *make_figures(self.edition.drawings, "start_up"),
            *start_table.make_start_blocks(self.lookup),
        )
        return [Section("page:start_up", "Start-up", blocks, page_break=True)] if blocks else []

    def make_timing(self) -> list[Section]:
        """Make the chapter of figures of timing."""
        timing_lookup = self.lookup.timing
        if timing_lookup is None or self.edition.level == "functional":
            return []
        blocks = timing_chapter.make_timing_blocks(self.lookup, timing_lookup, self.edition.drawings)
        sections = timing_chapter.make_timing_sections(self.lookup, timing_lookup, self.edition.drawings)
        return [Section("page:timing", "Timing", blocks, sections, page_break=True)] if sections else []

    def make_chains(self) -> list[Section]:
        """Make the chapter of chains of effect."""
        blocks = timing_chapter.make_chain_overview(self.lookup)
        if not blocks or self.lookup.scope.components is not None:
            return []
        sections = tuple(timing_chapter.make_chain_sections(self.lookup, self.edition.drawings))
        return [Section("page:chains", "Chains of effect", blocks, sections, page_break=True)]

    def make_views(self) -> list[Section]:
        """Make the chapter of the project's own views."""
        project_views = self.lookup.architecture.views.values()
        sections = [
            Section(
                f"view:{project_view.id}",
                project_view.title,
                (*figures, *functional_tables.make_view_table(self.lookup, project_view)),
            )
            for project_view in project_views
            if (figures := make_figures(self.edition.drawings, f"views/{project_view.id}"))
        ]
        return [Section("page:views", "Views", (), tuple(sections), page_break=True)] if sections else []

    def make_types(self) -> list[Section]:
        """Make the appendix that maps conceptual types to messages."""
        return self._make_appendix("types", "Type mapping", functional_tables.make_type_table(self.lookup))

    def make_connections(self) -> list[Section]:
        """Make the appendix of connections."""
        shown_connections = functional_tables.shown_connections(self.lookup)
        return self._make_appendix(
            "connections", "Connections", functional_tables.make_connection_table(self.lookup, shown_connections)
        )

    def make_requirements(self) -> list[Section]:
        """Make the appendix that traces requirements."""
        requirement_table = requirement_tables.make_requirement_table(
            self.lookup, requirement_tables.shown_requirements(self.lookup)
        )
        return self._make_appendix(
            "requirements",
            "Requirements trace",
            requirement_table,
            requirement_tables.make_free_requirement_table(self.lookup),
        )

    def make_properties(self) -> list[Section]:
        """Make the appendix of properties."""
        sections = property_tables.make_property_sections(self.lookup)
        return (
            [Section("page:properties", "Properties", (), sections, appendix=True, page_break=True)] if sections else []
        )

    def make_glossary(self) -> list[Section]:
        """Make the appendix of terms."""
        return self._make_appendix("glossary", "Glossary", property_tables.make_glossary_table(self.lookup))

    def make_open_points(self) -> list[Section]:
        """Make the appendix of findings."""
        summary = Paragraph(
            inline_text.to_inlines(f"The check finds {finding_tables.describe_severities(self.lookup.findings)}.")
        )
        return self._make_appendix(
            "findings",
            "Open points",
            summary,
            finding_tables.make_finding_table(self.lookup, self.lookup.findings),
        )

    def make_statistics(self) -> list[Section]:
        """Make the appendix of size, progress and growth."""
        growth_blocks = statistics_tables.make_growth_blocks(self.edition.history, self.edition.drawings)
        return self._make_appendix("progress", "Statistics", *self.edition.statistics, *growth_blocks)

    def _make_appendix(self, anchor: str, title: str, *blocks: Block | None) -> list[Section]:
        present_blocks = tuple(_drop_missing(*blocks))
        return (
            [Section(f"page:{anchor}", title, present_blocks, appendix=True, page_break=True)] if present_blocks else []
        )


_GENERATED_SECTIONS: Mapping[str, Callable[[_ChapterMaker], Sequence[Section]]] = {
    "overview": _ChapterMaker.make_overview,
    "between_partners": _ChapterMaker.make_between_partners,
    "use_cases": _ChapterMaker.make_use_cases,
    "groups": _ChapterMaker.make_groups,
    "frames": _ChapterMaker.make_frames,
    "variants": _ChapterMaker.make_variants,
    "deployment": _ChapterMaker.make_deployment,
    "start_up": _ChapterMaker.make_start_up,
    "timing": _ChapterMaker.make_timing,
    "chains": _ChapterMaker.make_chains,
    "views": _ChapterMaker.make_views,
    "types": _ChapterMaker.make_types,
    "connections": _ChapterMaker.make_connections,
    "requirements": _ChapterMaker.make_requirements,
    "properties": _ChapterMaker.make_properties,
    "open_points": _ChapterMaker.make_open_points,
    "statistics": _ChapterMaker.make_statistics,
    "glossary": _ChapterMaker.make_glossary,
}
"""What makes each of the generated chapters, by its name in `GENERATED_CHAPTERS`."""


def _drop_missing(*blocks: Block | None) -> Iterator[Block]:
    """Drop the blocks that could not be made."""
    return (block for block in blocks if block is not None)


def split_title(chapter: Chapter) -> tuple[str, str]:
    """Return a chapter's first heading and the rest; without a heading, its file name and the whole text."""
    heading, _, body = chapter.text.lstrip().partition("\n")
    if heading.startswith("# "):
        # A heading of CommonMark may be closed by hash signs: `# Safety #`.
        return heading[2:].strip().rstrip("#").strip(), body
    name = chapter.path.rpartition("/")[2].rpartition(".")[0]
    return name.replace("_", " ").replace("-", " ").capitalize(), chapter.text
