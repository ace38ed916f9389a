"""Turn the imported project into data of the language: short forms, shortest references, and nothing that would be an
error.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from archgen.importers.draft import UNSORTED, Component, Draft, Group, Input
from archgen.link import interfaces
from archgen.model.mapping import full_message
from archgen.model.names import made_title


def data(draft: Draft, distro: str | None) -> dict[str, Any]:
    """Return the sections that a table says something about; empty where there is no component."""
    groups = {name: group for name, group in draft.groups.items() if group.components}
    _say_left_out(draft, groups)
    if not groups:
        return {}
    # Changes outputs and `wrong_messages`, so it must come before anything is written.
    _see_messages(draft, distro)
    counted = Counter(component.id for component in draft.components())
    # A reference may leave out its group only where no other component, and no group, has that id.
    short = {name for name, count in counted.items() if count == 1 and name not in draft.groups}
    found: dict[str, Any] = {
        "groups": {name: _group(group, short) for name, group in groups.items()},
        "nodes": {name: _node(node) for name, node in draft.nodes.items()},
        "types": _types(draft),
        "requirements": draft.requirements,
        "partners": draft.partners,
    }
    return {key: value for key, value in found.items() if value}


def _say_left_out(draft: Draft, groups: dict[str, Group]) -> None:
    """Report groups without components, and how many components no group was named for."""
    for name, group in draft.groups.items():
        if name not in groups:
            draft.say(
                "missing-key", f"the group `{group.name}` has no component and was not taken", group.at, "add one"
            )
    if UNSORTED in groups:
        count = len(groups[UNSORTED].components)
        message = (
            f"{count} {'components stand' if count > 1 else 'component stands'} in no group: look for `{UNSORTED}`"
        )
        draft.note(message, groups[UNSORTED].at, "a column `Group` sorts them; or move them by hand")


def _group(group: Group, short: set[str]) -> dict[str, Any]:
    made: dict[str, Any] = {"title": "To be sorted" if group.id == UNSORTED else group.name, **group.keys}
    owners = {component.keys.get("owner") for component in group.components.values()}
    # An owner that all components share is written once, at the group.
    shared = next(iter(owners)) if len(owners) == 1 else None
    if shared and "owner" not in made:
        made["owner"] = shared
    made["components"] = {
        name: _component(component, short, made.get("owner")) for name, component in group.components.items()
    }
    return made


def _component(component: Component, short: set[str], owner: object) -> dict[str, Any]:
    made: dict[str, Any] = {}
    bare = not (
        component.inputs or component.outputs or component.none or {"functionality", "role"} & set(component.keys)
    )
    if bare or component.name not in (component.id, made_title(component.id)):
        made["title"] = component.name
    keys = dict(component.keys)
    if keys.get("owner") == owner:
        keys.pop("owner", None)
    timing = keys.pop("timing", None)
    made |= {"functionality": keys.pop("functionality", None), **keys}
    if component.requirements:
        made["requirements"] = component.requirements
    made["inputs"] = {name: _input(port, component, short) for name, port in component.inputs.items()} or (
        {} if "inputs" in component.none else None
    )
    made["outputs"] = dict(component.outputs) or ({} if "outputs" in component.none else None)
    return made | ({"timing": timing} if timing else {})


def _input(port: Input, reader: Component, short: set[str]) -> Any:  # noqa: ANN401 - short or long form
    paths = [_reference(path, reader, short) for path in port.sources]
    source: Any = paths[0] if len(paths) == 1 else paths or None
    if port.description is None and (source is not None or port.type is None):
        return source
    made = {"from": source, "type": port.type if source is None else None, "description": port.description}
    return {key: value for key, value in made.items() if value is not None}


def _reference(path: tuple[str, ...], reader: Component, short: set[str]) -> str:
    """Write a reference as short as it can be without being ambiguous."""
    if len(path) == 3 and path[1] in short and path[1] != reader.id:  # noqa: PLR2004 - group, component, output
        return ".".join(path[1:])
    return ".".join(path)


def _node(node: dict[str, object]) -> dict[str, object]:
    implements = node["implements"]
    one = implements[0] if isinstance(implements, list) and len(implements) == 1 else implements
    return {"implements": one, **{key: value for key, value in node.items() if key != "implements"}}


def _types(draft: Draft) -> dict[str, str | None]:
    """Return the message of each type; None where the message does not exist."""
    return {name: message if message not in draft.wrong else None for name, message in draft.types.items()}


def _see_messages(draft: Draft, distro: str | None) -> None:
    """Report messages that do not exist, and mark them: written down they would be errors."""
    known, _ = interfaces.load(distro)
    written = {message for message in draft.types.values() if message}
    written |= {told for one in draft.components() for told in one.outputs.values() if told and full_message(told)}
    for message in sorted(written):
        if known.answer(message) == "wrong":
            near = known.nearest(message)
            help_line = f"did you mean `{near}`?" if near else "look the name up"
            text = f"{known.distro or 'ROS'} has no message `{message}`: it was not taken"
            draft.say("unknown-message", text, draft.places[message], help_line)
            draft.wrong.add(message)
    for one in draft.components():
        one.outputs = {name: None if told in draft.wrong else told for name, told in one.outputs.items()}
