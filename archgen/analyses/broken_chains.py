"""Can data flow along each chain, and does each step of a use case run along a connection?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from itertools import pairwise

from archgen.diagnostics import Diagnostic, Label, Severity, find_closest, join_words
from archgen.model import flow_graph
from archgen.model.architecture import Architecture, Chain, UseCase, Waypoint
from archgen.model.component import Input
from archgen.model.flow_graph import FlowGraph, build_component_graph
from archgen.model.graph_search import find_reachable
from archgen.model.step_connections import StepConnections
from archgen.model.use_case_steps import Step, StepEnd

_MAX_BETWEEN = 3
"""So many components between two are named where a step leaves them out."""
_MAX_VISITS = 300_000
"""Components that are visited in one run to find what lies between: in a project of usual size for every step."""


def broken_step(architecture: Architecture) -> Iterator[Diagnostic]:
    """A step of a use case runs along no connection."""
    if not any(use_case.steps for use_case in architecture.use_cases.values()):
        return
    judge = _StepJudge(architecture)
    for use_case in architecture.use_cases.values():
        for number, step in enumerate(use_case.steps, 1):
            if judge.connections.needs_connection(step) and not judge.connections.find_connections(step):
                yield from judge.diagnose_step(use_case, number, step)


class _StepJudge:
    """Says what is wrong with steps without a connection; what that takes is computed once, and only if there is one."""

    def __init__(self, architecture: Architecture) -> None:
        self.architecture = architecture
        self.connections = StepConnections(architecture)
        self._open_components: frozenset[str] | None = None
        self._graph: FlowGraph | None = None
        self._visits_left = _MAX_VISITS

    def diagnose_step(self, use_case: UseCase, number: int, step: Step) -> Iterator[Diagnostic]:
        """Report a step that runs along no connection."""
        ends = [end for end in (step.source, step.target) if end.kind != "actor"]
        if any(self._is_open(end.participant) for end in ends):
            return
        fault, help_line = self._describe_fault(use_case, step)
        declared = (self.architecture.find_component(end.participant) for end in ends)
        yield Diagnostic(
            "broken-step",
            f"in the use case `{use_case.id}`, step {number} runs along no connection: {fault}",
            step.at,
            labels=tuple(Label(component.at, f"`{component.id}`") for component in declared if component),
            help=help_line,
            element=use_case.id,
        )

    def _is_open(self, component_id: str) -> bool:
        """Whether an input of a component has a source that is not resolved: that is reported, and may be what is missing."""
        if self._open_components is None:
            # What reads an input of the component around it has no connection of its own, and lacks none.
            handed_in = {port for ports in self.architecture.shell_ports.values() for port in ports}
            self._open_components = frozenset(
                port.component
                for port in self.architecture.inputs.values()
                if port.from_written and not port.connections and port.id not in handed_in
            )
        return bool(self._open_components) and not self._open_components.isdisjoint(
            self.architecture.leaves_of(component_id)
        )

    def _describe_fault(self, use_case: UseCase, step: Step) -> tuple[str, str]:
        source, target = step.source, step.target
        if source.kind == "actor":
            who = use_case.actors[source.id].title
            return (
                f"no input of `{target.participant}` is `external`, where something comes in from outside",
                f"write at the input that takes it who gives it: `{{external: {_shorten_sentence(who)}}}`, or lead the step to another component",
            )
        if target.kind == "actor":
            what = f"`{source.id}` is not" if source.kind == "output" else f"no output of `{source.id}` is"
            return (
                f"{what} `external`, and so goes to nobody outside",
                "write at the output who takes it: `{external: ...}`, or let another component begin the step",
            )
        if target.kind == "output":
            return (
                f"`{source.participant}` does not call `{target.id}`",
                f"a step leads to an output only where that is a service or action; else to its component, `{target.participant}`",
            )
        return f"nothing leads from `{source.id}` to `{target.id}`", self._suggest_connection(source, target)

    def _suggest_connection(self, source: StepEnd, target: StepEnd) -> str:
        """Return what can be done about two components between which nothing is connected."""
        connections, sender, reader = self.connections, source.participant, target.participant
        direct = [each.output for each in connections.list_between(sender, reader) if each.output]
        if source.kind == "output" and direct:
            return f"`{direct[0]}` does: name that, or `{sender}`"
        turned = [each.output for each in connections.list_between(reader, sender) if each.output]
        if turned:
            return f"`{turned[0]}` leads the other way: turn the step round, or write the connection that is missing"
        sent = connections.list_sent(sender)
        readers = (self.architecture.inputs[each.input].component for each in sent if each.input)
        guess = find_closest(reader, (name for name in readers if name != reader))
        if guess is not None:
            return f"did you mean `{guess}`?"
        between = self._find_between(sender, reader)
        if between:
            return f"it goes over {join_words([f'`{each}`' for each in between])}: write a step for each"
        output = source.id if source.kind == "output" else self._choose_output(sender)
        return f"connect them at `{reader}`: `inputs: {{INPUT: {output}}}`, or write the steps that lie between"

    def _choose_output(self, component_id: str) -> str:
        component = self.architecture.find_component(component_id)
        return next(
            (port.id for port in component.outputs.values()) if component else iter(()), f"{component_id}.OUTPUT"
        )

    def _find_between(self, sender: str, reader: str) -> tuple[str, ...]:
        """Return the components on a shortest way from one to the other; none if it is long, or there is none."""
        if self._visits_left <= 0:
            return ()
        self._graph = self._graph or build_component_graph(self.architecture)
        starts, goals = self.architecture.leaves_of(sender), frozenset(self.architecture.leaves_of(reader))
        # Backwards, so that each step of the way is one that comes nearer.
        distances = find_reachable(self._graph.predecessors, goals, _MAX_BETWEEN + 1)
        self._visits_left -= len(distances)
        place = min((start for start in starts if start in distances), key=distances.__getitem__, default=None)
        way: list[str] = []
        while place is not None and distances[place] > 1:
            nearer = distances[place] - 1
            place = next(each for each in self._graph.successors[place] if distances.get(each) == nearer)
            way.append(place)
        return tuple(way)


def _shorten_sentence(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= 40 else f"{line[:39]}…"  # noqa: PLR2004 - what an example line holds


def broken_chain(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing flows from one element of a chain to the next, not even through others."""
    if not any(len(chain.through) > 1 for chain in architecture.chains.values()):
        return
    # The graph of components, not of nodes: a chain can be judged before anything is mapped to nodes.
    successors = flow_graph.build_component_graph(architecture).successors
    readers = _readers_by_output(architecture)
    open_components = _list_open_components(architecture)
    for chain in architecture.chains.values():
        if _runs_backwards(architecture, chain, successors):
            yield _diagnose_backward_chain(chain)
            continue
        for waypoint, next_waypoint in pairwise(chain.through):
            # A chain that goes through an output leaves its component by that output only.
            starts = (
                readers[waypoint.id] if waypoint.kind == "output" else _components_of_waypoint(architecture, waypoint)
            )
            goals = _components_of_waypoint(architecture, next_waypoint)
            reached = find_reachable(successors, starts).keys()
            # Inputs whose `from` could not be resolved are reported already, and one of them may be the missing step:
            # `unsure - reached` are the components with such inputs that cannot be reached from here.
            if (
                not goals
                or not _components_of_waypoint(architecture, waypoint)
                or goals & reached
                or open_components - reached
            ):
                continue
            yield Diagnostic(
                "broken-chain",
                f"in the chain `{chain.id}`, nothing leads from `{waypoint.id}` to `{next_waypoint.id}`",
                next_waypoint.at,
                labels=(Label(waypoint.at, "from here"),),
                help="name the connection that is missing in an input, or correct the order in `through`",
                element=chain.id,
            )


