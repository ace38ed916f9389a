"""What views for generators are made from, for a backend and the part of a project that is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.emit.backend_manifests import Backend
from archgen.pipeline import CheckedProject
from archgen.products.output_options import OutputOptions
from archgen.views.generation.generation_context import GenerationContext


def make_generation_context(
    checked_project: CheckedProject, options: OutputOptions, backend: Backend
) -> GenerationContext:
    """Return the context for a backend; nothing is packed before a view asks for it."""

    def pack() -> Mapping[str, Any]:
        from archgen.checking.checked_packing import pack_checked_project

        return pack_checked_project(checked_project).data

    selection = options.selection
    return GenerationContext(
        checked_project.architecture,
        selection.components if selection else None,
        selection.nodes if selection else None,
        options=backend.options,
        backend=backend.id,
        level=options.level or "implementation",
        types_only=options.types_only,
        pack_project=pack,
    )
