"""The chains that a simulation follows: their activities and wires, and what all runs together showed of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise

from archgen.simulation.plan import Plan
from archgen.simulation.result import ChainSeen, Distribution, Figures
from archgen.simulation.run import Run
from archgen.simulation.series import Series, Span, Trace, quantiles, series


@dataclass(frozen=True, slots=True)
class Track:
    """A chain by numbers: its activities, the parallel wires between each two of them, and the figures of each run."""

    steps: tuple[int, ...]
    wires: tuple[tuple[int, ...], ...]
    samples: bool
    selective: bool
    """Whether an output on the way may leave inputs out."""
    every: list[Series] = field(default_factory=list)
    passing: list[Series] = field(default_factory=list)

    def add(self, run: Run) -> None:
        """Add the figures of one run."""
        trace = Trace(
            run.steps.firings[self.steps[0]],
            [_stalest(run, wires) for wires in self.wires],
            run.steps.ends[self.steps[-1]],
            [_passed(run, wires) for wires in self.wires],
            self.samples,
        )
        self.every.append(series(trace))
        if self.selective:
            self.passing.append(series(trace, passing=True))

    def seen(self, through: Sequence[str], unit: Fraction) -> ChainSeen:
        """Summarise all runs. `through` are the ids of the activities, `unit` is in ns."""
        passing = _figures(self.passing, unit) if self.selective else None
        return ChainSeen(tuple(through), _figures(self.every, unit), passing)


def nothing(through: Sequence[str]) -> ChainSeen:
    """Return the empty result of a chain along which nothing can pass."""
    return ChainSeen(tuple(through), _figures((), Fraction(1)), None)


def route(plan: Plan, way: Sequence[str]) -> Track | None:
    """Find the wires along a list of activities; None where two neighbours have no wire."""
    number = {step.id: at for at, step in enumerate(plan.steps)}
    wires = tuple(
        tuple(at for at, arc in enumerate(plan.arcs) if (arc.source, arc.target) == pair) for pair in pairwise(way)
    )
    if not way or not all(wires):
        return None
    steps = tuple(number[name] for name in way)
    selective = any(plan.wires[at].selective for pair in wires for at in pair)
    return Track(steps, wires, plan.steps[steps[0]].samples, selective)


def _stalest(run: Run, wires: Sequence[int]) -> list[int]:
    """Return for each job of an activity the oldest job of the one before it whose data it read on any of several
    wires.
    """
    return list(map(min, *(run.wires.log[wire] for wire in wires))) if len(wires) > 1 else run.wires.log[wires[0]]


def _passed(run: Run, wires: Sequence[int]) -> frozenset[int] | None:
    """Return the jobs that sent something on all of several wires; None where every job does."""
    found = [frozenset(run.wires.passed[wire]) for wire in wires if run.wires.noted[wire]]
    return frozenset.intersection(*found) if found else None


def _figures(found: Sequence[Series], unit: Fraction) -> Figures:
    """Summarise the figures of all runs, converted to ns."""
    reduced = [one.reduced_reaction for one in found if one.reduced_reaction is not None]
    reduced_ages = [one.reduced_age for one in found if one.reduced_age is not None]
    return Figures(
        _distribution([span for one in found for span in one.reactions], unit),
        _distribution([span for one in found for span in one.ages], unit),
        max(reduced) * unit if reduced else None,
        max(reduced_ages) * unit if reduced_ages else None,
        sum(one.inputs for one in found),
    )


def _distribution(spans: Sequence[Span], unit: Fraction) -> Distribution | None:
    """Summarise ranges as a distribution in ns; None where there are none."""
    if not spans:
        return None
    median, most = quantiles(spans, (0.5, 0.95))
    return Distribution(
        min(low for low, _ in spans) * unit,
        # `compute_quantiles` works in floats; the rounded fraction keeps the result exact from here on.
        Fraction(median).limit_denominator(1000) * unit,
        Fraction(most).limit_denominator(1000) * unit,
        max(high for _, high in spans) * unit,
    )
