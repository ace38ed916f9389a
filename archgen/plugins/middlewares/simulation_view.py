"""The view `simulation`: the architecture as classes of a program that runs it in logical time, without middleware.

The assemblies of a simulation: the whole, its groups and its composed components, each with its parts and connections.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import (
    GeneratedView,
    GenerationContext,
    find_name_clashes,
    make_identifier_in,
    make_snake_name,
    tell_left_out,
    write_place,
)
from archgen.plugin.model import Architecture
from archgen.plugins.middlewares.java_names import choose_java_spellings
from archgen.plugins.middlewares.simulated_classes import ClassName, SimulatedClass, collect_classes, record_class
from archgen.plugins.middlewares.simulated_timing import record_activation
from archgen.plugins.middlewares.simulated_types import SimulatedTypes, name_java_field

_JAVA_PACKAGE = re.compile(r"[a-z][a-z0-9_]*(?:\.[a-z][a-z0-9_]*)*\Z")
_TAKEN_PACKAGES = frozenset(("archgen", "java", "javax"))


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the records of the types, the classes of the components, and the assemblies that join their ports.

    The option `package` says below which package the classes of Java stand; without it, that is the project's id.
    """
    architecture = context.architecture
    base = _name_java_base(context)
    types = SimulatedTypes(architecture, base)
    classes = collect_classes(context, types)
    own_classes = list({id(each): each for each in classes.values()}.values())
    assemblies = collect_assemblies(architecture, classes)
    findings: list[Diagnostic] = list(_find_class_clashes(own_classes, assemblies.values()))
    left_out = frozenset(each.element or "" for each in findings)
    records: dict[str, dict[str, object]] = {}
    for own in own_classes:
        if own.components[0].id not in left_out:
            record, class_findings = record_class(context, types, own, base)
            findings += class_findings
            records.update((component.id, record) for component in own.components)
    unmade = left_out | (classes.keys() - records.keys())
    for assembly in assemblies.values():
        findings += place_parts(context, assembly, unmade)
    ways = find_ways(assemblies)
    connections, unjoined = connect_assemblies(architecture, classes, ways, assemblies)
    findings += unjoined
    written = {each.id for way in ways.values() for each in way if each.is_assembly} | {""}
    made_classes = MadeClasses(classes, records)
    assembly_records: dict[str, dict[str, object]] = {}
    for key, assembly in assemblies.items():
        if key in written:
            assembly_record, assembly_findings = record_assembly(context, assembly, made_classes, assemblies, base)
            assembly_records[key] = assembly_record
            findings += assembly_findings
    data = types.list_records()
    class_records = list({id(records[each]): records[each] for each in ways}.values())
    view = {
        "title": architecture.project.title,
        "java_package": base,
        "python_package": f"{make_snake_name(architecture.project.id)}_simulation",
        "data": data,
        "data_packages": [
            {"module": module, "records": [each for each in data if each["module"] == module]}
            for module in dict.fromkeys(str(each["module"]) for each in data)
        ],
        "packages": sorted(
            {
                "data",
                *(str(each["package"]) for each in (*class_records, *assembly_records.values()) if each["package"]),
            }
        ),
        "classes": class_records,
        "assemblies": [each for key, each in assembly_records.items() if key],
        "whole": assembly_records[""],
        "components": list(ways),
        "connections": connections,
    }
    return GeneratedView(view, (*findings, *types.findings))


def _name_java_base(context: GenerationContext) -> str:
    written = str(context.options.get("package") or "")
    if _JAVA_PACKAGE.match(written) and written.split(".", maxsplit=1)[0] not in _TAKEN_PACKAGES:
        return ".".join(make_identifier_in("java", each) for each in written.split("."))
    name = make_identifier_in("java", make_snake_name(context.architecture.project.id))
    return f"{name}_" if name in _TAKEN_PACKAGES else name


def _find_class_clashes(classes: Iterable[SimulatedClass], assemblies: Iterable[Assembly]) -> Iterator[Diagnostic]:
    """Yield components and assemblies whose class, or whose behaviour's, another one has in the same package."""
    names: list[tuple[str, str, Span]] = [
        (f"{each.name.package}.{each.name.java}", each.id, each.at) for each in assemblies
    ]
    names += (
        (f"{own.name.package}.{name}", own.components[0].id, own.components[0].at)
        for own in classes
        for name in (own.name.java, f"{own.name.java}Behaviour")
    )
    # Who falls together by name does so by behaviour, too: it is told once.
    yield from {clash.element: clash for clash in reversed(list(find_name_clashes(names, "class")))}.values()


def connect_assemblies(
    architecture: Architecture,
    classes: Mapping[str, SimulatedClass],
    ways: Mapping[str, tuple[AssemblyPart, ...]],
    assemblies: Mapping[str, Assembly],
) -> tuple[list[str], list[Diagnostic]]:
    """Give each assembly its connections; return all as `OUTPUT -> INPUT`, in the order in which a program lists them, and
    what is not joined.
    """
    numbers: dict[str, int] = {}
    # The ports in the order in which classes declare them, since instances may write theirs in another one.
    for component_id in ways:
        component = architecture.components[component_id]
        for direction, name in classes[component_id].ports:
            ports = component.inputs if direction in {"input", "client"} else component.outputs
            if name in ports:
                numbers[f"{direction in {'input', 'client'}} {ports[name].id}"] = len(numbers)
    edges = dict.fromkeys((each.output, each.input) for each in architecture.edges)
    known_edges = [each for each in edges if f"False {each[0]}" in numbers and f"True {each[1]}" in numbers]
    known_edges.sort(key=lambda edge: (numbers[f"False {edge[0]}"], numbers[f"True {edge[1]}"]))
    findings: list[Diagnostic] = []
    messages: list[str] = []
    calls: list[tuple[int, str]] = []
    for output_id, input_id in known_edges:
        output, reader = architecture.outputs[output_id], architecture.inputs[input_id]
        source, target = classes[output.component].find_port(output), classes[reader.component].find_port(reader)
        if source is None or target is None or source.is_call != target.is_call:
            continue
        if source.is_call and source.types != target.types:
            findings.append(
                tell_left_out(
                    f"`{input_id}` calls several types of services, and `{output_id}` answers one of them: they are not joined",
                    reader.at,
                    element=input_id,
                    help_line="give it an input for each",
                )
            )
            continue
        source_way, target_way = ways[output.component], ways[reader.component]
        common = 0
        while source_way[common] == target_way[common] and source_way[common].is_assembly:
            common += 1
        around = source_way[common - 1].id if common else ""
        assemblies[around].connections.append(
            {
                "id": f"{output_id} -> {input_id}",
                "java_source": ".".join([*(each.java_name for each in source_way[common:]), source.java]),
                "java_reader": ".".join([*(each.java_name for each in target_way[common:]), target.java]),
                "python_source": ".".join([*(each.python_name for each in source_way[common:]), source.python]),
                "python_reader": ".".join([*(each.python_name for each in target_way[common:]), target.python]),
            }
        )
        if source.is_call:
            calls.append((numbers[f"True {input_id}"], f"{output_id} -> {input_id}"))
        else:
            messages.append(f"{output_id} -> {input_id}")
    return [*messages, *(text for _, text in sorted(calls, key=lambda each: each[0]))], findings


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
