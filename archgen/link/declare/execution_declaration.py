"""Declare what an activation needs to run: execution times, resources such as a GPU, and the cores on which it may run."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link import mapping_values, sanity_checks
from archgen.link.port_resolution import PortResolver
from archgen.model.declared_timing import PERCENTILES, InputTiming, MeasuredTimes, ResourceTime
from archgen.model.quantity import Quantity
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode


def read_wcet(body: MappingNode) -> Quantity | None:
    """Read the worst execution time: `wcet` itself, or `max` below it."""
    return _read_longest(body, "wcet")


def _read_longest(mapping: MappingNode, key: str) -> Quantity | None:
    """Read a duration that may stand below `max`."""
    if type(mapping.get(key)) is MappingNode:
        mapping, key = mapping_values.get_mapping(mapping, key), "max"
    return mapping_values.get_quantity(mapping, key, "duration")


def read_measured_times(body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> MeasuredTimes | None:
    """Read what `wcet` says of measurements; percentiles that contradict one another are left out and reported."""
    wcet_body = mapping_values.get_mapping(body, "wcet")
    percentiles = {
        name: quantity
        for name in PERCENTILES
        if (quantity := mapping_values.get_quantity(wcet_body, name, "duration")) is not None
    }
    longest = mapping_values.get_quantity(wcet_body, "max", "duration")
    is_measured = mapping_values.get_flag(wcet_body, "measured")
    if sanity_checks.report_falling_percentiles(wcet_body, percentiles, longest, element_id, diagnostics):
        percentiles = {}
    return MeasuredTimes(percentiles, is_measured) if percentiles or is_measured else None


def read_input_timing(
    body: MappingNode, ports: PortResolver, diagnostics: list[Diagnostic]
) -> Iterator[tuple[str, InputTiming]]:
    """Yield the execution times of the callbacks that store inputs, by the input's id."""
    for key, entry, input_body in mapping_values.iterate_elements(body, "inputs"):
        port = ports.resolve_port(key, entry.key_span, "input")
        wcet = mapping_values.get_quantity(input_body, "wcet", "duration")
        bcet = mapping_values.get_quantity(input_body, "bcet", "duration")
        if sanity_checks.report_exchanged(input_body, ("bcet", bcet), ("wcet", wcet), ports.owner_id, diagnostics):
            bcet = None
        stored_at_once = mapping_values.get_text(input_body, "stored") is not None
        if stored_at_once and sanity_checks.report_times_of_none(input_body, ports.owner_id, diagnostics):
            wcet = bcet = None
        if port:
            memory = mapping_values.get_text(input_body, "memory")
            yield port, InputTiming(wcet, bcet, stored_at_once, "each_source" if memory else None, entry.key_span)


def read_resource_times(
    body: MappingNode, ports: PortResolver, diagnostics: list[Diagnostic]
) -> dict[str, ResourceTime]:
    """Read how long resources are used, by the resource's id; without those that no section declares."""
    times_by_resource: dict[str, ResourceTime] = {}
    for entry in mapping_values.get_mapping(body, "uses"):
        reference = ScalarNode(entry.key, entry.key, entry.key_span)
        resource = ports.resolver.resolve_plain_id(reference, "resource", ports.owner_id)
        resource_time = _read_resource_time(body, entry, ports.owner_id, diagnostics)
        if resource and resource_time:
            times_by_resource[resource] = resource_time
    return times_by_resource


def _read_resource_time(
    body: MappingNode, entry: MappingEntry, element_id: str, diagnostics: list[Diagnostic]
) -> ResourceTime | None:
    longest = _read_longest(mapping_values.get_mapping(body, "uses"), entry.key)
    use_body = mapping_values.get_body(entry)
    shortest = mapping_values.get_quantity(use_body, "min", "duration")
    if longest is None:
        sanity_checks.report_missing_maximum(entry, element_id, diagnostics)
        return None
    if sanity_checks.report_exchanged(use_body, ("min", shortest), ("max", longest), element_id, diagnostics):
        shortest = None
    return ResourceTime(longest, shortest, entry.key_span)


def read_cores(body: MappingNode, element_id: str, diagnostics: list[Diagnostic]) -> tuple[int, ...] | None:
    """Read a set of cores, in ascending order; None where none is written."""
    sanity_checks.report_empty_list(body, "cores", "core", element_id, diagnostics)
    numbers = {scalar.value for scalar in mapping_values.get_scalars(body, "cores") if type(scalar.value) is int}
    return tuple(sorted(numbers)) or None
