"""The site's pages, and the report's sections, of groups, components and component types."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator

from archgen.frozen import dataclass, replace
from archgen.model.component import Component, ComponentType, Group
from archgen.model.component_nesting import find_component, list_surrounding
from archgen.views import inline_text
from archgen.views.agreement.exchange_tables import list_unsettled
from archgen.views.elements.functional_level import (
    make_component_blocks,
    make_component_table,
    make_component_type_table,
    make_composed_blocks,
    make_group_blocks,
    make_type_blocks,
)
from archgen.views.elements.implementation_level import make_implementation_blocks, make_node_blocks
from archgen.views.elements.parameter_blocks import list_equal_settings
from archgen.views.lookup import Lookup
from archgen.views.pages import context_pages
from archgen.views.pages.context_pages import HOME_CRUMB, FigureFilter
from archgen.views.shapes import Block, Markdown, Page, Paragraph, Section, keep_columns
from archgen.views.tables.requirement_tables import make_requirement_table
from archgen.views.timing.flow_tables import (
    list_activities,
    make_chain_share_table,
    make_flow_sections,
    make_partner_bullets,
)
from archgen.views.type_names import find_component_type

_MAX_DEPTH = 2
"""So many composed components may be around one that has a heading: the document has four levels of them."""


def list_group_parts(lookup: Lookup, group: Group) -> Iterator[tuple[str, str, Block]]:
    """Yield what the components of a group serve, which chains run through them, and whom their owners talk to, with titles."""
    architecture = lookup.architecture
    members = {each.id: each for each in lookup.shown_members(group.id)}
    own_names = {use.text for each in members.values() for use in each.requirements if use.is_id}
    served = [
        architecture.requirements[name]
        for name in lookup.components_for_requirement
        if name in own_names and name in architecture.requirements
    ]
    if table := make_requirement_table(lookup, served):
        yield "requirements-of", "Requirements", replace(table, anchor=f"table:requirements-of/{group.id}")
    nodes = {node.id: node for member in sorted(members) for node in lookup.nodes_of.get(member, ())}
    activities = list_activities(lookup, nodes.values())
    if chains := make_chain_share_table(lookup, group.id, group.title, activities):
        # Between the first of its steps and the last one others may have theirs: no time is the group's alone.
        yield "chains-through", "Chains through it", keep_columns(chains, (0, 1, 5, 6, 7))
    if partners := make_partner_bullets(lookup, activities):
        yield "partners-of", "Who to talk to", partners


@dataclass(frozen=True)
class ReportSections:
    """Makes the sections. `shows_nodes` is whether the document has the implementation level."""

    lookup: Lookup
    keep_drawn: Callable[[Iterable[Block]], tuple[Block, ...]]
    shows_nodes: bool

    def make_sections(self) -> list[Section]:
        """Make one section for each group, with its components and their nodes; then one for all component types."""
        groups = [
            self._make_group_section(self.lookup.architecture.groups[name]) for name in self.lookup.shown_groups()
        ]
        return [*groups, *self._make_type_sections()]

    def _make_group_section(self, group: Group) -> Section:
        sections = tuple(self._make_section(component) for component in self.lookup.shown_members(group.id))
        blocks = self.keep_drawn(make_group_blocks(self.lookup, group))
        return Section(f"group:{group.id}", group.title, blocks, sections, page_break=True)

    def _make_section(self, component: Component) -> Section:
        if component.id in self.lookup.architecture.shells:
            return self._make_composed_section(component)
        blocks = self.keep_drawn(self._say_type_once(component, make_component_blocks(self.lookup, component)))
        return Section(
            f"component:{component.id}", component.title, blocks, tuple(self._make_implementation(component))
        )

    def _make_composed_section(self, shell: Component) -> Section:
        """Describe a composed component: what is inside has sections below it, or a table where headings get too deep."""
        architecture = self.lookup.architecture
        blocks = self.keep_drawn(self._say_type_once(shell, make_composed_blocks(self.lookup, shell)))
        children = self.lookup.shown_children(shell)
        if len(list_surrounding(architecture, shell.id)) < _MAX_DEPTH:
            sections = tuple(self._make_section(child) for child in children)
        else:
            sections = ()
            blocks = self._list_all_inside(shell, blocks)
        own_nodes = (
            self._make_implementation(architecture.components[shell.id]) if shell.id in architecture.components else ()
        )
        return Section(f"component:{shell.id}", shell.title, blocks, (*own_nodes, *sections))

    def _list_all_inside(self, shell: Component, blocks: tuple[Block, ...]) -> tuple[Block, ...]:
        """Replace the last table, of what is directly inside, by one of all components inside to any depth."""
        architecture = self.lookup.architecture
        shown = [name for name in architecture.leaves_of(shell.id) if name != shell.id and self.lookup.shows_part(name)]
        leaves = [architecture.components[name] for name in shown]
        if not leaves:
            return blocks
        caption = f"Components of {shell.title}"
        table = make_component_table(self.lookup, f"table:components/{shell.id}", caption, leaves, inside_of=shell.id)
        # Links to what has no section of its own lead to its row.
        return (*blocks[:-1], replace(table, row_anchors=tuple(f"component:{each.id}" for each in leaves)))

    def _say_type_once(self, component: Component, blocks: Iterable[Block]) -> tuple[Block, ...]:
        """Leave out what the section of the component's type has."""
        component_type = find_component_type(self.lookup.architecture, component)
        if component_type is None:
            return tuple(blocks)
        type_texts = {component_type.functionality, component_type.description}
        known_tables = list_equal_settings(component, component_type)
        own_blocks = [
            block
            for block in blocks
            if not (isinstance(block, Markdown) and block.text in type_texts) and block not in known_tables
        ]
        return tuple(own_blocks)

    def _make_implementation(self, component: Component) -> Iterable[Section]:
        """Yield the section with a component's nodes; nothing where it has none, and at the functional level."""
        if not self.shows_nodes:
            return
        figure_blocks = self.keep_drawn(make_implementation_blocks(self.lookup, component.id))
        nodes = self.lookup.nodes_of.get(component.id, ())
        node_sections = tuple(self._make_node_section(node.id, component) for node in nodes)
        if node_sections:
            title = f"Implementation of {component.title}"
            yield Section(f"implementation:{component.id}", title, figure_blocks, node_sections)

    def _make_node_section(self, node_id: str, component: Component) -> Section:
        """Describe a node at the first shown component that it implements; elsewhere refer to that place."""
        node = self.lookup.architecture.nodes[node_id]
        # Never exhausted: the component being written is itself shown and implemented by the node.
        first_component = next(c for c in node.implements if self.lookup.scope.shows_component(c))
        if first_component == component.id:
            return Section(f"node:{node.id}", f"Node {node.id}", make_node_blocks(self.lookup, node))
        link = inline_text.component_link(self.lookup.architecture.components[first_component])
        reference = inline_text.to_inlines(
            "The node ", inline_text.node_link(node), " implements this too; it is described at ", link, "."
        )
        # The plain anchor `node:ID` belongs to the full description and must stay unique.
        anchor = f"node:{node.id}:{component.id}"
        return Section(anchor, f"Node {node.id}", (Paragraph(reference),))

    def _make_type_sections(self) -> list[Section]:
        """Make the section of the component types, which says once what their instances share."""
        table = make_component_type_table(self.lookup)
        if table is None:
            return []
        sections = tuple(
            Section(f"component_type:{each.id}", each.title, make_type_blocks(self.lookup, each))
            for each in self.lookup.architecture.component_types.values()
        )
        return [Section("page:component_types", "Types of components", (table,), sections, page_break=True)]


