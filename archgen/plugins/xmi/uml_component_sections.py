"""Components and component types written as sections of the language, and connections: from who provides an interface to
each who uses it, and along the connectors between ports.
"""

from __future__ import annotations

from collections import ChainMap, defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from archgen.plugin.importing import XmlElement, make_unique_id, title_from_id
from archgen.plugins.xmi.component_assembly import ClassFeatures, ComponentAssembly
from archgen.plugins.xmi.component_facts import ClassFacts
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, choose_id, make_hints, name_element, say_title
from archgen.plugins.xmi.port_facts import InterfaceKey, PortFacts, get_interface_name
from archgen.plugins.xmi.uml_catalogue import read_description
from archgen.plugins.xmi.uml_data_types import find_field_type
from archgen.plugins.xmi.uml_index import get_id, get_kind, get_name, is_true, list_child_elements

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


def _list_inner_references(wiring: PortWiring, facts: ClassFacts, port: PortFacts) -> list[str]:
    """Return what a composed component's output passes on, as it names these."""
    ends = wiring.inner_of.get(facts, {}).get(port, ())
    return list(dict.fromkeys(f"{end.facts.id}.{end.port.output_id}" for end in ends))


def _name_port(port: PortFacts) -> str:
    """Return the name of a port, or that of its type where it has none."""
    return port.name or port.type_name or get_name(port.element)


_DECLARING_KEYS = frozenset({"title", "description", "inputs", "outputs", "components"})
PortKey = tuple[str, str]
"""`inputs` or `outputs`, and the id of a port."""


def assign_port_ids(assembly: ComponentAssembly, known_ids: Mapping[str, str]) -> None:
    """Give each port its ids. What a type made from another, or an instance, has again is the same port."""
    done: set[int] = set()
    for facts in (*assembly.types.values(), *assembly.components):
        for each in (*reversed(facts.list_bases()), facts):
            if id(each) not in done:
                done.add(id(each))
                _assign_own_ids(each, known_ids)


def _assign_own_ids(facts: ClassFacts, known_ids: Mapping[str, str]) -> None:
    bases = facts.list_bases()
    # Not one set of all ids: a hundred types made from one of a hundred ports would make a hundred of them.
    taken = ChainMap(facts.port_ids, *(base.port_ids for base in bases))
    for port in facts.ports:
        inherited = (base.ids_by_port_name.get(port.name) for base in bases) if port.name else ()
        port_id = next((each for each in inherited if each is not None), None)
        if port_id is None or port_id in facts.port_ids:
            # Two ports of one name in one class are two: the second one is not the inherited one again.
            port_id = choose_id(port.element, "port", taken, _name_port(port) or "port", known_ids)
        facts.port_ids[port_id] = port.name
        facts.ids_by_port_name.setdefault(port.name, port_id)
        port.input_id = port.output_id = port_id


