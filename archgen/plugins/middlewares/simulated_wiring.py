"""The connections of a simulation: each is made by the innermost assembly that both of its ends stand in."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import tell_left_out
from archgen.plugin.model import Architecture
from archgen.plugins.middlewares.simulated_assemblies import Assembly, AssemblyPart
from archgen.plugins.middlewares.simulated_classes import SimulatedClass


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
