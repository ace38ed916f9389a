"""The classes of components of a simulation: one for all instances of a component type, with the ports that any of them has."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from archgen.plugin.findings import Diagnostic, Span, first_written_span
from archgen.plugin.generating import (
    GenerationContext,
    find_name_clashes,
    find_type_words,
    make_camel_name,
    make_identifier_in,
    make_snake_name,
    write_place,
)
from archgen.plugin.model import Architecture, Component, Input, Output
from archgen.plugins.middlewares.component_parameters import record_simulated_parameters
from archgen.plugins.middlewares.java_names import JAVA_CLASS_NAMES
from archgen.plugins.middlewares.simulated_types import ANYTHING, TEXT, SimulatedTypes, ValueType, name_java_field

_JAVA_FIELDS = frozenset(("parameters", "behaviour"))
_PYTHON_ATTRIBUTES = frozenset(
    """
    activation behaviour clients fire id inputs join make_client make_input make_output make_server now_ns outputs
    parameters simulation timing
    """.split()  # noqa: SIM905 - a list of words
)


@dataclass(frozen=True, slots=True)
class ClassName:
    """The class of a component: the last word of its package, its name, and the words that its module is called after."""

    package: str
    words: str

    @property
    def java(self) -> str:
        """The name of the class."""
        name = make_camel_name(self.words)
        return f"{name}Component" if name in JAVA_CLASS_NAMES else name

    @property
    def module(self) -> str:
        """The module of Python."""
        return make_identifier_in("python", make_snake_name(self.words))


@dataclass(frozen=True, slots=True)
class PortNames:
    """What a port is called in both languages, and whether it is called instead of sent over."""

    java: str
    python: str
    is_call: bool
    types: tuple[ValueType, ...]


@dataclass
class SimulatedClass:
    """A class, with the components that are its instances."""

    name: ClassName
    components: list[Component] = field(default_factory=list)
    port_types: dict[tuple[str, str], list[ValueType]] = field(default_factory=dict)
    """What each port holds, by `input`, `output`, `client` or `server` and its name: request and answer of what is called."""
    ports: dict[tuple[str, str], Input | Output] = field(default_factory=dict)

    def find_port(self, port: Input | Output) -> PortNames | None:
        """Return the names of a port of an instance; None for what is left out."""
        directions = ("input", "client") if isinstance(port, Input) else ("output", "server")
        for direction in directions:
            if (direction, port.name) in self.ports:
                names = _name_java_port(self, direction, port.name), _name_python_port(self, direction, port.name)
                is_call = direction in {"client", "server"}
                return PortNames(*names, is_call=is_call, types=tuple(self.port_types[direction, port.name]))
        return None


def name_simulated_class(architecture: Architecture, component: Component) -> ClassName:
    """Return the class of a component: instances of one type have one, and so have the same parts of them."""
    type_words = find_type_words(architecture, component)
    if type_words is not None:
        return ClassName("types", type_words)
    names = [component.name, *(each.name for each in architecture.list_around(component))]
    return ClassName(make_identifier_in("java", make_snake_name(component.group)), " ".join(reversed(names)))


def collect_classes(context: GenerationContext, types: SimulatedTypes) -> dict[str, SimulatedClass]:
    """Return the class of each component to generate for, by its complete id."""
    architecture = context.architecture
    by_name: dict[ClassName, SimulatedClass] = {}
    classes: dict[str, SimulatedClass] = {}
    for component_id in context.wanted_components:
        component = architecture.components[component_id]
        class_name = name_simulated_class(architecture, component)
        if component_id in architecture.shells:
            # What nothing inside of a composed component carries yet.
            class_name = ClassName(class_name.package, f"{class_name.words} rest")
        own = classes[component_id] = by_name.setdefault(class_name, SimulatedClass(class_name))
        own.components.append(component)
        for port in component.ports:
            own.ports.setdefault((_name_direction(architecture, port), port.name), port)
    for own in by_name.values():
        for direction, name in own.ports:
            if direction in {"output", "server"}:
                own.port_types[direction, name] = _join_types(
                    _find_types(architecture, types, each.outputs[name])
                    for each in own.components
                    if name in each.outputs
                )
    sent_types = _list_sent_types(architecture, types, classes)
    for own in by_name.values():
        for direction, name in own.ports:
            if direction in {"input", "client"}:
                own.port_types[direction, name] = _join_types(
                    _list_reader_types(architecture, types, sent_types, own, name)
                )
    return classes


def _name_direction(architecture: Architecture, port: Input | Output) -> str:
    flow = architecture.flow_of(port)
    if isinstance(port, Input) and port.type is None and port.connections:
        # An input without a type of its own has that of what it reads.
        first = next((output for each in port.connections for output in each.outputs), None)
        flow = architecture.flow_of(architecture.outputs[first]) if first else flow
    if flow == "topic":
        return "input" if isinstance(port, Input) else "output"
    return "client" if isinstance(port, Input) else "server"


def _find_types(architecture: Architecture, types: SimulatedTypes, port: Input | Output) -> list[ValueType]:
    if architecture.flow_of(port) == "topic":
        return [types.find_port_type(port.type)]
    parts = 3 if architecture.flow_of(port) == "action" else 2
    return list(types.find_call_types(port.type))[:parts]


def _list_sent_types(
    architecture: Architecture, types: SimulatedTypes, classes: Mapping[str, SimulatedClass]
) -> Mapping[str, Sequence[list[ValueType]]]:
    """Return what the sources of each input send or answer, by the complete id of the input."""
    sent_types: dict[str, list[list[ValueType]]] = {}
    for edge in architecture.edges:
        source = architecture.outputs[edge.output]
        source_class = classes.get(source.component)
        if source_class is not None:
            found = source_class.port_types[_name_direction(architecture, source), source.name]
        else:
            found = _find_types(architecture, types, source)
        sent_types.setdefault(edge.input, []).append(found)
    return sent_types


def _list_reader_types(
    architecture: Architecture,
    types: SimulatedTypes,
    sent_types: Mapping[str, Sequence[list[ValueType]]],
    own: SimulatedClass,
    name: str,
) -> Iterator[list[ValueType]]:
    """Yield what the input of each instance expects and is sent."""
    for component in own.components:
        port = component.inputs.get(name)
        if port is not None:
            if port.type is not None:
                yield _find_types(architecture, types, port)
            yield from sent_types.get(port.id, ())


def _join_types(listed: Iterable[list[ValueType]]) -> list[ValueType]:
    """Return the types that all have; where they differ, anything."""
    all_types = list(listed)
    if not all_types:
        return [TEXT, TEXT]
    first = all_types[0]
    return [
        each if all(len(other) == len(first) and other[number] == each for other in all_types) else ANYTHING
        for number, each in enumerate(first)
    ]


def _list_port_types(own: SimulatedClass, *directions: str) -> list[ValueType]:
    """Return the types of the ports that a class has, and not of those that are left out."""
    kept = (listed for key, listed in own.port_types.items() if key in own.ports and key[0] in directions)
    return [each for listed in kept for each in listed]


def record_class(
    context: GenerationContext, types: SimulatedTypes, own: SimulatedClass, base: str
) -> tuple[dict[str, object], list[Diagnostic]]:
    """Return a class as data, and what is left out of it. Ports that are left out go from `own`, too."""
    first = own.components[0]
    findings: list[Diagnostic] = []
    for language_name in (_name_java_port, _name_python_port):
        names = [
            (language_name(own, direction, name), f"{port.id} {direction}", port.at)
            for (direction, name), port in own.ports.items()
        ]
        for clash in find_name_clashes(names, "name"):
            findings.append(clash)
            direction, name = next(key for key, port in own.ports.items() if f"{port.id} {key[0]}" == clash.element)
            del own.ports[direction, name]
    parameters, parameter_findings = record_simulated_parameters(context, own.components)
    findings += parameter_findings
    own_names = [own.name.java, f"{own.name.java}Behaviour", "Behaviour", "Parameters"]
    server_types = _list_port_types(own, "server")
    read_or_sent_types = _list_port_types(own, "input", "output")
    all_types = _list_port_types(own, "input", "output", "client", "server")
    package = f"{base}.{own.name.package}"
    spellings = types.spell_in_java(all_types, package, own_names)
    ports: dict[str, list[dict[str, object]]] = {"inputs": [], "outputs": [], "clients": [], "servers": []}
    for (direction, name), port in own.ports.items():
        value_types = [types.describe(each, spellings) for each in own.port_types[direction, name]]
        ports[f"{direction}s"].append(
            {
                "name": name,
                "java_name": _name_java_port(own, direction, name),
                "java_method": f"serve{make_camel_name(_name_port(own, direction, name))}",
                "python_name": _name_python_port(own, direction, name),
                "types": value_types,
                "is_action": len(value_types) > 2,  # noqa: PLR2004
                "type_name": port.type or "",
                "description": port.description or "",
                "place": write_place(port.at),
            }
        )
    is_shared = len(own.components) > 1 or first.component_type is not None
    return {
        "package": own.name.package,
        "java_package": package,
        "class_name": own.name.java,
        "module": own.name.module,
        "python_class": make_identifier_in("python", own.name.java),
        "title": first.component_type or own.name.java if is_shared else first.title,
        "description": first.description or first.functionality or "",
        "type": first.component_type,
        "place": write_place(_find_place(context.architecture, first)),
        "components": [each.id for each in own.components],
        "parameters": parameters,
        "java_imports": types.list_java_imports(all_types, spellings, package),
        "server_imports": types.list_java_imports(server_types, spellings, package),
        "modules": types.list_modules(read_or_sent_types),
        "server_modules": types.list_modules(server_types),
        **ports,
    }, findings


def _find_place(architecture: Architecture, component: Component) -> Span:
    component_type = architecture.component_types.get(component.type_name)
    return first_written_span(component_type.at, component.at) if component_type else component.at


def _has_both(own: SimulatedClass, name: str) -> bool:
    return len({direction in {"input", "client"} for direction, other in own.ports if other == name}) > 1


def _name_port(own: SimulatedClass, direction: str, name: str) -> str:
    """Return the name of a port; an input is told from an output that is called so, too."""
    return f"{name}_input" if direction in {"input", "client"} and _has_both(own, name) else name


def _name_java_port(own: SimulatedClass, direction: str, name: str) -> str:
    java_name = name_java_field(_name_port(own, direction, name))
    return f"{java_name}_" if java_name in _JAVA_FIELDS else java_name


def _name_python_port(own: SimulatedClass, direction: str, name: str) -> str:
    python_name = make_identifier_in("python", make_snake_name(_name_port(own, direction, name)))
    return f"{python_name}_" if python_name in _PYTHON_ATTRIBUTES else python_name
