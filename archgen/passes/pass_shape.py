"""What a pass is, and what it works with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass as frozen_dataclass
from archgen.model.known_interfaces import Interfaces
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.project_tree import ProjectTree
from archgen.project import LoadedProject


@dataclass
class PassWork:
    """What a pass works with: the tree that it edits, and what it finds on the way."""

    loaded_project: LoadedProject
    tree: ProjectTree
    interfaces: Interfaces
    findings: list[Diagnostic] = field(default_factory=list)
    _linked: LinkedTree | None = None
    _linked_at: int = -1

    def link(self) -> LinkedTree:
        """Return what the linker knows about the tree as it stands now."""
        if self._linked is None or self._linked_at != self.tree.edit_count or self._linked.root is not self.tree.root:
            self._linked = LinkedTree(self.loaded_project, self.tree.root, self.interfaces)
            self._linked_at = self.tree.edit_count
        return self._linked


RunPass = Callable[[PassWork], None]


@frozen_dataclass(frozen=True, slots=True)
class Pass:
    """A pass: what it is called, what it does, and what it asks of a project and leaves true of it.

    `needs`, `leaves` and `ends` are words of `STATES`.
    """

    name: str
    title: str
    """What it does, in one sentence."""
    run: RunPass
    needs: tuple[str, ...] = ()
    leaves: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
    """What may no longer hold behind it."""
    keeps_variants: bool = False
    """Whether variants still fit what it makes; else it works on the project as it stands in one of them."""


STATES = {
    "named": "every component and port has a name",
    "readers_name_sources": "connections stand at the reader alone",
    "no_component_sources": "no instance names components as its sources",
    "no_autoconnect_ports": "no connection follows by itself from equal names",
    "no_autoconnect_types": "no connection follows by itself from equal types",
    "no_instances": "every component says all that it has",
    "no_generics": "no component type and no data type has names that stand for others",
    "flat": "no component holds components",
    "unique_names": "no two components of the project have one name",
    "enveloped": "every message carries its sender",
    "monitored": "every component says how it is, and is watched",
}
"""What may hold of a project, by the word that passes and backends ask for it with."""