def _runs_backwards(architecture: Architecture, chain: Chain, successors: Mapping[str, Collection[str]]) -> bool:
    """Whether each of three elements or more leads to the one before it, and none to the one behind it.

    Of two elements, that nothing leads from one to the other says it as well.
    """
    steps = [_components_of_waypoint(architecture, waypoint) for waypoint in chain.through]
    if not all(steps):
        return False
    reached = [find_reachable(successors, step).keys() for step in steps]
    return len(steps) > 2 and all(  # noqa: PLR2004
        reached[number + 1] & steps[number] and not reached[number] & steps[number + 1]
        for number in range(len(steps) - 1)
    )


def _diagnose_backward_chain(chain: Chain) -> Diagnostic:
    right_order = ", ".join(waypoint.id for waypoint in reversed(chain.through))
    return Diagnostic(
        "broken-chain",
        f"the chain `{chain.id}` runs against what flows: from `{chain.through[0].id}` nothing leads to `{chain.through[-1].id}`",
        chain.through[0].at,
        help=f"a chain begins where the data come from: `[{right_order}]`",
        element=chain.id,
    )


def _list_open_components(architecture: Architecture) -> set[str]:
    """Return the ids of the components with an input of which the `from` could not be resolved.

    What reads an input of the composed component around it (`self.x`) is as open as that one: where that is fed by
    nothing or by the outside, nothing is missing.
    """
    givers = defaultdict[str, list[str]](list)
    for shell_port, readers in architecture.shell_ports.items():
        kind, _, shell_input = shell_port.partition(" ")
        if kind == "input":
            for reader in readers:
                givers[reader].append(shell_input)

    def is_open(port: Input) -> bool:
        if not port.from_written or port.connections:
            return False
        outer_ports = []
        for giver in givers[port.id]:
            shell_id, _, name = giver.rpartition(".")
            outer_ports.append(architecture.shells[shell_id].inputs[name])
        return not outer_ports or any(is_open(each) for each in outer_ports)

    return {port.component for port in architecture.inputs.values() if is_open(port)}


def _readers_by_output(architecture: Architecture) -> Mapping[str, set[str]]:
    """Return the ids of the components that read each output, by output id."""
    readers = defaultdict[str, set[str]](set)
    for edge in architecture.edges:
        readers[edge.output].add(architecture.inputs[edge.input].component)
    return readers


def _components_of_waypoint(architecture: Architecture, waypoint: Waypoint) -> set[str]:
    """Return the ids of the components that a chain's element belongs to."""
    if waypoint.kind == "node":
        return set(architecture.nodes[waypoint.id].implements)
    if waypoint.kind == "component":
        return set(architecture.leaves_of(waypoint.id))
    return {architecture.outputs[waypoint.id].component}


RULES = (
    (broken_chain, Severity.WARNING),
    (broken_step, Severity.WARNING),
)
