"""What a simulation assumes: what it draws at random, what was filled in for figures nobody wrote, what contradicts
itself.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise

from archgen.frozen import dataclass
from archgen.simulation.simulation_result import SimulationResult
from archgen.timing.analysis import Analysis
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.system.core_placement import PREEMPTIVE_ORDERS
from archgen.timing.system.timing_system import Activity, TimingSystem, is_selective_arc

NOT_SIMULATED = (
    *("caches, migration, context switches and interrupts", "the middleware's own threads", "lost packets"),
    *("drifting clocks", "start-up", "callers that block until the answer is there"),
    *("deadlines and liveliness of quality of service", "whatever is outside of the architecture"),
)
"""The user's copy of this list is in docs/simulation.md."""


_CONDITIONAL_PHRASES = {
    "data": "does not always publish",
    "request": "does not always call",
    "answer": "does not always answer this caller on",
}


@dataclass(frozen=True, slots=True)
class DefaultFigure:
    """A figure that was not written, the value assumed for it, and the elements it is missing from."""

    figure: str
    assumed_value: str
    element_ids: tuple[str, ...]


def list_random_choices(system: TimingSystem) -> tuple[str, ...]:
    """Return phrases for what each seed draws at random, as far as this system leaves it open."""
    activities, arcs = system.activities.values(), system.arcs
    executors = {
        activity.executor: system.executors[activity.executor]
        for activity in activities
        if activity.executor in system.executors
    }
    callback_counts = Counter(
        key for activity in activities for key in (activity.executor, *(activity.executor for _ in activity.storing))
    )
    is_order_open = any(
        (executor.order or executor.usual_order) is None and callback_counts[key] > 1
        for key, executor in executors.items()
    )
    # In the wait set of rclcpp the order of creation counts, and nobody writes that.
    is_creation_open = any(
        "ros2_executor" in {executor.order, executor.order or executor.usual_order} and callback_counts[key] > 1
        for key, executor in executors.items()
    )
    used_resources = {key for activity in activities for key in activity.uses}
    open_hosts = {activity.host for activity in activities if activity.host} - system.fair_shares.keys()
    open_hosts |= {host for (host, _), order in system.core_orders.items() if order in PREEMPTIVE_ORDERS - {"fair"}}
    choices = (
        (
            any(activity.period for activity in activities),
            "the phase of each clock (every fourth run starts all at once)",
        ),
        (any(activity.jitter for activity in activities), "how late a release with jitter is"),
        (
            any((activity.wcet or 0) > (activity.bcet or 0) for activity in activities),
            "execution times from bcet to wcet",
        ),
        (
            any(
                (activity.worst or 0) > (activity.best or 0) and activity.link not in system.queued_links
                for activity in arcs
            ),
            "latencies of links from best to worst",
        ),
        (any(activity.conditional for activity in activities), "when a conditional output is published"),
        (any(activity.every > 1 for activity in activities), "where `every` begins to count"),
        (
            any(activity.host in open_hosts and activity.priority is None for activity in activities),
            "who comes first among those without a priority (in three of eight runs one comes after all others)",
        ),
        (is_order_open, "the order in which an executor takes its callbacks"),
        (is_creation_open, "the order in which an executor lists its subscriptions"),
        (
            any(resource.order is None for key, resource in system.resources.items() if key in used_resources),
            "the order in which a resource serves those that wait",
        ),
        (bool(used_resources), "after which part of its work an activity uses a resource"),
        (
            "round_robin" in (*system.host_orders.values(), *system.core_orders.values()),
            "how long a turn of round_robin is",
        ),
        (
            any(activity.response is not None for activity in activities),
            "when what has a declared response ends, within it",
        ),
    )
    return tuple(text for applies, text in choices if applies)


