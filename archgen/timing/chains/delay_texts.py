"""The words for why a step of a chain takes as long as it does."""

from __future__ import annotations

from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import is_known_bound
from archgen.timing.system.timing_system import Activity


def write_gap(gap: TimingValue) -> str:
    """Return the words for a reader's gap, where it is a bound."""
    return (
        f" every {figure_wording.format_duration(gap.value)} at the latest"
        if gap.value is not None and is_known_bound(gap)
        else ""
    )


def write_overtaking(wait: TimingValue) -> str:
    """Return the words for the time for which an older message may stand in a newer one's place."""
    if not wait.value or not is_known_bound(wait):
        return ""
    return f", which an older one may replace for {figure_wording.format_duration(wait.value)}"


def write_storing(wait: TimingValue) -> str:
    """Return the words for the time that a message may wait to be stored."""
    if wait.value is None or not wait.value:
        return ""
    return f", which may wait {figure_wording.format_duration(wait.value)} to be stored"


def write_thinning(activity: Activity) -> str:
    """Return the words for what lets a trigger wait."""
    phrases = [f"fires only once for {activity.every} triggers"] if activity.every > 1 else []
    if activity.throttle:
        phrases.append("keeps a smallest gap")
    if activity.jitter:
        phrases.append("starts late by its jitter")
    return f"; {', '.join(phrases)}" if phrases else ""
