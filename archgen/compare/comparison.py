"""The data of a comparison: changes, what follows from changes in figures, and the comparison as a whole."""

from __future__ import annotations

from typing import Literal

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import NamedTuple, dataclass, field
from archgen.model.node import Qos
from archgen.model.project_settings import BREAK_CATEGORIES, AcceptedChange, BreakCategory, BreakPolicy
from archgen.model.quantity import Quantity
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_verdicts import LimitState
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


ChangeKind = Literal["added", "removed", "changed", "renamed", "moved"]


@dataclass(frozen=True, slots=True)
class PartnerBreak:
    """What a partner loses by a change. `reason` completes a sentence after the change: "takes `a.b.c` from sssa, who
    ...".

    `agreement` is why the partner agrees, None if it does not. `category` says which policy judges it. `variants` are
    those in which it is lost, where nothing is lost in the project itself. `fallen` is the port and the key (`max_gap`) of
    a promise or freshness that is not kept any more.
    """

    partner: str
    reason: str
    agreement: str | None = None
    category: BreakCategory = "wire"
    variants: tuple[str, ...] = ()
    fallen: tuple[str, str] | None = None
    hash: str = ""
    """The hash that an agreement of the partner carries."""
    agreed_hash: str | None = None
    """The hash that the partner's agreement carries, None where it has none."""
    at_most: Severity = Severity.ERROR
    """How serious it is at most, whatever the policy says: what is not certain is a warning."""


@dataclass(frozen=True, slots=True)
class Change:
    """One change. `element_id` is the complete id in the second version, or in the first one for what was removed.

    `old_id` is the id before a rename or a move. `key` is what changed of an element, `before` and `after` are its
    values as plain data (None: not written). `confidence` is below 1 where a rename or a move was only recognised by
    likeness. `breaks` are the losses of partners other than the owner, those of the parts included; `claims` are the
    accepted entries that speak of the change and excuse nothing. `parts` are what came or went with an element, and what follows
    from the change. `variants` are those in which it is seen, where the project itself does not change there.
    """

    kind: ChangeKind
    element_kind: str
    element_id: str
    old_id: str | None = None
    key: str | None = None
    before: object = None
    after: object = None
    confidence: float = 1.0
    breaks: tuple[PartnerBreak, ...] = ()
    claims: tuple[AcceptedChange, ...] = ()
    text: str = ""
    parts: tuple[Change, ...] = ()
    variants: tuple[str, ...] = ()

    @property
    def broken_partners(self) -> tuple[str, ...]:
        """Return the partners who lose something, sorted."""
        return tuple(sorted({partner_break.partner for partner_break in self.breaks}))

    @property
    def break_categories(self) -> tuple[BreakCategory, ...]:
        """Return the categories of what partners lose, in the order of the policy."""
        return tuple(
            category for category in BREAK_CATEGORIES if any(each.category == category for each in self.breaks)
        )

    @property
    def unheard_partners(self) -> tuple[str, ...]:
        """Return the partners who lose something and did not agree, sorted."""
        return tuple(sorted({each.partner for each in self.breaks if each.agreement is None}))

    @property
    def acceptance_reason(self) -> str | None:
        """Return why all who lose something agree, None if one of them does not."""
        reasons = dict.fromkeys(each.agreement for each in self.breaks if each.agreement is not None)
        return "; ".join(reasons) if reasons and not self.unheard_partners else None


@dataclass(frozen=True, slots=True)
class ChainChange:
    """A chain whose bound or deadline changed, by its id (the old one if it was removed). None: not in that version."""

    id: str
    before: ChainResult | None
    after: ChainResult | None
    causes: tuple[Change, ...] = ()
    """The changes that made its bound another."""
    concerned_partners: frozenset[str] = frozenset()
    """The partners with a part on it in either version; none where the bound is nearly the same."""

    @property
    def deadline(self) -> TimingValue | None:
        """Return the deadline of the second version, or of the first one if the chain was removed."""
        chain_result = self.after or self.before
        return chain_result.deadline if chain_result else None


@dataclass(frozen=True, slots=True)
class Comparison:
    """Everything that differs. `cured_findings` and `silenced_findings` belong to the first version, `new_findings` to
    the second.

    A silenced finding is not cured: a comment or a setting hides it now. `policy` is how serious it is to break a
    partner: the stricter one of both versions. `idle_acceptances` are the accepted entries of the second version that
    name no breaking change.
    """

    before: ArchitectureVersion
    after: ArchitectureVersion
    matched_ids: MatchedIds
    versions: VersionPair
    changes: tuple[Change, ...]
    new_findings: tuple[Diagnostic, ...]
    cured_findings: tuple[Diagnostic, ...]
    chains: tuple[ChainChange, ...]
    concerned_owners: tuple[str, ...]
    silenced_findings: tuple[Diagnostic, ...] = ()
    policy: BreakPolicy = field(default_factory=BreakPolicy)
    idle_acceptances: tuple[AcceptedChange, ...] = ()
    boundaries: tuple[BoundaryChange, ...] = ()
    """What changed at the interfaces between partners, by interface."""
    limits: tuple[LimitChange, ...] = ()
    """The promises and freshness that are kept otherwise than before."""
    loads: tuple[LoadChange, ...] = ()
    """The hosts and links whose load changed noticeably."""
    left_out_files: tuple[str, ...] = ()
    """The files that the first version read, and the second one has and does not read."""
    facts: ReviewFacts = field(default_factory=ReviewFacts)
    """What is known of who made the change."""
    only_breaking: bool = False
    """Whether only the changes that break a partner were kept."""

    @property
    def is_refused(self) -> bool:
        """Whether the project's policy refuses this comparison: a partner is broken and did not agree, or nobody can
        say that none is.
        """
        return self.policy.gravest is Severity.ERROR and (
            not self.is_judged or any(self.break_severity(change) is Severity.ERROR for change in self.changes)
        )

    def break_severity(self, change: Change) -> Severity:
        """Return how serious it is that a change breaks partners who did not agree; `off` if there are none."""
        severities = (self.severity_of(each) for each in change.breaks if each.agreement is None)
        return max(severities, default=Severity.OFF)

    def severity_of(self, partner_break: PartnerBreak) -> Severity:
        """Return how serious a loss is where the partner did not agree."""
        return min(self.policy.severity_of(partner_break.category), partner_break.at_most)

    @property
    def is_judged(self) -> bool:
        """Whether both versions were read as a whole: what was not read may break anybody."""
        return not (self.before.unread_files or self.after.unread_files)

    @property
    def is_empty(self) -> bool:
        """Whether nothing differs."""
        return not (self.changes or self.new_findings or self.cured_findings or self.silenced_findings or self.chains)
