"""Whole configurations to try: which nodes are processes of their own, in which order a host runs them, what fires whom.

A node is never split, and leaves its container only where nothing that it reads or writes there is a shared memory. All of
a process has one priority, which is what a launch file can give it. Orders (`scheduling`) and cores that are written stay.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.search.change_trials import Changes, TriedChange
from archgen.timing.system.timing_system import Activity, is_selective_arc

ORDERS: Mapping[str, str] = {
    "rate": "priorities by rate",
    "deadline": "priorities by the chains' deadlines, then by rate",
    "end": "priorities by the chains' deadlines, then from each chain's end backwards",
    "chains": "priorities by rate, chains first",
}
"""The orders of the processes of a host that are tried, in words."""
_LOWEST_PRIORITY, _HIGHEST_PRIORITY = 10, 99
"""The least urgent priority that is given, which leaves room below it; and the most urgent one of SCHED_FIFO."""
_NAMED_MOVES = 2


@dataclass(frozen=True, slots=True)
class TriggerChoice:
    """A periodic element that is fired by each n-th message (`every`) of an input that it reads by its own clock now."""

    activity: str
    input: str
    every: int

    def list_changes(self) -> Iterator[TriedChange]:
        """Yield what is to be written."""
        yield TriedChange(self.activity, "timing.trigger", f"[{self.input}]")
        if self.every > 1:
            yield TriedChange(self.activity, "timing.every", str(self.every))

    def describe(self) -> str:
        """Return it in words."""
        which = "each message" if self.every == 1 else f"one message in {self.every}"
        return f"{self.activity} fired by {which} of its input {self.input}"


@dataclass(frozen=True, slots=True)
class RunConfiguration:
    """How an architecture is run: what differs from what is written. `priorities` are by process."""

    own_processes: tuple[str, ...] = ()
    """Nodes that leave their containers."""
    order: str = ""
    """The order that the priorities come from, a key of ORDERS."""
    priorities: tuple[tuple[str, int], ...] = ()
    moves: tuple[str, ...] = ()
    """What was moved to an end of its host's order, in words."""
    triggers: tuple[TriggerChoice, ...] = ()


