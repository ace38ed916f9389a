"""Threads and processors of a plan: who shares a thread, a container's threads, or cores."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.simulation.plan import Processor
from archgen.timing.system import Activity, System


class Places:
    """Threads and processors, numbered as activities ask for them. `number` gives the number of each activity."""

    def __init__(self, system: System, number: Mapping[str, int]) -> None:
        self.system = system
        self.number = number
        self.processors: list[Processor] = []
        self.shared: dict[tuple[str, int | None], int] = {}
        self.processor_of_thread: list[int] = []
        self.members: list[list[int]] = []
        self.executors: dict[str, int] = {}
        self.pools: list[int] = []
        self.pool_numbers: dict[str, int] = {}
        self.pool_of_thread: list[int] = []
        self.affinity: list[int] = []
        self.pinned: dict[str, list[int]] = {}
        for activity in system.activities.values():
            if activity.host is not None and activity.core is not None:
                cores = self.pinned.setdefault(activity.host, [])
                cores += [activity.core] if activity.core not in cores else []
        self.loose = {a.host for a in system.activities.values() if a.core is None}

    def cores(self) -> dict[str, int]:
        """Give the cores of each host that something runs on."""
        used = dict.fromkeys(processor.host for processor in self.processors if processor.host is not None)
        return {host: self.system.cores.get(host) or 1 for host in used}

    def thread(self, activity: Activity) -> int:
        """Give the thread: one of its own, or that of its container."""
        container = activity.container
        threads = self.system.threads.get(container) if container is not None else None
        if container is not None and threads == 1:
            if container not in self.executors:
                together = [a for a in self.system.activities.values() if a.container == container]
                self.executors[container] = self.new_thread(together, -1)
            return self.executors[container]
        pool = -1
        if container is not None and threads is not None:
            if container not in self.pool_numbers:
                self.pool_numbers[container] = len(self.pools)
                self.pools.append(threads)
            pool = self.pool_numbers[container]
        return self.new_thread([activity], pool)

    def new_thread(self, members: list[Activity], pool: int) -> int:
        """Add a thread, on the cores where its members run."""
        self.members.append([self.number[activity.id] for activity in members])
        core = next((a.core for a in members if a.core is not None), None)
        self.processor_of_thread.append(self.processor(members[0], core))
        self.affinity.append(self.pin(members[0].host, core))
        self.pool_of_thread.append(pool)
        return len(self.members) - 1

    def processor(self, activity: Activity, core: int | None) -> int:
        """Give the cores that a thread may run on. Those to which something is pinned are kept for it."""
        host = activity.host
        if host is None:
            self.processors.append(Processor(activity.id, None, 1))
            return len(self.processors) - 1
        cores = self.system.cores.get(host) or 1
        if cores == 1 or self.mixed(host):
            core = None
        if (host, core) not in self.shared:
            self.shared[host, core] = len(self.processors)
            free = max(cores - len(self.pinned.get(host, ())), 1) if cores > 1 and not self.mixed(host) else cores
            name = host if core is None else f"{host} core {core}"
            self.processors.append(Processor(name, host, free if core is None else 1))
        return self.shared[host, core]

    def mixed(self, host: str) -> bool:
        """Tell whether no core is left for what is not pinned: then it runs anywhere, between what is."""
        cores = self.system.cores.get(host) or 1
        return 1 < cores <= len(self.pinned.get(host, ())) and host in self.loose

    def pin(self, host: str | None, core: int | None) -> int:
        """Give the core that a thread must have, among the shared ones of a host where no core is left."""
        if host is None or core is None or not self.mixed(host):
            return -1
        return self.pinned[host].index(core) % (self.system.cores.get(host) or 1)
