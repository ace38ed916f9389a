"""What does a component still lack?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import Diagnostic, Severity, join_words
from archgen.model.architecture import Architecture
from archgen.model.component import Component


def list_missing_details(architecture: Architecture, component: Component, *, is_timed: bool) -> Iterator[str]:
    """Yield what is still missing of a component, in the order in which it is usually filled in.

    `inputs: {}` and `requirements: []` are answers. A source needs no inputs, a sink no outputs.
    """
    if not component.functionality:
        yield "functionality"
    # A project without partners has nobody who could be the owner.
    if architecture.partners and component.owner is None:
        yield "owner"
    if not component.requirements_known:
        yield "requirements"
    if not component.inputs_known and component.role != "source":
        yield "inputs"
    if not component.outputs_known and component.role != "sink":
        yield "outputs"
    untyped = [output.name for output in component.outputs.values() if output.type is None]
    if untyped:
        yield f"the type of {join_words([f'`{name}`' for name in untyped])}"
    if not component.performance:
        yield "performance"
    empty_indicators = [i.id for i in component.performance if i.accuracy is None and i.execution_time is None]
    if empty_indicators:
        yield f"figures for {join_words([f'`{name}`' for name in empty_indicators])}"
    if not is_timed:
        yield "timing"


def missing_detail(architecture: Architecture) -> Iterator[Diagnostic]:
    """Something about a component is not written yet."""
    # Timing may be written on the component or on any of its nodes.
    timed_components = {component for node in architecture.nodes.values() for component in node.timing}
    for component in architecture.components.values():
        missing_items = list(
            list_missing_details(
                architecture, component, is_timed=bool(component.timing) or component.id in timed_components
            )
        )
        if missing_items:
            yield Diagnostic(
                "missing-detail",
                f"`{component.id}` still lacks {join_words(missing_items)}",
                component.at,
                help=_suggest_place(component, missing_items),
                element=component.id,
            )


def _suggest_place(component: Component, missing_items: list[str]) -> str | None:
    """Return where a reference to a component type gets what it lacks, None for any other component."""
    if not component.is_reference or missing_items == ["owner"]:
        return None
    place = f"it at its component type `{component.type_name}`"
    if "owner" in missing_items:
        place = f"the owner here, the rest at its component type `{component.type_name}`"
    return f"write {place}; or make it an instance (`is`) instead of a reference (`same_as`)"


RULES = ((missing_detail, Severity.NOTE),)
