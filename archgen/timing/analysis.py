"""What follows from a system: how often things happen, how long they take, what hosts and links carry."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.model.declared_timing import ActivityBehaviour, SchedulingOrder
from archgen.model.node import Endpoint
from archgen.model.quantity import write_share
from archgen.timing.figures.figure_wording import describe_timing_value, format_duration
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, ResponseTier, TimingValue, is_known_bound
from archgen.timing.system import activity_builder
from archgen.timing.system.timing_system import Arc, TimingSystem

if TYPE_CHECKING:
    from archgen.timing.load.propagation_state import PropagationState


ChainVerdict = Literal["met", "missed", "not proven", "open"]
"""What is known of a chain's deadline: it is `met` at all times; it can be `missed` (an overload, a best case above it, a run that was late);
it is `not proven`, since the bound is above it, or none was found; it is `open`, since figures are missing.
"""


@dataclass(frozen=True, slots=True)
class Reason:
    """One step of the reasoning behind a figure: a sentence, and where in the files it rests on.

    It is put into words only when somebody asks for it: `template` is the sentence, with `{0}`, `{1}` for its
    `arguments`.
    """

    template: str
    # Places take no part in equality: a figure is the same wherever it is written (run_analysis compares them on its
    # own).
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    arguments: tuple[str | int | Fraction | TimingValue, ...] = ()

    @property
    def text(self) -> str:
        """Return the sentence."""
        return self.template.format(*map(_format_argument, self.arguments)) if self.arguments else self.template


def _format_argument(argument: str | int | Fraction | TimingValue) -> str:
    """Format an argument of a sentence: a value is a rate, a Fraction a duration in ns."""
    if isinstance(argument, TimingValue):
        return describe_timing_value(argument, "Hz")
    return format_duration(argument) if isinstance(argument, Fraction) else str(argument)


@dataclass(frozen=True, slots=True)
class EventPace:
    """How often an activity is activated, or an output published.

    `rate` in Hz; `gap` is the largest gap between two events, in ns (not the inverse of the rate: see docs/timing.md).
    `inferred` is False where the rate is written. `jitter` and `distance` (smallest gap), in ns, complete the event
    model.
    """

    behaviour: ActivityBehaviour | None
    rate: TimingValue = UNKNOWN_VALUE
    gap: TimingValue = UNKNOWN_VALUE
    jitter: TimingValue = UNKNOWN_VALUE
    distance: TimingValue = UNKNOWN_VALUE
    inferred: bool = True
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class ResponseTime:
    """From activation to completion, in ns: best and worst case, and how the worst was found."""

    best: TimingValue
    worst: TimingValue
    tier: ResponseTier
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class MatchFigures:
    """What is sure of an activity whose inputs are matched by time, in ns.

    `gap` is the largest between two matches. By input key: `waits` from the arrival of a message until an activation uses
    it or a newer one, `ages` from a message's time (the activation of its source) until the activation that uses it.
    """

    gap: TimingValue
    waits: Mapping[str, TimingValue]
    ages: Mapping[str, TimingValue]


@dataclass(frozen=True, slots=True)
class RunResponse:
    """How long a run takes at most, in ns: from the event that enters a core until an activity there has ended.

    `arcs` are the arcs by which a run comes to the activity: it starts at the end of the one before, on the same core, or
    behind a link.
    """

    worst: TimingValue
    arcs: tuple[Arc, ...]


@dataclass(frozen=True, slots=True)
class HostLoad:
    """A host's utilisation (of all its cores together), and the bounds that it is compared with."""

    utilisation: TimingValue
    cores: int | None
    """None where nobody wrote how many there are, and it matters."""
    rate_monotonic_bound: TimingValue
    verdict: Literal["schedulable", "overload", "undecided", "unknown"]
    activity_shares: tuple[tuple[str, TimingValue], ...]
    """What each activity adds."""
    core_loads: tuple[tuple[str, int, TimingValue], ...] = ()
    """The cores to which something is pinned, and those that everything else shares: name, cores, utilisation.

    Cores that nobody wrote the number of are left out.
    """
    earliest_deadline_bound: TimingValue = UNKNOWN_VALUE
    unproven: tuple[str, ...] = ()
    """The activities that nothing proves to be done by their deadline, or before they are activated again."""

    @property
    def share_of_cores(self) -> TimingValue | None:
        """Return the utilisation as a share of all cores; None where nobody knows how many there are."""
        if self.cores is None or self.utilisation.value is None:
            return None if self.cores is None else self.utilisation
        return replace(self.utilisation, value=self.utilisation.value / self.cores)


