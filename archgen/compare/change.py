"""The data of a comparison: changes, chain changes, and the comparison as a whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from archgen.compare.names import Names
from archgen.compare.told import Told
from archgen.compare.version import Version
from archgen.diagnostic import Diagnostic, Severity
from archgen.model.review import Accepted
from archgen.timing.analysis import ChainResult
from archgen.timing.value import Value

Kind = Literal["added", "removed", "changed", "renamed", "moved"]


@dataclass(frozen=True, slots=True)
class Break:
    """What a partner loses by a change. `reason` completes a sentence after the change: "takes `a.b.c` from sssa, who
    ...".
    """

    partner: str
    why: str


@dataclass(frozen=True, slots=True)
class Change:
    """One change. `element_id` is the complete id in the second version, or in the first one for what was removed.

    `old_id` is the id before a rename or a move. `key` is what changed of an element, `before` and `after` are its
    values as plain data (None: not written). `confidence` is below 1 where a rename or a move was only recognised by
    likeness. `breaks` are the losses of partners other than the owner, those of the parts included; `acceptance_reason`
    is why the project accepts them (None: it does not). `parts` are what came or went with an element, and what follows
    from the change.
    """

    kind: Kind
    sort: str
    element: str
    was: str | None = None
    key: str | None = None
    before: object = None
    after: object = None
    confidence: float = 1.0
    breaks: tuple[Break, ...] = ()
    accepted: str | None = None
    text: str = ""
    parts: tuple[Change, ...] = ()

    @property
    def broken(self) -> tuple[str, ...]:
        """Return the partners who lose something, sorted."""
        return tuple(sorted({each.partner for each in self.breaks}))


@dataclass(frozen=True, slots=True)
class ChainChange:
    """A chain whose bound or deadline changed, by its id (the old one if it was removed). None: not in that version."""

    id: str
    before: ChainResult | None
    after: ChainResult | None

    @property
    def deadline(self) -> Value | None:
        """Return the deadline of the second version, or of the first one if the chain was removed."""
        there = self.after or self.before
        return there.deadline if there else None


@dataclass(frozen=True, slots=True)
class Comparison:
    """Everything that differs. `cured_findings` and `silenced_findings` belong to the first version, `new_findings` to
    the second.

    A silenced finding is not cured: a comment or a setting hides it now. `breaking_severity` is how serious it is to
    break a partner: the stricter policy of both versions. `idle_acceptances` are the accepted entries of the second
    version that name no breaking change.
    """

    before: Version
    after: Version
    names: Names
    told: Told
    changes: tuple[Change, ...]
    new: tuple[Diagnostic, ...]
    cured: tuple[Diagnostic, ...]
    chains: tuple[ChainChange, ...]
    owners: tuple[str, ...]
    silenced: tuple[Diagnostic, ...] = ()
    breaking: Severity = Severity.WARNING
    idle: tuple[Accepted, ...] = ()
    narrowed: bool = False
    """Whether only the changes that break a partner were kept."""

    @property
    def failing(self) -> bool:
        """Whether the project's policy refuses this comparison: a partner is broken, and nobody accepted it."""
        return self.breaking is Severity.ERROR and any(each.breaks and each.accepted is None for each in self.changes)

    @property
    def empty(self) -> bool:
        """Whether nothing differs."""
        return not (self.changes or self.new or self.cured or self.silenced or self.chains)
