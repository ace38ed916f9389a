"""What was observed in all runs together. Durations are in ns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.frozen import NamedTuple, dataclass, field
from archgen.simulation.chain_series import TimeRange, compute_quantiles
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_verdicts import SeenVerdict, judge_seen_share


@dataclass(frozen=True, slots=True)
class DurationDistribution:
    """How a duration was distributed over all seeds, in ns."""

    least: Fraction
    median: Fraction
    percentile_95: Fraction
    """The 95th percentile."""
    largest: Fraction
    ranges: Sequence[TimeRange] = field(default=(), repr=False, compare=False)
    """All that was seen, in units of so many ns."""
    unit: Fraction = Fraction(1)

    def find_quantile(self, share: Fraction) -> Fraction:
        """Return how long the share takes at most that is over first."""
        # `compute_quantiles` works in floats; the rounded fraction keeps the result exact from here on.
        return Fraction(*compute_quantiles(self.ranges, (float(share),))).limit_denominator(1000) * self.unit


@dataclass(frozen=True, slots=True)
class ChainFigures:
    """The figures of a chain, None where nothing passed along all of it. `input_count` is the number of inputs behind
    them.
    """

    reaction: DurationDistribution | None
    age: DurationDistribution | None
    reduced_reaction: Fraction | None
    reduced_age: Fraction | None
    input_count: int


@dataclass(frozen=True, slots=True)
class ObservedChain:
    """A chain: over all inputs, and over only those inputs for which each output was published, as its bound assumes.

    `forwarded_inputs` is None where no output of the chain leaves any input out: then the bound holds for all of them.
    """

    through: tuple[str, ...]
    all_inputs: ChainFigures
    forwarded_inputs: ChainFigures | None
    latest_seed: int | None = None
    """The run in which it took longest; None where nothing passed along it."""

    @property
    def bounded_figures(self) -> ChainFigures:
        """The figures that the bounds hold for."""
        return self.all_inputs if self.forwarded_inputs is None else self.forwarded_inputs


class SeenShare(NamedTuple):
    """The deadline of a share (`95 %`) of a chain's reactions, in ns, beside what that share took; None if none was seen."""

    share: str
    limit: Fraction
    seen: Fraction | None
    verdict: SeenVerdict


def list_seen_shares(observed: ObservedChain, result: ChainResult) -> Iterator[SeenShare]:
    """Yield the deadlines of shares of a chain, judged by what was seen, over the inputs that its bound holds for."""
    figures = observed.bounded_figures
    for asked in result.shares:
        seen = figures.reaction.find_quantile(asked.share) if figures.reaction else None
        verdict = judge_seen_share(asked.share, asked.limit, seen, figures.input_count)
        yield SeenShare(asked.name, asked.limit, seen, verdict)


@dataclass(frozen=True, slots=True)
class ObservedActivity:
    """An activity: jobs done in all seeds, jobs a second, response times, and largest gaps between activations and
    ends.
    """

    jobs: int
    rate: Fraction
    best_response: Fraction | None
    worst_response: Fraction | None
    activation_gap: Fraction | None
    end_gap: Fraction | None
    output_silences: Mapping[str, Fraction]
    """The longest time between two publications, by conditional output."""
    read_ages: Mapping[str, Fraction] = field(default_factory=dict)
    """By input that fires nobody: the longest time from sending a message to the start of a job that read it."""
    fused_age: Fraction | None = None
    """The longest time since the oldest stamp among matched messages, at the start of a job; None if none was."""
    fused_spread: Fraction | None = None
    """The longest time between the stamps of matched messages."""


@dataclass(frozen=True, slots=True)
class ObservedHost:
    """The busy share of a host's cores: over all seeds, and in the busiest one."""

    mean_load: Fraction
    largest_load: Fraction


@dataclass(frozen=True, slots=True)
class ObservedLink:
    """A link of known bandwidth: the longest wait from sending until sent (in ns), and the share of time that it was
    busy.
    """

    wait: Fraction
    share: Fraction


@dataclass(frozen=True, slots=True)
class SimulationResult:
    """What was observed. Each maximum is a lower bound on the worst case: no run is certain to show the worst."""

    seconds: int
    seeds: int
    first_seed: int
    events: int
    activities: Mapping[str, ObservedActivity]
    chains: Mapping[str, ObservedChain]
    hosts: Mapping[str, ObservedHost]
    links: Mapping[str, ObservedLink]
    drops: Mapping[tuple[str, str, str], int]
    """Samples pushed out of a queue unread, by activity, input and topic."""
    unknown_figures: tuple[str, ...]
    """Figures that are not written: they were taken as nothing, or what depends on them did not run."""
