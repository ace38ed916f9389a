"""The site's pages: one for each element, and those that span the architecture."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group
from archgen.model.node import Node
from archgen.views import growth, pages_rest, tables, timing_chapter, words
from archgen.views.functional import component_blocks, group_blocks
from archgen.views.implementation import implementation_blocks, node_blocks
from archgen.views.index import Index
from archgen.views.report import Edition, split_title, title_facts
from archgen.views.shapes import Block, Facts, Figure, Markdown, Page, Paragraph, Section, Text

HOME = ("Overview", "page:index")


def pages(view: Index, edition: Edition) -> tuple[Page, ...]:
    """Make every page of the site."""
    made = _Pages(view, edition)
    functional = [made.start(), *made.groups(), *made.chapters(), *made.spanning()]
    rest = list(pages_rest.pages(view, made.drawn))
    low = [*made.nodes(), *pages_rest.topics(view)] if edition.level == "implementation" else []
    # Of pages whose paths collide the first one keeps its path, so this order is part of the site's addresses.
    return _distinct(functional + low + rest)


def _distinct(found: list[Page]) -> tuple[Page, ...]:
    """Add numbers to paths that several pages share: the names of two elements may give one file name."""
    taken: dict[str, int] = {}
    result = []
    for page in found:
        taken[page.path] = number = taken.get(page.path, 0) + 1
        stem = page.path.removesuffix(".html")
        result.append(page if number == 1 else replace(page, path=f"{stem}-{number}.html"))
    return tuple(result)


@dataclass(frozen=True, slots=True)
class _Pages:
    """Makes the pages; each method returns one page or yields several."""

    view: Index
    edition: Edition

    @property
    def found(self) -> Architecture:
        """Return the architecture."""
        return self.view.architecture

    def drawn(self, blocks: Iterable[Block]) -> tuple[Block, ...]:
        """Drop figures that are not among this site's drawings: of another level, or outside of the selection."""
        return tuple(b for b in blocks if not isinstance(b, Figure) or b.graph in self.edition.graphs)

    def figures(self, *names: str) -> Iterator[Figure]:
        """Yield figures for those of the named drawings that exist."""
        for name in names:
            graph = self.edition.graphs.get(name)
            if graph:
                yield Figure(f"figure:{name}", name, graph.title, graph.alt)

    def start(self) -> Page:
        """Make the start page: description, title facts, clickable overview, table of groups."""
        project = self.found.project
        blocks: list[Block] = [Markdown(project.description)] if project.description else []
        blocks.append(Facts(tuple(title_facts(self.view, self.edition))))
        blocks += self.figures("overview", "components")
        blocks += [table] if (table := tables.groups(self.view)) else []
        section = Section("page:index", project.title, tuple(blocks))
        return Page("index.html", "page:index", project.title, "overview", section, lead="Software architecture")

    def groups(self) -> Iterator[Page]:
        """Make a page for each shown group, followed by its shown components."""
        for name in self.view.groups():
            group = self.found.groups[name]
            yield self._group(group)
            for component in self.view.components(name):
                yield self._component(group, component)

    def _group(self, group: Group) -> Page:
        section = Section(f"group:{group.id}", group.title, self.drawn(group_blocks(self.view, group)))
        lead = self._owned(f"Group of {words.plural(len(group.components), 'component')}", group.owners)
        return Page(f"groups/{group.id}.html", section.anchor, group.title, "groups", section, (HOME,), lead)

    def _owned(self, words_: str, owners: Iterable[str]) -> str:
        """Return a page's lead with the titles of the owners behind it."""
        return " · ".join([words_, *(self.found.partners[owner].title for owner in owners)])

    def _component(self, group: Group, component: Component) -> Page:
        sections = []
        if self.edition.level == "implementation":
            blocks = self.drawn(implementation_blocks(self.view, component.id))
            nodes = list(self.view.nodes_of.get(component.id, ()))
            table = pages_rest.node_table(self.view, nodes, component)
            sections = [Section(f"implementation:{component.id}", "Implementation", (*blocks, *table))]
        sections += self._findings(component.id)
        blocks = self.drawn(component_blocks(self.view, component))
        section = Section(f"component:{component.id}", component.title, blocks, tuple(sections))
        crumbs = (HOME, (group.title, f"group:{group.id}"))
        lead = self._owned(f"Component{f' · {component.role}' if component.role else ''}", component.owners)
        path = f"components/{component.id}.html"
        return Page(path, section.anchor, component.title, "components", section, crumbs, lead)

    def _findings(self, element: str) -> list[Section]:
        """Return a section with the findings about an element, or nothing."""
        found = self.view.findings_of.get(element, ())
        table = tables.open_points(found, f"table:findings/{element}")
        return [Section(f"findings:{element}", "Open points", (table,))] if table else []

    def nodes(self) -> Iterator[Page]:
        """Make a page for each shown node."""
        for node in self.view.nodes():
            yield self._node(node)

    def _node(self, node: Node) -> Page:
        section = Section(f"node:{node.id}", node.id, node_blocks(self.view, node), tuple(self._findings(node.id)))
        kinds = ", ".join(words.KINDS[kind] for kind in node.kinds)
        lead = self._owned(f"{kinds[0].upper()}{kinds[1:]}{f' · {node.status}' if node.status else ''}", node.owners)
        crumbs = (HOME, ("Nodes", "page:nodes"))
        return Page(f"nodes/{node.id}.html", section.anchor, node.id, "nodes", section, crumbs, lead)

    def chapters(self) -> Iterator[Page]:
        """Make a page for each chapter that the project wrote."""
        for name, chapter in self.edition.texts.items():
            title, text = split_title(chapter)
            # `shift` 0: the chapter's own headings follow the page's title, which was its first heading.
            section = Section(f"chapter:{name}", title, (Markdown(text, chapter.folder, 0),))
            path = f"chapters/{pages_rest.slug(name.rpartition('.')[0])}.html"
            yield Page(path, section.anchor, title, "chapters", section, (HOME,), "Chapter")

    def spanning(self) -> Iterator[Page]:
        """Make the pages that span the architecture: tables, progress, timing, views, hosts."""
        shown = tables.shown_connections(self.view)
        yield self._spanning("connections", "Connections", tables.connections(self.view, shown))
        yield self._spanning("types", "Types", tables.types(self.view))
        trace = tables.requirements(self.view, tables.shown_requirements(self.view))
        yield self._spanning("requirements", "Requirements", trace, tables.free_requirements(self.view))
        said = Paragraph(words.text(f"archgen finds {tables.severities(self.view.findings)} in this architecture."))
        yield self._spanning("findings", "Open points", said, tables.open_points(self.view.findings))
        grown = growth.blocks(self.edition.history, tuple(self.edition.graphs))
        yield self._spanning("progress", "Progress", *self.edition.statistics, *grown)
        yield from self._timing()
        views = [f"views/{name}" for name in self.found.views]
        yield self._spanning("views", "Views", *self.figures(*views))
        if self.edition.level == "implementation":
            yield self._spanning(
                "nodes", "Nodes", *self.figures("ros"), *pages_rest.node_table(self.view, self.view.nodes())
            )
            yield self._spanning("topics", "Topics, services and actions", *pages_rest.topic_tables(self.view))
            hosts = (tables.hosts(self.view), tables.links(self.view))
            yield self._spanning("hosts", "Hosts", *self.figures("hosts"), *hosts)

    def _timing(self) -> Iterator[Page]:
        """Make the pages on timing: one for the whole, one for all chains, and one for each chain."""
        graphs = self.edition.graphs
        if self.view.timed is not None and self.edition.level == "implementation":
            blocks = timing_chapter.blocks(self.view, self.view.timed, graphs)
            sections = timing_chapter.sections(self.view, self.view.timed, graphs)
            yield self._spanning("timing", "Timing", *blocks, sections=sections)
        yield self._spanning("chains", "Chains of effect", *timing_chapter.chain_blocks(self.view))
        crumbs = (HOME, ("Chains of effect", "page:chains"))
        for section in timing_chapter.chains(self.view, graphs):
            path = f"chains/{section.anchor.partition(':')[2]}.html"
            yield Page(path, section.anchor, section.title, "chains", section, crumbs, "Chain of effect")

    def _spanning(self, name: str, title: str, *blocks: Block | None, sections: tuple[Section, ...] = ()) -> Page:
        """Make a page for the whole architecture."""
        present = tuple(block for block in blocks if block is not None)
        # A page without content is made all the same: the crumbs of other pages lead to it.
        nothing = Paragraph(words.text(Text("There is nothing here yet.", muted=True)))
        section = Section(f"page:{name}", title, present or (nothing,), sections)
        return Page(f"{name}.html", section.anchor, title, "spanning", section, (HOME,))
