"""A configuration in which all chains meet their deadlines, or the one in which they are least late; each is analysed.

Bounded by a number of tries, in a fixed order: the same files give the same proposal everywhere.

Whole configurations are tried: which nodes are processes of their own, in which order and on which cores a host runs
them, what fires whom.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise, product

from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.search.change_trials import Changes, ChangeTrials, OverrideLayer, TriedChange, TriesSpentError
from archgen.timing.system.timing_system import Activity, is_selective_arc

ORDERS: Mapping[str, str] = {
    "rate": "priorities by rate",
    "deadline": "priorities by the chains' deadlines, then by rate",
    "end": "priorities by the chains' deadlines, then from each chain's end backwards",
    "chains": "priorities by rate, chains first",
    "": "priorities",
}
"""The orders of the processes of a host, in words; the last one is that of processes which were moved alone."""
_LOWEST_PRIORITY, _HIGHEST_PRIORITY = 10, 99
"""The least urgent priority that is given, which leaves room below it; and the most urgent one of SCHED_FIFO."""
_NAMED_MOVES = 2
Ranking = tuple[str, ...]
"""Processes of a host, the most urgent first; those that are not in it have no priority."""
HostCores = tuple[str, tuple[tuple[str, int], ...]]
"""A host, and its processes, each with the core on which alone it runs."""


@dataclass(frozen=True, slots=True)
class TriggerChoice:
    """A periodic element that is fired by each n-th message (`every`) of an input that it reads by its own clock now."""

    activity: str
    input: str
    every: int
    message_rate: Fraction
    """Messages for each time that it works now."""

    def list_changes(self) -> Iterator[TriedChange]:
        """Yield what is to be written."""
        yield TriedChange(self.activity, "timing.trigger", f"[{self.input}]")
        if self.every > 1:
            yield TriedChange(self.activity, "timing.every", str(self.every))

    def describe(self) -> str:
        """Return it in words."""
        which = "each message" if self.every == 1 else f"one message in {self.every}"
        factor = int(self.message_rate / self.every)
        oftener = f", {factor} times as often as now" if factor > 1 else ""
        return f"{self.activity} fired by {which} of its input {self.input}{oftener}"


@dataclass(frozen=True, slots=True)
class RunConfiguration:
    """How an architecture is run: what differs from what is written. `rankings` are by host."""

    own_processes: tuple[str, ...] = ()
    """Nodes that leave their containers."""
    order: str = ""
    """The order that the rankings come from, a key of ORDERS."""
    rankings: tuple[tuple[str, Ranking], ...] = ()
    pins: tuple[HostCores, ...] = ()
    moves: tuple[str, ...] = ()
    """What was moved within the order, in words."""
    triggers: tuple[TriggerChoice, ...] = ()

    def with_ranking(self, host: str, ranking: Ranking, move: str = "") -> RunConfiguration:
        """Return a configuration with another ranking of one host: an empty one leaves its priorities as they are written."""
        rankings = {**dict(self.rankings), host: ranking}
        kept = tuple((name, each) for name, each in rankings.items() if each)
        return replace(self, rankings=kept, moves=(*self.moves, move) if move else self.moves)


NextLister = Callable[[RunConfiguration], Iterable[RunConfiguration]]
"""Lists what to try after a configuration."""


class ConfigurationSpace:
    """The configurations of an architecture, from the analysis and the chains of what is written."""

    def __init__(self, architecture: Architecture, analysis: Analysis, chains: Mapping[str, ChainResult]) -> None:
        """Find out what may be changed."""
        self._architecture, self._analysis = architecture, analysis
        self._activities = analysis.system.activities
        self._chains = [chain for chain in chains.values() if chain.deadline is not None and chain.terms]
        self._on_chain = {name for chain in self._chains for name in chain.through}
        self.separable_nodes = tuple(self._find_separable_nodes())
        chain_hosts = {self._activities[name].host for name in self._on_chain}
        self.ranked_hosts = tuple(
            host.id
            for host in architecture.hosts.values()
            if host.id in chain_hosts and host.scheduling in {None, "fixed_priority"} and not host.core_scheduling
        )
        pinned_hosts = {activity.host for activity in self._activities.values() if activity.cores}
        cores = {host: analysis.system.cores.get(host) or 1 for host in self.ranked_hosts if host not in pinned_hosts}
        self.free_cores = {host: count for host, count in cores.items() if count > 1}
        """How many cores hosts have that have several, of which none is written for anything."""

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
        ranked = replace(configuration, order=order)
        for host in self.ranked_hosts:
            processes = self.list_processes(host, configuration.own_processes)
            if len(processes) > 1:
                names = sorted(processes, key=lambda name: self._make_rank_key(order, processes[name]))
                ranked = ranked.with_ranking(host, tuple(names))
        return ranked

    def pin(self, configuration: RunConfiguration) -> RunConfiguration:
        """Return a configuration in which each process has one core: those with most to do first, where least is to do."""
        pins_by_host: list[HostCores] = []
        for host, core_count in self.free_cores.items():
            processes = self.list_processes(host, configuration.own_processes)
            shares = {name: share.value or Fraction(0) for name, share in self._analysis.hosts[host].activity_shares}
            loads = {name: sum(shares.get(each.id, 0) for each in members) for name, members in processes.items()}
            core_loads, pins = [Fraction(0)] * core_count, dict[str, int]()
            for name in sorted(loads, key=lambda each: -loads[each]):
                core = pins[name] = core_loads.index(min(core_loads))
                core_loads[core] += loads[name]
            if len(pins) > 1:
                pins_by_host.append((host, tuple(pins.items())))
        return replace(configuration, pins=tuple(pins_by_host))

    def _make_rank_key(self, order: str, members: Sequence[Activity]) -> tuple[bool | Fraction, ...]:
        """Return what a process is sorted by, the most urgent first."""
        names = {activity.id for activity in members}
        own_chains = [chain for chain in self._chains if names.intersection(chain.through)]
        deadline = min((chain.deadline.value or Fraction(0) for chain in own_chains if chain.deadline), default=None)
        rate = -max(self._analysis.paces[name].rate.value or Fraction(0) for name in names)
        if order == "rate":
            return (rate,)
        if deadline is None or order == "chains":
            return (deadline is None, rate)
        place = max(chain.through.index(name) for chain in own_chains for name in names.intersection(chain.through))
        return (False, deadline, *([Fraction(-place)] if order == "end" else []), rate)

    def list_moves(self, configuration: RunConfiguration, late_chains: Sequence[str]) -> Iterator[RunConfiguration]:
        """Yield configurations with one process moved: to an end of its host's order, late chains first; then by one place."""
        urgent_names = {name for chain in self._chains if chain.id in late_chains for name in chain.through}
        rankings = dict(configuration.rankings)
        for host in self.ranked_hosts:
            processes = self.list_processes(host, configuration.own_processes)
            is_written = any(activity.priority is not None for members in processes.values() for activity in members)
            if len(processes) == 1 or (is_written and host not in rankings):
                continue
            ranking = rankings.get(host, ())
            urgent = [name for name, members in processes.items() if any(a.id in urgent_names for a in members)]
            for process in (*urgent, *(name for name in processes if name not in urgent)):
                others = tuple(name for name in ranking if name != process)
                ends = [((process, *others), "first")]
                if len(ranking) == len(processes):
                    ends.insert(len(ends) if process in urgent else 0, ((*others, process), "last"))
                yield from (
                    configuration.with_ranking(host, moved, f"{process.partition(' ')[2]} {word} on {host}")
                    for moved, word in ends
                )
        for host, ranking in rankings.items():
            for place, (above, below) in enumerate(pairwise(ranking)):
                swapped = (*ranking[:place], below, above, *ranking[place + 2 :])
                names = [name.partition(" ")[2] for name in (below, above)]
                yield configuration.with_ranking(host, swapped, f"{' before '.join(names)} on {host}")

    def list_smaller(self, configuration: RunConfiguration) -> Iterator[RunConfiguration]:
        """Yield configurations that change less: fewer pins, priorities of fewer processes, fewer processes, or fewer triggers."""
        for pinned in configuration.pins:
            yield replace(configuration, pins=tuple(each for each in configuration.pins if each != pinned))
        for host, ranking in configuration.rankings:
            processes = self.list_processes(host, configuration.own_processes)
            needed = [place for place, name in enumerate(ranking) if self._on_chain & {a.id for a in processes[name]}]
            yield configuration.with_ranking(host, ())
            yield configuration.with_ranking(host, ranking[: max(needed, default=-1) + 1])
        container_of = {node: self._architecture.nodes[node].container for node in configuration.own_processes}
        for container in dict.fromkeys(container_of.values()):
            kept_nodes = tuple(node for node, own_container in container_of.items() if own_container != container)
            processes_left = replace(configuration, own_processes=kept_nodes)
            ranked = self.rank(processes_left, configuration.order) if configuration.order else processes_left
            yield self.pin(ranked) if configuration.pins else ranked
        for choice in configuration.triggers:
            yield replace(configuration, triggers=tuple(each for each in configuration.triggers if each != choice))

    def list_triggers(self, chain_ids: Sequence[str], *, by_each_message: bool = False) -> list[TriggerChoice]:
        """Return the triggers that would spare chains the wait for a clock, what waits longest first.

        The element is fired at least as often as it works now, but no oftener than it must or `by_each_message`;
        what it reads must come at a sure rate, from one source.
        """
        choices: dict[TriggerChoice, Fraction] = {}
        for chain in (chain for chain in self._chains if chain.id in chain_ids):
            for source, reader in pairwise(chain.through):
                choice = self._find_trigger(source, reader)
                if choice is not None:
                    fastest = replace(choice, every=1) if by_each_message else choice
                    choices[fastest] = self._analysis.paces[reader].gap.value or Fraction(0)
        return sorted(choices, key=lambda choice: -choices[choice])

    def _find_trigger(self, source: str, reader_id: str) -> TriggerChoice | None:
        system, reader = self._analysis.system, self._activities[reader_id]
        own_rate = self._analysis.paces[reader_id].rate.value
        arcs = [arc for arc in system.arcs_into.get(reader_id, ()) if arc.role == "data"]
        for arc in (arc for arc in arcs if arc.source == source):
            port = self._architecture.inputs.get(arc.input)
            rate = self._analysis.outputs[source, arc.output].rate.value
            is_sure = not self._activities[source].conditional and not is_selective_arc(system, arc)
            has_one_source = sum(other.input == arc.input for other in arcs) == 1
            if port and own_rate and rate and reader.behaviour == "periodic" and is_sure and has_one_source:
                every, message_rate = int(rate / own_rate), rate / own_rate
                return TriggerChoice(reader_id, port.name, every, message_rate) if every else None
        return None

    def list_changes(self, configuration: RunConfiguration) -> Changes:
        """Return what is to be written for a configuration: no more than differs."""
        changes = [TriedChange(node, "container", "none") for node in configuration.own_processes]
        for host, ranking in configuration.rankings:
            processes = self.list_processes(host, configuration.own_processes)
            room = _HIGHEST_PRIORITY - _LOWEST_PRIORITY
            for place, process in enumerate(reversed(ranking)):
                step = place if len(ranking) <= room else place * room // len(ranking)
                members = [a for a in processes.get(process, ()) if a.priority != _LOWEST_PRIORITY + step]
                changes += [
                    TriedChange(node, "timing.priority", str(_LOWEST_PRIORITY + step))
                    for node in dict.fromkeys(activity.node for activity in members)
                ]
        for host, pins in configuration.pins:
            processes = self.list_processes(host, configuration.own_processes)
            changes += [
                TriedChange(node, "timing.core", str(core))
                for process, core in pins
                for node in dict.fromkeys(activity.node for activity in processes.get(process, ()))
            ]
        return (*changes, *(change for choice in configuration.triggers for change in choice.list_changes()))

    def describe(self, configuration: RunConfiguration) -> str:
        """Return a configuration in words: `a process for each node, priorities by rate`."""
        own_nodes, moves = configuration.own_processes, configuration.moves
        is_each = own_nodes == self.separable_nodes
        phrases = (
            ["a process for each node" if is_each else f"own processes for {join_words(own_nodes)}"]
            if own_nodes
            else []
        )
        if configuration.rankings and configuration.order:
            hosts = [host for host, _ in configuration.rankings]
            place = f" on {join_words(hosts)}" if len(hosts) < len(self.ranked_hosts) else ""
            sizes = [
                (len(ranking), len(self.list_processes(host, own_nodes))) for host, ranking in configuration.rankings
            ]
            tail = ", none below the chains" if any(ranked < count for ranked, count in sizes) else ""
            phrases.append(f"{ORDERS[configuration.order]}{place}{tail}")
        if configuration.pins:
            phrases.append(f"each process on one core of {join_words([host for host, _ in configuration.pins])}")
        phrases += moves if len(moves) <= _NAMED_MOVES else [f"{len(moves)} moves in it"]
        return ", ".join([*phrases, *(choice.describe() for choice in configuration.triggers)]) or "as written"


