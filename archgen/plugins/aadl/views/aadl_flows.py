"""Chains as end to end flows: what each process adds on the way, each connection, and our bounds of the whole.

The ways of chains between processes. AADL's flows follow ports alone: through a call they go by its request and answer.

A way through systems that stand in one another as flows: each system has one for the part of the way inside of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.plugin import dataclass
from archgen.plugin.model import Architecture, Chain
from archgen.plugin.timing import Analysis, Arc, ChainResult, ChainTerm
from archgen.plugins.aadl.views.aadl_ports import PortPart
from archgen.plugins.aadl.views.aadl_processes import NodeProcess, SystemPart
from archgen.plugins.aadl.views.aadl_system_tree import Route, SystemTree
from archgen.plugins.aadl.views.aadl_types import UNTYPED, TypeBook
from archgen.plugins.aadl.views.aadl_words import AadlProperty, can_be_written, make_item, make_property, write_range


@dataclass(frozen=True, slots=True)
class _Segment:
    """What a chain does in one process: its terms, the data by which it comes and goes, and the node that it comes from."""

    terms: tuple[ChainTerm, ...]
    entry: Arc | None = None
    entry_node: str = ""
    leave: Arc | None = None


class FlowWriter:
    """Writes the flows of processes and systems as chains ask for them; chains that ask for the same share one."""

    def __init__(
        self, architecture: Architecture, analysis: Analysis, processes: Mapping[str, NodeProcess], routes: RouteFinder
    ) -> None:
        """Begin with no flow."""
        self._architecture = architecture
        self._analysis = analysis
        self._processes = processes
        self._routes = routes
        self._known_systems: dict[tuple[SystemPart, str, str], str] = {}

    def write_chain(self, chain: Chain, result: ChainResult) -> tuple[SystemPart, str] | str:
        """Write a chain as an end to end flow; return in which system, and its name, or why AADL cannot say it."""
        if chain.unresolved or not result.terms:
            return "no way leads through all that it names"
        segments = self._split_terms(result.terms)
        if isinstance(segments, str):
            return segments
        if len(segments) == 1:
            return "it stays in one process"
        for segment in segments:
            if self._node_of(segment.terms[0]) not in self._processes:
                return f"`{self._node_of(segment.terms[0])}` is not part of this export"
        for segment in segments[1:]:
            if segment.entry is None or self._routes.find_route(segment.entry, *self._find_ends(segment)) is None:
                return f"nothing here joins two of its nodes on the way to `{segment.terms[0].activity}`"
        system, texts = fold_steps(self._list_steps(segments), self._known_systems)
        name = system.names.take_name(chain.id)
        text = f"end to end flow {' -> '.join(texts)}"
        system.flows.append(make_item(name, text, _list_latencies(chain, result)))
        return system, name

    def _node_of(self, term: ChainTerm) -> str:
        return self._analysis.system.activities[term.activity].node

    def _find_ends(self, segment: _Segment) -> tuple[NodeProcess, NodeProcess]:
        """Return the process that a chain comes from, and the one that it comes to."""
        return self._processes[segment.entry_node], self._processes[self._node_of(segment.terms[0])]

    def _split_terms(self, terms: Sequence[ChainTerm]) -> list[_Segment] | str:
        """Return the terms by process, each with how the chain comes in and goes out."""
        segments = [_Segment((terms[0],))]
        for before, term in pairwise(terms):
            arc = self._find_arc(before, term)
            if arc is None:
                return f"from `{before.activity}` to `{term.activity}` it goes through what is no port of a component"
            last, node = segments[-1], self._node_of(before)
            if node == self._node_of(term):
                segments[-1] = _Segment((*last.terms, term), last.entry, last.entry_node)
            else:
                segments[-1] = _Segment(last.terms, last.entry, last.entry_node, arc)
                segments.append(_Segment((term,), arc, node))
        return segments

    def _find_arc(self, before: ChainTerm, term: ChainTerm) -> Arc | None:
        """Return the data or the call by which a chain goes on from one activity to the next."""
        arcs = self._analysis.system.arcs_from.get(before.activity, ())
        known = [arc for arc in arcs if arc.target == term.activity and self._joins_ports(arc)]
        return min(known, key=lambda arc: arc.role != "data", default=None)

    def _joins_ports(self, arc: Arc) -> bool:
        """Whether both ends of what passes between two activities are ports of components."""
        inputs, outputs = self._architecture.inputs, self._architecture.outputs
        if arc.role == "request":
            return arc.output in inputs and arc.input in outputs
        return arc.output in outputs and arc.input in inputs

    def _list_steps(self, segments: Sequence[_Segment]) -> list[FlowStep]:
        """Return all that a chain goes through, with the systems around it."""
        first, last = (self._processes[self._node_of(segments[index].terms[0])] for index in (0, -1))
        steps = [FlowStep("", NO_TIME, enters=system) for system in first.home.path]
        for segment in segments:
            if segment.entry is not None:
                ends = self._find_ends(segment)
                if route := self._routes.find_route(segment.entry, *ends):
                    steps += list_route_steps(route, self._routes.find_latency(segment.entry, *ends))
            process = self._processes[self._node_of(segment.terms[0])]
            name, latency = self._write_flow(process, segment)
            steps.append(FlowStep(f"{process.name_in_system}.{name}", latency))
        return [*steps, *(FlowStep("", NO_TIME, leaves=True) for _ in last.home.path)]

    def _write_flow(self, process: NodeProcess, segment: _Segment) -> tuple[str, TimeRange | None]:
        """Return the name of a flow through a process, and how long it takes: waiting to be read, and its threads' answers."""
        entry, leave, ends = segment.entry, segment.leave, list[str]()
        if entry:
            ends.append(self._name_end(process, entry, is_output=False))
        if leave:
            ends.append(self._name_end(process, leave, is_output=True))
        kind = "path" if entry and leave else "sink" if entry else "source"
        latency = self._find_latency(segment.terms)
        properties = [make_property("Latency", write_range(*latency))] if latency else []
        text = f"flow {kind} {' -> '.join(ends)}"
        wanted = "_to_".join(ends) + ("_flow" if len(ends) == 1 else "")
        return process.add_flow(wanted, text, properties), latency

    def _name_end(self, process: NodeProcess, arc: Arc, *, is_output: bool) -> str:
        """Return the feature by which a chain comes to a process or leaves it."""
        part = self._routes.find_port(arc, process, is_output=is_output)
        return process.features[part.key] if part else ""

    def _find_latency(self, terms: Sequence[ChainTerm]) -> TimeRange | None:
        """Return how long the terms of one process take (ns), None where that is open."""
        shortest = longest = Fraction(0)
        for index, term in enumerate(terms):
            shortest += self._find_best(term)
            # The way to the first one of a process is the connection's.
            inner_link = () if index == 0 else (term.link,)
            for value in (term.sampling, term.response, *inner_link):
                if value.value is None or not value.complete:
                    return None
                longest += value.value
        return (min(shortest, longest), longest) if can_be_written(longest) else None

    def _find_best(self, term: ChainTerm) -> Fraction:
        response = self._analysis.responses.get(term.activity)
        return (response.best.value if response else None) or Fraction(0)


