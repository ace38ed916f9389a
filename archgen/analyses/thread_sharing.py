"""Do callbacks that share a thread leave one another enough of it?"""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.system.thread_pools import name_lane

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis
    from archgen.timing.system.timing_system import Activity


def long_callback(_: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
    """A callback takes longer than the period of another one that waits for the same thread."""
    members_by_thread: dict[str, list[Activity]] = defaultdict(list)
    for activity in analysis.system.activities.values():
        members_by_thread[name_lane(analysis.system, activity)].append(activity)
    for members in members_by_thread.values():
        if len(members) > 1:
            yield from _find_long_callbacks(analysis, members)


def _find_long_callbacks(analysis: Analysis, members: Sequence[Activity]) -> Iterator[Diagnostic]:
    """Yield a finding for each callback of a thread that lets another one miss a tick, with the most frequent of these."""
    # What others fire is due whenever they do: how late it may come is for chains to say.
    timed = [(member.period, member) for member in members if member.behaviour == "periodic" and member.period]
    timed.sort(key=lambda pair: pair[0])
    for slow in members:
        # While it uses a resource, it keeps its thread.
        held = (slow.wcet or 0) + sum(use.worst for use in slow.uses.values())
        delayed = [(period, member) for period, member in timed if period < held and member is not slow]
        if not delayed:
            continue
        period, first = delayed[0]
        more_count = len(delayed) - 1
        more_text = f", and of {more_count} more timer{'s' if more_count > 1 else ''}" if more_count else ""
        period_span = first.places.get("period", first.places.get("rate", NO_SPAN))
        held_text, period_text = (format_duration(Fraction(ticks * analysis.system.tick)) for ticks in (held, period))
        yield Diagnostic(
            "long-callback",
            f"`{slow.id}`, {held_text}, shares the thread of `{first.id}`, which is due every {period_text}{more_text}",
            slow.places.get("wcet", slow.at),
            labels=(Label(period_span, "due in the meantime"),) if period_span != NO_SPAN else (),
            help=f"`archgen timing --why {first.id}` shows how late it may come, `archgen timing --propose` what helps chains "
            "that are late for it",
            element=slow.node,
        )


RULES = ((long_callback, Severity.WARNING),)
