"""Build a simulation plan from a system. Unknown figures are taken as nothing, and listed.

Place activities on executors and their threads on processors, and number their callbacks, for a simulation plan.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.frozen import replace
from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.simulation_plan import (
    CLIENT,
    INACTIVE,
    MAX_UNIT_NS,
    ONCE,
    OUTSIDE,
    PERIODIC,
    REENTRANT,
    SERVICE,
    SLOT_ANY,
    SLOT_SAMPLED,
    SUBSCRIPTION,
    TIMER,
    TRIGGERED,
    PlannedActivity,
    PlannedCallback,
    PlannedExecutor,
    PlannedOutput,
    PlannedResource,
    PlannedWire,
    Processor,
    SimulationPlan,
)
from archgen.timing.system.timing_system import (
    Activity,
    Arc,
    StoringCallback,
    TimingSystem,
    is_selective_arc,
    name_queue,
)


class ThreadPlacement:
    """Executors and processors, numbered as activities ask for them."""

    def __init__(self, system: TimingSystem) -> None:
        self.system = system
        self.executors: list[PlannedExecutor] = []
        self.processors: list[Processor] = []
        self.members: dict[str, list[Activity]] = {}
        self.executor_numbers: dict[str, int] = {}
        self.processor_numbers: dict[tuple[str | None, tuple[int, ...]], int] = {}
        for activity in system.activities.values():
            self.members.setdefault(_executor_key(system, activity), []).append(activity)
        self.placed_cores = {activity.id: self._placed_cores(activity) for activity in system.activities.values()}
        self.cores_of_host = {host: self._cores_of_host(host) for host in self._hosts()}

    def cores_by_host(self) -> dict[str, int]:
        """Return the number of cores of each host that something runs on; 1 where it is unknown."""
        return {host: self._core_count(host) for host in self._hosts()}

    def executor_of(self, activity: Activity) -> int:
        """Return the number of the executor that runs an activity."""
        key = _executor_key(self.system, activity)
        if key not in self.executor_numbers:
            self.executor_numbers[key] = len(self.executors)
            self.executors.append(self._find_executor(key, activity))
        return self.executor_numbers[key]

    def processor_of(self, activity: Activity) -> tuple[int, tuple[int, ...]]:
        """Return the number of the processor on which an activity runs, and the cores there that it may use (empty for
        any).
        """
        if activity.host is None:
            executor = self.executors[self.executor_of(activity)]
            return self._number(None, (self.executor_of(activity),), Processor(executor.id, None, executor.threads)), ()
        host, cores = activity.host, self.placed_cores[activity.id]
        count = self._core_count(host)
        all_cores = tuple(range(count))
        shared_cores, is_joint = self.cores_of_host[host]
        allowed = cores or shared_cores
        if is_joint:
            # Everything competes in one queue: sets of cores may overlap in any way.
            processor = Processor(host, host, count, self._order_of(host, all_cores))
            return self._number(host, (), processor), () if allowed == all_cores else allowed
        if cores and count > 1:
            name = f"{host} core {cores[0]}"
            return self._number(host, cores, Processor(name, host, 1, self._order_of(host, cores))), ()
        order = self._order_of(host, shared_cores)
        return self._number(host, (), Processor(host, host, len(shared_cores), order)), ()

    def _number(self, host: str | None, cores: tuple[int, ...], processor: Processor) -> int:
        share = self.system.fair_shares.get(host or "")
        if share is not None and processor.order in {None, "fair"}:
            processor = replace(processor, order="fair", turn=share.turn * self.system.tick)
        if (host, cores) not in self.processor_numbers:
            self.processor_numbers[host, cores] = len(self.processors)
            self.processors.append(processor)
        return self.processor_numbers[host, cores]

    def _hosts(self) -> list[str]:
        hosts = [activity.host for activity in self.system.activities.values() if activity.host is not None]
        return list(dict.fromkeys(hosts))

    def _core_count(self, host: str) -> int:
        return self.system.cores.get(host) or 1

    def _order_of(self, host: str, cores: tuple[int, ...]) -> SchedulingOrder | None:
        """Return the order that all of some cores have; None where they differ, or none is written."""
        host_order = self.system.host_orders.get(host)
        orders = [self.system.core_orders.get((host, core), host_order) for core in cores]
        return orders[0] if orders.count(orders[0]) == len(orders) else None

    def _placed_cores(self, activity: Activity) -> tuple[int, ...]:
        """Return the cores to which an activity is pinned, as far as its host has them; one thread runs where its first
        pinned member is.
        """
        key = _executor_key(self.system, activity)
        executor = self._find_executor(key, activity)
        candidates = self.members[key] if executor.threads == 1 or executor.is_serial else [activity]
        pins = (
            tuple(core for core in member.cores if member.host is not None and core < self._core_count(member.host))
            for member in candidates
            if member.host == activity.host
        )
        return next((cores for cores in pins if cores), ())

    def _cores_of_host(self, host: str) -> tuple[tuple[int, ...], bool]:
        """Return the cores on which what is not pinned runs, and whether all threads of the host share one queue."""
        placements = [self.placed_cores[a.id] for a in self.system.activities.values() if a.host == host]
        all_cores = tuple(range(self._core_count(host)))
        # A core is kept for what is pinned to it alone; a set of cores keeps nobody away.
        kept_cores = {cores[0] for cores in placements if len(cores) == 1}
        free_cores = tuple(core for core in all_cores if core not in kept_cores)
        has_sets = any(len(cores) > 1 for cores in placements)
        is_crowded = not free_cores and any(not cores for cores in placements)
        return free_cores or all_cores, len(all_cores) > 1 and (has_sets or is_crowded)

    def _find_executor(self, key: str, activity: Activity) -> PlannedExecutor:
        """Return the executor of an activity; where none is known, a thread of its own."""
        executor = self.system.executors.get(activity.executor)
        if executor is None:
            return PlannedExecutor(key, 1, "fifo")
        threads = executor.threads or len(self.members[key])
        return PlannedExecutor(
            key, threads, executor.order or executor.usual_order, executor.is_serial, executor.library.serves_by_kind
        )


def _executor_key(system: TimingSystem, activity: Activity) -> str:
    """Return the executor's key; without one, that of the activity."""
    return activity.executor if activity.executor in system.executors else f"activity {activity.id}"


