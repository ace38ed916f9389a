"""What composed components mean to whom a change breaks: an id below one follows its id, and their ports pass on those of
the leaves inside.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.losses.change_context import ChangeContext
from archgen.model.architecture import Architecture


def find_component_renames(context: ChangeContext, component_id: str) -> list[int]:
    """Return the indices of the change that gave a component its id: its own, else that of what it stands in."""
    indices = context.indices_by_change_kind("component", component_id, "renamed", "moved")
    shell_id = component_id.rpartition(".")[0]
    while not indices and "." in shell_id:
        indices = context.indices_by_change_kind("composed", shell_id, "renamed", "moved")
        shell_id = shell_id.rpartition(".")[0]
    return indices


def needs_other_id(context: ChangeContext, input_id: str, output_id: str, new_output: str) -> bool:
    """Whether the file that names an output for an input has to name it otherwise, since nothing passes it on under the
    name that stands there.
    """
    if not (context.before.shells or context.after.shells):
        return True
    old_input = context.before.inputs.get(context.old_id("input", input_id))
    old_output = context.old_id("output", output_id)
    names = [
        connection.shell_port or connection.target
        for connection in (old_input.connections if old_input else ())
        if old_output in connection.outputs
    ]
    return not names or any(new_output not in _list_named_outputs(context.after, name) for name in names)


def _list_named_outputs(architecture: Architecture, name: str) -> Iterator[str]:
    """Yield the outputs of leaves that the id of an output, or of a component, stands for."""
    component = architecture.find_component(name)
    names = [output.id for output in component.outputs.values()] if component else [name]
    for each in names:
        inner_outputs = architecture.shell_ports.get(f"output {each}", ())
        if inner_outputs:
            for inner_output in inner_outputs:
                yield from _list_named_outputs(architecture, inner_output)
        elif each in architecture.outputs:
            yield each
