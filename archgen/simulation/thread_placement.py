"""Place activities on threads, and threads on processors, for a simulation plan."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.simulation.simulation_plan import Processor
from archgen.timing.system.core_placement import find_pins
from archgen.timing.system.timing_system import Activity, TimingSystem


class ThreadPlacement:
    """Threads and processors, numbered as activities ask for them. `activity_numbers` is the number of each activity by
    id.
    """

    def __init__(self, system: TimingSystem, activity_numbers: Mapping[str, int]) -> None:
        self.system = system
        self.activity_numbers = activity_numbers
        self.processors: list[Processor] = []
        self.shared_processors: dict[tuple[str, int | None], int] = {}
        self.processor_of_thread: list[int] = []
        self.members: list[list[int]] = []
        self.executor_threads: dict[str, int] = {}
        self.pools: list[int] = []
        self.pool_numbers: dict[str, int] = {}
        self.pool_of_thread: list[int] = []
        self.affinity: list[int] = []
        self.pinned_cores: dict[str, list[int]] = {}
        self.core_of_activity: dict[str, int | None] = {}
        self.hosts_with_unpinned: set[str] = set()
        for host in dict.fromkeys(a.host for a in system.activities.values() if a.host is not None):
            # `pins` is the analysis's own placement, so that bounds and simulation agree on who may run where.
            for activity_ids, core in find_pins(
                system, [a for a in system.activities.values() if a.host == host]
            ).items():
                self.core_of_activity |= dict.fromkeys(activity_ids, core)
                if core is None:
                    self.hosts_with_unpinned.add(host)
                elif core not in self.pinned_cores.setdefault(host, []):
                    self.pinned_cores[host].append(core)

    def cores_by_host(self) -> dict[str, int]:
        """Return the number of cores of each host that something runs on; 1 where it is unknown."""
        used_hosts = dict.fromkeys(processor.host for processor in self.processors if processor.host is not None)
        return {host: self.system.cores.get(host) or 1 for host in used_hosts}

    def thread_of(self, activity: Activity) -> int:
        """Return the number of an activity's thread: its own, or the one of its single-threaded container."""
        container = activity.container
        threads = self.system.threads.get(container) if container is not None else None
        if container is not None and threads == 1:
            if container not in self.executor_threads:
                container_activities = [a for a in self.system.activities.values() if a.container == container]
                self.executor_threads[container] = self.add_thread(container_activities, -1)
            return self.executor_threads[container]
        pool = -1
        if container is not None and threads is not None:
            if container not in self.pool_numbers:
                self.pool_numbers[container] = len(self.pools)
                self.pools.append(threads)
            pool = self.pool_numbers[container]
        return self.add_thread([activity], pool)

    def add_thread(self, members: list[Activity], pool: int) -> int:
        """Add a thread on the cores where its members run, and return its number."""
        self.members.append([self.activity_numbers[activity.id] for activity in members])
        core = self.core_of_activity.get(members[0].id)
        self.processor_of_thread.append(self.processor_of(members[0], core))
        self.affinity.append(self.pinned_position(members[0].host, core))
        self.pool_of_thread.append(pool)
        return len(self.members) - 1

    def processor_of(self, activity: Activity, core: int | None) -> int:
        """Return the number of the processor that a thread may run on.

        A core to which something is pinned is a processor of its own; the other cores of a host form one together.
        """
        host = activity.host
        if host is None:
            self.processors.append(Processor(activity.id, None, 1))
            return len(self.processors) - 1
        cores = self.system.cores.get(host) or 1
        if cores == 1 or self.has_no_free_core(host):
            core = None
        if (host, core) not in self.shared_processors:
            self.shared_processors[host, core] = len(self.processors)
            free = (
                max(cores - len(self.pinned_cores.get(host, ())), 1)
                if cores > 1 and not self.has_no_free_core(host)
                else cores
            )
            name = host if core is None else f"{host} core {core}"
            self.processors.append(Processor(name, host, free if core is None else 1))
        return self.shared_processors[host, core]

    def has_no_free_core(self, host: str) -> bool:
        """Return whether pins leave no core for the unpinned activities of a host, which then run on any core."""
        cores = self.system.cores.get(host) or 1
        return 1 < cores <= len(self.pinned_cores.get(host, ())) and host in self.hosts_with_unpinned

    def pinned_position(self, host: str | None, core: int | None) -> int:
        """Return the core that a pinned thread must have on a host where no core is left; -1 for any."""
        if host is None or core is None or not self.has_no_free_core(host):
            return -1
        return self.pinned_cores[host].index(core) % (self.system.cores.get(host) or 1)
