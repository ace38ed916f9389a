"""The plan of a start-up: its steps in order, what each waits for, and the waits that were given up."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil
from typing import Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.node import PHASES, LifecycleState, NodeStatus, ReadyConditions, StartPhase
from archgen.model.process_scheduling import NO_SCHEDULING, ProcessScheduling
from archgen.model.quantity import Quantity

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
WaitEnd = Literal["started", "ready", "ended"]
SignalKind = Literal["port", "file", "topic", "service", "log", "time", "end"]
DEFAULT_SECONDS = 60
"""How long something may take until it is up where it does not say so itself."""
_NANOSECONDS = 1_000_000_000


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
class AwaitedStep:
    """All for which a step waits for one other: until that is started, is up (`ready`) or has ended; and why."""

    awaited: str
    until: WaitEnd
    waits: tuple[Wait, ...]


@dataclass(frozen=True, slots=True)
class ReadySignal:
    """One thing that shows that a step is up, as it is looked for on the step's own host.

    `target` is a port's number, the path of a file, the absolute name of a topic or a service, words of the output, or a
    number of seconds; it is empty for the end of what runs once.
    """

    kind: SignalKind
    target: str = ""


@dataclass(frozen=True, slots=True)
class RosLaunch:
    """What ROS is told where it starts or loads a step: for those who write it otherwise than as a command.

    Parameters have their dotted names. Of one name the last value counts: first `earlier_values` (of all nodes and of the
    component), then the files in their order, then `own_values`. `file_values` are those of the files that archgen knows.
    `value_commands` are the words of commands whose output is a value, by the parameter's name.
    """

    name: str
    namespace: str = "/"
    package: str | None = None
    executable: str | None = None
    plugin: str | None = None
    container: str | None = None
    """The complete name in ROS of the container that loads it."""
    earlier_values: Mapping[str, object] = field(default_factory=dict)
    parameter_files: tuple[str, ...] = ()
    file_values: Mapping[str, object] = field(default_factory=dict)
    own_values: Mapping[str, object] = field(default_factory=dict)
    value_commands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    untyped_names: frozenset[str] = frozenset()
    """Parameters whose value is a variable of the environment alone, which may hold a number: nobody says that it is a text."""
    arguments: tuple[str, ...] = ()
    """What the program gets before the arguments of ROS."""
    remaps: Mapping[str, str] = field(default_factory=dict)
    """New names by those that the program uses."""
    shares_memory: bool = False
    """Whether it hands messages to others in its container without a copy."""

    @property
    def full_name(self) -> str:
        """The namespace and the name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def all_values(self) -> dict[str, object]:
        """The values that count."""
        return {**self.earlier_values, **self.file_values, **self.own_values}


@dataclass(frozen=True, slots=True)
class StartStep:
    """One step: a program, a node or a container that is started, or a node that a container loads.

    `id` is that of the node or container. `command` are the words that start it, empty where nothing says how: then
    somebody else starts it, or it is planned. `ready` has topics and services with their absolute names. `needs_rights`
    says what only an administrator may do.
    """

    id: str
    kind: StepKind
    phase: StartPhase
    host: str | None = None
    title: str = ""
    file_name: str = ""
    """What files about it are called, without their ending: no other step has it, in any case of letters."""
    status: NodeStatus | None = None
    ros: RosLaunch | None = None
    """None for what is no ROS, or starts by words of its own."""
    preparations: tuple[tuple[str, ...], ...] = ()
    """Commands that run to their ends before `command`, one after the other: they give it its parameters."""
    command: tuple[str, ...] = ()
    waits: tuple[Wait, ...] = ()
    awaited: tuple[AwaitedStep, ...] = ()
    """The same, each other step once; that all steps of earlier phases are up is left out."""
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
    scheduling: ProcessScheduling = NO_SCHEDULING
    """That of its process; of what a container loads nothing."""
    needs_rights: tuple[str, ...] = ()

    @property
    def log_file(self) -> str:
        """The name of the file for its output."""
        return f"{self.file_name}.log"

    @property
    def signals(self) -> tuple[ReadySignal, ...]:
        """What shows that it is up, all of it; nothing where it is up as soon as it runs (and has its state)."""
        if self.once:
            return (ReadySignal("end"),)
        ready = self.ready
        texts: tuple[tuple[SignalKind, object], ...] = (
            ("port", ready.port),
            ("file", ready.file),
            ("topic", ready.topic),
            ("service", ready.service),
            ("log", ready.log),
            ("time", None if ready.wait is None else format_seconds(ready.wait)),
        )
        return tuple(ReadySignal(kind, str(target)) for kind, target in texts if target is not None)

    @property
    def seconds_at_most(self) -> str | None:
        """How many seconds it may take until it is up, as a decimal number.

        None for what is up at once, and for what runs once without `within`: that takes as long as it takes.
        """
        if self.ready.within is not None:
            return format_seconds(self.ready.within)
        if self.once or not self.signals:
            return None
        awaited_time = self.ready.wait.value if self.ready.wait is not None else 0
        return str(DEFAULT_SECONDS + ceil(awaited_time / _NANOSECONDS))


@dataclass(frozen=True, slots=True)
class StartPlan:
    """All steps in an order in which they can be started one by one, and the waits that were given up.

    `circles` are waits that never give way and that contradict one another or the phases: they are mistakes.
    """

    steps: tuple[StartStep, ...] = ()
    dropped: tuple[DroppedWait, ...] = ()
    circles: tuple[DroppedWait, ...] = ()

    @property
    def phases(self) -> tuple[tuple[StartPhase, tuple[StartStep, ...]], ...]:
        """The steps of each phase that has any. All of a phase are up before the first of the next one starts."""
        return tuple(
            (phase, steps) for phase in PHASES if (steps := tuple(step for step in self.steps if step.phase == phase))
        )

    @property
    def hosts(self) -> tuple[str | None, ...]:
        """The hosts of the steps, in the order in which the first one of each starts; None for steps without any."""
        return tuple(dict.fromkeys(step.host for step in self.steps))


def format_seconds(duration: Quantity) -> str:
    """Return a duration as a decimal number of seconds, without a unit: `0.5`, `20`."""
    seconds = duration.value / _NANOSECONDS
    if seconds.denominator == 1:
        return str(seconds.numerator)
    return f"{float(seconds):.9f}".rstrip("0").rstrip(".")
