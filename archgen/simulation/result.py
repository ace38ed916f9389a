"""What was seen in all runs together; durations in ns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class Distribution:
    """Figures as they were distributed over all seeds."""

    least: Fraction
    median: Fraction
    most_of_it: Fraction
    """95 of 100 are no larger."""
    largest: Fraction


@dataclass(frozen=True, slots=True)
class Figures:
    """What was seen of a chain: None where nothing passed along all of it. `inputs` counts what the figures are of."""

    reaction: Distribution | None
    age: Distribution | None
    reduced_reaction: Fraction | None
    reduced_age: Fraction | None
    inputs: int


@dataclass(frozen=True, slots=True)
class ChainSeen:
    """A chain: over all inputs, and over those alone that each output was published for, as its bound assumes.

    `passing` is None where no output of the chain leaves any out: then the bound holds for all inputs.
    """

    through: tuple[str, ...]
    every: Figures
    passing: Figures | None

    @property
    def comparable(self) -> Figures:
        """Give the figures that the bounds hold for."""
        return self.every if self.passing is None else self.passing


@dataclass(frozen=True, slots=True)
class ActivitySeen:
    """An activity: jobs done in all seeds, jobs a second, response times, largest gaps of activations and of ends."""

    jobs: int
    rate: Fraction
    best: Fraction | None
    worst: Fraction | None
    activation_gap: Fraction | None
    gap: Fraction | None
    silences: Mapping[str, Fraction]
    """The largest time between two publications of each conditional output."""


@dataclass(frozen=True, slots=True)
class HostSeen:
    """The share of a host's cores that was busy: over all seeds, and in the busiest one."""

    mean: Fraction
    largest: Fraction


@dataclass(frozen=True, slots=True)
class LinkSeen:
    """A link of known bandwidth: the longest time from sending to sent, and the share of time that it was busy."""

    wait: Fraction
    share: Fraction


@dataclass(frozen=True, slots=True)
class Result:
    """What was seen. Each largest figure is a lower bound on the worst case: no run shows the worst for certain."""

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
    """Figures that are not written: they were taken as nothing, or what rests on them did not run."""