def _list_latencies(chain: Chain, result: ChainResult) -> list[AadlProperty]:
    """Return what a chain is to keep as `Latency`, and what is proven of it as `Actual_Latency`."""
    found = []
    if chain.deadline and can_be_written(chain.deadline.value):
        found.append(make_property("Latency", write_range(Fraction(0), chain.deadline.value)))
    bound = result.bound
    if bound.value is not None and bound.complete and can_be_written(bound.value):
        shortest = min(result.best.value or Fraction(0), bound.value)
        found.append(make_property("Actual_Latency", write_range(shortest, bound.value)))
    return found


RouteEnds = tuple[str, str, str, str]
"""Two processes that are joined: node and port, node and port."""


class RouteFinder:
    """Finds how data gets from one process to another; ports for requests and answers are made as chains ask for them."""

    def __init__(
        self,
        types: TypeBook,
        tree: SystemTree,
        routes: Mapping[RouteEnds, Route],
        latencies: Mapping[RouteEnds, TimeRange],
    ) -> None:
        """Name the data of calls by `types`, join in `tree`; `routes` are those of data, `latencies` of calls as well."""
        self._types = types
        self._tree = tree
        self._routes = routes
        self._calls: dict[RouteEnds, Route | None] = {}
        self._latencies = latencies

    def find_route(self, arc: Arc, source: NodeProcess, target: NodeProcess) -> Route | None:
        """Return the way of what passes between two processes; None where nothing here joins them."""
        ends = (source.node.id, arc.output, target.node.id, arc.input)
        if arc.role == "data":
            return self._routes.get(ends)
        if ends not in self._calls:
            self._calls[ends] = self._join_call(arc, source, target, self._latencies.get(ends))
        return self._calls[ends]

    def find_latency(self, arc: Arc, source: NodeProcess, target: NodeProcess) -> TimeRange:
        """Return how long the way between two processes takes."""
        return self._latencies.get((source.node.id, arc.output, target.node.id, arc.input), NO_TIME)

    def find_port(self, arc: Arc, process: NodeProcess, *, is_output: bool) -> PortPart | None:
        """Return the port by which what passes leaves a process or arrives there."""
        if arc.role != "data":
            return self._find_call_part(arc, process, is_output=is_output)
        if is_output:
            return process.find_part(arc.output, is_output=True)
        return process.find_part(arc.input, is_output=False, source_id=arc.output)

    def _join_call(self, arc: Arc, source: NodeProcess, target: NodeProcess, latency: TimeRange | None) -> Route | None:
        output, reader = (
            self._find_call_part(arc, source, is_output=True),
            self._find_call_part(arc, target, is_output=False),
        )
        if output is None or reader is None:
            return None
        properties = [make_property("Latency", write_range(*latency))] if latency else []
        return self._tree.join((source, output), (target, reader), properties)

    def _find_call_part(self, arc: Arc, process: NodeProcess, *, is_output: bool) -> PortPart | None:
        port_id, other_id = (arc.output, arc.input) if is_output else (arc.input, arc.output)
        is_request = arc.role == "request"
        # Who answers has an output for the call; who calls has an input, which may read several.
        called = process.find_part(port_id, is_output=is_request != is_output, source_id=other_id)
        if called is None:
            return None
        part = self._make_part(called, is_request=is_request, is_output=is_output)
        process.add_call_feature(part)
        return part

    def _make_part(self, called: PortPart, *, is_request: bool, is_output: bool) -> PortPart:
        request, answer = self._types.call_data.get(called.classifier, (UNTYPED, UNTYPED))
        return PortPart(
            called.port,
            f"{called.name}_{'request' if is_request else 'answer'}",
            "topic",
            request if is_request else answer,
            f"{'out' if is_output else 'in'} event data port",
            is_call_data=True,
        )