@dataclass(frozen=True, slots=True)
class ResourceLoad:
    """What is asked of a resource that works on one use at a time (a GPU).

    `waits` are, by activity, the longest time in ns from the moment at which it asks for the resource until it is done
    with it; `shares` is what each adds to the utilisation.
    """

    host: str | None
    order: SchedulingOrder | None
    utilisation: TimingValue
    verdict: Literal["bearable", "overload", "unknown"]
    shares: tuple[tuple[str, TimingValue], ...]
    waits: Mapping[str, TimingValue]


@dataclass(frozen=True, slots=True)
class LinkLoad:
    """Traffic on a link in B/s, its share of the bandwidth, the burst in B and the longest queueing in ns."""

    traffic: TimingValue
    share: TimingValue
    burst: TimingValue
    queueing: TimingValue
    topic_traffic: tuple[tuple[str, TimingValue], ...]
    longest_sending: tuple[Fraction, str] | None = None
    """How long the largest message takes by the bandwidth alone, in ns, and its topic; None where either is unknown."""


@dataclass(frozen=True, slots=True)
class TopicLoad:
    """What is published on a topic, and delivered to all of its readers, in B/s; message size in B."""

    size: TimingValue
    published: TimingValue
    delivered: TimingValue


@dataclass(frozen=True, slots=True)
class EdgeFit:
    """How producer and consumer of an arc fit together.

    `loss` is the share of samples never read, `rereads` how often each is read, `beat` the time between two slips (ns),
    `queue` the messages that can wait.
    """

    arc: Arc
    loss: TimingValue
    rereads: TimingValue
    beat: TimingValue
    queue: TimingValue


@dataclass(frozen=True, slots=True)
class ServiceLoad:
    """A server (by activity id): who calls it, and how long an answer takes at most, in ns.

    `waits` is how long one activation of a caller waits if it waits for each answer: for each of its calls the answer
    and the links both ways. `synchronous_responses` is what its response becomes then: its own R plus that.
    """

    callers: tuple[str, ...]
    worst: TimingValue
    waits: Mapping[str, TimingValue]
    synchronous_responses: Mapping[str, TimingValue]


@dataclass(frozen=True, slots=True)
class Analysis:
    """All results for one system but the chains.

    Keys are ids of activities, hosts and links, names of topics, or (activity, output key).
    """

    system: TimingSystem
    paces: Mapping[str, EventPace]
    outputs: Mapping[tuple[str, str], EventPace]
    responses: Mapping[str, ResponseTime]
    hosts: Mapping[str, HostLoad]
    links: Mapping[str, LinkLoad]
    topics: Mapping[str, TopicLoad]
    edges: tuple[EdgeFit, ...]
    endless: tuple[tuple[str, ...], ...] = ()
    """Rings of any-of triggers: an event that enters one circulates for ever."""
    deadlocked: tuple[tuple[str, ...], ...] = ()
    """Rings of all-of triggers without a first token: they never fire."""
    diverged: tuple[str, ...] = ()
    derived: Mapping[str, EventPace] = field(default_factory=dict)
    """What the inputs would give for those event-driven or on-demand activities that state a period themselves."""
    services: Mapping[str, ServiceLoad] = field(default_factory=dict)
    runs: Mapping[str, RunResponse] = field(default_factory=dict)
    """The runs that end at each activity that something on its own core fires."""
    host_runs: Mapping[str, RunResponse] = field(default_factory=dict)
    """The same over hosts that fire one another in turn, pinned cores and links."""
    matches: Mapping[str, MatchFigures] = field(default_factory=dict)
    """What is sure of those whose inputs are matched by time."""
    resources: Mapping[str, ResourceLoad] = field(default_factory=dict)
    """The load of GPUs and other resources that work on one use at a time."""
    storing_waits: Mapping[str, TimingValue] = field(default_factory=dict)
    """How long a message may wait to be stored while its reader is activated, by reader, in ns."""
    notes: tuple[Reason, ...] = ()
    # Kept for whoever asks why: the terms of a figure are read off the very state that it was found in.
    state: PropagationState | None = field(default=None, compare=False, repr=False)
    searched_terms: int = field(default=0, compare=False, repr=False)
    """How many terms the searches looked at: what the analysis has cost, on whatever computer."""


