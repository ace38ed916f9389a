"""The ways of chains between processes. AADL's flows follow ports alone: through a call they go by its request and answer."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.plugin.timing import Arc
from archgen.plugins.aadl.views.aadl_flow_steps import NO_TIME, TimeRange
from archgen.plugins.aadl.views.aadl_ports import PortPart
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_system_tree import Route, SystemTree
from archgen.plugins.aadl.views.aadl_types import UNTYPED, TypeBook
from archgen.plugins.aadl.views.aadl_words import make_property, write_range

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