TimeRange = tuple[Fraction, Fraction]
"""At least and at most, in ns."""
NO_TIME: TimeRange = (Fraction(0), Fraction(0))


@dataclass(frozen=True, slots=True)
class FlowStep:
    """A flow or connection by its `text`; or a system that is entered or left, by the feature `text`, empty at both ends."""

    text: str
    latency: TimeRange | None
    enters: SystemPart | None = None
    leaves: bool = False


def list_route_steps(route: Route, latency: TimeRange) -> Iterator[FlowStep]:
    """Yield the connections of a route, and the systems that it leaves and enters."""
    for _, feature, inner in route.outward:
        yield FlowStep(inner, NO_TIME)
        yield FlowStep(feature, NO_TIME, leaves=True)
    yield FlowStep(route.joint, latency)
    for system, feature, inner in route.inward:
        yield FlowStep(feature, NO_TIME, enters=system)
        yield FlowStep(inner, NO_TIME)


def fold_steps(
    steps: Sequence[FlowStep], flow_names: dict[tuple[SystemPart, str, str], str]
) -> tuple[SystemPart, list[str]]:
    """Return the innermost system that holds all of a way, and the way as seen there; flows of inner systems are written.

    `flow_names` has the flows that are written already.
    """
    # Systems that all of it stands in are no step of it.
    while steps[1].enters is not None and _find_exit(steps, 1) == len(steps) - 2:
        steps = steps[1:-1]
    system = steps[0].enters
    if system is None:
        raise ValueError("a way begins where it enters the launch")
    return system, _Folding(steps, flow_names).fold(1)[0]


def _find_exit(steps: Sequence[FlowStep], start: int) -> int:
    """Return where the system is left that is entered at a step."""
    depth = 0
    for index in range(start, len(steps)):
        depth += (steps[index].enters is not None) - steps[index].leaves
        if depth == 0:
            return index
    return -1


class _Folding:
    """One way, taken together from the inside to the outside."""

    def __init__(self, steps: Sequence[FlowStep], flow_names: dict[tuple[SystemPart, str, str], str]) -> None:
        self._steps = steps
        self._flow_names = flow_names

    def fold(self, start: int) -> tuple[list[str], TimeRange | None, int]:
        """Return the steps inside of one system, how long they take, and where it is left."""
        texts: list[str] = []
        total: TimeRange | None = NO_TIME
        index = start
        while not self._steps[index].leaves:
            step = self._steps[index]
            text, latency = step.text, step.latency
            if step.enters is not None:
                inner, latency, index = self.fold(index + 1)
                flow = self._write_flow(step.enters, (step.text, self._steps[index].text), inner, latency)
                text = f"{step.enters.name}.{flow}"
            texts.append(text)
            total = (total[0] + latency[0], total[1] + latency[1]) if total and latency else None
            index += 1
        return texts, total, index

    def _write_flow(
        self, system: SystemPart, ends: tuple[str, str], inner: Sequence[str], latency: TimeRange | None
    ) -> str:
        """Return the name of a flow through a system: what it is from outside, and how it goes inside."""
        entry, leave = ends
        kind = "path" if entry and leave else "sink" if entry else "source"
        properties = [make_property("Latency", write_range(*latency))] if latency and can_be_written(latency[1]) else []
        inside = f"flow {kind} {' -> '.join(filter(None, (entry, *inner, leave)))}"
        key = (system, inside, str(properties))
        if key not in self._flow_names:
            outer_ends = [each for each in ends if each]
            wanted = "_to_".join(outer_ends) + ("_flow" if len(outer_ends) == 1 else "")
            name = self._flow_names[key] = system.names.take_name(wanted)
            system.flow_specs.append(make_item(name, f"flow {kind} {' -> '.join(outer_ends)}", properties))
            system.flows.append(make_item(name, inside))
        return self._flow_names[key]
