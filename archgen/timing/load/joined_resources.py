"""Cores and resources (GPUs) that are joined by the threads that use both, taken as one processor with all their work.

While anything of them is pending, one of them works: what is pending runs or waits for its core, uses its resource or waits
for that, or waits for a thread of something of which the same is true. So the longest time for which all their work
together keeps one processor busy bounds each response, whatever the orders. No response is in it. It is the bound that
remains at moderate loads where the waits of several threads for one another would add up.

Where all that is used on some cores comes in the order of arrival, those cores need not be joined with others: while
anything of them is pending, one of them works, or one of their threads waits for a resource or uses it. That takes each
activation no longer than the longest use of each other thread, and its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from archgen.frozen import dataclass, replace
from archgen.model.graph_search import find_strong_components
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.core_responses import open_core_solver
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core
from archgen.timing.load.inner_triggers import InnerTriggers, find_inner_triggers
from archgen.timing.load.level_cascades import ArcModelFinder
from archgen.timing.load.resource_waits import find_turn_times
from archgen.timing.load.response_times import AnalysisEffort, find_responses
from archgen.timing.load.thread_work import EventModels
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import ThreadUnit
from archgen.timing.system.timing_system import TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph


@dataclass(frozen=True, slots=True)
class JoinedResources:
    """Joined cores and resources as one processor: `system` has the uses as execution time, and no priorities."""

    system: TimingSystem
    processor: ProcessingResource
    inner_triggers: InnerTriggers | None
    core: InnerCore | None

    def find_bounds(
        self,
        model_of: ArcModelFinder,
        event_models: EventModels,
        budget: SearchBudget,
    ) -> Mapping[str, int]:
        """Return the bounds of responses, of those that have one."""
        responses = (
            find_responses(self.system, self.processor, event_models, AnalysisEffort(budget))
            if self.core is None
            else open_core_solver(self.core, model_of, budget).solve().response_of
        )
        # What is declared says when an output leaves, and not how long it keeps a thread.
        return {
            name: response.value
            for name, response in responses.items()
            if response.value is not None and response.tier != "declared"
        }


def find_joined_resources(
    system: TimingSystem, triggers: TriggerGraph, parts: Mapping[str, ProcessingResource]
) -> Iterable[JoinedResources]:
    """Yield the groups of cores that resources join; without those of which nobody wrote how many cores there are."""
    steps_of: dict[str, list[str]] = {}
    for step, part in parts.items():
        for name in (name for unit in (*part.units, *part.foreign_units) for name in unit):
            steps_of.setdefault(name, []).append(step)
    user_ids = [activity.id for activity in system.activities.values() if activity.suspends]
    neighbours: dict[str, list[str]] = {step: [] for step in parts}
    neighbours |= {name: [] for name in user_ids if name not in steps_of}
    last_user_of: dict[str, str] = {}
    for name in user_ids:
        for resource_id in system.activities[name].uses:
            other = last_user_of.setdefault(resource_id, name)
            _join_steps(neighbours, steps_of.get(name, [name]), steps_of.get(other, [other]))
    for steps in steps_of.values():
        _join_steps(neighbours, steps, steps)
    yield from _list_groups(system, triggers, parts, neighbours, _list_uses(system))
    if use_times := {name: time for name, time in find_turn_times(system).items() if time is not None}:
        neighbours = {step: [] for step in (*parts, *user_ids) if step in parts or step not in steps_of}
        for steps in steps_of.values():
            _join_steps(neighbours, steps, steps)
        yield from _list_groups(system, triggers, parts, neighbours, use_times)


def _list_uses(system: TimingSystem) -> dict[str, int]:
    """Return how long each activation uses resources at most, without any wait for them, and waits for the world outside."""
    return {
        activity.id: sum(use.worst for use in activity.uses.values()) + activity.wait
        for activity in system.activities.values()
        if activity.suspends
    }


def _list_groups(
    system: TimingSystem,
    triggers: TriggerGraph,
    parts: Mapping[str, ProcessingResource],
    neighbours: Mapping[str, list[str]],
    use_times: Mapping[str, int],
) -> Iterable[JoinedResources]:
    """Yield the groups of cores that are joined, of which all uses take a time that is known."""
    for group in find_strong_components(neighbours, neighbours.__getitem__):
        units = dict.fromkeys(unit for step in group if step in parts for unit in parts[step].units)
        units |= dict.fromkeys((step,) for step in group if step not in parts)
        is_open = any(step in parts and parts[step].missing for step in group)
        users = [name for unit in units for name in unit if system.activities[name].suspends]
        if users and not is_open and all(name in use_times for name in users):
            yield _join_units(system, triggers, tuple(units), use_times)


def _join_steps(neighbours: Mapping[str, list[str]], steps: Sequence[str], other_steps: Sequence[str]) -> None:
    # By way of the first one. Each with each joins the same, in time that grows with the cube of a resource's users.
    for step in (*steps, *other_steps):
        neighbours[step].append(steps[0])
        neighbours[steps[0]].append(step)


def _join_units(
    system: TimingSystem, triggers: TriggerGraph, units: tuple[ThreadUnit, ...], use_times: Mapping[str, int]
) -> JoinedResources:
    """Return the processor that does all work of some units, on cores and on resources."""
    activities = dict(system.activities)
    for name in (name for unit in units for name in unit):
        activity = activities[name]
        wcet = None if activity.wcet is None else activity.wcet + use_times.get(name, 0)
        activities[name] = replace(activity, wcet=wcet, uses={}, priority=None)
    joined_system = replace(system, activities=activities)
    processor = ProcessingResource("joined", None, 1, units)
    inner_triggers = find_inner_triggers(joined_system, triggers, processor)
    core = None if inner_triggers is None else prepare_inner_core(joined_system, processor, inner_triggers)
    return JoinedResources(joined_system, processor, inner_triggers, core)