Crumbs = tuple[tuple[str, str], ...]
FindingSections = Callable[[str], list[Section]]
"""Returns a section with the findings about an element, or nothing."""
TYPES_CRUMB = ("Types of components", "page:component_types")


def _list_repeated_facts(component: Component) -> Collection[str]:
    """Return the keys of the facts that the line below the title, or the way to the page, says already."""
    return {"group", "inside_of", "role"} if component.role else {"group", "inside_of"}


@dataclass(frozen=True)
class ComponentPages:
    """Makes the pages. `shows_nodes` is whether the site has the implementation level."""

    lookup: Lookup
    keep_drawn: FigureFilter
    find_findings: FindingSections
    shows_nodes: bool

    def make_pages(self) -> Iterator[Page]:
        """Yield a page for each shown group, followed by its shown components, those inside of others behind them."""
        for name in self.lookup.shown_groups():
            group = self.lookup.architecture.groups[name]
            yield self.make_group_page(group)
            crumbs = (HOME_CRUMB, (group.title, f"group:{group.id}"))
            for component in self.lookup.shown_members(name):
                yield from self._list_pages(component, crumbs)

    def _list_pages(self, component: Component, crumbs: Crumbs) -> Iterator[Page]:
        """Yield the page of a component, followed by those of what is inside."""
        if component.id not in self.lookup.architecture.shells:
            yield self._make_component_page(component, crumbs)
            return
        yield self._make_composed_page(component, crumbs)
        inner_crumbs = (*crumbs, (component.title, f"component:{component.id}"))
        for child in self.lookup.shown_children(component):
            yield from self._list_pages(child, inner_crumbs)

    def make_single_page(self, component_id: str) -> Page:
        """Make the page of a component, composed or not."""
        architecture = self.lookup.architecture
        component = find_component(architecture, component_id)
        around = [architecture.shells[name] for name in list_surrounding(architecture, component_id)]
        group = architecture.groups[component.group]
        shell_crumbs = ((shell.title, f"component:{shell.id}") for shell in around)
        crumbs = (HOME_CRUMB, (group.title, f"group:{group.id}"), *shell_crumbs)
        return next(self._list_pages(component, crumbs))

    def make_group_page(self, group: Group) -> Page:
        """Make the page of a group."""
        # With composed components the line below the title says less.
        is_composed = any(shell.group == group.id for shell in self.lookup.architecture.shells.values())
        blocks = self.keep_drawn(make_group_blocks(self.lookup, group, () if is_composed else {"components"}))
        parts = list_group_parts(self.lookup, group)
        sections = tuple(Section(f"{kind}:{group.id}", title, (block,)) for kind, title, block in parts)
        section = Section(f"group:{group.id}", group.title, blocks, sections)
        lead = f"Group of {inline_text.count_noun(len(group.components), 'component')}"
        return Page(f"groups/{group.id}.html", section.anchor, group.title, "groups", section, (HOME_CRUMB,), lead)

    def _make_component_page(self, component: Component, crumbs: Crumbs) -> Page:
        blocks = self.keep_drawn(make_component_blocks(self.lookup, component, _list_repeated_facts(component)))
        # Not the owner: the facts below have it, as a link.
        lead = f"Component{f' · {component.role}' if component.role else ''}"
        return self._make_page(component, blocks, crumbs, lead)

    def _make_composed_page(self, shell: Component, crumbs: Crumbs) -> Page:
        blocks = self.keep_drawn(make_composed_blocks(self.lookup, shell, _list_repeated_facts(shell)))
        leaves = [leaf for leaf in self.lookup.architecture.leaves_of(shell.id) if leaf != shell.id]
        count = inline_text.count_noun(len(leaves), "component")
        lead = f"Composed component with {count} inside{f' · {shell.role}' if shell.role else ''}"
        return self._make_page(shell, blocks, crumbs, lead)

    def _make_page(self, component: Component, blocks: tuple[Block, ...], crumbs: Crumbs, lead: str) -> Page:
        is_composed = component.id in self.lookup.architecture.shells
        unsettled = list_unsettled(self.lookup, self.lookup.architecture.leaves_of(component.id))
        sections = make_flow_sections(self.lookup, component, unsettled)
        if self.shows_nodes:
            figures = self.keep_drawn(make_implementation_blocks(self.lookup, component.id))
            nodes = list(self.lookup.nodes_inside(component.id))
            table = context_pages.make_node_table(self.lookup, nodes, component)
            if table or not is_composed:
                anchor = f"implementation:{component.id}"
                sections.append(Section(anchor, "Implementation", (*figures, *table)))
        sections += self.find_findings(component.id)
        section = Section(f"component:{component.id}", component.title, blocks, tuple(sections))
        path = f"components/{component.id}.html"
        return Page(path, section.anchor, component.title, "components", section, crumbs, lead)

    def list_type_pages(self) -> Iterator[Page]:
        """Yield the page that lists the component types, and one for each; nothing where there are none."""
        table = make_component_type_table(self.lookup)
        if table is None:
            return
        section = Section(TYPES_CRUMB[1], TYPES_CRUMB[0], (table,))
        yield Page("component_types.html", section.anchor, section.title, "spanning", section, (HOME_CRUMB,))
        for component_type in self.lookup.architecture.component_types.values():
            yield self._make_type_page(component_type)

    def _make_type_page(self, component_type: ComponentType) -> Page:
        anchor = f"component_type:{component_type.id}"
        findings = self.find_findings(component_type.id)
        section = Section(anchor, component_type.title, make_type_blocks(self.lookup, component_type), tuple(findings))
        lead = "Abstract component type" if component_type.is_abstract else "Component type"
        return context_pages.make_page(section, "component_types", TYPES_CRUMB, lead)