class ConfigurationSpace:
    """The configurations of an architecture, from the analysis and the chains of what is written."""

    def __init__(self, architecture: Architecture, analysis: Analysis, chains: Mapping[str, ChainResult]) -> None:
        """Find out what may be changed."""
        self._architecture, self._analysis = architecture, analysis
        self._activities = analysis.system.activities
        self._chains = [chain for chain in chains.values() if chain.deadline is not None and chain.terms]
        self.separable_nodes = tuple(self._find_separable_nodes())
        on_chain = {self._activities[term.activity].host for chain in self._chains for term in chain.terms}
        self.ranked_hosts = tuple(
            host.id
            for host in architecture.hosts.values()
            if host.id in on_chain and host.scheduling in {None, "fixed_priority"} and not host.core_scheduling
        )

    def _find_separable_nodes(self) -> Iterator[str]:
        """Yield the nodes that can leave their containers: all but those that share data, or one that then is alone."""
        memory_nodes: set[str] = set()
        for arc in self._analysis.system.arcs:
            source, target = self._activities[arc.source], self._activities[arc.target]
            timing = self._architecture.nodes[target.node].timing.get(target.component or "")
            written = timing.inputs.get(arc.input) if timing else None
            if written and written.stored_at_once and source.container == target.container:
                memory_nodes |= {source.node, target.node}
        members: dict[str, list[str]] = defaultdict(list)
        for node in self._architecture.nodes.values():
            if node.container:
                members[node.container].append(node.id)
        for nodes in members.values():
            free_nodes = [node for node in nodes if node not in memory_nodes]
            yield from free_nodes[1:] if len(free_nodes) == len(nodes) else free_nodes

    def list_processes(self, host: str, own_processes: Sequence[str]) -> dict[str, list[Activity]]:
        """Return the processes of a host, each with what runs in it."""
        processes: dict[str, list[Activity]] = defaultdict(list)
        for activity in self._activities.values():
            if activity.host == host:
                is_own = activity.node in own_processes
                processes[f"node {activity.node}" if is_own else activity.executor].append(activity)
        return dict(processes)

    def rank(self, configuration: RunConfiguration, order: str) -> RunConfiguration:
        """Return a configuration with priorities for all processes on the hosts of the chains."""
        priorities: list[tuple[str, int]] = []
        for host in self.ranked_hosts:
            processes = self.list_processes(host, configuration.own_processes)
            names = sorted(processes, key=lambda name: self._make_rank_key(order, processes[name]))
            room = _HIGHEST_PRIORITY - _LOWEST_PRIORITY
            priorities += [
                (name, _LOWEST_PRIORITY + (place if len(names) <= room else place * room // len(names)))
                for place, name in enumerate(reversed(names))
                if len(names) > 1
            ]
        return replace(configuration, order=order, priorities=tuple(priorities))

    def _make_rank_key(self, order: str, members: Sequence[Activity]) -> tuple[bool | Fraction, ...]:
        """Return what a process is sorted by, the most urgent first."""
        names = {activity.id for activity in members}
        own_chains = [chain for chain in self._chains if names.intersection(chain.through)]
        deadline = min((chain.deadline.value or Fraction(0) for chain in own_chains if chain.deadline), default=None)
        rate = -max(self._analysis.paces[name].rate.value or Fraction(0) for name in names)
        if order == "rate":
            return (rate,)
        if deadline is None or order == "chains":
            return (deadline is None, rate) if order == "chains" else (True, rate)
        place = max(chain.through.index(name) for chain in own_chains for name in names.intersection(chain.through))
        return (False, deadline, *([Fraction(-place)] if order == "end" else []), rate)

    def list_moves(self, configuration: RunConfiguration, late_chains: Sequence[str]) -> Iterator[RunConfiguration]:
        """Yield configurations with one process moved: to an end of its host's order, those of late chains first; then by one place."""
        urgent_names = {name for chain in self._chains if chain.id in late_chains for name in chain.through}
        present = {host: self._list_priorities(host, configuration) for host in self.ranked_hosts}
        for host, priorities in present.items():
            processes = self.list_processes(host, configuration.own_processes)
            urgent = [name for name, members in processes.items() if any(a.id in urgent_names for a in members)]
            for process in (*urgent, *(name for name in processes if name not in urgent)):
                others = [priority for name, priority in priorities.items() if name != process]
                top, bottom = max(others, default=0) + 1, min(others, default=0) - 1
                ends = [(top, "first"), (bottom if len(others) == len(processes) - 1 else 0, "last")]
                for priority, word in ends if process in urgent else ends[::-1]:
                    if len(processes) > 1 and 1 <= priority <= _HIGHEST_PRIORITY:
                        yield _set_priorities(
                            configuration, {process: priority}, f"{name_process(process)} {word} on {host}"
                        )
        for host, priorities in present.items():
            ranked = sorted(priorities, key=lambda name: -priorities[name])
            for above, below in pairwise(ranked):
                swapped = {above: priorities[below], below: priorities[above]}
                yield _set_priorities(
                    configuration, swapped, f"{name_process(below)} before {name_process(above)} on {host}"
                )

    def _list_priorities(self, host: str, configuration: RunConfiguration) -> dict[str, int]:
        """Return the priority of each process on a host that has one: as configured, else the highest that is written in it."""
        configured = dict(configuration.priorities)
        written = {
            name: max((a.priority for a in members if a.priority is not None), default=None)
            for name, members in self.list_processes(host, configuration.own_processes).items()
        }
        return {n: rank for n, own in written.items() if (rank := configured.get(n, own)) is not None}

    def find_order(self, configuration: RunConfiguration) -> tuple[object, ...]:
        """Return what two configurations share that run everything in the same order, whatever numbers they give."""
        orders: list[tuple[str, int]] = []
        for host in self.ranked_hosts:
            priorities = self._list_priorities(host, configuration)
            places = {value: place for place, value in enumerate(sorted(set(priorities.values())))}
            orders += [(name, places[value]) for name, value in priorities.items()]
        is_ranked = bool(configuration.priorities)
        return configuration.own_processes, configuration.triggers, is_ranked, tuple(orders)

    def list_triggers(self, chain_ids: Sequence[str]) -> list[TriggerChoice]:
        """Return the triggers that would spare chains the wait for a clock, what waits longest first.

        The element is fired at least as often as it works now; what it reads must come at a sure rate, from one source.
        """
        choices: dict[TriggerChoice, Fraction] = {}
        for chain in (chain for chain in self._chains if chain.id in chain_ids):
            for source, reader in pairwise(chain.through):
                choice = self._find_trigger(source, reader)
                if choice is not None:
                    choices[choice] = self._analysis.paces[reader].gap.value or Fraction(0)
        return sorted(choices, key=lambda choice: -choices[choice])

    def _find_trigger(self, source: str, reader_id: str) -> TriggerChoice | None:
        system, reader = self._analysis.system, self._activities[reader_id]
        own_rate = self._analysis.paces[reader_id].rate.value
        for arc in system.arcs_into.get(reader_id, ()):
            port = self._architecture.inputs.get(arc.input)
            writers = [other for other in system.arcs_into[reader_id] if other.input == arc.input]
            if arc.source != source or arc.role != "data" or port is None or len(writers) > 1:
                continue
            rate = self._analysis.outputs[arc.source, arc.output].rate.value
            if reader.behaviour != "periodic" or not own_rate or not rate or is_selective_arc(system, arc):
                continue
            if rate >= own_rate and not self._activities[source].conditional:
                return TriggerChoice(reader_id, port.name, int(rate / own_rate))
        return None

    def list_changes(self, configuration: RunConfiguration) -> Changes:
        """Return what is to be written for a configuration: no more than differs."""
        changes = [TriedChange(node, "container", "none") for node in configuration.own_processes]
        priorities = dict(configuration.priorities)
        for host in self.ranked_hosts if priorities else ():
            for process, members in self.list_processes(host, configuration.own_processes).items():
                priority = priorities.get(process)
                nodes = dict.fromkeys(
                    activity.node for activity in members if priority is not None and activity.priority != priority
                )
                changes += [TriedChange(node, "timing.priority", str(priority)) for node in nodes]
        return (*changes, *(change for choice in configuration.triggers for change in choice.list_changes()))

    def list_smaller(self, configuration: RunConfiguration) -> Iterator[RunConfiguration]:
        """Yield configurations that change less: without the priorities of one host, the processes of one container."""
        priorities = dict(configuration.priorities)
        for host in self.ranked_hosts:
            processes = self.list_processes(host, configuration.own_processes)
            ranked = sorted((name for name in processes if name in priorities), key=lambda name: priorities[name])
            on_chain = [
                any(a.id in chain.through for chain in self._chains for a in processes[name]) for name in ranked
            ]
            tail = ranked[: on_chain.index(True)] if True in on_chain else ranked
            for left_out in (ranked, tail):
                if left_out:
                    kept = tuple((name, value) for name, value in configuration.priorities if name not in left_out)
                    yield replace(configuration, priorities=kept)
        containers = dict.fromkeys(self._architecture.nodes[node].container for node in configuration.own_processes)
        for container in containers:
            kept_nodes = tuple(
                n for n in configuration.own_processes if self._architecture.nodes[n].container != container
            )
            yield replace(configuration, own_processes=kept_nodes)
        for choice in configuration.triggers:
            yield replace(configuration, triggers=tuple(each for each in configuration.triggers if each != choice))

    def describe(self, configuration: RunConfiguration) -> str:
        """Return a configuration in words: `a process for each node, priorities by rate`."""
        own_nodes = configuration.own_processes
        phrases = (
            [
                "a process for each node"
                if own_nodes == self.separable_nodes
                else f"processes of their own for {join_words(own_nodes)}"
            ]
            if own_nodes
            else []
        )
        if configuration.order and configuration.priorities:
            ranked = dict(configuration.priorities)
            processes_by_host = {host: self.list_processes(host, own_nodes) for host in self.ranked_hosts}
            hosts = [host for host, processes in processes_by_host.items() if ranked.keys() & processes.keys()]
            rest = any(ranked.keys() & p.keys() and p.keys() - ranked.keys() for p in processes_by_host.values())
            place = f" on {join_words(hosts)}" if len(hosts) < len(self.ranked_hosts) else ""
            phrases.append(
                f"{ORDERS[configuration.order]}{place}{' (not for what is below the chains)' if rest else ''}"
            )
        moves = configuration.moves
        phrases += [
            *(moves if len(moves) <= _NAMED_MOVES else [f"{len(moves)} moves in it"]),
            *(choice.describe() for choice in configuration.triggers),
        ]
        return ", ".join(phrases) or "as written"


def name_process(process: str) -> str:
    """Return the id of a process's node or container."""
    return process.partition(" ")[2]


def _set_priorities(configuration: RunConfiguration, priorities: Mapping[str, int], move: str) -> RunConfiguration:
    new_priorities = {**dict(configuration.priorities), **priorities}
    return replace(configuration, priorities=tuple(new_priorities.items()), moves=(*configuration.moves, move))
