"""Bounds of what may run on several cores that others are pinned to: each core alone is one that it may wait for.

Let a thread have work that does not run. Then each core on which it may run is busy, any one of them too. So from the last
instant at which that core was idle and the thread had no work, the core's own work and that of the thread, wherever it
runs, are used up as fast as time passes: the bound is that of the core alone, with what may have begun elsewhere.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.frozen import replace
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStreams, delay_streams
from archgen.timing.load.response_times import AnalysisEffort, find_responses
from archgen.timing.load.thread_work import EventModels, WorstResponse
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.thread_pools import CoreSet, ThreadUnit
from archgen.timing.system.timing_system import TimingSystem


class SingleCores:
    """The cores of a resource, each with what may run there; `cores_of` has those of each activity of the host.

    `waiting_ids` are the activities whose threads wait for GPUs and the like: their work comes late as well.
    """

    def __init__(
        self,
        system: TimingSystem,
        resource: ProcessingResource,
        cores_of: Mapping[str, CoreSet],
        waiting_ids: Collection[str] = (),
    ) -> None:
        """Find what may run on each core."""
        # What somebody declares may hold a wait for the world outside. Here it matters when the work is done.
        own_activities = {name: replace(system.activities[name], response=None) for name in resource.members}
        self.system = replace(system, activities={**system.activities, **own_activities})
        self.resource = resource
        self.units_by_core = {
            core: tuple(unit for unit in resource.foreign_units if core in cores_of.get(unit[0], ()))
            for core in resource.core_set
        }
        self.roaming_units = frozenset(
            unit
            for unit in resource.foreign_units
            if len(cores_of.get(unit[0], ())) > 1 or any(name in waiting_ids for name in unit)
        )

    def limit(
        self, event_models: EventModels, responses: Mapping[str, WorstResponse], budget: SearchBudget
    ) -> dict[str, int]:
        """Return when the work of the resource's activities is done, for the responses of all that may run there."""
        bounds: dict[str, int] = {}
        for unit in self.resource.units:
            for core, models in self.list_placements(unit, event_models, responses):
                for name, response in find_responses(self.system, core, models, AnalysisEffort(budget)).items():
                    if response.value is not None:
                        bounds[name] = min(response.value, bounds.get(name, response.value))
        return bounds

    def list_placements(
        self, unit: ThreadUnit, event_models: EventModels, responses: Mapping[str, WorstResponse]
    ) -> Iterator[tuple[ProcessingResource, dict[str, EventStreams | UnknownCause]]]:
        """Yield each core with a thread and all that may run there, and the event models seen from it."""
        for core, core_units in self.units_by_core.items():
            yield self._place_on_core(unit, core_units, core, event_models, responses)

    def _place_on_core(
        self,
        unit: ThreadUnit,
        core_units: tuple[ThreadUnit, ...],
        core: int,
        event_models: EventModels,
        responses: Mapping[str, WorstResponse],
    ) -> tuple[ProcessingResource, dict[str, EventStreams | UnknownCause]]:
        neighbours = tuple(other_unit for other_unit in self.resource.units if other_unit != unit)
        resource = ProcessingResource(
            self.resource.id, self.resource.host, 1, (unit,), (*core_units, *neighbours), core_set=(core,)
        )
        roaming_ids = {
            name for each in resource.foreign_units if each in neighbours or each in self.roaming_units for name in each
        }
        models = {
            name: delay_by_response(event_models[name], responses.get(name))
            if name in roaming_ids
            else event_models[name]
            for each in (unit, *resource.foreign_units)
            for name in each
        }
        return resource, models


def find_single_cores(
    system: TimingSystem,
    resources: Mapping[str, ProcessingResource],
    shared_steps: Iterable[str],
    waiting_ids: Collection[str],
) -> dict[str, SingleCores]:
    """Return the cores, one by one, of the resources (by key) that share several of them with what is pinned to some."""
    cores_of = {name: resource.core_set for resource in resources.values() for name in resource.members}
    return {
        step: SingleCores(system, resources[step], cores_of, waiting_ids)
        for step in shared_steps
        if resources[step].foreign_units
    }


def delay_by_response(
    event_model: EventStreams | UnknownCause, response: WorstResponse | None, work_end: int | None = None
) -> EventStreams | UnknownCause:
    """Return the event model of work that another core may have begun: what comes here came up to a response ago."""
    if isinstance(event_model, UnknownCause) or not event_model:
        return event_model
    if work_end is not None:
        return delay_streams(event_model, work_end)
    if response is None or response.value is None:
        return response.cause if response is not None else UnknownCause()
    return delay_streams(event_model, response.value)
