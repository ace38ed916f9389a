"""The assemblies of a simulation: the whole, its groups and its composed components, each with its parts and connections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import (
    GenerationContext,
    find_name_clashes,
    make_identifier_in,
    make_snake_name,
    write_place,
)
from archgen.plugin.model import Architecture
from archgen.plugins.middlewares.java_names import choose_java_spellings
from archgen.plugins.middlewares.simulated_classes import ClassName, SimulatedClass
from archgen.plugins.middlewares.simulated_timing import record_activation
from archgen.plugins.middlewares.simulated_types import name_java_field

_PYTHON_ATTRIBUTES = frozenset(("add", "components", "connect", "include", "list_connections"))


@dataclass(frozen=True, slots=True)
class MadeClasses:
    """The classes of components, and what is recorded of them, by the ids of the components."""

    classes: Mapping[str, SimulatedClass]
    records: Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True, slots=True)
class AssemblyPart:
    """A part of an assembly: a component, or another assembly."""

    id: str
    is_assembly: bool
    java_name: str
    python_name: str


@dataclass
class Assembly:
    """What holds components; `children` are the names of its parts by their ids, and whether they are assemblies."""

    id: str
    name: ClassName
    title: str
    at: Span
    children: dict[tuple[str, bool], str] = field(default_factory=dict)
    parts: list[AssemblyPart] = field(default_factory=list)
    connections: list[dict[str, str]] = field(default_factory=list)


def collect_assemblies(architecture: Architecture, classes: Mapping[str, SimulatedClass]) -> dict[str, Assembly]:
    """Return the assemblies of the components that have classes, by id, the whole as an empty one; it is the first."""
    project = architecture.project
    whole = Assembly("", ClassName("", f"{project.id} system"), project.title, project.at)
    assemblies = {"": whole}
    for component_id in classes:
        component = architecture.components[component_id]
        chain = list(architecture.list_around(component))[::-1]
        if component_id in architecture.shells:
            chain.append(architecture.shells[component_id])
        group = architecture.groups[component.group]
        package = make_identifier_in("java", make_snake_name(group.id))
        around = assemblies.setdefault(
            group.id, Assembly(group.id, ClassName(package, f"{group.id} group"), group.title, group.at)
        )
        whole.children[group.id, True] = group.id
        for shell in chain:
            words = shell.id.removeprefix(f"{group.id}.").replace(".", " ")
            around.children[shell.id, True] = shell.name
            around = assemblies.setdefault(
                shell.id, Assembly(shell.id, ClassName(package, words), shell.title, shell.at)
            )
        name = "rest" if component_id in architecture.shells else component.name
        around.children[component_id, False] = name
    return assemblies


def place_parts(context: GenerationContext, assembly: Assembly, left_out: frozenset[str]) -> Iterator[Diagnostic]:
    """Give an assembly its parts, but for those whose names fall together, which are yielded, and those left out already."""
    architecture = context.architecture
    parts: dict[str, AssemblyPart] = {}
    spans: dict[str, Span] = {}
    for (part_id, is_assembly), name in assembly.children.items():
        if part_id in left_out:
            continue
        element = architecture.find_component(part_id) or architecture.groups[part_id]
        python_name = make_identifier_in("python", make_snake_name(name))
        python_name = f"{python_name}_" if python_name in _PYTHON_ATTRIBUTES else python_name
        key = part_id if is_assembly or part_id not in architecture.shells else f"{part_id} rest"
        parts[key] = AssemblyPart(part_id, is_assembly, name_java_field(name), python_name)
        spans[key] = element.at
    dropped = set[str]()
    for names in (
        {key: each.java_name for key, each in parts.items()},
        {key: each.python_name for key, each in parts.items()},
    ):
        for clash in find_name_clashes(
            [(name, key, spans[key]) for key, name in names.items() if key not in dropped], "name"
        ):
            dropped.add(clash.element or "")
            yield clash
    assembly.parts = [each for key, each in parts.items() if key not in dropped]


def find_ways(assemblies: Mapping[str, Assembly]) -> dict[str, tuple[AssemblyPart, ...]]:
    """Return the parts on the way from the whole to each component, in the order in which the program makes these."""
    ways: dict[str, tuple[AssemblyPart, ...]] = {}
    open_parts: list[tuple[AssemblyPart, ...]] = [(each,) for each in reversed(assemblies[""].parts)]
    while open_parts:
        way = open_parts.pop()
        if way[-1].is_assembly:
            open_parts += [(*way, each) for each in reversed(assemblies[way[-1].id].parts)]
        else:
            ways[way[-1].id] = way
    return ways


def record_assembly(
    context: GenerationContext, assembly: Assembly, classes: MadeClasses, assemblies: Mapping[str, Assembly], base: str
) -> tuple[dict[str, object], list[Diagnostic]]:
    """Return an assembly as data, and what is odd about when its components are active."""
    findings: list[Diagnostic] = []
    names = {
        f"{each.is_assembly} {each.id}": assemblies[each.id].name if each.is_assembly else classes.classes[each.id].name
        for each in assembly.parts
    }
    package = f"{base}.{assembly.name.package}".rstrip(".")
    full_names = {key: f"{base}.{name.package}.{name.java}" for key, name in names.items()}
    spellings = choose_java_spellings(full_names, package, [assembly.name.java])
    parts: list[dict[str, object]] = []
    for part in assembly.parts:
        key = f"{part.is_assembly} {part.id}"
        class_name = names[key]
        record: dict[str, object] = {
            "id": part.id,
            "is_assembly": part.is_assembly,
            "java_name": part.java_name,
            "python_name": part.python_name,
            "java_class": spellings[key],
            "package": class_name.package,
            "module": class_name.module,
            "python_class": make_identifier_in("python", class_name.java),
            "place": "",
        }
        if not part.is_assembly:
            component = context.architecture.components[part.id]
            input_names = [each["name"] for each in classes.records[part.id]["inputs"]]
            record["timing"], finding = record_activation(context, component, input_names)
            record["place"] = write_place(component.at)
            record["settings"] = [
                {**each, "value": each["values"].get(part.id), "is_given": part.id in each["values"]}
                for each in classes.records[part.id]["parameters"]
            ]
            findings += [finding] if finding else []
        parts.append(record)
    return {
        "id": assembly.id,
        "package": assembly.name.package,
        "java_package": package,
        "class_name": assembly.name.java,
        "module": assembly.name.module,
        "python_class": make_identifier_in("python", assembly.name.java),
        "title": assembly.title,
        "place": write_place(assembly.at),
        "java_imports": sorted(
            {
                full_name
                for key, full_name in full_names.items()
                if "." not in spellings[key] and names[key].package != assembly.name.package
            }
        ),
        "modules": sorted({(names[key].package, names[key].module) for key in names}),
        "parts": parts,
        "connections": assembly.connections,
    }, findings
