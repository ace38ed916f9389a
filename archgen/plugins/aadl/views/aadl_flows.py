"""Chains as end to end flows: what each process adds on the way, each connection, and our bounds of the whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.plugin import dataclass
from archgen.plugin.model import Architecture, Chain
from archgen.plugin.timing import Analysis, Arc, ChainResult, ChainTerm
from archgen.plugins.aadl.views.aadl_calls import RouteFinder
from archgen.plugins.aadl.views.aadl_flow_steps import NO_TIME, FlowStep, TimeRange, fold_steps, list_route_steps
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_system_part import SystemPart
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
