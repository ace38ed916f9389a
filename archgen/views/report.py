"""The report's outline: chapters of the project and generated ones, in the order that the project asks for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from archgen.model.component import Component, Group
from archgen.model.document import GENERATED, Chapter
from archgen.model.history import History
from archgen.views import growth, tables, timing_chapter, words
from archgen.views.bars import Drawing
from archgen.views.functional import component_blocks, group_blocks
from archgen.views.implementation import implementation_blocks, node_blocks
from archgen.views.index import Index
from archgen.views.shapes import Block, Figure, Inlines, Markdown, Outline, Paragraph, Section, Table, Text

Level = Literal["functional", "implementation"]


@dataclass(frozen=True, slots=True)
class Edition:
    """What a document contains beside the architecture."""

    revision: str = ""
    level: Level = "implementation"
    chapters: tuple[str, ...] = GENERATED
    texts: Mapping[str, Chapter] = field(default_factory=dict)
    graphs: Mapping[str, Drawing] = field(default_factory=dict)
    statistics: tuple[Table, ...] = ()
    history: History = field(default_factory=History)
    broken: bool = False
    """The model has errors; documents show what is sound, and say so."""


def report(view: Index, edition: Edition) -> Outline:
    """Make the outline of the report; appendices move to the end, else the project's order is kept."""
    found = view.architecture
    made = _Chapters(view, edition)
    sections = [section for name in edition.chapters for section in made.chapter(name)]
    return Outline(
        title=found.project.title,
        subtitle="Software architecture",
        facts=tuple(title_facts(view, edition)),
        notices=notices(view, edition),
        sections=tuple(section for section in sections if not section.appendix)
        + tuple(section for section in sections if section.appendix),
    )


def title_facts(view: Index, edition: Edition) -> Iterator[tuple[str, Inlines]]:
    """Yield the lines of the title page: version, revision, ROS distribution, partners."""
    project = view.architecture.project
    if project.version:
        yield "Version", words.text(project.version)
    if edition.revision:
        yield "Revision", words.text(edition.revision)
    if view.architecture.distro:
        yield "ROS distribution", words.text(view.architecture.distro)
    if view.architecture.partners:
        yield "Partners", words.lines(words.text(partner.title) for partner in view.architecture.partners.values())


def notices(view: Index, edition: Edition) -> tuple[Paragraph, ...]:
    """Return what the reader must know first: that only a part or a level is shown, or that there are errors."""
    said: list[Paragraph] = []
    if view.scope.components is not None:
        part = words.text("This document shows a part of the architecture: ", Text(view.scope.words, code=True))
        said.append(Paragraph(part, "note"))
    if edition.level == "functional":
        said.append(Paragraph(words.text("This document shows the functional level only."), "note"))
    if edition.broken:
        words_ = (
            f"The architecture has errors ({tables.severities(view.findings)}). What is sound is shown all the same."
        )
        said.append(Paragraph(words.text(words_), "error"))
    return tuple(said)


