"""The costs of steps as whole numbers, so that paths through thousands of activities are compared exactly and fast."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from math import lcm
from typing import Literal

from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.paths import Graph, Hop
from archgen.timing.steps import Steps
from archgen.timing.sums import boundless, known
from archgen.timing.system import Arc
from archgen.timing.value import ZERO, Value

Aim = Literal["bound", "reduced reaction", "reduced age", "best"]
"""What a path is extreme in: three kinds of longest paths, and `best`, the shortest one."""
_UNKNOWN_BITS = 24
"""Bits below the figures that break ties by how much is unknown: a path with gaps precedes an equal one without."""


@dataclass(frozen=True, slots=True)
class Network:
    """A system's activities as vertices, its arcs with their costs for each aim. Costs are computed on first use."""

    steps: Steps
    names: tuple[str, ...]
    index: dict[str, int]
    _costs: dict[Aim, tuple[Graph, list[int]]] = field(default_factory=dict)

    @classmethod
    def of(cls, analysis: Analysis) -> Network:
        """Prepare an analysis for questions about paths."""
        names = tuple(analysis.system.activities)
        return cls(Steps.of(analysis), names, {name: at for at, name in enumerate(names)})

    @property
    def arcs(self) -> tuple[Arc, ...]:
        """Return the system's arcs; `Hop.arc` is an index into them."""
        return self.steps.analysis.system.arcs

    def graph(self, aim: Aim) -> tuple[Graph, list[int]]:
        """Return the graph with the costs of an aim, and what each vertex costs as a start."""
        if aim not in self._costs:
            self._costs[aim] = self._made(aim)
        return self._costs[aim]

    def start(self, name: str, aim: Aim) -> tuple[Value, ...]:
        """Return what the first activity of a path adds."""
        if aim == "best":
            return (self.steps.response(name, worst=False),)
        return (self.steps.start(name).value if aim == "bound" else ZERO, self.steps.response(name))

    def step(self, arc: Arc, aim: Aim) -> tuple[Value, ...]:
        """Return what a step adds: link, sampling (or holding), response."""
        if aim == "best":
            return (self.steps.link(arc, worst=False), self.steps.response(arc.target, worst=False))
        waits = self.steps.holding(arc) if aim == "reduced age" else self.steps.sampling(arc)
        return (self.steps.link(arc), waits, self.steps.response(arc.target))

    def _made(self, aim: Aim) -> tuple[Graph, list[int]]:
        """Build the graph of an aim."""
        starts = [self.start(name, aim) for name in self.names]
        steps = [self.step(arc, aim) for arc in self.arcs]
        weigh = _scale([*starts, *steps])
        graph: list[list[Hop]] = [[] for _ in self.names]
        for at, (arc, parts) in enumerate(zip(self.arcs, steps, strict=True)):
            graph[self.index[arc.source]].append(Hop(self.index[arc.target], weigh(parts), at))
        return graph, [weigh(parts) for parts in starts]


def _scale(rows: list[tuple[Value, ...]]) -> Callable[[tuple[Value, ...]], int]:
    """Return the function that turns figures into one whole number.

    What is boundless outweighs any sum of what is not; unknown figures count only where everything else is equal.
    """
    # By identity: step delays share their value objects, and hashing Fractions is slow. The rows keep the values alive,
    # so that no id is used twice.
    distinct = {id(value): value for row in rows for value in row}
    unit = lcm(*(value.value.denominator for value in distinct.values() if value.value is not None))
    exact = {
        key: value.value.numerator * (unit // value.value.denominator) if value.value is not None else 0
        for key, value in distinct.items()
    }
    # More than any sum of figures, ties included: a path visits each arc at most once.
    largest = max((abs(number) for number in exact.values()), default=0) * sum(map(len, rows))
    beyond = 1 << (largest.bit_length() + _UNKNOWN_BITS + 1)
    weights = {
        key: beyond if boundless(value) else (exact[key] << _UNKNOWN_BITS) + (0 if known(value) else 1)
        for key, value in distinct.items()
    }
    # It knows the given values only: parts that were not in `rows` raise KeyError.
    return lambda parts: sum([weights[id(part)] for part in parts])