def list_default_figures(system: TimingSystem) -> tuple[DefaultFigure, ...]:
    """Return the figures that nobody wrote and the simulation needs."""
    working = [activity for activity in system.activities.values() if activity.behaviour != "once"]
    hosts_with_priorities = {activity.host for activity in working if activity.priority is not None}
    hosts_without_cores = {
        activity.host for activity in working if activity.host and system.cores.get(activity.host) is None
    }

    def list_lacking(lacks: Callable[[Activity], object]) -> tuple[str, ...]:
        return tuple(activity.id for activity in working if lacks(activity))

    figures = (
        DefaultFigure("wcet", "0", list_lacking(lambda each: each.wcet is None and each.response is None)),
        DefaultFigure("bcet", "0", list_lacking(lambda each: each.wcet and each.bcet is None)),
        DefaultFigure("jitter", "none", list_lacking(lambda each: each.period and "jitter" not in each.places)),
        DefaultFigure(
            "priority",
            "after all that have one",
            list_lacking(lambda each: each.host in hosts_with_priorities and each.priority is None),
        ),
        DefaultFigure("host", "a core of its own", list_lacking(lambda each: each.host is None)),
        DefaultFigure(
            "scheduling", "fair", tuple(host for host in system.fair_shares if host not in system.host_orders)
        ),
        DefaultFigure(
            "scheduling", "fifo", tuple(each.id for each in system.resources.values() if each.is_order_assumed)
        ),
        DefaultFigure("cores", "1", tuple(sorted(host for host in hosts_without_cores if host))),
        DefaultFigure("calls", "1 for each activation", list_lacking(lambda each: _uses_default_calls(system, each))),
        DefaultFigure(
            "latency",
            "the best that is written (0 without one), and on a link with a bandwidth the wait for it",
            tuple(dict.fromkeys(f"{arc.source} to {arc.target}" for arc in system.arcs if arc.worst is None)),
        ),
    )
    return tuple(default for default in figures if default.element_ids)


def _uses_default_calls(system: TimingSystem, activity: Activity) -> bool:
    """Return whether an activity calls without saying how often."""
    requests = [arc for arc in system.arcs_from.get(activity.id, ()) if arc.role == "request"]
    return any(arc.output not in activity.calls for arc in requests)


def find_simulated_contradictions(result: SimulationResult, analysis: Analysis) -> tuple[str, ...]:
    """Return sentences on what is written but cannot hold: there an observed figure may exceed its bound."""
    return (
        *_rate_contradictions(analysis),
        *_gap_contradictions(result, analysis),
        *_latency_contradictions(result, analysis),
    )


def _rate_contradictions(analysis: Analysis) -> Iterator[str]:
    for activity_id, derived in analysis.derived.items():
        declared = analysis.paces[activity_id]
        if derived.gap.value is not None and derived.gap.value != declared.gap.value:
            period = (analysis.system.activities[activity_id].period or 0) * analysis.system.tick
            yield f"{activity_id} states a period of {format_duration(period)}, and its inputs fire it at another: here they do"


def _gap_contradictions(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    for activity_id, observed in result.activities.items():
        max_gaps = analysis.system.activities[activity_id].max_gaps
        for key, silence in observed.output_silences.items():
            limit = max_gaps[key] * analysis.system.tick if key in max_gaps else None
            if limit is not None and silence > limit:
                yield (
                    f"{activity_id} promises {key} every {format_duration(limit)} at least, and had no chance to for {format_duration(silence)}"
                )


def _latency_contradictions(result: SimulationResult, analysis: Analysis) -> Iterator[str]:
    written = {arc.link: arc.worst * analysis.system.tick for arc in analysis.system.arcs if arc.worst is not None}
    for name, link in result.links.items():
        if name in written and name not in analysis.system.queued_links and link.wait > written[name]:
            yield (
                f"{name} has a latency of {format_duration(written[name])}, and messages waited {format_duration(link.wait)} "
                "for it: ways over it take longer than is seen here"
            )


def list_selective_elements(system: TimingSystem, through: tuple[str, ...]) -> tuple[str, ...]:
    """Return phrases for the elements of a chain that may not send each input on, and do not promise when they do."""
    phrases = (
        f"{source} {_CONDITIONAL_PHRASES[arc.role]} {arc.topic}"
        for source, target in pairwise(through)
        for arc in system.arcs_from.get(source, ())
        if arc.target == target and is_selective_arc(system, arc)
    )
    return tuple(dict.fromkeys(phrases))
