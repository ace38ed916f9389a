"""Place activities on executors and their threads on processors, and number their callbacks, for a simulation plan."""

from __future__ import annotations

from archgen.frozen import replace
from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.simulation_plan import (
    CLIENT,
    REENTRANT,
    SERVICE,
    SUBSCRIPTION,
    PlannedCallback,
    PlannedExecutor,
    Processor,
)
from archgen.timing.system.timing_system import Activity, Arc, StoringCallback, TimingSystem, name_queue


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
