"""What of a project exists already: programs that no pass changes."""

from __future__ import annotations

from archgen.diagnostics.element_origins import TreePath
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.selector_keys import find_component_status
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.project_tree import ProjectTree
from archgen.project.library_reading import SHIPPED_ID

_EXISTING = "existing"


def is_existing(tree: ProjectTree, path: TreePath) -> bool:
    """Whether what is written of a component, of its node, or of what it stands in, says that it exists."""
    around = [path[:length] for length in range(len(path), 1, -2)]
    return any(
        tree.get_text((*each, *key)) == _EXISTING for each in around for key in (("status",), ("node", "status"))
    )


def list_existing_components(linked: LinkedTree) -> set[str]:
    """Return the components that exist already, by what they, what is around them, their nodes or their library say."""
    architecture = linked.architecture
    existing = {
        component_id
        for node in architecture.nodes.values()
        if node.status == _EXISTING
        for component_id in node.implements
    }
    components = (*architecture.components.values(), *architecture.shells.values())
    return existing | {each.id for each in components if _says_existing(architecture, each)}


def _says_existing(architecture: Architecture, component: Component) -> bool:
    if find_component_status(architecture, component) == _EXISTING:
        return True
    around = (component, *architecture.list_around(component))
    return any((each.component_type or "").startswith(f"{SHIPPED_ID}.") for each in around)
