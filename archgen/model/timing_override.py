"""Another figure than the one that is written, as `--set` lays it over an architecture, and as a search tries it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing


@dataclass(frozen=True, slots=True)
class TimingOverride:
    """A new value for one key of one activity: a node's part for a component ("" if the node implements none).

    `activity` is its id, where that is not the node's.
    """

    node: str
    component: str
    key: str
    value: Any
    activity: str = ""

    def __str__(self) -> str:
        """Return the override as `--set` reads it."""
        return f"{self.activity or self.node}.timing.{self.key}={str(self.value).replace(' ', '')}"


@dataclass(frozen=True, slots=True)
class ThreadsOverride:
    """Another number of threads of a container, or of a node outside of one."""

    element: str
    kind: Literal["container", "node"]
    threads: int

    def __str__(self) -> str:
        """Return the override as `--set` reads it."""
        return f"{self.element}.threads={self.threads}"


ArchitectureOverride = TimingOverride | ThreadsOverride


def apply_override(architecture: Architecture, override: ArchitectureOverride) -> Architecture:
    """Return an architecture with one value overridden; overriding the rate removes the period, and the reverse."""
    if isinstance(override, ThreadsOverride):
        return _replace_threads(architecture, override)
    node = architecture.nodes[override.node]
    timing = node.timing.get(override.component, Timing(at=node.at))
    changes = {override.key: override.value}
    if override.key in {"rate", "period"}:
        changes["period" if override.key == "rate" else "rate"] = None
    kept_places = {key: span for key, span in timing.places.items() if changes.get(key, key) is not None}
    new_timing = replace(
        timing, **changes, places={**kept_places, override.key: timing.places.get(override.key, timing.at)}
    )
    new_node = replace(node, timing={**node.timing, override.component: new_timing})
    return replace(architecture, nodes={**architecture.nodes, node.id: new_node})


def _replace_threads(architecture: Architecture, override: ThreadsOverride) -> Architecture:
    container = replace(architecture.containers[override.element], threads=override.threads)
    return replace(architecture, containers={**architecture.containers, container.id: container})
