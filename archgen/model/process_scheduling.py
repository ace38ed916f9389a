"""With which real-time priority and on which cores a process is started: what timing takes it to have, said to the kernel.

Linux gives both to a thread, and who starts a process gives them to all of its threads: so a process has one priority and
one set of cores, or none.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing
from archgen.model.node import Node

MAX_PRIORITY = 99
"""The most urgent priority that SCHED_FIFO has; 0 is none."""
SCHEDULING_SCRIPT = "run_scheduled"
"""The script that generated launch files put in front: it leaves out what the computer does not allow."""
_PREEMPTIVE_ORDERS = frozenset({None, "fair", "fixed_priority"})
"""Orders of a host in which a priority keeps others from the cores."""


@dataclass(frozen=True, slots=True)
class ProcessScheduling:
    """What the kernel is told of a process: its priority under SCHED_FIFO, and the cores that it may run on, from 0."""

    priority: int | None = None
    cores: tuple[int, ...] = ()

    @property
    def words(self) -> tuple[str, ...]:
        """The words that stand in front of a command; none where nothing is told."""
        first = () if self.priority is None else ("chrt", "-f", str(self.priority))
        return (*first, *(("taskset", "-c", ",".join(map(str, self.cores))) if self.cores else ()))

    def list_needed_rights(self) -> Iterator[str]:
        """Yield what of it only an administrator may do, as ends of "needs rights ..."."""
        if self.priority is not None:
            yield f"to run with the real-time priority {self.priority}"


NO_SCHEDULING = ProcessScheduling()
_PRIORITY = re.compile(r"[1-9][0-9]?\Z")
_CORE_RANGE = re.compile(r"([0-9]{1,4})(?:-([0-9]{1,4}))?\Z")
_MAX_CORE = 1023


def read_scheduling(words: Sequence[str]) -> tuple[ProcessScheduling, tuple[str, ...]]:
    """Read the words that stand in front of a command; what is none of `chrt -f` and `taskset -c`, and all behind it, is returned."""
    priority: int | None = None
    cores: tuple[int, ...] = ()
    rest = tuple(words)
    while rest:
        first, *others = rest
        if first == "--" or first.rpartition("/")[2] == SCHEDULING_SCRIPT:
            rest = tuple(others)
        elif first == "chrt" and len(others) > 1 and others[0] in {"-f", "--fifo"} and _PRIORITY.match(others[1]):
            priority, rest = int(others[1]), tuple(others[2:])
        elif first == "taskset" and len(others) > 1 and others[0] in {"-c", "--cpu-list"}:
            ranges = [_CORE_RANGE.match(each) for each in others[1].split(",")]
            numbers = [(int(each[1]), int(each[2] or each[1])) for each in ranges if each]
            is_list = len(numbers) == len(ranges) <= _MAX_CORE
            if not is_list or not all(begin <= last <= _MAX_CORE for begin, last in numbers):
                break
            cores = tuple(sorted({core for begin, last in numbers for core in range(begin, last + 1)}))
            rest = tuple(others[2:])
        else:
            break
    return ProcessScheduling(priority, cores), rest


def find_process_scheduling(architecture: Architecture, nodes: Sequence[Node]) -> ProcessScheduling:
    """Return what is told of a process that runs some nodes: what all that it runs has in common."""
    timings = list_process_timings(nodes)
    priorities = list(dict.fromkeys(timing.priority if timing else None for timing in timings))
    cores = list(dict.fromkeys(map(list_pinned_cores, timings)))
    priority = priorities[0] if len(priorities) == 1 and heeds_priorities(architecture, nodes) else None
    is_possible = priority is not None and 1 <= priority <= MAX_PRIORITY
    return ProcessScheduling(priority if is_possible else None, cores[0] if len(cores) == 1 else ())


def list_process_timings(nodes: Sequence[Node]) -> list[Timing | None]:
    """Return the timing of each thing that a process of some nodes runs, None where nothing is written of it."""
    return [node.timing.get(each) for node in nodes for each in node.implements or ("",)]


def list_pinned_cores(timing: Timing | None) -> tuple[int, ...]:
    """Return the cores to which something is pinned; none where it may run on all."""
    if timing is None:
        return ()
    return (timing.core,) if timing.core is not None else timing.cores or ()


def heeds_priorities(architecture: Architecture, nodes: Sequence[Node]) -> bool:
    """Whether the host of a process, if it has one, keeps to priorities on the cores that it may run on."""
    host = architecture.hosts.get(nodes[0].host or "") if nodes else None
    if host is None:
        return False
    cores = [core for timing in list_process_timings(nodes) for core in list_pinned_cores(timing)]
    return {host.scheduling, *(host.core_scheduling.get(core) for core in cores)} <= _PREEMPTIVE_ORDERS