MAX_TRIES, _UNASKED_TRIES = 120, 60
"""How many configurations are tried for a project: where somebody asks, and where nobody did and it is small."""
_SMALL_SIZE, _LEAST_TRIES = 150, 12
"""So many activities make a small project; and so many configurations are tried of the largest one that nobody asked for."""
_KEPT_TRIES = 12
"""How many tries moving single elements leaves for what comes after it."""
_UNBOUNDED_LATENESS = Fraction(3)
"""How late a chain without a bound counts, in deadlines; and one with a bound at most."""


@dataclass(frozen=True, slots=True)
class TriedConfiguration:
    """A configuration that was analysed: what is to be written for it, and what its chains take at most then, in ns.

    `lateness` is the sum over the chains of how far each is above its deadline, in deadlines.
    """

    words: str
    changes: Changes
    bounds: Mapping[str, Fraction | None]
    late: tuple[str, ...]
    lateness: Fraction

    @property
    def rank(self) -> tuple[Fraction, int]:
        """Return what configurations are compared by: lateness, and then how much is to be changed."""
        return self.lateness, len(self.changes)

    @property
    def changes_triggers(self) -> bool:
        """Whether it changes what fires an element, and with that a program."""
        return any(change.kind == "trigger" for change in self.changes)


@dataclass(frozen=True, slots=True)
class Proposal:
    """What was tried for the chains that are not met, in its order: what is written is the first."""

    deadlines: Mapping[str, Fraction]
    hopeless: Mapping[str, Fraction]
    """The floors that are above the deadline of their chain, in ns."""
    tried: tuple[TriedConfiguration, ...]
    is_cut: bool = False
    """Whether more could have been tried."""
    unjudged: tuple[str, ...] = ()
    """Chains that have a deadline, and lack figures."""

    @property
    def best(self) -> TriedConfiguration:
        """Return the one that is least late, and makes no chain late that is not so now: what is written, if none is better."""
        return self._find_best(self.tried)

    @property
    def kept_triggers(self) -> TriedConfiguration:
        """Return the best one that changes no trigger."""
        return self._find_best([each for each in self.tried if not each.changes_triggers])

    def _find_best(self, tried: Sequence[TriedConfiguration]) -> TriedConfiguration:
        harmless = [each for each in tried if set(each.late) <= set(self.tried[0].late)]
        return min(harmless, key=lambda each: each.rank)


