"""Tighter bounds for chains of periodic elements under fixed priorities, with implicit communication.

M. Duerr, G. von der Brueggen, K.-H. Chen, J.-J. Chen: "End-to-End Timing Analysis of Sporadic Cause-Effect Chains in
Distributed Systems", ACM TECS 18(5s), 2019, doi:10.1145/3358181. They rest on more than archgen's own bound does: each
element reads at its start and writes at its end, is preempted by fixed priorities, and no link lies between.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.system import Activity


@dataclass(frozen=True, slots=True)
class Task:
    """A periodic element of a chain: period (largest gap) and largest response, in any one unit."""

    period: Fraction
    response: Fraction


def reaction(tasks: Sequence[Task], ahead: Sequence[bool]) -> Fraction:
    """Bound the reaction time: T_1 + R_n + sum over i < n of max(R_i, T_(i+1) + p_i R_i).

    `precedence[i]` says that i and its successor share a processor and i has the higher priority (p_i = 0).
    """
    waits = (
        max(one.response, after.period + (Fraction(0) if first else one.response))
        for (one, after), first in zip(pairwise(tasks), ahead, strict=True)
    )
    return tasks[0].period + tasks[-1].response + sum(waits, Fraction(0))


def reduced_age(tasks: Sequence[Task], ahead: Sequence[bool]) -> Fraction:
    """Bound the age of data when the last element writes: R_n + sum over i < n of (T_i + p_i R_i)."""
    lies = (one.period + (Fraction(0) if first else one.response) for one, first in zip(tasks[:-1], ahead, strict=True))
    return tasks[-1].response + sum(lies, Fraction(0))


def of_chain(analysis: Analysis, through: Sequence[str]) -> tuple[Fraction, Fraction] | None:
    """Return reaction time and reduced data age, in ns, of a chain that the bounds hold for; None for any other."""
    activities = [analysis.system.activities[name] for name in through]
    tasks: list[Task] = []
    for activity in activities:
        gap, response = analysis.paces[activity.id].gap, analysis.responses[activity.id]
        if activity.behaviour != "periodic" or gap.value is None or response.worst.value is None:
            return None
        if not gap.complete or not response.worst.complete or response.tier not in {"priorities", "declared"}:
            return None
        tasks.append(Task(gap.value, response.worst.value))
    if len(tasks) < 2 or any(not _local(analysis, *pair) for pair in pairwise(activities)):  # noqa: PLR2004 - a pair
        return None
    ahead = [_ahead(*pair) for pair in pairwise(activities)]
    return reaction(tasks, ahead), reduced_age(tasks, ahead)


def _local(analysis: Analysis, one: Activity, other: Activity) -> bool:
    """Whether data passes from one activity to another without taking time."""
    arcs = [arc for arc in analysis.system.out_of.get(one.id, ()) if arc.target == other.id]
    return bool(arcs) and all(arc.worst == 0 for arc in arcs)


def _ahead(one: Activity, other: Activity) -> bool:
    """Whether two activities share a core and the first one has the higher priority."""
    if one.host is None or one.host != other.host or one.core != other.core:
        return False
    return one.priority is not None and other.priority is not None and one.priority > other.priority
