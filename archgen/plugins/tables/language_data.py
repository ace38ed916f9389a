"""Turn the imported project into data of the language: short forms, shortest references, and nothing that would be an
error.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from archgen.plugin.importing import title_from_id
from archgen.plugin.ros import full_message_name, load_interfaces
from archgen.plugins.tables.imported_project import (
    UNSORTED,
    ImportedComponent,
    ImportedGroup,
    ImportedInput,
    ImportedProject,
)


def build_language_data(project: ImportedProject, distro: str | None) -> dict[str, Any]:
    """Return the sections that a table says something about; empty where there is no component."""
    groups = {name: group for name, group in project.groups.items() if group.components}
    _report_left_out(project, groups)
    if not groups:
        return {}
    # Changes outputs and `wrong_messages`, so it must come before anything is written.
    _check_messages(project, distro)
    id_counts = Counter(component.id for component in project.all_components())
    # A reference may leave out its group only where no other component, and no group, has that id.
    unique_ids = {name for name, count in id_counts.items() if count == 1 and name not in project.groups}
    sections: dict[str, Any] = {
        "groups": {name: _group_data(group, unique_ids) for name, group in groups.items()},
        "nodes": {name: _node_data(node) for name, node in project.nodes.items()},
        "types": _type_data(project),
        "requirements": project.requirements,
        "partners": project.partners,
    }
    return {key: value for key, value in sections.items() if value}


def _report_left_out(project: ImportedProject, groups: dict[str, ImportedGroup]) -> None:
    """Report groups without components, and how many components no group was named for."""
    for name, group in project.groups.items():
        if name not in groups:
            project.add_warning(
                "missing-key", f"the group `{group.name}` has no component and was not taken", group.span, "add one"
            )
            project.ledger.list_element(group.path, "its group has no component")
    if UNSORTED in groups:
        count = len(groups[UNSORTED].components)
        message = (
            f"{count} {'components stand' if count > 1 else 'component stands'} in no group: look for `{UNSORTED}`"
        )
        project.add_note(message, groups[UNSORTED].span, "a column `Group` sorts them; or move them by hand")


def _group_data(group: ImportedGroup, unique_ids: set[str]) -> dict[str, Any]:
    data: dict[str, Any] = {"title": "To be sorted" if group.id == UNSORTED else group.name, **group.values}
    owners = dict.fromkeys(component.values.get("owner") for component in group.components.values())
    # An owner that all components share is written once, at the group.
    shared = next(iter(owners)) if len(owners) == 1 else None
    if shared and "owner" not in data:
        data["owner"] = shared
    data["components"] = {
        name: _component_data(component, unique_ids, data.get("owner")) for name, component in group.components.items()
    }
    return data


def _component_data(component: ImportedComponent, unique_ids: set[str], owner: object) -> dict[str, Any]:
    data: dict[str, Any] = {}
    has_no_content = not (
        component.inputs
        or component.outputs
        or component.declared_empty
        or {"functionality", "role"} & set(component.values)
    )
    if has_no_content or component.name not in (component.id, title_from_id(component.id)):
        data["title"] = component.name
    keys = dict(component.values)
    if keys.get("owner") == owner:
        keys.pop("owner", None)
    timing = keys.pop("timing", None)
    data |= {"functionality": keys.pop("functionality", None), **keys}
    if component.requirements:
        data["requirements"] = component.requirements
    data["inputs"] = {name: _input_data(port, component, unique_ids) for name, port in component.inputs.items()} or (
        {} if "inputs" in component.declared_empty else None
    )
    data["outputs"] = dict(component.outputs) or ({} if "outputs" in component.declared_empty else None)
    return data | ({"timing": timing} if timing else {})


def _input_data(port: ImportedInput, reader: ImportedComponent, unique_ids: set[str]) -> Any:  # noqa: ANN401 - short or long form
    paths = [_shortest_reference(path, reader, unique_ids) for path in port.sources]
    source: Any = paths[0] if len(paths) == 1 else paths or None
    if port.description is None and (source is not None or port.type is None):
        return source
    data = {"from": source, "type": port.type if source is None else None, "description": port.description}
    return {key: value for key, value in data.items() if value is not None}


def _shortest_reference(path: tuple[str, ...], reader: ImportedComponent, unique_ids: set[str]) -> str:
    """Write a reference as short as it can be without being ambiguous."""
    if len(path) == 3 and path[1] in unique_ids and path[1] != reader.id:  # noqa: PLR2004 - group, component, output
        return ".".join(path[1:])
    return ".".join(path)


def _node_data(node: dict[str, object]) -> dict[str, object]:
    implements = node["implements"]
    implemented = implements[0] if isinstance(implements, list) and len(implements) == 1 else implements
    return {"implements": implemented, **{key: value for key, value in node.items() if key != "implements"}}


def _type_data(project: ImportedProject) -> dict[str, str | None]:
    """Return the message of each type; None where the message does not exist."""
    return {name: message if message not in project.wrong_messages else None for name, message in project.types.items()}


def _check_messages(project: ImportedProject, distro: str | None) -> None:
    """Report messages that do not exist, and mark them: written down they would be errors."""
    known_interfaces, _ = load_interfaces(distro)
    written = {message for message in project.types.values() if message}
    written |= {
        type_name
        for component in project.all_components()
        for type_name in component.outputs.values()
        if type_name and full_message_name(type_name)
    }
    for message in sorted(written):
        if known_interfaces.status_of(message) == "wrong":
            nearest = known_interfaces.find_nearest(message)
            help_line = f"did you mean `{nearest}`?" if nearest else "look the name up"
            text = f"{known_interfaces.distro or 'ROS'} has no message `{message}`: it was not taken"
            first_cell, *other_cells = project.message_cells[message]
            project.reject_cell("unknown-message", text, first_cell, help_line)
            for cell in other_cells:
                project.ledger.list_cell(cell, f"there is no message `{message}`")
            project.wrong_messages.add(message)
    for component in project.all_components():
        component.outputs = {
            name: None if type_name in project.wrong_messages else type_name
            for name, type_name in component.outputs.items()
        }
