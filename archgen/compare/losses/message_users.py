"""Who uses a type or a message of the first version, and who of them is broken by another definition."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from archgen.compare.losses.change_context import ChangeContext
from archgen.model.graph_search import find_reachable

DefinitionUse = tuple[bool, str]
"""Whether somebody writes what is defined, and the partner."""


class MessageUsers:
    """The users of types and messages in the first version."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context
        self._uses: dict[tuple[str, str], list[DefinitionUse]] = defaultdict(list)
        for endpoint in context.before.endpoints:
            node = context.before.nodes[endpoint.node]
            component = context.before.components.get(endpoint.component or "")
            partner = (component.owner if component else None) or node.owner
            if not partner:
                continue
            use = endpoint.use in {"publishes", "serves"}, context.matched_ids.common_id("partner", partner)
            if endpoint.message:
                self._uses["message", context.matched_ids.common_id("message", endpoint.message)].append(use)
            if endpoint.type:
                self._uses["type", context.matched_ids.common_id("type", endpoint.type)].append(use)

    def partners_using_type(self, type_name: str) -> list[str]:
        """Return the partners whom another definition of a type breaks, sorted."""
        return _other_partners(self._uses.get(("type", type_name), ()))

    def partners_using_message(self, message_name: str) -> list[str]:
        """Return the partners whom another definition of a message breaks, also inside of other messages, sorted."""
        names = _messages_containing(self._context, message_name)
        return _other_partners([use for name in names for use in self._uses.get(("message", name), ())])


def _other_partners(uses: Sequence[DefinitionUse]) -> list[str]:
    """Return all users but the one who alone writes what is defined, if there is one."""
    writers = {partner for is_writer, partner in uses if is_writer}
    return sorted({partner for _, partner in uses} - (writers if len(writers) == 1 else frozenset()))


def _messages_containing(context: ChangeContext, message_name: str) -> Sequence[str]:
    """Return a message of the second version and all that contain it, at any depth."""
    packages = context.after.interfaces.project_packages
    project_messages = [
        interface_name
        for interface_name in context.after.interfaces.names
        if interface_name.partition("/")[0] in packages
    ]
    containers_by_type: Mapping[str, list[str]] = defaultdict(list)
    for container_name in sorted(project_messages):
        definition = context.after.interfaces.definitions.get(container_name)
        for part in definition.parts if definition else ():
            for field in part:
                containers_by_type[field.type].append(container_name)
    return list(find_reachable(containers_by_type, [message_name]))
