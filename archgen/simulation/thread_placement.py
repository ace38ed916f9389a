"""Place activities on executors, and their threads on processors, for a simulation plan."""

from __future__ import annotations

from archgen.frozen import replace
from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation.simulation_plan import PlannedExecutor, Processor
from archgen.timing.system.timing_system import Activity, TimingSystem


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
