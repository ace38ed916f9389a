"""The data of what follows from changes in figures: at interfaces between partners, of what was promised of them, and of
the load of hosts and links.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from archgen.frozen import dataclass
from archgen.model.node import Qos
from archgen.model.quantity import Quantity
from archgen.timing.chains.limit_states import LimitState
from archgen.timing.figures.timing_values import TimingValue

BoundaryKind = Literal["added", "removed", "changed"]


class FigureKey(NamedTuple):
    """What a figure is called, and the node that it is of where several nodes have one, by its common id."""

    name: str
    node: str = ""


@dataclass(frozen=True, slots=True)
class TravelPath:
    """The hosts that data leaves and reaches, and the links that it crosses, by common ids."""

    senders: tuple[str, ...]
    receivers: tuple[str, ...]
    links: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class WireNames:
    """The topics, services or actions (`flow`) of an interface; compared only where it took the place of another one."""

    flow: str
    names: tuple[str, ...]


ComparedFigure = TimingValue | Qos | TravelPath | WireNames


@dataclass(frozen=True, slots=True)
class FigureChange:
    """A figure before and after; None where the interface was not there, or had no such figure."""

    key: FigureKey
    before: ComparedFigure | None
    after: ComparedFigure | None


@dataclass(frozen=True, slots=True)
class BoundaryChange:
    """What changed of one output (or of a topic that needs none) between givers and takers, by common ids.

    `interface_id` is its id in the second version, in the first one if it is gone; `old_id` is the earlier one where it
    has another now, or that of the output that its takers read before. `kind` is `added`, `removed` or `changed`.
    `old_givers` are those who gave it before, and `old_takers` those who took it, if it changed hands.
    """

    kind: BoundaryKind
    interface_id: str
    old_id: str | None
    givers: tuple[str, ...]
    takers: tuple[str, ...]
    figures: tuple[FigureChange, ...]
    concerned_partners: frozenset[str]
    old_givers: tuple[str, ...] = ()
    old_takers: tuple[str, ...] = ()
    missed_deadline: TimingValue | None = None
    """The deadline that its subscribers ask for, where the largest gap keeps it no longer; in ns."""


@dataclass(frozen=True, slots=True)
class LoadChange:
    """The load of a host (of all its cores) or of a link, as a share of what it has; `before` None: it was not there.

    `users` are the partners with something on it in the second version.
    """

    kind: Literal["host", "link"]
    id: str
    before: TimingValue | None
    after: TimingValue
    users: frozenset[str]

    @property
    def concerned_partners(self) -> frozenset[str]:
        """Return whom it concerns: those who use what has less to spare now."""
        old_share = self.before.value if self.before else None
        return self.users if (self.after.value or 0) > (old_share or 0) else frozenset()


@dataclass(frozen=True, slots=True)
class LimitChange:
    """A promise of an output (`rate`, `max_gap`, `max_age`), what a node promises of its gaps (`timing.max_gap`,
    `qos.deadline`), or the `freshness` of an input, that is kept otherwise than before; by common ids, of an age with the
    input where it is read.

    `limit` is the stricter one of both versions; `is_asked_anew`: the second one asks for another. Rates are in Hz,
    durations in ns.
    """

    port: str
    key: str
    reader: str
    limit: Quantity
    before: TimingValue
    after: TimingValue
    old_state: LimitState
    new_state: LimitState
    is_asked_anew: bool
    concerned_partners: frozenset[str] = frozenset()

    @property
    def has_fallen(self) -> bool:
        """Whether it was kept, and is not shown to be kept any more."""
        return self.old_state == "kept" and self.new_state != "kept"
