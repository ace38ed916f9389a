"""What was observed of a robot, whoever saw it: its nodes and what they use, each with the place that says so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.node import FlowKind, UseKind

ObservationKind = Literal["workspace", "graph", "recording", "trace"]
"""Sources and launch files; the graph of a running robot; messages that were recorded; what its programs did."""


@dataclass(frozen=True, slots=True)
class ObservedEndpoint:
    """The use of one topic, service or action by a node. `name` is absolute; None where only running the program tells it."""

    node: str
    """The node's full name."""
    use: UseKind
    flow: FlowKind
    name: str | None
    message: str | None = None
    """The full name of its type, None where that is unknown."""
    qos: Mapping[str, Any] = field(default_factory=dict)
    """The policies that are known: values of fields of `Qos`, by their names."""
    is_conditional: bool = False
    """Whether it is made only under a condition that is not known."""
    program_name: str | None = None
    """What its program says, made absolute, before remaps; None where only the name on the wire is known."""
    at: Span = field(default=NO_SPAN, compare=False)


@dataclass(frozen=True, slots=True)
class ObservedNode:
    """A node. `count` is how many of this full name run."""

    full_name: str
    count: int = 1
    parameters: Mapping[str, object] | None = None
    """By dotted names; None where nobody asked for them."""
    has_known_uses: bool = True
    """Whether what it uses could be seen: not where its sources are elsewhere."""
    has_all_uses: bool = True
    """Whether it uses nothing else: not where a part of its sources is elsewhere, such as the base of its class."""
    is_conditional: bool = False
    """Whether it runs only under conditions that do not hold by default."""
    state: str | None = None
    """The state of a lifecycle node; None where nobody asked for it."""
    host: str | None = None
    """What the computer calls itself on which it runs; None where that is not known."""
    at: Span = field(default=NO_SPAN, compare=False)


@dataclass(frozen=True, slots=True)
class RecordedTopic:
    """The messages of one topic. Times are in ns and sizes in bytes; what only the messages themselves tell may be None."""

    name: str
    message: str | None
    count: int
    duration: int
    """From its first message to its last; where only the whole recording is known, its duration."""
    is_own_duration: bool
    """Whether `duration` is that of the topic itself."""
    delay: int | None = None
    """From the beginning of the recording to its first message."""
    longest_gap: int | None = None
    largest_size: int | None = None
    frames: tuple[str, ...] | None = None
    """The `frame_id`s of its headers; None where its messages have none in front, or nobody looked."""
    qos: Mapping[str, Any] = field(default_factory=dict)
    """What its publishers offered: policies that are the same for all of them."""
    at: Span = field(default=NO_SPAN, compare=False)


@dataclass(frozen=True, slots=True)
class ObservedRobot:
    """All that one workspace, graph or recording says. `origin` is what people call it: its path as it was given."""

    origin: str
    kind: ObservationKind
    nodes: tuple[ObservedNode, ...] = ()
    endpoints: tuple[ObservedEndpoint, ...] = ()
    topics: tuple[RecordedTopic, ...] = ()
    unseen_uses: frozenset[UseKind] = frozenset()
    """What it cannot tell of any node: the master of ROS 1 knows no clients of services."""
    has_all_parameters: bool = False
    """Whether the parameters of a node are all that it declares, so that one which is missing is not declared."""
    unnamed_nodes: int = 0
    """How many nodes it has besides, of which only running their programs tells the names."""
    has_designed_starts: bool = False
    """Whether its programs were taken as the design starts them: it tells nothing of names, remaps and parameters that a start gives."""
    unread: tuple[str, ...] = ()
    """What could not be read of it, a sentence each with the place."""

    @property
    def where(self) -> str:
        """What sentences call it: a workspace says what a robot would be, and is not one that runs."""
        return f"in {self.origin}" if self.kind == "workspace" else "on the robot"
