"""What is going away, and what is to be used instead: of outputs, types and component types."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.promise import Deprecation


def find_replacement(architecture: Architecture, kind: str, deprecated: Deprecation) -> str | None:
    """Return what is to be used in the end, where what replaces something is deprecated itself; None if nothing is named.

    `kind` is `output`, `type` or `component_type`. In a circle nothing can be used: that is reported elsewhere.
    """
    seen: set[str] = set()
    current: Deprecation | None = deprecated
    while current is not None and current.target is not None:
        if current.target in seen:
            return None
        seen.add(current.target)
        following = find_deprecation(architecture, kind, current.target)
        if following is None or following.target is None:
            return current.target
        current = following
    return None


def find_deprecation(architecture: Architecture, kind: str, name: str) -> Deprecation | None:
    """Return what is said of an output, a type or a component type that is going away; None for any other."""
    if kind == "output":
        component = architecture.find_component(name.rpartition(".")[0])
        output = component.outputs.get(name.rpartition(".")[2]) if component else None
        return output.deprecated if output else None
    holder = (architecture.types if kind == "type" else architecture.component_types).get(name)
    return holder.deprecated if holder else None


def list_deprecated_kinds(architecture: Architecture, component: Component) -> Iterator[str]:
    """Yield what of a component is going away: an `output` of its own, a `type` that its ports name, its `component_type`."""
    if any(output.deprecated for output in component.outputs.values()):
        yield "output"
    type_names = (port.type for port in component.ports if port.type)
    if any(find_deprecation(architecture, "type", name) for name in type_names):
        yield "type"
    origins = architecture.list_types_of(component)
    if any(find_deprecation(architecture, "component_type", name) for name in origins):
        yield "component_type"