@dataclass(frozen=True, slots=True)
class _Chapters:
    """Makes the sections of each chapter by the chapter's name."""

    view: Index
    edition: Edition

    def chapter(self, name: str) -> Sequence[Section]:
        """Return the sections of a chapter: several for `groups`, none where there is nothing to say."""
        if name in GENERATED:
            # One method for each name in GENERATED, called `_NAME`: they are found by name, so renaming one breaks its
            # chapter. NAME is one of archgen's own words here, never the user's text.
            made: Sequence[Section] = getattr(self, f"_{name}")()
            return made
        chapter = self.edition.texts.get(name)
        return (self._own(chapter),) if chapter else ()

    def _own(self, chapter: Chapter) -> Section:
        title, text = split_title(chapter)
        return Section(f"chapter:{chapter.path}", title, (Markdown(text, chapter.folder),), page_break=True)

    def _overview(self) -> list[Section]:
        project = self.view.architecture.project
        blocks: list[Block] = [Markdown(project.description)] if project.description else []
        blocks += self._figures("overview", "components")
        # Anchors are the same as the site's, so that references in shared blocks work in both.
        return [Section("page:index", "Overview", tuple(blocks), page_break=True)] if blocks else []

    def _figures(self, *names: str) -> Iterator[Figure]:
        for name in names:
            graph = self.edition.graphs.get(name)
            if graph:
                yield Figure(f"figure:{name}", name, graph.title, graph.alt)

    def _groups(self) -> list[Section]:
        return [self._group(self.view.architecture.groups[group]) for group in self.view.groups()]

    def _group(self, group: Group) -> Section:
        sections = tuple(self._component(component) for component in self.view.components(group.id))
        blocks = self._drawn(group_blocks(self.view, group))
        return Section(f"group:{group.id}", group.title, blocks, sections, page_break=True)

    def _component(self, component: Component) -> Section:
        blocks = self._drawn(component_blocks(self.view, component))
        sections: tuple[Section, ...] = ()
        if self.edition.level == "implementation":
            drawn = self._drawn(implementation_blocks(self.view, component.id))
            nodes = tuple(self._node(node.id, component) for node in self.view.nodes_of.get(component.id, ()))
            if nodes:
                title = f"Implementation of {component.title}"
                sections = (Section(f"implementation:{component.id}", title, drawn, nodes),)
        return Section(f"component:{component.id}", component.title, blocks, sections)

    def _node(self, node_id: str, component: Component) -> Section:
        """Describe a node at the first shown component that it implements; elsewhere refer to that place."""
        node = self.view.architecture.nodes[node_id]
        # Never exhausted: the component being written is itself shown and implemented by the node.
        first = next(c for c in node.implements if self.view.scope.component(c))
        if first == component.id:
            return Section(f"node:{node.id}", f"Node {node.id}", node_blocks(self.view, node))
        where = words.component_link(self.view.architecture.components[first])
        said = words.text("The node ", words.node_link(node), " implements this too; it is described at ", where, ".")
        # The plain anchor `node:ID` belongs to the full description and must stay unique.
        anchor = f"node:{node.id}:{component.id}"
        return Section(anchor, f"Node {node.id}", (Paragraph(said),))

    def _drawn(self, blocks: Iterable[Block]) -> tuple[Block, ...]:
        """Drop figures that are not among this document's drawings."""
        return tuple(b for b in blocks if not isinstance(b, Figure) or b.graph in self.edition.graphs)

    def _deployment(self) -> list[Section]:
        if self.edition.level == "functional":
            return []
        blocks = [*self._figures("hosts", "ros"), *_present(tables.hosts(self.view), tables.links(self.view))]
        return [Section("page:hosts", "Deployment", tuple(blocks), page_break=True)] if blocks else []

    def _timing(self) -> list[Section]:
        timed = self.view.timed
        if timed is None or self.edition.level == "functional":
            return []
        blocks = timing_chapter.blocks(self.view, timed, self.edition.graphs)
        sections = timing_chapter.sections(self.view, timed, self.edition.graphs)
        return [Section("page:timing", "Timing", blocks, sections, page_break=True)] if sections else []

    def _chains(self) -> list[Section]:
        blocks = timing_chapter.chain_blocks(self.view)
        if not blocks or self.view.scope.components is not None:
            return []
        sections = tuple(timing_chapter.chains(self.view, self.edition.graphs))
        return [Section("page:chains", "Chains of effect", blocks, sections, page_break=True)]

    def _views(self) -> list[Section]:
        asked = self.view.architecture.views.values()
        sections = [
            Section(f"view:{asked_view.id}", asked_view.title, tuple(self._figures(f"views/{asked_view.id}")))
            for asked_view in asked
        ]
        sections = [section for section in sections if section.blocks]
        return [Section("page:views", "Views", (), tuple(sections), page_break=True)] if sections else []

    def _types(self) -> list[Section]:
        return self._appendix("types", "Type mapping", tables.types(self.view))

    def _connections(self) -> list[Section]:
        shown = tables.shown_connections(self.view)
        return self._appendix("connections", "Connections", tables.connections(self.view, shown))

    def _requirements(self) -> list[Section]:
        declared = tables.requirements(self.view, tables.shown_requirements(self.view))
        return self._appendix("requirements", "Requirements trace", declared, tables.free_requirements(self.view))

    def _open_points(self) -> list[Section]:
        said = Paragraph(words.text(f"archgen finds {tables.severities(self.view.findings)} in this architecture."))
        return self._appendix("findings", "Open points", said, tables.open_points(self.view.findings))

    def _statistics(self) -> list[Section]:
        grown = growth.blocks(self.edition.history, tuple(self.edition.graphs))
        return self._appendix("progress", "Statistics", *self.edition.statistics, *grown)

    def _appendix(self, anchor: str, title: str, *blocks: Block | None) -> list[Section]:
        present = tuple(_present(*blocks))
        return [Section(f"page:{anchor}", title, present, appendix=True, page_break=True)] if present else []


def _present(*blocks: Block | None) -> Iterator[Block]:
    """Drop the blocks that could not be made."""
    return (block for block in blocks if block is not None)


def split_title(chapter: Chapter) -> tuple[str, str]:
    """Return a chapter's first heading and the rest; without a heading, its file name and the whole text."""
    head, _, rest = chapter.text.lstrip().partition("\n")
    if head.startswith("# "):
        # A heading of CommonMark may be closed by hash signs: `# Safety #`.
        return head[2:].strip().rstrip("#").strip(), rest
    name = chapter.path.rpartition("/")[2].rpartition(".")[0]
    return name.replace("_", " ").replace("-", " ").capitalize(), chapter.text
