"""What a node is in NoDL, of either version, and the component type that it becomes."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from archgen.plugin.importing import Span, make_id, make_unique_id
from archgen.plugins.ros.ros_package.import_account import ImportAccount

_TYPE = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/(?:(msg|srv|action)/)?([A-Z][A-Za-z0-9_]*)\Z")
_NAME = re.compile(r"[A-Za-z]\Z|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]\Z")


class NodlPort(NamedTuple):
    """What a node has, as written: `use` is `publishes`, ...; `kind` is `topic`, `service` or `action`."""

    use: str
    kind: str
    name: str
    type_name: str
    span: Span


class NodeType:
    """The component type that a node becomes, as it grows."""

    def __init__(self, account: ImportAccount) -> None:
        """Tell the account what is taken, and what is not."""
        self._account = account
        self.words: dict[str, Any] = {}
        """What is said of the whole: its description."""
        self.node: dict[str, Any] = {}
        self.parameters: dict[str, Any] = {}
        self.open: list[str] = []
        self._ports: dict[str, dict[str, Any]] = {"inputs": {}, "outputs": {}}
        self._uses: dict[str, dict[str, Any]] = {}

    def add_port(self, port: NodlPort, further: dict[str, Any] | None = None) -> None:
        """Add what a node publishes, subscribes to, serves or calls, with what else is said of it."""
        use, kind, name, type_name, span = port
        message = _read_type(type_name, {"topic": "msg", "service": "srv", "action": "action"}[kind])
        if not _NAME.match(name) or "//" in name:
            self._account.add_note(kind, f"`{name}` is no name of a {kind}", span, "letters, digits, `_` and `/`")
            return
        if message is None:
            words = f"`{type_name}` of `{name}` is no type of a {kind}"
            self._account.add_note(kind, words, span, "it is `package/kind/Name`, such as `std_msgs/msg/String`")
            return
        side = "outputs" if use in {"publishes", "serves"} else "inputs"
        further = dict(further or {})
        description = further.pop("description", "")
        port_id = make_unique_id(make_id(name.strip("/~").replace("/", "_"), kind), self._ports[side].keys())
        self._ports[side][port_id] = {"type": message, "description": description} if description else message
        key = "topic" if kind == "topic" else "name"
        self._uses.setdefault(use, {})[port_id] = {key: name, **further} if further else name
        self._account.count(kind)

    def write(self) -> dict[str, Any]:
        """Return the component type."""
        body = {**self.words, **self._ports}
        if self.parameters:
            body["parameters"] = self.parameters
        if self.open:
            body["open"] = self.open
        node = {**self.node, **self._uses}
        return {**body, "node": node} if node else body


def _read_type(text: str, kind: str) -> str | None:
    match = _TYPE.match(text)
    if match is None or (match[2] or kind) != kind:
        return None
    return f"{match[1]}/{kind}/{match[3]}"
