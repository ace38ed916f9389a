"""What of a project exists already: programs that no pass changes."""

from __future__ import annotations

from archgen.diagnostics.element_origins import TreePath
from archgen.model.component import Component
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.project_tree import ProjectTree
from archgen.project.shipped_library import SHIPPED_ID

_EXISTING = "existing"


def is_existing(tree: ProjectTree, path: TreePath) -> bool:
    """Whether what is written of a component, or of the node that it brings along, says that it exists."""
    return _EXISTING in {tree.get_text((*path, "status")), tree.get_text((*path, "node", "status"))}


def list_existing_components(linked: LinkedTree) -> set[str]:
    """Return the components that exist already, by what they, their nodes or the library of their type say."""
    architecture = linked.architecture
    existing = {
        component_id
        for node in architecture.nodes.values()
        if node.status == _EXISTING
        for component_id in node.implements
    }
    return existing | {each.id for each in architecture.components.values() if _says_existing(each)}


def _says_existing(component: Component) -> bool:
    return component.status == _EXISTING or (component.component_type or "").startswith(f"{SHIPPED_ID}.")
