"""How what interfaces promise, and that they are going away, is read for comparing."""

from __future__ import annotations

from archgen.compare.kinds.key_spec import ReadContext
from archgen.frozen import replace
from archgen.model.component import ComponentType, Output
from archgen.model.message_types import ConceptualType
from archgen.model.promise import Deprecation, Promise, format_range

NO_DAY = "no day"
"""What is compared where something is deprecated and nobody has said until when."""


def read_range(promise: Promise, _context: ReadContext) -> str | None:
    """Return the promised least and greatest value."""
    return format_range(promise.range) if promise.range else None


def find_output_deprecation(output: Output, context: ReadContext) -> Deprecation | None:
    """Return until when an output is there, and what replaces it."""
    found = _find_deprecation(output.deprecated, "output", context)
    if found is None or found.use is None or not found.target or found.target.rpartition(".")[0] != output.component:
        return found
    # As people write it: instances of a type say the same of their own outputs.
    return replace(found, use=found.use.rpartition(".")[2])


def find_type_deprecation(conceptual_type: ConceptualType, context: ReadContext) -> Deprecation | None:
    """Return until when a type is there, and what replaces it."""
    return _find_deprecation(conceptual_type.deprecated, "type", context)


def find_component_type_deprecation(component_type: ComponentType, context: ReadContext) -> Deprecation | None:
    """Return until when a component type is there, and what replaces it."""
    return _find_deprecation(component_type.deprecated, "component_type", context)


def _find_deprecation(written: Deprecation | None, kind: str, context: ReadContext) -> Deprecation | None:
    if written is None:
        return None
    use = context.common_id(kind, written.target) if written.target else written.use
    return replace(written, until=written.until or NO_DAY, use=use)