class CallbackNumbering:
    """Callbacks, numbered as they are asked for. `scale` is the number of units in a tick."""

    def __init__(
        self, system: TimingSystem, activity_numbers: dict[str, int], placement: ThreadPlacement, scale: int
    ) -> None:
        self.system = system
        self.activity_numbers = activity_numbers
        self.placement = placement
        self.scale = scale
        self.planned: list[PlannedCallback] = []
        self.numbers: dict[tuple[str, str], int] = {}
        self.group_numbers: dict[str, int] = {}

    def callback_of_arc(self, reader: Activity, arc: Arc, *, is_sampled: bool) -> int:
        """Return the number of the callback that a message on an arc starts; -1 where it is stored at once."""
        if not is_sampled:
            kind = SERVICE if arc.role == "request" else SUBSCRIPTION
            return self.number_callback(reader, f"{arc.role} {arc.input} {name_queue(reader, arc)}", kind)
        # A request to a periodic server waits for its next job.
        if arc.role == "request" or self.system.activities[arc.source].behaviour == "once":
            return -1
        storing = reader.storing.get(arc.input)
        if arc.role == "answer" and reader.executor in self.system.executors:
            # rclcpp hands out an answer in a callback of the client, which takes its turn like any other.
            return self.number_callback(reader, f"answer {arc.topic}", CLIENT, storing or StoringCallback())
        if storing is None:
            return -1
        return self.number_callback(
            reader, f"{arc.input} {name_queue(reader, arc)}", SUBSCRIPTION, storing, arc.depth or 0
        )

    def number_callback(
        self, activity: Activity, entity: str, kind: int, storing: StoringCallback | None = None, depth: int = 0
    ) -> int:
        """Return the number of the callback of an activity's clock, subscription, service or client."""
        key = (activity.id, entity)
        if key not in self.numbers:
            self.numbers[key] = len(self.planned)
            best, worst = (storing.bcet, storing.wcet) if storing else (activity.bcet or 0, activity.wcet or 0)
            self.planned.append(
                PlannedCallback(
                    self.activity_numbers[activity.id],
                    kind,
                    self.placement.executor_of(activity),
                    self._group_of(activity),
                    storing is not None,
                    min(best, worst) * self.scale,
                    worst * self.scale,
                    depth,
                )
            )
        return self.numbers[key]

    def _group_of(self, activity: Activity) -> int:
        """Return the number of an activity's group: where no executor is known, it excludes only itself."""
        if activity.executor not in self.system.executors:
            key = f"activity {activity.id}"
        elif activity.callback_group is None:
            return REENTRANT
        else:
            key = f"group {activity.callback_group}"
        return self.group_numbers.setdefault(key, len(self.group_numbers))


