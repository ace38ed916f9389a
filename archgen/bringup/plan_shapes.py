"""The plan of a start-up: its steps in order, what each waits for, and the waits that were given up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.model.start_up import LifecycleState, ReadyConditions, StartPhase

StepKind = Literal["program", "node", "container", "composable"]
WaitReason = Literal["container", "after", "service", "data", "sampled", "optional", "manages", "managed"]
"""Why a step waits: for the container that loads it; because it says so (`after`); for a server; for a source that fires
it, that it samples, that it can do without; a manager for the nodes that it manages; a reader for the manager of its
source."""
NEEDS: Mapping[WaitReason, int] = {
    "container": 7,
    "after": 6,
    "manages": 5,
    "service": 4,
    "data": 3,
    "managed": 2,
    "sampled": 1,
    "optional": 0,
}
"""How much a wait is needed: of a circle the one that is needed least is given up, never one of the first two."""
FIRM_NEED = 6
"""A wait with at least this need never gives way."""


@dataclass(frozen=True, slots=True)
class Wait:
    """A step waits for an earlier one. `ports` are the pairs of output and input for which it does, by complete id."""

    awaited: str
    waiting: str
    reason: WaitReason
    ports: tuple[tuple[str, str], ...] = ()
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def need(self) -> int:
        """How much it is needed."""
        return NEEDS[self.reason]


@dataclass(frozen=True, slots=True)
class DroppedWait:
    """A wait that is not kept: the phases say otherwise, or it closes a circle.

    `circle` are the steps of that circle, from the one that is awaited to the one that waits; empty for phases.
    """

    wait: Wait
    circle: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StartStep:
    """One step: a program, a node or a container that is started, or a node that a container loads.

    `id` is that of the node or container. `command` are the words that start it, empty where nothing says how. `ready`
    has topics and services with their absolute names. `needs_rights` says what only an administrator may do.
    """

    id: str
    kind: StepKind
    phase: StartPhase
    host: str | None = None
    title: str = ""
    command: tuple[str, ...] = ()
    waits: tuple[Wait, ...] = ()
    ready: ReadyConditions = field(default_factory=ReadyConditions)
    once: bool = False
    transitions: tuple[tuple[str, ...], ...] = ()
    """The commands that bring a lifecycle node into its state; empty where a manager does it."""
    state: LifecycleState | None = None
    manager: tuple[str, ...] = ()
    """The steps that bring it into its state; empty where its own transitions do."""
    container: str | None = None
    respawn: bool = False
    respawn_delay: Quantity | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    directory: str | None = None
    user: str | None = None
    needs_rights: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StartPlan:
    """All steps in an order in which they can be started one by one, and the waits that were given up.

    `circles` are waits that never give way and that contradict one another or the phases: they are mistakes.
    """

    steps: tuple[StartStep, ...] = ()
    dropped: tuple[DroppedWait, ...] = ()
    circles: tuple[DroppedWait, ...] = ()
