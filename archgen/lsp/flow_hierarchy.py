"""Flow as calls: who feeds a component, and who reads what it gives."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.source_span import Span
from archgen.live.edited_project import EditedProject
from archgen.model.component_nesting import find_component


def find_flow_component(project: EditedProject, kind: str, element_id: str) -> str | None:
    """Return the component that an element is, or whose port it is; None where it is neither."""
    architecture = project.checked.architecture
    component_id = element_id if kind == "component" else element_id.rpartition(".")[0]
    is_known = component_id in architecture.components or component_id in architecture.shells
    return component_id if is_known and kind in {"component", "input", "output"} else None


def describe_component(project: EditedProject, component_id: str) -> tuple[str, Span]:
    """Return the title of a component, and where it is declared."""
    component = find_component(project.checked.architecture, component_id)
    return component.title, component.at


def list_flows(project: EditedProject, component_id: str, *, is_incoming: bool) -> Iterator[tuple[str, list[Span]]]:
    """Yield the components that feed one, or that read it, each with where the outputs stand that flow there."""
    architecture = project.checked.architecture
    inside = frozenset(architecture.leaves_of(component_id))
    flows: dict[str, dict[Span, None]] = {}
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        for output_id in connection.outputs:
            output = architecture.outputs[output_id]
            ends = (reader, output.component) if is_incoming else (output.component, reader)
            if ends[0] in inside and ends[1] not in inside:
                flows.setdefault(ends[1], {})[output.at] = None
    for other, spans in flows.items():
        yield other, list(spans)