_SECOND = 10**9
_MATCH_DEPTH = 10
"""How many samples wait for partners of the same time where no depth is known: the default of ROS 2."""
PublishPauses = Mapping[tuple[str, str], Fraction]
"""The longest time between two chances to publish an output, in ns, by activity and output key."""


def build_plan(system: TimingSystem, pauses: PublishPauses | None = None) -> SimulationPlan:
    """Build a plan.

    `pauses` say when a conditional output must be published so that its promised largest gap is kept.
    """
    builder = _PlanBuilder(system, pauses or {})
    # Wires come first: unknown latencies are listed before unknown execution times.
    wires = tuple(builder.plan_wire(arc) for arc in system.arcs)
    activities = tuple(builder.plan_activity(activity) for activity in system.activities.values())
    answer_wires = {
        (arc.target, arc.source, arc.topic): wire_index
        for wire_index, arc in enumerate(system.arcs)
        if arc.role == "answer"
    }
    requests = (
        (wire_index, (arc.source, arc.target, arc.topic))
        for wire_index, arc in enumerate(system.arcs)
        if arc.role == "request"
    )
    answers = {wire_index: answer_wires[key] for wire_index, key in requests if key in answer_wires}
    return SimulationPlan(
        system.tick / builder.scale,
        activities,
        wires,
        tuple(builder.activity_numbers[arc.source] for arc in system.arcs),
        system.arcs,
        tuple(builder.callbacks.planned),
        tuple(builder.placement.executors),
        tuple(PlannedResource(resource.id, resource.order) for resource in system.resources.values()),
        tuple(builder.placement.processors),
        tuple(builder.links),
        tuple(builder.queues),
        builder.placement.cores_by_host(),
        answers,
        tuple(builder.unknown),
    )