def find_short_proposal(
    architecture: Architecture, analysis: Analysis, results: Mapping[str, ChainResult], lay_overrides: OverrideLayer
) -> Proposal | None:
    """Look for a configuration in which chains are met, without being asked for it; None where none is late.

    Of a large project fewer are tried: `--propose` tries them all.
    """
    if not any(result.deadline and result.verdict in {"missed", "not proven"} for result in results.values()):
        return None
    tries = max(_LEAST_TRIES, _UNASKED_TRIES * _SMALL_SIZE // max(_SMALL_SIZE, len(analysis.system.activities)))
    return find_proposal(ChangeTrials(architecture, analysis, lay_overrides, tries), results)


def find_proposal(trials: ChangeTrials, chains: Mapping[str, ChainResult], *, keep_triggers: bool = False) -> Proposal:
    """Look for the configuration that proves all chains, or else the one in which they are least late."""
    return _ProposalSearch(trials, chains, keep_triggers=keep_triggers).run()


class _ProposalSearch:
    def __init__(self, trials: ChangeTrials, chains: Mapping[str, ChainResult], *, keep_triggers: bool) -> None:
        self.trials, self.space = trials, ConfigurationSpace(trials.architecture, trials.analysis, chains)
        # However things are run, what lacks figures is not proven.
        judged = [c for c in chains.values() if c.terms and c.verdict != "open" and not c.bound.missing]
        self.deadlines = {
            chain.id: chain.deadline.value for chain in judged if chain.deadline and chain.deadline.value is not None
        }
        self.unjudged = tuple(
            chain.id for chain in chains.values() if chain.deadline and chain.id not in self.deadlines
        )
        self.keeps_triggers = keep_triggers
        self.hopeless: dict[str, Fraction] = {}
        self.tried: dict[Changes, tuple[TriedConfiguration, RunConfiguration]] = {}
        self.written = self.best = self._try(RunConfiguration())
        self.is_cut = False

    def run(self) -> Proposal:
        """Search until all chains are proven, or no try is left."""
        if self.written.late:
            self.hopeless = self._find_hopeless(())
            try:
                self._search()
                self._climb(self.best, self.space.list_smaller)
            except TriesSpentError:
                self.is_cut = True
        tried = tuple(each for each, _ in self.tried.values())
        return Proposal(self.deadlines, self.hopeless, tried, self.is_cut, self.unjudged)

    def _search(self) -> None:
        if self._try_orders():
            return
        if self.hopeless and not self.keeps_triggers:
            triggers = self._choose_triggers()
            if triggers and self._try_orders(triggers):
                return
        for start in self._list_starts():
            self._climb(start, lambda each: self.space.list_moves(each, self.best.late), _KEPT_TRIES)
        if not self.keeps_triggers and self.best.late:
            self._add_triggers()

    def _list_starts(self) -> list[TriedConfiguration]:
        """Return the best configurations with a core for each process and without, the better one first."""
        starts: dict[bool, TriedConfiguration] = {}
        for tried, configuration in sorted(self.tried.values(), key=lambda each: each[0].rank):
            if self._is_harmless(tried):
                starts.setdefault(bool(configuration.pins), tried)
        return list(starts.values())

    def _is_harmless(self, tried: TriedConfiguration) -> bool:
        return set(tried.late) <= set(self.written.late)

    def _add_triggers(self) -> None:
        """Try triggers of the late chains: all with each order, and one after the other on top of the best configuration."""
        late = self.best.late
        slow_choices = self.space.list_triggers(late)
        has_room = self.trials.tries_left > 2 * _KEPT_TRIES
        if has_room and slow_choices and not self.hopeless and self._try_orders(slow_choices):
            return
        for choice in (*slow_choices, *self.space.list_triggers(late, by_each_message=True)):
            if self.best.late:
                base = self.tried[self.best.changes][1]
                others = tuple(each for each in base.triggers if each.activity != choice.activity)
                self._try(replace(base, triggers=(*others, choice)))

    def _find_hopeless(self, changes: Changes) -> dict[str, Fraction]:
        """Return the floors that are above their chain's deadline with some changes."""
        floors = self.trials.find_floors(changes)
        return {name: floors[name] for name, limit in self.deadlines.items() if floors.get(name, limit) > limit}

    def _try(self, configuration: RunConfiguration) -> TriedConfiguration:
        """Analyse a configuration, or recall how it was; it is the best if it is better, and makes no other chain late."""
        changes = self.space.list_changes(configuration)
        if changes in self.tried:
            return self.tried[changes][0]
        slacks = {name: self.trials.find_slack(name, changes) for name in self.deadlines}
        bounds = {name: None if slack is None else self.deadlines[name] - slack for name, slack in slacks.items()}
        late = {name: slack for name, slack in slacks.items() if slack is None or slack < 0}
        lateness = [
            _UNBOUNDED_LATENESS if slack is None else min(_UNBOUNDED_LATENESS, -slack / self.deadlines[name])
            for name, slack in late.items()
        ]
        words = self.space.describe(configuration)
        result = TriedConfiguration(words, changes, bounds, tuple(late), sum(lateness, Fraction(0)))
        self.tried[changes] = result, configuration
        if changes and self._is_harmless(result) and result.rank < self.best.rank:
            self.best = result
        return result

    def _try_orders(self, triggers: Sequence[TriggerChoice] = ()) -> bool:
        """Try each order, with the processes as they are and with one for each node; then with a core for each process."""
        own_choices = dict.fromkeys(((), self.space.separable_nodes))
        for is_pinned in (False, True) if self.space.free_cores else (False,):
            for order, own_processes in product(("", *filter(None, ORDERS)), own_choices):
                configuration = RunConfiguration(own_processes=own_processes, triggers=tuple(triggers))
                configuration = self.space.rank(configuration, order) if order else configuration
                self._try(self.space.pin(configuration) if is_pinned else configuration)
                if not self.best.late:
                    return True
        return False

    def _choose_triggers(self) -> tuple[TriggerChoice, ...]:
        """Return the fewest triggers with which no chain's floor is above its deadline; empty where none do.

        Who works oftener than now takes more of its host: only where nothing else is short enough.
        """
        for by_each_message in (False, True):
            choices = self.space.list_triggers(list(self.hopeless), by_each_message=by_each_message)
            for count in range(1, len(choices) + 1):
                triggers = tuple(choices[:count])
                if not self._find_hopeless(self.space.list_changes(RunConfiguration(triggers=triggers))):
                    return triggers
        return ()

    def _climb(self, start: TriedConfiguration, list_next: NextLister, kept_tries: int = 0) -> None:
        """Go on to the first configuration after one that is better, as long as there is one."""
        is_better = True
        while is_better and (self.best.late or not kept_tries):
            is_better = False
            for configuration in list_next(self.tried[start.changes][1]):
                if self.trials.tries_left <= kept_tries:
                    self.is_cut = True
                    return
                tried = self._try(configuration)
                if self._is_harmless(tried) and tried.rank < start.rank:
                    start, is_better = tried, True
                    break
