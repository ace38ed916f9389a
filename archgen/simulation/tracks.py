"""The chains that a simulation follows: their steps and wires, and what all runs together showed of each."""

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
    """A chain by numbers: its steps, the wires between each two of them, and what each run showed."""

    steps: tuple[int, ...]
    wires: tuple[tuple[int, ...], ...]
    samples: bool
    selective: bool
    """Whether an output on the way may leave inputs out."""
    every: list[Series] = field(default_factory=list)
    passing: list[Series] = field(default_factory=list)

    def add(self, run: Run) -> None:
        """Read one run's figures."""
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
        """Give what all runs showed."""
        passing = _figures(self.passing, unit) if self.selective else None
        return ChainSeen(tuple(through), _figures(self.every, unit), passing)


def nothing(through: Sequence[str]) -> ChainSeen:
    """Give what is seen of a chain that nothing can pass along."""
    return ChainSeen(tuple(through), _figures((), Fraction(1)), None)


def route(plan: Plan, way: Sequence[str]) -> Track | None:
    """Follow a way of activities; None where a step has no wire."""
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
    """Tell for each job of an activity which job of the one before it has reached it by all of several arcs."""
    return list(map(min, *(run.wires.log[wire] for wire in wires))) if len(wires) > 1 else run.wires.log[wires[0]]


def _passed(run: Run, wires: Sequence[int]) -> frozenset[int] | None:
    """Tell which jobs sent something on all of several arcs; None where all do."""
    found = [frozenset(run.wires.passed[wire]) for wire in wires if run.wires.noted[wire]]
    return frozenset.intersection(*found) if found else None


def _figures(found: Sequence[Series], unit: Fraction) -> Figures:
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
    if not spans:
        return None
    median, most = quantiles(spans, (0.5, 0.95))
    return Distribution(
        min(low for low, _ in spans) * unit,
        Fraction(median).limit_denominator(1000) * unit,
        Fraction(most).limit_denominator(1000) * unit,
        max(high for _, high in spans) * unit,
    )
