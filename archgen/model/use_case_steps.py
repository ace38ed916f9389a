"""What happens in a use case: actors from outside, and steps between them and the components."""

from __future__ import annotations

from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field


@dataclass(frozen=True, slots=True)
class Actor:
    """Somebody or something outside of the architecture that takes part in a use case."""

    id: str
    title: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class StepEnd:
    """Where a step begins or ends: the id of an actor, or the complete id of a component or an output.

    `unknown` is what names nothing, or several things: its id is the text as written, and no rule judges the step.
    """

    kind: Literal["actor", "component", "output", "unknown"]
    id: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def participant(self) -> str:
        """Return the id of who takes part: an output stands for its component."""
        return self.id.rpartition(".")[0] if self.kind == "output" else self.id


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a use case: `source` sends something to `target`; both may be the same."""

    source: StepEnd
    target: StepEnd
    say: str | None = None
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def is_inner(self) -> bool:
        """Whether it stays with who begins it: that needs no connection."""
        return self.source.participant == self.target.participant

    @property
    def is_resolved(self) -> bool:
        """Whether both ends name something."""
        return "unknown" not in {self.source.kind, self.target.kind}
