"""Wire inputs: turn each reference in `from` into the outputs that it stands for, as connections and edges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from archgen.diagnostics import Span
from archgen.frozen import dataclass, field
from archgen.link import mapping_values, sanity_checks
from archgen.link.element_outline import ElementOutline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_values
from archgen.model.architecture import PortEdge
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.message_types import ConceptualType
from archgen.model.path_resolver import ElementRef
from archgen.model.port_media import PHYSICAL, flow_of_port, is_physical
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode

if TYPE_CHECKING:
    from archgen.link.port_sources import PortSources

_SOURCE_KINDS = ("group", "component", "output")
MAX_PAIRS = 500_000
"""How many pairs of output and input references may make. 10,000 components with 23,000 connections make 30,000; only
many references to large groups make more, and then their number grows with the square of the groups' size.
"""


@dataclass(slots=True)
class InputWiring:
    """Wires inputs one after the other; the results are in `connections` and `edges`."""

    outline: ElementOutline
    resolver: ReferenceResolver
    types: Mapping[str, ConceptualType]
    sources: PortSources | None = None
    """What ports take their data from where components hold components; None where none does."""
    connections: list[Connection] = field(default_factory=list)
    edges: list[PortEdge] = field(default_factory=list)
    _is_full: bool = False
    _outputs_by_target: dict[str, tuple[Output, ...]] = field(default_factory=dict)

    def declare_input(self, component_id: str, entry: MappingEntry, *, is_leaf: bool = True) -> Input:
        """Return an input, connected to what its `from` names.

        That of a composed component (`is_leaf` False) only says where its data comes from: the flow goes to the leaves
        that read it.
        """
        body = mapping_values.get_body(entry)
        input_id = f"{component_id}.{entry.key}"
        connections = (
            tuple(self._connect_sources(component_id, input_id, self.sources))
            if self.sources
            else tuple(
                connection
                for reference in mapping_values.get_scalars(body, "from")
                if (connection := self._connect_source(component_id, input_id, reference))
            )
        )
        if is_leaf:
            self._add_connections(input_id, connections)
        return self._make_input(component_id, entry, connections)

    def _make_input(self, component_id: str, entry: MappingEntry, connections: tuple[Connection, ...]) -> Input:
        body = mapping_values.get_body(entry)
        values = read_values("input", Input, body)
        # What comes into a composed component from outside of the system comes so to what reads it there.
        outside = self.sources.find_outside(("input", f"{component_id}.{entry.key}")) if self.sources else body
        values["external"] = mapping_values.get_text(outside, "external")
        return Input(
            **values,
            id=f"{component_id}.{entry.key}",
            name=entry.key,
            component=component_id,
            connections=connections,
            medium=self._find_medium(body, outside, connections),
            medium_written=any(mapping_values.get_medium(each, "medium") for each in (body, outside)),
            freshness=sanity_checks.read_positive(
                body, "freshness", "duration", component_id, self.resolver.diagnostics
            ),
            from_written=body.get("from") is not None
            or (self.sources is not None and ("input", f"{component_id}.{entry.key}") in self.sources.ambiguous_ports),
            at=entry.key_span,
        )

    def brings_same(self, component: Component) -> bool:
        """Whether the connections of another version's component, whose targets are the same, bring the same outputs."""
        connections = [connection for port in component.inputs.values() for connection in port.connections]
        if self._is_full or len(self.edges) + sum(len(each.outputs) for each in connections) > MAX_PAIRS:
            return False
        for each in connections:
            if each.kind != "output" and each.outputs != tuple(
                self._list_output_ids(ElementRef(each.kind, each.target), component.id)
            ):
                return False
        return True

    def take_over(self, component: Component) -> None:
        """Take the connections of another version's component over."""
        for port in component.inputs.values():
            self._add_connections(port.id, port.connections)

    def list_source_media(self, component: Component) -> tuple[str, ...]:
        """Return what the outputs travel over that the inputs of a component read, in the order of connections."""
        return tuple(
            self._medium_of_output(output)
            for port in component.inputs.values()
            for connection in port.connections
            for output in connection.outputs
        )

    def _add_connections(self, input_id: str, connections: tuple[Connection, ...]) -> None:
        self.connections += connections
        # Two references may bring the same output: one edge, in the order of first mention and with its position. The
        # reversal makes the first mention win in the dict.
        spans_by_output = {
            output: connection.at for connection in reversed(connections) for output in connection.outputs
        }
        output_ids = dict.fromkeys(output for connection in connections for output in connection.outputs)
        self.edges += [PortEdge(output, input_id, spans_by_output[output]) for output in output_ids]

    def _find_medium(self, body: MappingNode, outside: MappingNode, connections: Iterable[Connection]) -> str:
        """Return what an input travels over: as written, else the word of all of its sources, else the project's."""
        written = [mapping_values.get_medium(each, "medium") for each in (body, outside)]
        if any(written):
            return PHYSICAL if PHYSICAL in written else next(filter(None, written))
        words = {self._medium_of_output(output) for connection in connections for output in connection.outputs}
        # What is heard or seen is turned into data by who reads it: that is said at the input, if it is so.
        return min(words) if len(words) == 1 and PHYSICAL not in words else self.outline.middleware

    def _medium_of_output(self, output_id: str) -> str:
        component_id, _, name = output_id.rpartition(".")
        return self.outline.outputs[component_id][name].medium

    def _connect_sources(self, component_id: str, input_id: str, sources: PortSources) -> Iterator[Connection]:
        """Yield the connections of an input as if everything had been written out: one for each output of a leaf."""
        for source in sources.list_sources(("input", input_id)):
            target = source.target
            output_ids = () if self._is_full else sources.outputs_behind(target, component_id)
            if len(self.edges) + len(output_ids) > MAX_PAIRS:
                self._report_too_many(source.at, component_id)
                output_ids = ()
            if target.kind == "group" or target.id in self.outline.components or output_ids == (target.id,):
                yield Connection(
                    input_id,
                    source.written,
                    target.kind,  # type: ignore[arg-type]
                    target.id,
                    output_ids,
                    source.at,
                    is_made=source.is_made,
                )
                continue
            for output_id in output_ids:
                yield Connection(
                    input_id, source.written, "output", output_id, (output_id,), source.at, target.id, source.is_made
                )

    def _connect_source(self, component_id: str, input_id: str, reference: ScalarNode) -> Connection | None:
        target = self.resolver.resolve_reference(reference, _SOURCE_KINDS, component_id, component_id)
        if target is None:
            return None
        # A connection without outputs is kept: it is what was written, even if it brings nothing.
        output_ids = () if self._is_full else tuple(self._list_output_ids(target, component_id))
        if len(self.edges) + len(output_ids) > MAX_PAIRS:
            self._report_too_many(reference.span, component_id)
            output_ids = ()
        return Connection(input_id, reference.text, target.kind, target.id, output_ids, reference.span)  # type: ignore[arg-type]

    def _report_too_many(self, place: Span, component_id: str) -> None:
        """Report the limit on pairs once; all later references bring nothing, so that the cut is at one clear place."""
        if not self._is_full:
            self._is_full = True
            message = (
                f"up to here references make more than {MAX_PAIRS:,} pairs of output and input; the rest is left out"
            )
            help_line = "name single outputs or components where whole groups are named"
            self.resolver.report("too-large", message, place, help_line=help_line, element=component_id)

    def _list_output_ids(self, target: ElementRef, reader_id: str) -> Iterator[str]:
        """Yield the outputs that a reference stands for: one, or all that carry messages except the reader's own."""
        if target.kind == "output":
            yield target.id
            return
        # Cached by id alone: a group and a component never share a complete id, since one has a dot and one has none.
        if target.id not in self._outputs_by_target:
            self._outputs_by_target[target.id] = tuple(self._list_message_outputs(target))
        yield from (output.id for output in self._outputs_by_target[target.id] if output.component != reader_id)

    def _list_message_outputs(self, target: ElementRef) -> Iterator[Output]:
        members = (
            mapping_values.get_mapping(mapping_values.get_body(self.outline.groups[target.id]), "components")
            if target.kind == "group"
            else None
        )
        components = [target.id] if members is None else [f"{target.id}.{name}" for name in members.entries]
        for component in components:
            for output in self.outline.outputs[component].values():
                # A component or group as a whole stands for its data: a service is called by name, light is no message.
                if not is_physical(output) and flow_of_port(output, self.types.get(output.type or "")) == "topic":
                    yield output
