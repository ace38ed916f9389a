"""What follows from a system: how often things happen, how long they take, what hosts and links carry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from fractions import Fraction
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.timing import Behaviour
from archgen.source import NOWHERE, Span
from archgen.timing.system import Arc, System
from archgen.timing.value import UNKNOWN, Value
from archgen.timing.wording import duration, told

Tier = Literal["declared", "dedicated", "host", "priorities", "executor", "cores", "unknown"]
"""How a response time was found (docs/timing.md, "Response times"): `declared`; `dedicated`, assuming a core
of its own; `host`, any work-conserving scheduler of one core; `priorities`, fixed ones; `executor`,
single-threaded; `cores`, several.
"""


@dataclass(frozen=True, slots=True)
class Reason:
    """One step of the reasoning behind a figure: a sentence, and where in the files it rests on.

    It is put into words only when somebody asks for it: `template` is the sentence, with `{0}`, `{1}` for its
    `arguments`.
    """

    words: str
    # Places take no part in equality: a figure is the same wherever it is written (run_analysis compares them on its
    # own).
    at: Span = field(default=NOWHERE, compare=False, repr=False)
    parts: tuple[str | int | Fraction | Value, ...] = ()

    @property
    def text(self) -> str:
        """Return the sentence."""
        return self.words.format(*map(_said, self.parts)) if self.parts else self.words


def _said(part: str | int | Fraction | Value) -> str:
    """Format an argument of a sentence: a value is a rate, a Fraction a duration in ns."""
    if isinstance(part, Value):
        return told(part, "Hz")
    return duration(part) if isinstance(part, Fraction) else str(part)


@dataclass(frozen=True, slots=True)
class Pace:
    """How often an activity is activated, or an output published.

    `rate` in Hz; `gap` is the largest gap between two events, in ns (not the inverse of the rate: see docs/timing.md).
    `inferred` is False where the rate is written. `jitter` and `distance` (smallest gap), in ns, complete the event
    model.
    """

    behaviour: Behaviour | None
    rate: Value = UNKNOWN
    gap: Value = UNKNOWN
    jitter: Value = UNKNOWN
    distance: Value = UNKNOWN
    inferred: bool = True
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class Response:
    """From activation to completion, in ns: best and worst case, and how the worst was found."""

    best: Value
    worst: Value
    tier: Tier
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class HostLoad:
    """A host's utilisation (of all its cores together), and the bounds that it is compared with."""

    utilisation: Value
    cores: int
    rate_monotonic_bound: Value
    verdict: Literal["schedulable", "overload", "undecided", "unknown"]
    parts: tuple[tuple[str, Value], ...]
    """What each activity adds."""
    places: tuple[tuple[str, int, Value], ...] = ()
    """The cores to which something is pinned, and those that everything else shares: name, cores, utilisation."""
    earliest_deadline_bound: Value = UNKNOWN


@dataclass(frozen=True, slots=True)
class LinkLoad:
    """Traffic on a link in B/s, its share of the bandwidth, the burst in B and the longest queueing in ns."""

    traffic: Value
    share: Value
    burst: Value
    queueing: Value
    parts: tuple[tuple[str, Value], ...]


@dataclass(frozen=True, slots=True)
class TopicLoad:
    """What is published on a topic, and delivered to all of its readers, in B/s; message size in B."""

    size: Value
    published: Value
    delivered: Value


@dataclass(frozen=True, slots=True)
class EdgePace:
    """How producer and consumer of an arc fit together.

    `loss` is the share of samples never read, `rereads` how often each is read, `beat` the time between two slips (ns),
    `queue` the messages that can wait.
    """

    arc: Arc
    loss: Value
    rereads: Value
    beat: Value
    queue: Value


@dataclass(frozen=True, slots=True)
class ServiceLoad:
    """A server (by activity id): who calls it, and how long an answer takes at most, in ns.

    `waits` is how long one activation of a caller waits if it waits for each answer: for each of its calls the answer
    and the links both ways. `synchronous_responses` is what its response becomes then: its own R plus that.
    """

    callers: tuple[str, ...]
    worst: Value
    waits: Mapping[str, Value]
    synchronous: Mapping[str, Value]


@dataclass(frozen=True, slots=True)
class Analysis:
    """All results for one system but the chains.

    Keys are ids of activities, hosts and links, names of topics, or (activity, output key).
    """

    system: System
    paces: Mapping[str, Pace]
    outputs: Mapping[tuple[str, str], Pace]
    responses: Mapping[str, Response]
    hosts: Mapping[str, HostLoad]
    links: Mapping[str, LinkLoad]
    topics: Mapping[str, TopicLoad]
    edges: tuple[EdgePace, ...]
    endless: tuple[tuple[str, ...], ...] = ()
    """Rings of any-of triggers: an event that enters one circulates for ever."""
    deadlocked: tuple[tuple[str, ...], ...] = ()
    """Rings of all-of triggers without a first token: they never fire."""
    diverged: tuple[str, ...] = ()
    derived: Mapping[str, Pace] = field(default_factory=dict)
    """What the inputs would give for those event-driven or on-demand activities that state a period themselves."""
    services: Mapping[str, ServiceLoad] = field(default_factory=dict)
    notes: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class Term:
    """One step of a chain's bound, in ns: waiting for the sample to be read, response, link."""

    activity: str
    sampling: Value
    response: Value
    link: Value
    why: str
    at: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ChainResult:
    """A chain: its safe bound (reaction time = data age), best case, the reduced figures and the verdict; in ns."""

    id: str
    through: tuple[str, ...]
    terms: tuple[Term, ...]
    bound: Value
    best: Value
    reduced_reaction: Value
    reduced_age: Value
    deadline: Value | None
    verdict: Literal["met", "missed", "open"]
