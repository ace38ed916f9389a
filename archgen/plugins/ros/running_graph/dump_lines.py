"""Read dumps line by line, within bounds; a line `$ COMMAND` says which command printed what follows.

The graph of a running robot, as tools print it. Parameters that a dump holds as YAML.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from archgen.plugin.importing import (
    ForeignFileError,
    ImportNote,
    MappingNode,
    Span,
    node_to_data,
    parse_yaml,
    read_bounded,
)
from archgen.plugin.model import UseKind
from archgen.plugin.ros import find_name_fault, flatten_parameters

MAX_DUMP_BYTES = 64_000_000
_MAX_LINE = 20_000
_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
_PROMPT = re.compile(r"\$ +(\S.*)")
FULL_NAME = re.compile(r"(?:/[A-Za-z_]\w*)+\Z", re.ASCII)
"""A name of ROS from the root."""


class DumpLine(NamedTuple):
    """A line without its end. `command` is what printed it, as far as a line in front says so; that is `command_line`."""

    text: str
    span: Span
    command: str
    command_line: int = 0


def _split_lines(text: str) -> list[str]:
    # Not `splitlines`: a form feed or a line separator in a value ends no line of the file.
    return text.removeprefix("\ufeff").removesuffix("\n").replace("\r\n", "\n").split("\n")


def read_dump_lines(files: Sequence[Path]) -> Iterator[DumpLine]:
    """Yield the lines of dumps. Raise ForeignFileError for a file that cannot be read, or is no text."""
    for path in files:
        data = read_bounded(path, MAX_DUMP_BYTES)
        if b"\0" in data:
            raise ForeignFileError("it is no text", Span.of_file(path.name), "give what the commands print, as text")
        command, command_line = "", 0
        for number, raw_line in enumerate(_split_lines(data.decode("utf-8", "replace")), 1):
            line = _COLOURS.sub("", raw_line[:_MAX_LINE]).rstrip()
            match = _PROMPT.fullmatch(line)
            if match:
                command, command_line = match[1].strip(), number
                continue
            yield DumpLine(line, Span(path.name, number, 1, number, len(line) + 1), command, command_line)


_OWN_PARAMETERS = ("qos_overrides", "start_type_description_service")
"""What every node of ROS 2 has, and nobody sets."""
_USUAL_TIME = ("use_sim_time", False)


def take_node_parameters(graph: RunningGraph, lines: Sequence[DumpLine]) -> None:
    """Read what `ros2 param dump` printed of one node: its name, and `ros__parameters` below it."""
    root = _parse_lines(graph, lines)
    for entry in root or ():
        values = entry.value.get("ros__parameters") if isinstance(entry.value, MappingNode) else None
        if not isinstance(values, MappingNode):
            continue
        node = graph.get_node(f"/{entry.key.strip('/')}", lines[0].span)
        for value in flatten_parameters(values):
            is_own = value.name.partition(".")[0] in _OWN_PARAMETERS or (value.name, value.value) == _USUAL_TIME
            if not is_own and value.value is not None:
                node.parameters[value.name] = value.value
                graph.taken["parameter"] += 1


def read_server_values(graph: RunningGraph, lines: Sequence[DumpLine]) -> dict[str, Any]:
    """Return what `rosparam dump` printed: the whole parameter server."""
    root = _parse_lines(graph, lines)
    data = node_to_data(root) if root is not None else {}
    return data if isinstance(data, dict) else {}


def _parse_lines(graph: RunningGraph, lines: Sequence[DumpLine]) -> MappingNode | None:
    first = lines[0].span
    document, problems = parse_yaml(first.file, "\n".join(line.text for line in lines) + "\n")
    if document is None:
        problem = problems[0].message if problems else "it is no mapping"
        graph.add_note("parameters", f"they cannot be read: {problem}", first)
    return document.root if document is not None else None


USES: tuple[UseKind, ...] = ("publishes", "subscribes", "serves", "calls")


@dataclass(slots=True, eq=False)
class RunningNode:
    """A node: by use, the names of topics, services and actions with their messages (empty where not known)."""

    full_name: str
    span: Span
    uses: dict[str, dict[str, str]] = field(default_factory=lambda: {use: {} for use in USES})
    qos: dict[tuple[str, str], dict[str, Any]] = field(default_factory=dict)
    """By use and name; None is a duration without an end."""
    places: dict[tuple[str, str], Span] = field(default_factory=dict)
    """Where each use stands, by use and name."""
    parameters: dict[str, Any] = field(default_factory=dict)
    count: int = 1
    """How many nodes of this full name a list of nodes shows."""
    is_container: bool = False
    container: str = ""
    """The full name of the container that loaded it."""
    state: str | None = None
    """The state of a lifecycle node."""
    host: str | None = None
    """What the computer calls itself on which it runs."""


class RunningGraph:
    """All that a dump says, with an account of what was taken."""

    def __init__(self, *, is_ros_1: bool) -> None:
        self.is_ros_1 = is_ros_1
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

    def add_use(self, node: RunningNode, use: str, name: str, message: str, span: Span) -> None:
        """Add a topic, service or action of a node, unless ROS knows no such name: a line of a dump may be cut or garbled."""
        fault = "it is only a `/`" if name == "/" else find_name_fault(name, ros_1=self.is_ros_1)
        if fault:
            self.add_note("name", f"`{name}` of `{node.full_name}` is no name of ROS: {fault}", node.span)
            return
        if name not in node.uses[use]:
            self.taken[use] += 1
            node.places[use, name] = span
        if message:
            self.messages.setdefault(name, message)
        if message or name not in node.uses[use]:
            node.uses[use][name] = message

    def add_note(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note."""
        self.notes.append(ImportNote(kind, message, span, help_line, fate))
