"""What recordings give: samples by element and figure, and what of them has no place in the design."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from typing import Literal

from archgen.plugin.findings import Diagnostic
from archgen.plugin.importing import Span
from archgen.plugin.model import Quantity
from archgen.plugin.timing import Observation, SampleCounter, SampleStatistics, UnmappedSamples, format_duration

SampleKind = Literal["execution", "storing", "period", "latency"]
"""Execution times of an activity; those of the callback that stores an input; times between two activations, or two
messages of a topic; latencies of a chain.
"""


class RecordedFigures:
    """Collects what readers find in one or several recordings."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.observations: list[Observation] = []
        """Figures that a recording gives as such, and not as samples."""
        self.partial_activities: set[str] = set()
        """Activities of which some callbacks do not do the whole work: the quickest is not their best case."""
        self._samples: dict[tuple[str, SampleKind], tuple[SampleCounter, Span]] = {}
        self._unmapped: dict[tuple[str, str], UnmappedSamples] = {}

    def add_samples(self, element: str, kind: SampleKind, samples: SampleCounter, at: Span) -> None:
        """Add samples of an element's figure; those of several recordings count together."""
        if not samples.count:
            return
        known_samples = self._samples.get((element, kind))
        if known_samples is None:
            known_samples = self._samples[element, kind] = (SampleCounter(), at)
        known_samples[0].add_samples(samples)

    def add_unmapped(self, name: str, count: int, why: str, at: Span) -> None:
        """Add what could not be mapped to the design."""
        earlier = self._unmapped.get((name, why))
        self._unmapped[name, why] = UnmappedSamples(
            name, count + (earlier.count if earlier else 0), why, earlier.at if earlier else at
        )

    @property
    def unmapped(self) -> tuple[UnmappedSamples, ...]:
        """Everything that could not be mapped, sorted."""
        return tuple(sorted(self._unmapped.values(), key=lambda samples: (samples.name, samples.why)))

    def list_observations(self) -> tuple[Observation, ...]:
        """Return an observation for each element, by its id; then those that recordings gave as such."""
        statistics: dict[str, dict[str, SampleStatistics]] = defaultdict(dict)
        places: dict[str, Span] = {}
        for (element, kind), (counter, at) in sorted(self._samples.items(), key=lambda item: item[0]):
            statistics[element][kind] = counter.summarise()
            places.setdefault(element, at)
        return (
            *(
                Observation(element, self._choose_figures(element, samples), places[element], samples)
                for element, samples in statistics.items()
            ),
            *self.observations,
        )

    def _choose_figures(self, element: str, samples: dict[str, SampleStatistics]) -> dict[str, Quantity]:
        """Return the figures that the design has a counterpart of."""
        values: dict[str, Fraction] = {}
        if period := samples.get("period"):
            values["period"] = Fraction(period.total, period.count)
            # Of an activity the trace knows when callbacks begin, which is later than their activation by as much as they
            # wait: only the mean says something about the gaps that the bounds rest on.
            if element.startswith("/"):
                values |= {"min_period": Fraction(period.least), "max_period": Fraction(period.largest)}
        if execution := samples.get("execution"):
            if element not in self.partial_activities:
                values["bcet"] = Fraction(execution.least)
            values["wcet"] = Fraction(execution.largest)
        values |= {kind: Fraction(samples[kind].largest) for kind in ("storing", "latency") if kind in samples}
        return {key: make_duration(value) for key, value in values.items() if value or key != "period"}


def make_duration(ns: Fraction) -> Quantity:
    """Return a duration with its text."""
    return Quantity(ns, format_duration(ns))
