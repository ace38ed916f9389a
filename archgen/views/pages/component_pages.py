"""The site's pages of groups, of components, of what is inside of composed ones, and of component types."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

from archgen.model.component import Component, ComponentType, Group
from archgen.model.component_nesting import find_component, list_surrounding
from archgen.views import inline_text
from archgen.views.elements.component_type_blocks import make_component_type_table, make_type_blocks
from archgen.views.elements.composed_blocks import make_composed_blocks
from archgen.views.elements.functional_level import make_component_blocks, make_group_blocks
from archgen.views.elements.implementation_level import make_implementation_blocks
from archgen.views.lookup import Lookup
from archgen.views.pages import context_pages
from archgen.views.pages.context_pages import HOME_CRUMB, FigureFilter
from archgen.views.shapes import Block, Page, Section

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
        section = Section(f"group:{group.id}", group.title, blocks)
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
        sections: list[Section] = []
        is_composed = component.id in self.lookup.architecture.shells
        if self.shows_nodes:
            figures = self.keep_drawn(make_implementation_blocks(self.lookup, component.id))
            nodes = list(self.lookup.nodes_inside(component.id))
            table = context_pages.make_node_table(self.lookup, nodes, component)
            if table or not is_composed:
                anchor = f"implementation:{component.id}"
                sections = [Section(anchor, "Implementation", (*figures, *table))]
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
