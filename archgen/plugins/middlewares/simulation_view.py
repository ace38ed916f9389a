"""The view `simulation`: the architecture as classes of a program that runs it in logical time, without middleware."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from archgen.plugin.findings import Diagnostic, Span
from archgen.plugin.generating import (
    GeneratedView,
    GenerationContext,
    find_name_clashes,
    make_identifier_in,
    make_snake_name,
    tell_left_out,
)
from archgen.plugin.model import Architecture
from archgen.plugins.middlewares.simulated_assemblies import (
    Assembly,
    AssemblyPart,
    MadeClasses,
    collect_assemblies,
    find_ways,
    place_parts,
    record_assembly,
)
from archgen.plugins.middlewares.simulated_classes import SimulatedClass, collect_classes, record_class
from archgen.plugins.middlewares.simulated_types import SimulatedTypes

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
