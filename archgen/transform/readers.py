"""Endpoints that read (subscribe, call): the inputs of a node's components, under the names of their sources."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Input
from archgen.model.mapping import flow_of
from archgen.model.node import Endpoint, Flow, PortUse, Use
from archgen.transform import ros_names
from archgen.transform.writers import DEFAULT, UNWRITTEN, Carrier, flow, side

Key = tuple[str, Flow]


@dataclass(frozen=True, slots=True)
class Traffic:
    """Writing endpoints by output and by name, and the outputs that feed each input."""

    architecture: Architecture
    shared: frozenset[str]
    by_output: Mapping[str, Sequence[Endpoint]]
    by_name: Mapping[Key, Sequence[Endpoint]]
    sources: Mapping[str, Sequence[str]]
    """The ids of the outputs that feed an input, without physical ones, by input id."""


def traffic(architecture: Architecture, shared: frozenset[str], writers: Iterable[Endpoint]) -> Traffic:
    """Index all writing endpoints, before the reading ones are derived from them."""
    by_output: dict[str, list[Endpoint]] = defaultdict(list)
    by_name: dict[Key, list[Endpoint]] = defaultdict(list)
    for writer in writers:
        by_name[writer.name, writer.flow].append(writer)
        if writer.port:
            by_output[writer.port].append(writer)
    sources: dict[str, list[str]] = defaultdict(list)
    for edge in architecture.edges:
        if not architecture.outputs[edge.output].physical:
            sources[edge.input].append(edge.output)
    return Traffic(architecture, shared, dict(by_output), dict(by_name), dict(sources))


def read_endpoints(found: Traffic, carrier: Carrier) -> Iterator[Endpoint]:
    """Yield what a node reads for a component: one endpoint for each input and each topic, service or action."""
    for port in carrier.component.inputs.values():
        uses = side(carrier.uses.get(port.id, ()), {"subscribes", "calls"})
        # A component's only node reads all of its inputs; several nodes read only what they list.
        if not port.physical and (uses or carrier.alone):
            yield from _Reading(found, carrier, port).endpoints(uses)


@dataclass(frozen=True, slots=True)
class _Reading:
    """Derives the endpoints of one node for one input."""

    found: Traffic
    carrier: Carrier
    port: Input

    def endpoints(self, uses: Sequence[PortUse]) -> Iterator[Endpoint]:
        """Yield the endpoints of the entries that the node lists for the input, and of what it need not list."""
        arriving = [writer for output in self.found.sources.get(self.port.id, ()) for writer in self._writers(output)]
        sections: dict[Use, list[Endpoint]] = {
            "subscribes": [writer for writer in arriving if writer.flow == "topic"],
            "calls": [writer for writer in arriving if writer.flow != "topic"],
        }
        left = dict(sections) if self.carrier.alone else {}
        for use in uses:
            # An entry in the wrong section is reported by `wrong-section`, and read as if it were in the right one.
            section = use.use if sections[use.use] or not arriving else _other(use.use)
            left.pop(section, None)
            yield from self._written(use, sections[section]) if use.topics else self._derived(use, sections[section])
        # An input may have both topics and services as sources: the only node also reads those it has no entry for.
        for writers in left.values():
            yield from self._derived(UNWRITTEN, writers) if writers else ()
        if not uses and not arriving:
            yield from self._derived(UNWRITTEN, ())

    def _writers(self, output: str) -> Sequence[Endpoint]:
        """Return an output's writing endpoints; if no node writes it, the one that its only node would have."""
        known = self.found.by_output.get(output)
        if known:
            return known
        source = self.found.architecture.outputs[output]
        message = self.found.architecture.message(source)
        kind = flow_of(message)
        use: Use = "publishes" if kind == "topic" else "serves"
        return (Endpoint("", use, ros_names.of_port(output), kind, output, source.component, message, source.type),)

    def _derived(self, use: PortUse, writers: Sequence[Endpoint]) -> Iterator[Endpoint]:
        """Yield one endpoint for each topic that the sources are written on, or for the input's own default topic.

        A source without any known output has no topic that could be named: nothing is read from it.
        """
        if writers:
            topics: dict[Key, list[Endpoint]] = {}
            for writer in writers:
                topics.setdefault((writer.name, writer.flow), []).append(writer)
            for (name, kind), on_topic in topics.items():
                yield self._endpoint(use, name, kind, on_topic)
        elif not self.port.from_written:
            name = ros_names.of_port(self.port.id)
            yield self._endpoint(use, name, flow(use.message or self._expected(), use), ())

    def _written(self, use: PortUse, writers: Sequence[Endpoint]) -> Iterator[Endpoint]:
        """Yield one endpoint for each topic that the node names for the input."""
        for topic in use.topics:
            name = ros_names.absolute(topic, self.carrier.node)
            kind = writers[0].flow if writers else flow(use.message or self._expected(), use)
            # If no source is on this topic (`unaccounted-topic` reports it), message and type still come from them.
            endpoint = self._endpoint(use, name, kind, [w for w in writers if w.name == name] or writers)
            yield replace(endpoint, name_written=True)

    def _endpoint(self, use: PortUse, name: str, kind: Flow, writers: Sequence[Endpoint]) -> Endpoint:
        return Endpoint(
            node=self.carrier.node.id,
            use="subscribes" if kind == "topic" else "calls",
            name=name,
            flow=kind,
            port=self.port.id,
            component=self.carrier.component.id,
            # What the node writes outranks what the sources send, and that what the input expects.
            message=use.message or next((w.message for w in writers if w.message), None) or self._expected(),
            type=self.port.type or next((w.type for w in writers if w.type), None),
            qos=use.qos or DEFAULT,
            written=use is not UNWRITTEN,
            sources=self._sources(name, kind, writers),
            at=use.at,
            message_at=use.message_at,
        )

    def _sources(self, name: str, kind: Flow, writers: Sequence[Endpoint]) -> tuple[str, ...]:
        """Return the ids of the outputs that arrive: all that are written on the topic, unless all nodes share it."""
        # On a shared topic such as /tf every node writes: there only the input's own sources count.
        named = [writer.port for writer in writers if writer.name == name]
        others = [] if name in self.found.shared else [w.port for w in self.found.by_name.get((name, kind), ())]
        return tuple(dict.fromkeys(port for port in (*named, *others) if port))

    def _expected(self) -> str | None:
        """Return the message of the type that the input expects, None if unknown."""
        mapped = self.found.architecture.types.get(self.port.type or "")
        return mapped.message if mapped else None


def _other(section: Use) -> Use:
    return "calls" if section == "subscribes" else "subscribes"