class ComponentSections:
    """Makes the sections `groups` and `component_types`."""

    def __init__(self, assembly: ComponentAssembly, wiring: PortWiring) -> None:
        self._assembly, self._wiring, self._ledger = assembly, wiring, assembly.ledger
        self._port_keys = {facts: _list_keys(facts.ports) for facts in assembly.types.values()}
        self._given_ports: dict[ClassFacts, list[PortFacts]] = defaultdict(list)
        self._made_types: dict[str, dict[str, object]] = {}
        self._type_of: dict[ClassFacts, str] = {}
        self._settle_types()

    def _settle_types(self) -> None:
        """Let the class that realizes a component have its ports, or make a type between the two.

        An instance adds nothing to its type: where two components of one class differ, each has a type of its own.
        """
        instances: dict[ClassFacts, list[ClassFacts]] = defaultdict(list)
        for facts in self._assembly.components:
            if facts.base is not None:
                instances[facts.base].append(facts)
        bases = {facts.base for facts in self._assembly.types.values() if facts.base is not None}
        for base, users in instances.items():
            missing = [self._find_missing(each) for each in users]
            has_same = all(_list_keys(each) == _list_keys(missing[0]) for each in missing)
            is_plain = not is_true(base.element, "isAbstract") and base not in bases
            for user, ports in zip(users, missing, strict=True):
                if (
                    self._adds_features(user)
                    or is_true(base.element, "isAbstract")
                    or (ports and not (is_plain and has_same))
                ):
                    self._make_type(user, ports)
                else:
                    self._type_of[user] = user.say_base()
                    if user is users[0]:
                        self._given_ports[base] = ports

    def _find_missing(self, facts: ClassFacts) -> list[PortFacts]:
        known = [self._port_keys[base] for base in facts.list_bases()] if facts.ports else []
        return [
            port for port in facts.ports if not all(any(key in each for each in known) for key in _list_keys([port]))
        ]

    def _adds_features(self, facts: ClassFacts) -> bool:
        own = self._assembly.features[facts.element]
        if not own.parameters:
            return bool(own.operations or facts.inside)
        inherited = {name for base in facts.list_bases() for name in self._assembly.features[base.element].parameters}
        return bool(own.parameters.keys() - inherited or own.operations or facts.inside)

    def _make_type(self, facts: ClassFacts, ports: list[PortFacts]) -> None:
        used = {*self._assembly.types, *self._made_types}
        type_id = make_unique_id(facts.id, used)
        body: dict[str, object] = {"is": facts.say_base()} if facts.base else {}
        body |= self._write_ports(ports, facts, is_type=True)
        features = self._assembly.features[facts.element]
        body |= features.list_sections()
        body |= self._write_inside(facts)
        self._made_types[type_id] = body
        self._type_of[facts] = type_id
        words = f"{name_element(facts.element)} has more than the class that realizes it: the component type `{type_id}` lies between them"
        self._ledger.note(facts.element, words)

    def make_types(self) -> dict[str, object]:
        """Return the section `component_types`."""
        section: dict[str, object] = {}
        for facts in self._assembly.types.values():
            element = facts.element
            body: dict[str, object] = say_title(get_name(element), facts.id)
            body |= read_description(self._ledger, element)
            if is_true(element, "isAbstract"):
                body["abstract"] = True
            if facts.generic_names:
                body["generic"] = list(facts.generic_names)
            if facts.base is not None:
                body["is"] = facts.say_base()
            body |= self._write_ports([*facts.ports, *self._given_ports[facts]], facts, is_type=True)
            body |= self._assembly.features[element].list_sections()
            body |= self._write_inside(facts)
            section[facts.id] = body | make_hints(element)
        return section | self._made_types

    def make_groups(self) -> dict[str, object]:
        """Return the section `groups`."""
        groups: dict[str, dict[str, object]] = {}
        for group_id, package in self._assembly.groups.items():
            body = say_title(get_name(package), group_id) | read_description(self._ledger, package)
            groups[group_id] = body | {"components": {}} | make_hints(package)
        for facts in self._assembly.components:
            if facts.owner is None:
                components = groups[facts.path[0]]["components"]
                assert isinstance(components, dict)  # noqa: S101 - made above
                components[facts.id] = self._write_component(facts)
        return dict(groups)

    def _write_component(self, facts: ClassFacts) -> dict[str, object]:
        body: dict[str, object] = say_title(get_name(facts.element), facts.id)
        body |= read_description(self._ledger, facts.element)
        features = self._assembly.features[facts.element]
        type_id = self._type_of.get(facts)
        if type_id is not None:
            body["is"] = type_id
            body |= self._write_instance_ports(facts)
            if type_id not in self._made_types:
                body |= _keep_values(features)
            return body | make_hints(facts.element)
        if (
            get_kind(facts.element) == "Component"
            and not get_id(facts.element).startswith(OWN_PREFIX)
            and facts.base is None
            and not features.list_sections()
        ):
            words = f"no class realizes {name_element(facts.element)}: it has no parameters and no operations"
            self._ledger.note(facts.element, words)
        body |= self._write_ports(facts.ports, facts, is_type=False)
        body |= features.list_sections() | self._write_inside(facts)
        if not _DECLARING_KEYS & body.keys():
            # A component of which nothing else is known is declared by its title.
            body = {"title": get_name(facts.element) or title_from_id(facts.id)} | body
        return body | make_hints(facts.element, kind="Device" if facts.device else "")

    def _write_inside(self, facts: ClassFacts) -> dict[str, object]:
        return {"components": {each.id: self._write_component(each) for each in facts.inside}} if facts.inside else {}

    def _write_ports(self, ports: Iterable[PortFacts], facts: ClassFacts, *, is_type: bool) -> dict[str, object]:
        """Return `inputs` and `outputs`; those of a type read nothing."""
        inputs: dict[str, object] = {}
        outputs: dict[str, object] = {}
        own = {id(port) for port in facts.ports}
        for port in ports:
            sources = [] if is_type else list(self._wiring.sources.get(facts, {}).get(port, ()))
            port_type = self._find_type(port, facts, is_fed=bool(sources))
            is_given = is_type and id(port) not in own
            hints = {} if is_given else self._make_hints(port, is_fed=bool(sources))
            texts = {} if is_given or not port.is_port else read_description(self._ledger, port.element)
            if port.is_input:
                inputs[port.input_id] = port_type | _write_sources(sources) | ({} if port.is_output else texts | hints)
            if port.is_output:
                given = _list_inner_references(self._wiring, facts, port)
                outputs[port.output_id] = (
                    (port_type if port.type_name or not given else {}) | _write_sources(given) | texts | hints
                )
        return _leave_out_empty(inputs=inputs, outputs=outputs)

    def _write_instance_ports(self, facts: ClassFacts) -> dict[str, object]:
        inputs: dict[str, object] = {}
        outputs: dict[str, object] = {}
        read = self._wiring.sources.get(facts, {})
        own = {id(port) for port in facts.ports}
        for port in (*facts.ports, *(port for port in read if id(port) not in own)):
            hints = self._make_hints(port, is_fed=bool(read.get(port))) if id(port) in own else {}
            if port.is_input and (
                written := _write_sources(list(read.get(port, ()))) | (hints if not port.is_output else {})
            ):
                inputs[port.input_id] = written
            if port.is_output and hints:
                outputs[port.output_id] = hints
        return _leave_out_empty(inputs=inputs, outputs=outputs)

    def _find_type(self, port: PortFacts, facts: ClassFacts, *, is_fed: bool) -> dict[str, object]:
        features = [self._assembly.features[each.element] for each in (facts, *facts.list_bases())]
        known = next((each.data_types[port.name] for each in features if each.data_types.get(port.name)), "")
        name = known or port.type_name
        if not name and not (is_fed and not port.is_output):
            # What an input reads says its type; the interface does where nobody provides it.
            name = self._assembly.sorting.uses.find_data_type(port)
        return {"type": find_field_type(name) or name} if name else {}

    @staticmethod
    def _make_hints(port: PortFacts, *, is_fed: bool = False) -> dict[str, object]:
        interfaces = [
            name
            for key in (port.provided if port.is_output else port.required)
            if (name := get_interface_name(key)) and not _is_own(key)
        ]
        # The interface stands at who provides it: who uses it is connected with that.
        kept = [] if is_fed and not port.is_output else interfaces
        if not port.is_port:
            return {"hints": {"uml": {"interface": kept[0]}}} if kept else {}
        return make_hints(port.element, interface=kept[0] if len(kept) == 1 else kept)


def _is_own(key: XmlElement | str) -> bool:
    return isinstance(key, XmlElement) and (
        get_id(key).startswith(f"{OWN_PREFIX}made_interface.") or get_kind(key) != "Interface"
    )


def _list_keys(ports: Iterable[PortFacts]) -> set[PortKey]:
    return {
        key
        for port in ports
        for key in [("inputs", port.input_id)] * port.is_input + [("outputs", port.output_id)] * port.is_output
    }


def _write_sources(references: list[str]) -> dict[str, object]:
    if not references:
        return {}
    return {"from": references[0] if len(references) == 1 else references}


def _keep_values(features: ClassFeatures) -> dict[str, object]:
    """Return what an instance may say of its parameters and its timing: values."""
    values = {
        name: parameter["value"]
        for name, parameter in features.parameters.items()
        if isinstance(parameter, dict) and "value" in parameter
    }
    return _leave_out_empty(parameters=values, timing=features.timing)


def _leave_out_empty(**sections: dict[str, object]) -> dict[str, object]:
    return {key: value for key, value in sections.items() if value}
