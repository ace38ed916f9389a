"""What a comparison takes and gives."""

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
    """What a partner loses by a change. `why` goes on where the change's name ends: "takes `a.b.c` from sssa, who ..."."""

    partner: str
    why: str


@dataclass(frozen=True, slots=True)
class Change:
    """One change. `element` is its complete id, as it was where it is removed; `was` is the id before a rename or a move.

    `key` is what changed of an element, `before` and `after` its values as plain data (None: not written). `confidence`
    is below 1 where a rename or a move was only recognised. `breaks` are what partners other than the owner lose, those
    of the parts included; `accepted` is why the project accepts that, None where it does not. `parts` are what came or
    went with an element, and what follows from the change.
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
        """Name the partners who lose something, sorted."""
        return tuple(sorted({each.partner for each in self.breaks}))


@dataclass(frozen=True, slots=True)
class ChainChange:
    """A chain of which the bound or the deadline changed, by its id (before, where it is gone). None: it is not there."""

    id: str
    before: ChainResult | None
    after: ChainResult | None

    @property
    def deadline(self) -> Value | None:
        """Give the deadline that counts now."""
        there = self.after or self.before
        return there.deadline if there else None


@dataclass(frozen=True, slots=True)
class Comparison:
    """All that differs. `cured` and `silenced` findings speak of the first version, `new` ones of the second. A silenced one
    is not cured: a comment or a setting keeps it quiet now.

    `breaking` is how much a change matters that breaks a partner: what the stricter version says. `idle` are the accepted
    entries of the second version that name no breaking change here.
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
    """Only what breaks a partner was kept."""

    @property
    def failing(self) -> bool:
        """Say whether the project's policy refuses this: a partner is broken, and nobody accepted that."""
        return self.breaking is Severity.ERROR and any(each.breaks and each.accepted is None for each in self.changes)

    @property
    def empty(self) -> bool:
        """Say whether nothing differs."""
        return not (self.changes or self.new or self.cured or self.silenced or self.chains)
