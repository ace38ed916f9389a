"""Figures that are tried in steps: execution times, responses and periods, each step a tick of its own."""

from __future__ import annotations

from fractions import Fraction

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.timing.figures.figure_wording import write_exact_duration
from archgen.timing.figures.tick_unit import written_period
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.system.timing_system import Activity

_TICK = 1_000
"""What a figure is tried in, in ns: a microsecond."""
_FINE_TICK, _MAX_FINE = 1, 100_000
"""What figures below the latter are tried in: a nanosecond."""


@dataclass(frozen=True, slots=True)
class TriedFigure:
    """A written duration of one activity (`wcet`, `response`, `period`), and what it is counted in; both in ns."""

    activity: Activity
    key: str
    written: Fraction
    tick: int
    least: Fraction = Fraction(0)
    """What it cannot be below: an execution time is not less than the best one."""

    @property
    def written_step(self) -> int:
        """Return the written value in whole ticks, rounded down."""
        return int(self.written // self.tick)

    @property
    def least_step(self) -> int:
        """Return the least value in whole ticks, at least one."""
        return max(1, int(-(-self.least // self.tick)))

    def grow_by(self, factor: Fraction) -> Fraction:
        """Return what is written times a factor, in ns; not less than it can be."""
        return max(self.written * factor, self.least)

    def change_to(self, step: int) -> TriedChange:
        """Return the change that sets the figure to a number of ticks."""
        return self.change_to_duration(Fraction(step * self.tick))

    def change_to_duration(self, duration: Fraction) -> TriedChange:
        """Return the change that sets the figure to a duration in ns."""
        return TriedChange(self.activity.id, f"timing.{self.key}", write_exact_duration(duration).replace(" ", ""))


def find_execution_time(architecture: Architecture, activity: Activity) -> TriedFigure | None:
    """Return the execution time of an activity, or the response that is written instead; None where neither is."""
    timing = architecture.nodes[activity.node].timing.get(activity.component or "")
    if timing is None:
        return None
    if timing.response is not None:
        return _make_figure(activity, "response", timing.response.value)
    least = timing.bcet.value if timing.bcet else Fraction(0)
    return _make_figure(activity, "wcet", timing.wcet.value, least) if timing.wcet else None


def find_own_period(architecture: Architecture, activity: Activity) -> TriedFigure | None:
    """Return the period of an activity that works by its own clock, written as a period or as a rate."""
    timing = architecture.nodes[activity.node].timing.get(activity.component or "")
    period = written_period(timing) if timing and activity.behaviour == "periodic" else None
    return _make_figure(activity, "period", period) if period else None


def _make_figure(activity: Activity, key: str, written: Fraction, least: Fraction = Fraction(0)) -> TriedFigure:
    return TriedFigure(activity, key, written, _FINE_TICK if written < _MAX_FINE else _TICK, least)
