"""Connections: from who provides an interface to each who uses it, and along the connectors between ports."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator
from dataclasses import dataclass

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.component_assembly import ComponentAssembly
from archgen.plugins.xmi.component_facts import ClassFacts
from archgen.plugins.xmi.import_ledger import name_element
from archgen.plugins.xmi.port_facts import InterfaceKey, PortFacts, get_interface_name
from archgen.plugins.xmi.uml_index import get_name, list_child_elements

_MAX_CONNECTIONS = 100_000
"""So many connections one interface makes: each who uses it reads each who realizes it."""


@dataclass(frozen=True, slots=True)
class PortEnd:
    """A port of one component: `facts` is that component, whose type the port may belong to."""

    facts: ClassFacts
    port: PortFacts


class PortWiring:
    """The connections of all components. Ports become inputs where a connector joins them to an output."""

    def __init__(self, assembly: ComponentAssembly) -> None:
        self._assembly, self._sorting, self._ledger = assembly, assembly.sorting, assembly.ledger
        self._index = self._ledger.index
        self.inner_of: dict[ClassFacts, dict[PortFacts, list[PortEnd]]] = defaultdict(lambda: defaultdict(list))
        """The ports inside that a port of a composed component passes on, by component and port."""
        self._everyone = [*assembly.types.values(), *assembly.components]
        self._end_of_port = {
            port.element: PortEnd(facts, port) for facts in self._everyone for port in facts.ports if port.is_port
        }
        joined = [ends for each in assembly.catalogue.connectors if (ends := self._read_connector(each))]
        self._decide_directions(joined)
        self.sources: dict[ClassFacts, dict[PortFacts, dict[str, None]]] = defaultdict(lambda: defaultdict(dict))
        """What each input reads, as references of the language."""
        for connector, first, second in joined:
            self._connect(connector, first, second)
        self._connect_interfaces()

    def _read_connector(self, connector: XmlElement) -> tuple[XmlElement, PortEnd, PortEnd] | None:
        ends = list_child_elements(connector, "ConnectorEnd")
        found = [end for each in ends if (end := self._find_end(each))]
        if len(ends) != 2 or len(found) != 2:  # noqa: PLR2004 - a connector joins two
            elsewhere = [
                reference.name
                for each in ends
                for reference in self._index.list_references(each, "role", "partWithPort")
                if reference.is_outside
            ]
            if elsewhere:
                words = f"`{elsewhere[0][:80]}`, which it joins, lies in a file that is not among those that are read"
                self._ledger.refuse(connector, words, "give that file, too")
            else:
                self._ledger.refuse(connector, "it does not join two ports of components")
            return None
        for each, other in (found, found[::-1]):
            # A port that is passed on to the inside still meets others outside.
            each.port.is_joined |= other.facts.owner is not each.facts
        return connector, found[0], found[1]

    def _find_end(self, end: XmlElement) -> PortEnd | None:
        role = self._index.find_reference(end, "role")
        if role is None or role.element is None:
            return None
        part = self._index.find_reference(end, "partWithPort")
        if part is not None and part.element in self._sorting.parts:
            facts = self._sorting.parts[part.element]
            port = self._assembly.find_port(facts, role.element)
            return PortEnd(facts, port) if port else None
        return self._end_of_port.get(role.element)

    def _decide_directions(self, joined: list[tuple[XmlElement, PortEnd, PortEnd]]) -> None:
        """Let a connector say which way a port goes of which nothing else does, and what follows from that."""
        ways_from: dict[PortFacts, list[tuple[PortEnd, PortEnd]]] = defaultdict(list)
        for _, first, second in joined:
            ways_from[first.port].append((first, second))
            ways_from[second.port].append((second, first))
        decided = {port for facts in self._everyone for port in facts.ports if port.is_decided}
        waiting = deque(port for port in ways_from if port in decided)
        while waiting:
            for known, open_end in ways_from[waiting.popleft()]:
                if open_end.port in decided:
                    continue
                is_same_way = known.facts is open_end.facts.owner or open_end.facts is known.facts.owner
                is_input = known.port.is_input if is_same_way else known.port.is_output
                open_end.port.is_input, open_end.port.is_output = is_input, not is_input
                decided.add(open_end.port)
                waiting.append(open_end.port)

    def _connect(self, connector: XmlElement, first: PortEnd, second: PortEnd) -> None:
        for outer, inner in ((first, second), (second, first)):
            if inner.facts.owner is outer.facts:
                self._delegate(connector, outer, inner)
                return
        if first.port.is_output and second.port.is_output and not (first.port.is_input or second.port.is_input):
            words = f"{name_element(connector)} joins two ports of which nothing says which one reads: {self._tell_ends(first, second)}"
            self._ledger.leave(connector, words, "let one of the two use the interface that the other one realizes")
            return
        taken = False
        for source, reader in ((first, second), (second, first)):
            if source.port.is_output and reader.port.is_input:
                taken |= self._add_source(source, reader)
        if taken:
            self._ledger.take(connector)
        else:
            self._ledger.refuse(connector, f"{self._tell_ends(first, second)} do not fit")

    @staticmethod
    def _tell_ends(first: PortEnd, second: PortEnd) -> str:
        names = [f"`{each.facts.id}.{each.port.name}`"[:100] for each in (first, second)]
        return " and ".join(names)

    def _delegate(self, connector: XmlElement, outer: PortEnd, inner: PortEnd) -> None:
        """Connect a port of a composed component with one of what stands inside."""
        if outer.port.is_input and inner.port.is_input:
            self.sources[inner.facts][inner.port].setdefault(f"self.{outer.port.input_id}")
        if outer.port.is_output and inner.port.is_output:
            self.inner_of[outer.facts][outer.port].append(inner)
        if outer.port.is_input != inner.port.is_input and outer.port.is_output != inner.port.is_output:
            self._ledger.refuse(connector, f"its ports do not go the same way, {self._tell_ends(outer, inner)}")
        else:
            self._ledger.take(connector)

    def _add_source(self, source: PortEnd, reader: PortEnd) -> bool:
        reference = self._refer(source, reader.facts)
        if reference is None:
            return False
        self.sources[reader.facts][reader.port].setdefault(reference)
        return True

    @staticmethod
    def _refer(source: PortEnd, reader: ClassFacts) -> str | None:
        """Return how a component names an output; None where it cannot."""
        # Neither itself, nor what it stands in.
        around: ClassFacts | None = reader
        while around is not None and around is not source.facts:
            around = around.owner
        if around is not None:
            return None
        if source.facts.owner is not None and source.facts.owner is reader.owner:
            return f"{source.facts.id}.{source.port.output_id}"
        is_reachable = source.facts.root.sort == "component" and reader.root.sort == "component"
        return ".".join((*source.facts.path, source.port.output_id)) if is_reachable else None

    def _connect_interfaces(self) -> None:
        """Connect each who uses an interface with each who provides it; connectors count where there are any."""
        providers: dict[tuple[ClassFacts | None, InterfaceKey], list[PortEnd]] = defaultdict(list)
        for end in self._list_free_ends():
            for key in end.port.provided:
                providers[self._find_scope(end.facts), key].append(end)
        users: dict[tuple[ClassFacts | None, InterfaceKey], list[PortEnd]] = defaultdict(list)
        for end in self._list_free_ends():
            for key in end.port.required:
                users[self._find_scope(end.facts), key].append(end)
        for (scope, key), readers in users.items():
            source_count = len(providers.get((scope, key), ()))
            if source_count * len(readers) > _MAX_CONNECTIONS:
                self._refuse_connections(key, source_count, readers)
                del providers[scope, key]
        for end in self._list_free_ends():
            for key in end.port.required:
                for source in providers.get((self._find_scope(end.facts), key), ()):
                    self._add_source(source, end)

    def _refuse_connections(self, key: InterfaceKey, provider_count: int, readers: list[PortEnd]) -> None:
        element = key if isinstance(key, XmlElement) else readers[0].port.element
        words = (
            f"nobody is connected by the interface `{get_interface_name(key)[:80]}`: {provider_count:,} ports realize it and "
            f"{len(readers):,} use it, which makes more than {_MAX_CONNECTIONS:,} connections"
        )
        self._ledger.leave(element, words, "join the ports by connectors")

    def _list_free_ends(self) -> Iterator[PortEnd]:
        for facts in self._assembly.components:
            for port in facts.ports:
                if not port.is_joined:
                    yield PortEnd(facts, port)

    @staticmethod
    def _find_scope(facts: ClassFacts) -> ClassFacts | None:
        """Return the component type that a component stands in, None for one that is really there."""
        return facts.root if facts.root.sort == "component_type" else None


def list_inner_references(wiring: PortWiring, facts: ClassFacts, port: PortFacts) -> list[str]:
    """Return what a composed component's output passes on, as it names these."""
    ends = wiring.inner_of.get(facts, {}).get(port, ())
    return list(dict.fromkeys(f"{end.facts.id}.{end.port.output_id}" for end in ends))


def name_port(port: PortFacts) -> str:
    """Return the name of a port, or that of its type where it has none."""
    return port.name or port.type_name or get_name(port.element)
