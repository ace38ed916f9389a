"""The messages, services and actions that the nodes of a workspace use, from the interface files in it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.importing import ForeignFileError, Span, make_unique_id, read_bounded
from archgen.plugin.ros import is_ros_1
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.message_files import make_type_name, read_message_definition
from archgen.plugins.ros.workspace.node_components import NodeKnowledge
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles

_MAX_BYTES = 1_000_000
_FIELD_TYPE = re.compile(r"(?:([a-z][a-z0-9_]*)/)?(?:msg/)?([A-Z]\w*)")


def read_used_messages(
    workspace: WorkspaceFiles, knowledge: Sequence[NodeKnowledge], account: ImportAccount, distro: str
) -> dict[str, Any]:
    """Return the types of the messages that are used, and of those in their fields; what archgen knows of ROS is left out."""
    pending = [
        endpoint.message
        for each in knowledge
        for node in (each.program.nodes if each.program is not None else ())
        for endpoint in node.endpoints
    ]
    found: dict[str, Any] = {}
    seen: set[str] = set()
    while pending:
        message = pending.pop(0)
        package = workspace.packages.get(message.partition("/")[0])
        if message in seen or package is None:
            continue
        seen.add(message)
        path = package.manifest.folder / f"{message.partition('/')[2]}.{message.split('/')[1]}"
        shown = workspace.shown.get(path)
        data = {} if shown is None else _read_message(path, shown, message, account, distro)
        if len(data) > 1:
            found[make_unique_id(make_type_name(message), found.keys())] = data
            pending += _list_inner(data, package.manifest.name)
    return found


def _read_message(path: Path, shown: str, message: str, account: ImportAccount, distro: str) -> dict[str, Any]:
    try:
        text = read_bounded(path, _MAX_BYTES).decode("utf-8-sig", "replace")
    except ForeignFileError as error:
        account.add_note("file", error.message, Span.of_file(shown))
        return {}
    data, problems = read_message_definition(text, message, shown, is_ros_1=is_ros_1(distro), distro=distro)
    for problem in problems:
        account.add_note("message", problem.message, problem.span, problem.help or "")
    account.count("message")
    return data


def _list_inner(data: Any, package: str) -> Iterator[str]:  # noqa: ANN401 - data of YAML
    """Yield the messages in the fields of one."""
    for key, value in data.items() if isinstance(data, dict) else ():
        if isinstance(value, dict):
            yield from _list_inner(value, package)
        elif isinstance(value, str) and key not in {"message", "comment"} and (match := _FIELD_TYPE.match(value)):
            yield f"{match[1] or package}/msg/{match[2]}"
