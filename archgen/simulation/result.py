"""What was observed in all runs together. Durations are in ns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class Distribution:
    """How a duration was distributed over all seeds, in ns."""

    least: Fraction
    median: Fraction
    most_of_it: Fraction
    """The 95th percentile."""
    largest: Fraction


@dataclass(frozen=True, slots=True)
class Figures:
    """The figures of a chain, None where nothing passed along all of it. `input_count` is the number of inputs behind
    them.
    """

    reaction: Distribution | None
    age: Distribution | None
    reduced_reaction: Fraction | None
    reduced_age: Fraction | None
    inputs: int


@dataclass(frozen=True, slots=True)
class ChainSeen:
    """A chain: over all inputs, and over only those inputs for which each output was published, as its bound assumes.

    `forwarded_inputs` is None where no output of the chain leaves any input out: then the bound holds for all of them.
    """

    through: tuple[str, ...]
    every: Figures
    passing: Figures | None

    @property
    def comparable(self) -> Figures:
        """The figures that the bounds hold for."""
        return self.every if self.passing is None else self.passing


@dataclass(frozen=True, slots=True)
class ActivitySeen:
    """An activity: jobs done in all seeds, jobs a second, response times, and largest gaps between activations and
    ends.
    """

    jobs: int
    rate: Fraction
    best: Fraction | None
    worst: Fraction | None
    activation_gap: Fraction | None
    gap: Fraction | None
    silences: Mapping[str, Fraction]
    """The longest time between two publications, by conditional output."""


@dataclass(frozen=True, slots=True)
class HostSeen:
    """The busy share of a host's cores: over all seeds, and in the busiest one."""

    mean: Fraction
    largest: Fraction


@dataclass(frozen=True, slots=True)
class LinkSeen:
    """A link of known bandwidth: the longest wait from sending until sent (in ns), and the share of time that it was
    busy.
    """

    wait: Fraction
    share: Fraction


@dataclass(frozen=True, slots=True)
class Result:
    """What was observed. Each maximum is a lower bound on the worst case: no run is certain to show the worst."""

    seconds: int
    seeds: int
    events: int
    activities: Mapping[str, ActivitySeen]
    chains: Mapping[str, ChainSeen]
    hosts: Mapping[str, HostSeen]
    links: Mapping[str, LinkSeen]
    drops: Mapping[tuple[str, str, str], int]
    """Samples pushed out of a queue unread, by activity, input and topic."""
    unknown: tuple[str, ...]
    """Figures that are not written: they were taken as nothing, or what depends on them did not run."""
