"""What the class of a component is called after, in words: all instances of a component type have one class."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.component import Component


def find_type_words(architecture: Architecture, component: Component) -> str | None:
    """Return the component type that a component is made from, in words; of what stands inside of an instance the type with
    the names behind it. None for a component without a type.
    """
    parts: list[str] = []
    around: Component | None = component
    while around is not None:
        if around.component_type is not None:
            type_name = around.type_name if not around.component_type.endswith(">") else around.component_type
            return " ".join([type_name.replace("<", " of "), *reversed(parts)])
        parts.append(around.name)
        around = architecture.shells.get(around.parent or "")
    return None
