"""Chains as end to end flows: what each process adds on the way, each connection, and our bounds of the whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from archgen.model.architecture import Architecture, Chain
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.system.timing_system import Arc
from archgen.views.generation.aadl_processes import Process
from archgen.views.generation.aadl_words import (
    AadlProperty,
    NameSpace,
    can_be_written,
    make_item,
    make_property,
    write_range,
)

Connections = Mapping[tuple[str, str, str, str], str]
"""The names of connections in the system by node and output, node and input."""


class FlowWriter:
    """Writes the flows of processes as chains ask for them; chains that ask for the same share one."""

    def __init__(self, architecture: Architecture, analysis: Analysis, processes: Mapping[str, Process]) -> None:
        """Begin with no flow."""
        self._architecture = architecture
        self._analysis = analysis
        self._processes = processes
        self._known: dict[tuple[str, str, str], str] = {}

    def write_chain(
        self, chain: Chain, result: ChainResult, connections: Connections, names: NameSpace
    ) -> dict[str, Any] | str:
        """Return a chain as an end to end flow, or why AADL cannot say it."""
        if chain.unresolved or not result.terms:
            return "no way leads through all that it names"
        segments = self._split_terms(result.terms)
        if isinstance(segments, str):
            return segments
        if len(segments) == 1:
            return "it stays in one process"
        steps: list[str] = []
        for terms, entry, leave in segments:
            node = self._node_of(terms[0])
            process = self._processes.get(node)
            if process is None:
                return f"`{node}` is not part of this export"
            if entry is not None:
                key = (entry.output_node, entry.arc.output, node, entry.arc.input)
                if key not in connections:
                    return f"nothing here joins `{entry.arc.output}` and `{entry.arc.input}`"
                steps.append(connections[key])
            steps.append(
                f"{process.name_in_system}.{self._write_flow(process, terms, entry.arc if entry else None, leave)}"
            )
        name = names.take_name(chain.id)
        return make_item(
            name,
            f"end to end flow {' -> '.join(steps)}",
            _list_latencies(chain, result),
        )

    def _node_of(self, term: ChainTerm) -> str:
        return self._analysis.system.activities[term.activity].node

    def _split_terms(self, terms: Sequence[ChainTerm]) -> list[tuple[list[ChainTerm], _Entry | None, Arc | None]] | str:
        """Return the terms by process, each with how the chain comes in and goes out."""
        parts: list[tuple[list[ChainTerm], _Entry | None, Arc | None]] = [([terms[0]], None, None)]
        for before, term in pairwise(terms):
            arc = self._find_arc(before, term)
            if arc is None:
                return f"from `{before.activity}` to `{term.activity}` it goes through a call"
            if self._node_of(before) == self._node_of(term):
                parts[-1][0].append(term)
                continue
            last_terms, entry, _ = parts[-1]
            parts[-1] = (last_terms, entry, arc)
            parts.append(([term], _Entry(arc, self._node_of(before)), None))
        return parts

    def _find_arc(self, before: ChainTerm, term: ChainTerm) -> Arc | None:
        """Return the data by which a chain goes on: that whose delays are those of the step."""
        arcs = [
            arc
            for arc in self._analysis.system.arcs_from.get(before.activity, ())
            if arc.target == term.activity and arc.role == "data" and arc.input in self._architecture.inputs
        ]
        return next(iter(arcs), None)

    def _write_flow(self, process: Process, terms: Sequence[ChainTerm], entry: Arc | None, leave: Arc | None) -> str:
        """Return the name of a flow through a process: waiting to be read, and what its threads take to answer."""
        ends = []
        if entry:
            reader = process.find_part(entry.input, is_output=False, source_id=entry.output)
            ends.append(process.features[reader.key] if reader else "")
        if leave:
            output = process.find_part(leave.output, is_output=True)
            ends.append(process.features[output.key] if output else "")
        kind = "path" if entry and leave else "sink" if entry else "source"
        properties = self._list_flow_latency(terms)
        text = f"flow {kind} {' -> '.join(ends)}"
        key = (process.name, text, str(properties))
        if key not in self._known:
            self._known[key] = process.names.take_name("_to_".join(ends) + ("_flow" if len(ends) == 1 else ""))
            process.flows.append(make_item(self._known[key], text, properties))
        return self._known[key]

    def _list_flow_latency(self, terms: Sequence[ChainTerm]) -> list[AadlProperty]:
        longest = Fraction(0)
        for index, term in enumerate(terms):
            # The way to the first one of a process is the connection's.
            inner_link = () if index == 0 else (term.link,)
            for value in (term.sampling, term.response, *inner_link):
                if value.value is None or not value.complete:
                    return []
                longest += value.value
        shortest = sum((self._find_best(term) for term in terms), Fraction(0))
        return (
            [make_property("Latency", write_range(min(shortest, longest), longest))] if can_be_written(longest) else []
        )

    def _find_best(self, term: ChainTerm) -> Fraction:
        response = self._analysis.responses.get(term.activity)
        return (response.best.value if response else None) or Fraction(0)


class _Entry:
    """How a chain comes into a process."""

    def __init__(self, arc: Arc, output_node: str) -> None:
        self.arc = arc
        self.output_node = output_node


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
