"""The graph of a running robot, as tools print it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import ImportNote, Span

USES = ("publishes", "subscribes", "serves", "calls")


@dataclass(slots=True, eq=False)
class RunningNode:
    """A node: by use, the names of topics, services and actions with their messages (empty where not known)."""

    full_name: str
    span: Span
    uses: dict[str, dict[str, str]] = field(default_factory=lambda: {use: {} for use in USES})
    qos: dict[tuple[str, str], dict[str, Any]] = field(default_factory=dict)
    parameters: dict[str, Any] = field(default_factory=dict)
    is_container: bool = False
    container: str = ""
    """The full name of the container that loaded it."""


class RunningGraph:
    """All that a dump says, with an account of what was taken."""

    def __init__(self) -> None:
        self.nodes: dict[str, RunningNode] = {}
        self.messages: dict[str, str] = {}
        """Messages by the names of topics, services and actions."""
        self.taken: Counter[str] = Counter()
        self.notes: list[ImportNote] = []
        self.distro = ""

    def get_node(self, full_name: str, span: Span) -> RunningNode:
        """Return a node, which is known from now on."""
        if full_name not in self.nodes:
            self.nodes[full_name] = RunningNode(full_name, span)
            self.taken["node"] += 1
        return self.nodes[full_name]

    def add_use(self, node: RunningNode, use: str, name: str, message: str) -> None:
        """Add a topic, service or action of a node."""
        if name not in node.uses[use]:
            self.taken[use] += 1
        if message or name not in node.uses[use]:
            node.uses[use][name] = message

    def add_note(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note."""
        self.notes.append(ImportNote(kind, message, span, help_line, fate))