@dataclass(frozen=True, slots=True)
class ChainTerm:
    """One step of a chain's bound, in ns: waiting for the sample to be read, response, link."""

    activity: str
    sampling: TimingValue
    response: TimingValue
    link: TimingValue
    why: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    counted_at: str = ""
    """The activity at which the time of this one is counted, as far as `response` does not say more; empty: at this one."""


@dataclass(frozen=True, slots=True)
class ShareDeadline:
    """How long a share of a chain's reactions may take, in ns. Only what holds for all of them is proven: else it is open."""

    share: Fraction
    limit: Fraction
    verdict: Literal["met", "missed", "open"]

    @property
    def name(self) -> str:
        """Return the share as it is written: `95 %`."""
        return write_share(self.share)


class DrawnOrder(NamedTuple):
    """Who goes first at a place (`navbox`, `pc`, `gpu`), in words, where several wait there and no order is written."""

    place: str
    words: str


@dataclass(frozen=True, slots=True)
class LateRun:
    """A run in which a chain took longer than its deadline: `archgen simulate --seed SEED --seconds SECONDS`."""

    seed: int
    seconds: int
    longest: Fraction
    """What the chain took in it, in ns: its longest reaction, or its oldest data where it samples the world."""
    orders: tuple[DrawnOrder, ...] = ()
    """The orders of what the chain comes to, where nobody wrote one."""

    def write_command(self, chain_id: str) -> str:
        """Return the command that shows the run again."""
        return f"archgen simulate --chain {chain_id} --seed {self.seed} --seconds {self.seconds}"


@dataclass(frozen=True, slots=True)
class ChainResult:
    """A chain: its safe bound (reaction time = data age), best case, the reduced figures and the verdict; in ns."""

    id: str
    through: tuple[str, ...]
    terms: tuple[ChainTerm, ...]
    bound: TimingValue
    best: TimingValue
    reduced_reaction: TimingValue
    reduced_age: TimingValue
    deadline: TimingValue | None
    verdict: ChainVerdict
    shares: tuple[ShareDeadline, ...] = ()
    """What is asked of shares of its reactions, the smallest first."""
    late_run: LateRun | None = None
    """The run that shows that it can be late, where bounds alone do not prove that (`simulation.judge_chains`)."""

    def find_limit(self, share: Fraction) -> Fraction | None:
        """Return how long a share of the reactions may take at most, as is asked of it or of more of them; None for any time."""
        always = [self.deadline.value] if self.deadline and self.deadline.value is not None else []
        return min((*always, *(each.limit for each in self.shares if each.share >= share)), default=None)

    @property
    def spread(self) -> Fraction | None:
        """Return by how much its end may jitter, from the best case to the bound, in ns; None where one is not known."""
        if self.bound.value is None or self.best.value is None:
            return None
        is_known = is_known_bound(self.bound) and is_known_bound(self.best, "at least")
        return self.bound.value - self.best.value if is_known else None

    @property
    def slack(self) -> Fraction | None:
        """Return what the bound leaves of the deadline, in ns: negative where it is above; None where either is unknown."""
        if self.deadline is None or self.deadline.value is None or self.bound.value is None:
            return None
        return self.deadline.value - self.bound.value if is_known_bound(self.bound) else None


def find_pace(analysis: Analysis, activity_names: activity_builder.ActivityNames, endpoint: Endpoint) -> EventPace:
    """Return how often something is published at an endpoint."""
    activity = activity_builder.activity_of_endpoint(activity_names, endpoint)
    return analysis.outputs.get((activity, activity_builder.endpoint_key(endpoint)), EventPace(None))
