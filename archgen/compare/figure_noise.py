"""Figures that moved too little to be told one by one: they follow from others, and nothing is kept or broken by them.

This is for telling alone: whatever is judged is judged by the exact figures.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.compare.comparison import BoundaryChange, ChainChange, Comparison, FigureChange, LoadChange
from archgen.compare.interface_figures import is_close_value
from archgen.frozen import dataclass
from archgen.timing.figures.timing_values import TimingValue


@dataclass(frozen=True, slots=True)
class SmallMove:
    """A figure of an interface, a chain, a host or a link that moved by a share of what it was."""

    element: str
    figure: str
    share: Fraction


@dataclass(frozen=True, slots=True)
class FigureNoise:
    """Tells what moved by less than the project's `review.noise`."""

    comparison: Comparison

    @property
    def threshold(self) -> Fraction:
        """Return the share from which on a figure is told by itself."""
        return self.comparison.after.architecture.review.noise

    def is_small_figure(self, change: BoundaryChange, figure: FigureChange) -> bool:
        """Whether a figure of an interface moved too little, and no promise is kept otherwise by it."""
        before, after = figure.before, figure.after
        if change.kind != "changed" or change.missed_deadline or self._has_other_state(change.interface_id):
            return False
        return isinstance(before, TimingValue) and isinstance(after, TimingValue) and self._is_small(before, after)

    def is_small_chain(self, chain: ChainChange) -> bool:
        """Whether the bound of a chain moved too little, with the same deadline and the same verdict."""
        old, new = chain.before, chain.after
        if old is None or new is None or (old.verdict, old.deadline) != (new.verdict, new.deadline):
            return False
        return self._is_small(old.bound, new.bound)

    def is_small_load(self, load: LoadChange) -> bool:
        """Whether a load moved too little, and is not too much only now."""
        return (
            load.before is not None
            and ((load.before.value or 0) < 1) == ((load.after.value or 0) < 1)
            and self._is_small(load.before, load.after)
        )

    def list_moves(self) -> Iterator[SmallMove]:
        """Yield all that moved too little."""
        for change in self.comparison.boundaries:
            for figure in change.figures:
                if self.is_small_figure(change, figure):
                    yield _measure_move(change.interface_id, figure.key.name, figure.before, figure.after)
        for chain in self.comparison.chains:
            if self.is_small_chain(chain) and chain.before and chain.after:
                yield _measure_move(chain.id, "latency", chain.before.bound, chain.after.bound)
        for load in self.comparison.loads:
            if self.is_small_load(load):
                yield _measure_move(load.id, "load", load.before, load.after)

    def _is_small(self, before: TimingValue, after: TimingValue) -> bool:
        is_known = before.value is not None and after.value is not None and before.value != after.value
        return is_known and is_close_value(before, after, self.threshold)

    def _has_other_state(self, port: str) -> bool:
        return any(
            limit.old_state != limit.new_state and port in {limit.port, limit.reader}
            for limit in self.comparison.limits
        )


def _measure_move(element: str, figure: str, before: object, after: object) -> SmallMove:
    values = [each.value or Fraction(0) for each in (before, after) if isinstance(each, TimingValue)]
    return SmallMove(element, figure, abs(values[1] - values[0]) / max(abs(values[0]), abs(values[1])))
