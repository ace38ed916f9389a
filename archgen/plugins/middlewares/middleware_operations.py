"""What can be called at a component: rule R3. A `get` that is waited for is a method, a `set` that is not a command."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from archgen.plugin.generating import list_name_words, write_place
from archgen.plugin.model import Architecture, Component, Operation, Output
from archgen.plugins.middlewares.middleware_names import name_inside, name_member, name_port_member, shorten_wire_name
from archgen.plugins.middlewares.middleware_types import MiddlewareTypes

_MOST_ARGUMENTS = 4
"""What takes more gets a record: not every middleware takes any number."""
_SETTING_WORD = "set"


def is_command(operation: Operation) -> bool:
    """Return whether nobody waits for an operation: as `call` says, else where its name begins with `set`."""
    if operation.call is not None:
        return operation.call == "asynchronous"
    return [each.lower() for each in list_name_words(operation.id)[:1]] == [_SETTING_WORD]


def record_operations(types: MiddlewareTypes, words: str, components: Iterable[Component]) -> list[dict[str, Any]]:
    """Return the operations that instances of a class have and that are not private."""
    found: dict[str, tuple[Operation, Component]] = {}
    for component in components:
        for name, operation in component.operations.items():
            if operation.visibility != "private":
                found.setdefault(name, (operation, component))
    return [_record_operation(types, words, operation, component) for operation, component in found.values()]


def _record_operation(types: MiddlewareTypes, words: str, operation: Operation, component: Component) -> dict[str, Any]:
    request = operation.request
    if isinstance(request, str):
        request = {"request": request}
    given = dict(request or {})
    if len(given) > _MOST_ARGUMENTS or len({name_member(name) for name in given}) < len(given):
        fields = [(name, types.find_written_type(written)) for name, written in given.items()]
        arguments = [("request", types.add_answer(f"{words} {operation.id} request", fields, operation.at))]
    else:
        arguments = [(name, types.find_called_type(written, operation.at)) for name, written in given.items()]
    answer = operation.response
    if isinstance(answer, Mapping):
        fields = [(name, types.find_written_type(written)) for name, written in answer.items()]
        made = types.add_answer(f"{words} {operation.id} response", fields, operation.at) if fields else None
    else:
        made = types.find_called_type(answer, operation.at) if answer else None
    return {
        "element": f"{component.id} {operation.id}",
        "span": operation.at,
        **_record_names(operation.id),
        "title": operation.id,
        "port": None,
        "is_command": is_command(operation),
        "arguments": [
            {"name": name_inside(name_member(name), name_port_member(operation.id)), "title": name, "type": each}
            for name, each in arguments
        ],
        "result": made,
        "description": operation.description or "",
        "place": write_place(operation.at),
    }


def record_served(architecture: Architecture, types: MiddlewareTypes, port: Output) -> dict[str, Any]:
    """Return an output that is called as an operation: a service is waited for, an action is not."""
    request, answer = types.find_call_parts(port.type)
    return {
        "element": port.id,
        "span": port.at,
        **_record_names(port.name),
        "title": port.name,
        "port": port.name,
        "is_command": architecture.flow_of(port) == "action",
        "arguments": [
            {"name": name_inside("request", name_port_member(port.name)), "title": "request", "type": request}
        ]
        if request
        else [],
        "result": answer,
        "description": port.description or "",
        "place": write_place(port.at),
    }


def _record_names(name: str) -> dict[str, str]:
    interface = name_port_member(name)
    return {"name": interface, "member": interface.rstrip("_"), "wire": shorten_wire_name(interface)}
