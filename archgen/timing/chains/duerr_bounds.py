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
from archgen.timing.figures.timing_values import ZERO_VALUE
from archgen.timing.system.timing_system import Activity, is_sampled


@dataclass(frozen=True, slots=True)
class PeriodicTask:
    """A periodic element of a chain: period (largest gap) and largest response, in any one unit."""

    period: Fraction
    response: Fraction


def bound_reaction(tasks: Sequence[PeriodicTask], precedence: Sequence[bool]) -> Fraction:
    """Bound the reaction time: T_1 + R_n + sum over i < n of max(R_i, T_(i+1) + p_i R_i).

    `precedence[i]` says that i and its successor share a processor and i has the higher priority (p_i = 0).
    """
    wait_terms = (
        max(task.response, next_task.period + (Fraction(0) if is_ahead else task.response))
        for (task, next_task), is_ahead in zip(pairwise(tasks), precedence, strict=True)
    )
    return tasks[0].period + tasks[-1].response + sum(wait_terms, Fraction(0))


def bound_reduced_age(tasks: Sequence[PeriodicTask], precedence: Sequence[bool]) -> Fraction:
    """Bound the age of data when the last element writes: R_n + sum over i < n of (T_i + p_i R_i)."""
    age_terms = (
        task.period + (Fraction(0) if is_ahead else task.response)
        for task, is_ahead in zip(tasks[:-1], precedence, strict=True)
    )
    return tasks[-1].response + sum(age_terms, Fraction(0))


def bound_periodic_chain(analysis: Analysis, activity_ids: Sequence[str]) -> tuple[Fraction, Fraction] | None:
    """Return reaction time and reduced data age, in ns, of a chain that the bounds hold for; None for any other."""
    activities = [analysis.system.activities[name] for name in activity_ids]
    tasks: list[PeriodicTask] = []
    for activity in activities:
        gap, response = analysis.paces[activity.id].gap, analysis.responses[activity.id]
        if activity.behaviour != "periodic" or gap.value is None or response.worst.value is None:
            return None
        if not gap.complete or not response.worst.complete or response.tier not in {"priorities", "declared"}:
            return None
        tasks.append(PeriodicTask(gap.value, response.worst.value))
    if len(tasks) < 2 or any(not _is_local(analysis, *pair) for pair in pairwise(activities)):  # noqa: PLR2004 - a pair
        return None
    precedence = [_has_precedence(*pair) for pair in pairwise(activities)]
    return bound_reaction(tasks, precedence), bound_reduced_age(tasks, precedence)


def _is_local(analysis: Analysis, producer: Activity, consumer: Activity) -> bool:
    """Whether data passes from one activity to another without taking time, and without waiting to be stored."""
    arcs = [arc for arc in analysis.system.arcs_from.get(producer.id, ()) if arc.target == consumer.id]
    storing_wait = analysis.storing_waits.get(consumer.id, ZERO_VALUE)
    return bool(arcs) and all(
        arc.worst == 0 and (storing_wait.value == 0 or not is_sampled(consumer, arc)) for arc in arcs
    )


def _has_precedence(producer: Activity, consumer: Activity) -> bool:
    """Whether two activities share a core and the first one has the higher priority."""
    if producer.host is None or producer.host != consumer.host or producer.core != consumer.core:
        return False
    return producer.priority is not None and consumer.priority is not None and producer.priority > consumer.priority
