"""What is written about the start-up of a node: when it starts, and how one sees that it is up."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, get_args

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.quantity import Quantity

StartPhase = Literal["network", "simulators", "core", "components"]
LifecycleState = Literal["unconfigured", "inactive", "active"]
PHASES: tuple[StartPhase, ...] = get_args(StartPhase)
"""The parts of a start-up, one after the other."""
DEFAULT_PHASE: StartPhase = "components"


@dataclass(frozen=True, slots=True)
class StartTarget:
    """A node, or a component with all of its nodes, that a start-up names: its complete id."""

    kind: Literal["node", "component"]
    id: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ReadyConditions:
    """How one sees that something is up: all that is known must hold. `within` is the longest that it may take (ns)."""

    port: int | None = None
    file: str | None = None
    topic: str | None = None
    """The name as written."""
    service: str | None = None
    """The name of a service or an action as written."""
    log: str | None = None
    """Words of its output."""
    wait: Quantity | None = None
    """How long to wait in any case (ns)."""
    within: Quantity | None = None
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The spans of the values, by key."""

    @property
    def has_sign(self) -> bool:
        """Whether anything is waited for, and be it only some time."""
        return any(getattr(self, key) is not None for key in SIGN_KEYS)


SIGN_KEYS = ("port", "file", "topic", "service", "log", "wait")
"""What can be waited for."""


@dataclass(frozen=True, slots=True)
class StartUp:
    """What a node says of its start-up; None and empty for what is left out. `respawn_delay` in ns."""

    phase: StartPhase | None = None
    after: tuple[StartTarget, ...] = ()
    ready: ReadyConditions = field(default_factory=ReadyConditions)
    respawn: bool = False
    respawn_delay: Quantity | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    directory: str | None = None
    user: str | None = None
    once: bool = False
    state: LifecycleState | None = None
    by: StartTarget | None = None
    """What brings a lifecycle node into its state."""
    by_written: bool = False
    """Whether `by` is written, resolved or not."""
    places: Mapping[str, Span] = field(default_factory=dict, compare=False, repr=False)
    """The spans of the values, by key."""

    def list_awaited(self) -> tuple[str, ...]:
        """Return the ids of what is to be there before it, and of what brings it into its state."""
        return tuple(target.id for target in (*self.after, *filter(None, (self.by,))))

    @property
    def wanted_state(self) -> LifecycleState | None:
        """The state that a lifecycle node is brought into; None where nobody says so."""
        return self.state or ("active" if self.by_written else None)


NO_START = StartUp()
"""What counts where nothing is written."""