class _PlanBuilder:
    """Numbers activities, wires, queues, links and threads in order of appearance."""

    def __init__(self, system: TimingSystem, pauses: PublishPauses) -> None:
        self.system = system
        self.pauses = pauses
        # Rounded up: a unit is at most MAX_UNIT_NS ns long.
        self.scale = max(1, -(-system.tick.numerator // (system.tick.denominator * MAX_UNIT_NS)))
        self.activity_numbers = {key: index for index, key in enumerate(system.activities)}
        self.placement = ThreadPlacement(system)
        self.callbacks = CallbackNumbering(system, self.activity_numbers, self.placement, self.scale)
        self.resource_numbers = {key: index for index, key in enumerate(system.resources)}
        self.links: dict[str, int] = {}
        self.queues: dict[tuple[str, str, str], int] = {}
        self.unknown: dict[str, None] = {}
        self.arcs_into: dict[str, list[tuple[int, Arc]]] = {}
        self.arcs_out_of: dict[str, list[tuple[int, Arc]]] = {}
        for wire_index, arc in enumerate(system.arcs):
            self.arcs_into.setdefault(arc.target, []).append((wire_index, arc))
            self.arcs_out_of.setdefault(arc.source, []).append((wire_index, arc))

    def ticks_to_units(self, ticks: int) -> int:
        """Convert ticks to units."""
        return ticks * self.scale

    def known_units(self, ticks: int | None, figure: str) -> int:
        """Convert ticks to units; an unknown figure is noted and counts as 0."""
        if ticks is None:
            self.unknown[figure] = None
            return 0
        return self.ticks_to_units(ticks)

    def plan_wire(self, arc: Arc) -> PlannedWire:
        """Plan the wire for an arc."""
        reader = self.system.activities[arc.target]
        slot = _slot_of(reader, arc)
        best = self.ticks_to_units(arc.best or 0)
        # A latency that the analysis computed for a queued link is not a declared one: the simulation must be free to
        # exceed it, or it would prove nothing.
        declared = None if arc.worst is None or arc.link in self.system.queued_links else self.ticks_to_units(arc.worst)
        if arc.worst is None:
            self.unknown[f"latency from {arc.source} to {arc.target}"] = None
        link, transmission = -1, 0
        bandwidth = self.system.bandwidths.get(arc.link or "")
        if arc.link is not None and arc.size is not None and bandwidth:
            link = self.links.setdefault(arc.link, len(self.links))
            transmission = int(arc.size * _SECOND * self.scale / (bandwidth * self.system.tick))
        queue = -1
        if arc.role == "data":
            queue = self.queues.setdefault((arc.target, arc.input, name_queue(reader, arc)), len(self.queues))
        return PlannedWire(
            target=self.activity_numbers[arc.target],
            slot=slot,
            best=best if declared is None else min(best, declared),
            worst=best if declared is None else declared,
            queue=queue,
            depth=arc.depth or 0,
            link=link,
            transmission=transmission,
            declared_latency=declared,
            is_request=arc.role == "request",
            callback=self.callbacks.callback_of_arc(reader, arc, is_sampled=slot == SLOT_SAMPLED) if slot < 0 else -1,
            is_selective=is_selective_arc(self.system, arc),
        )

    def plan_activity(self, activity: Activity) -> PlannedActivity:
        """Plan an activity."""
        kind = self.start_kind(activity)
        wcet = self.known_units(activity.wcet, f"execution time of {activity.id}")
        # Here no execution time is needed, so it is not listed as unknown.
        if activity.wcet is None and (activity.response is not None or kind == ONCE):
            self.unknown.pop(f"execution time of {activity.id}", None)
        needs_all = activity.mode != "any"
        incoming = self.arcs_into.get(activity.id, [])
        processor, allowed_cores = self.placement.processor_of(activity)
        deadline = activity.deadline if activity.deadline is not None else activity.period
        return PlannedActivity(
            activity.id,
            kind,
            self.ticks_to_units(activity.period or 0) if kind == PERIODIC else 0,
            self.ticks_to_units(activity.jitter),
            min(self.ticks_to_units(activity.bcet or 0), wcet),
            wcet,
            None if activity.response is None else self.ticks_to_units(activity.response),
            1 if kind == PERIODIC else activity.every,
            0 if kind == PERIODIC else self.ticks_to_units(activity.throttle),
            len(activity.triggers),
            self.constant_slots(activity) if needs_all else (),
            tuple(wire_index for wire_index, arc in incoming if needs_all and _slot_of(activity, arc) >= 0),
            tuple(wire_index for wire_index, _ in incoming),
            tuple(self.plan_output(activity, key) for key in self.output_keys(activity)),
            tuple(self.planned_calls(activity)),
            processor,
            allowed_cores,
            activity.priority,
            None if deadline is None else self.ticks_to_units(deadline),
            activity.behaviour == "periodic",
            self.clock_callback(activity) if kind == PERIODIC else -1,
            self.callbacks.number_callback(activity, "", SUBSCRIPTION) if needs_all and activity.triggers else -1,
            self.ticks_to_units(activity.within or 0) if activity.mode == "match" else None,
            self.match_depths(activity) if activity.mode == "match" else (),
            activity.keeps_dropped,
            tuple(
                (self.resource_numbers[key], self.ticks_to_units(use.best), self.ticks_to_units(use.worst))
                for key, use in activity.uses.items()
                if key in self.resource_numbers
            )
            + (((OUTSIDE, 0, self.ticks_to_units(activity.wait)),) if activity.wait else ()),
        )

    def clock_callback(self, activity: Activity) -> int:
        """Return the number of the callback that the clock of an activity starts, or the world outside."""
        return self.callbacks.number_callback(
            activity, "clock", TIMER if activity.behaviour == "periodic" else SUBSCRIPTION
        )

    def match_depths(self, activity: Activity) -> tuple[int, ...]:
        """Return how many samples of each trigger wait for those with which they are matched."""
        incoming = self.arcs_into.get(activity.id, [])
        depths = ([arc.depth or _MATCH_DEPTH for _, arc in incoming if arc.input == key] for key in activity.triggers)
        return tuple(max(input_depths, default=_MATCH_DEPTH) for input_depths in depths)

    def start_kind(self, activity: Activity) -> int:
        """Return what starts an activity, and note what is missing where nothing does."""
        if activity.behaviour == "once":
            return ONCE
        if activity.behaviour == "periodic":
            if activity.period:
                return PERIODIC
            self.unknown[f"period of {activity.id}"] = None
            return INACTIVE
        if activity.period and not self.is_fired(activity):
            return PERIODIC
        if activity.behaviour is None:
            self.unknown[f"behaviour of {activity.id}"] = None
        for external_input in self.system.external_inputs.get(activity.id, ()):
            if external_input in activity.triggers:
                self.unknown[f"events from outside at {external_input}"] = None
        return TRIGGERED

    def is_fired(self, activity: Activity) -> bool:
        """Return whether something within the architecture fires an activity; else it keeps its stated period."""
        return any(
            arc.role == "request" or (arc.role == "data" and arc.input in activity.triggers)
            for arc in self.system.arcs_into.get(activity.id, ())
        )

    def constant_slots(self, activity: Activity) -> tuple[int, ...]:
        """Return the slots of an all-of trigger that outputs published once fill for good."""
        incoming = self.arcs_into.get(activity.id, [])
        constant_inputs = {arc.input for _, arc in incoming if self.system.activities[arc.source].behaviour == "once"}
        return tuple(slot for slot, key in enumerate(activity.triggers) if key in constant_inputs)

    def output_keys(self, activity: Activity) -> tuple[str, ...]:
        """Return the keys of the outputs that have readers or are conditional, in order and without duplicates."""
        connected_keys = [arc.output for _, arc in self.arcs_out_of.get(activity.id, []) if arc.role == "data"]
        return tuple(
            dict.fromkeys((*connected_keys, *(key for key in activity.outputs if key in activity.conditional)))
        )

    def plan_output(self, activity: Activity, key: str) -> PlannedOutput:
        """Plan an output."""
        outgoing = self.arcs_out_of.get(activity.id, [])
        wires = tuple(wire_index for wire_index, arc in outgoing if arc.output == key and arc.role == "data")
        max_gap = activity.max_gaps.get(key)
        pause = self.pauses.get((activity.id, key))
        patience = None
        if max_gap is not None:
            # Publish unless waiting for one more chance would still keep the promise. The 1 makes up for rounding; -1
            # (no bound on the pause) publishes at each chance.
            patience = (
                self.ticks_to_units(max_gap) - int(pause / self.system.tick * self.scale) - 1
                if pause is not None
                else -1
            )
        return PlannedOutput(key, wires, key in activity.conditional, patience)

    def planned_calls(self, activity: Activity) -> list[tuple[Fraction, tuple[int, ...]]]:
        """Return calls for each activation and the wires that they use, by output."""
        wires_by_output: dict[str, list[int]] = {}
        for wire_index, arc in self.arcs_out_of.get(activity.id, []):
            if arc.role == "request":
                wires_by_output.setdefault(arc.output, []).append(wire_index)
        return [(activity.calls.get(key, Fraction(1)), tuple(wires)) for key, wires in wires_by_output.items()]


def _slot_of(reader: Activity, arc: Arc) -> int:
    """Return the slot of an arc at its reader: a place of an all-of trigger, SLOT_ANY or SLOT_SAMPLED."""
    if arc.role == "request":
        return SLOT_SAMPLED if reader.behaviour == "periodic" else SLOT_ANY
    if arc.role == "answer" or arc.input not in reader.triggers:
        return SLOT_SAMPLED
    return reader.triggers.index(arc.input) if reader.mode != "any" else SLOT_ANY
