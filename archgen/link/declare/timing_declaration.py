"""Declare the timing of an element: its figures, its ports resolved, and nothing in it that makes no sense.

Declare what an activation needs to run: execution times, resources such as a GPU, and the cores on which it may run.

Declare the deadline of a chain: always, and for shares of its reactions. The only place that knows its forms.

Merge the timing of a node with that of its components: one timing for each activity (a component in a node).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Literal

from archgen.diagnostics import Diagnostic, Label, Span
from archgen.frozen import dataclass, fields, replace
from archgen.link import mapping_values, sanity_checks
from archgen.link.port_resolution import PortResolver
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_values
from archgen.model.component import Component
from archgen.model.declared_timing import (
    PERCENTILES,
    InputTiming,
    MeasuredTimes,
    OutputTiming,
    ResourceTime,
    Timing,
    Trigger,
)
from archgen.model.quantity import Quantity, parse_share, write_share
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode

_MAX_NUMBER_LENGTH = 40
"""Longer than any number that the schema allows in `calls`; it bounds the time that Fraction takes."""


def declare_timing(owner_entry: MappingEntry, ports: PortResolver, diagnostics: list[Diagnostic]) -> Timing | None:
    """Read the `timing` of an element; None if none is written."""
    entry = mapping_values.get_body(owner_entry).entries.get("timing")
    if entry is None or type(entry.value) is not MappingNode:
        return None
    body = entry.value
    calls = list(_read_calls(body, ports))
    uses = read_resource_times(body, ports, diagnostics)
    timing = Timing(
        **read_values("timing", Timing, body),
        wcet=_read_longest(body, "wcet"),
        measured_times=read_measured_times(body, ports.owner_id, diagnostics),
        trigger=_read_trigger(body, ports, diagnostics),
        inputs=dict(read_input_timing(body, ports, diagnostics)),
        outputs=dict(_read_output_timing(body, ports, diagnostics)),
        calls={port: count for port, count, _ in calls},
        uses=uses,
        deadline=sanity_checks.read_positive(body, "deadline", "duration", ports.owner_id, diagnostics),
        cores=read_cores(body, ports.owner_id, diagnostics),
        # Positions by key; each call and use has its own, under a key that no YAML key can be (it holds a blank).
        places={
            **{e.key: e.value.span for e in body},
            **{f"calls {port}": call_span for port, _, call_span in calls},
            **{f"uses {resource}": resource_time.at for resource, resource_time in uses.items()},
        },
        at=entry.key_span,
    )
    return sanity_checks.drop_senseless(timing, ports.owner_id, diagnostics)


def _read_trigger(body: MappingNode, ports: PortResolver, diagnostics: list[Diagnostic]) -> Trigger | None:
    entry = body.entries.get("trigger")
    if entry is None:
        return None
    node = entry.value
    if type(node) is ScalarNode:
        return Trigger(node.text, at=node.span) if node.text in {"any", "all"} else None  # type: ignore[arg-type]
    if type(node) is SequenceNode:
        inputs = _resolve_inputs(body, "trigger", ports, diagnostics)
        return None if inputs is None else Trigger("any", inputs, at=node.span)
    if type(node) is not MappingNode:
        return None
    mode: Literal["all", "match"] = "all" if node.get("all") is not None else "match"
    is_damaged = ports.owner_id in ports.resolver.damaged_elements
    sanity_checks.report_mixed_trigger(node, ports.owner_id, diagnostics)
    if not is_damaged:  # a misspelt `match` is reported
        sanity_checks.report_lonely_within(node, ports.owner_id, diagnostics)
    inputs = _resolve_inputs(node, mode, ports, diagnostics)
    if inputs is None or mode == "all":
        return None if inputs is None else Trigger(mode, inputs, at=node.span)
    within = mapping_values.get_quantity(node, "within", "duration")
    is_sound = sanity_checks.check_match(node, inputs, within, ports.owner_id, diagnostics, is_damaged=is_damaged)
    return Trigger(mode, inputs, within, node.span) if is_sound else None


def _resolve_inputs(
    mapping: MappingNode, key: str, ports: PortResolver, diagnostics: list[Diagnostic]
) -> tuple[str, ...] | None:
    """Resolve a list of inputs; None if it is empty or nothing in it can be resolved."""
    sanity_checks.report_empty_list(mapping, key, "input", ports.owner_id, diagnostics)
    sanity_checks.report_repetition(mapping, key, ports.owner_id, diagnostics)
    input_ids = [
        ports.resolve_port(scalar.text, scalar.span, "input") for scalar in mapping_values.get_scalars(mapping, key)
    ]
    distinct_ids = tuple(dict.fromkeys(port for port in input_ids if port))
    return distinct_ids or None


def _read_output_timing(
    body: MappingNode, ports: PortResolver, diagnostics: list[Diagnostic]
) -> Iterator[tuple[str, OutputTiming]]:
    for key, entry, output_body in mapping_values.iterate_elements(body, "outputs"):
        port = ports.resolve_port(key, entry.key_span, "output")
        if port:
            max_gap = sanity_checks.read_positive(output_body, "max_gap", "duration", ports.owner_id, diagnostics)
            yield port, OutputTiming(mapping_values.get_flag(output_body, "conditional"), max_gap, entry.key_span)


def _read_calls(body: MappingNode, ports: PortResolver) -> Iterator[tuple[str, Fraction, Span]]:
    for entry in mapping_values.get_mapping(body, "calls"):
        port = ports.resolve_port(entry.key, entry.key_span, "input")
        count = _parse_fraction(entry.value.text) if type(entry.value) is ScalarNode else None
        if port and count is not None:
            yield port, count, entry.key_span


def _parse_fraction(text: str) -> Fraction | None:
    try:
        return Fraction(text) if len(text) <= _MAX_NUMBER_LENGTH else None
    except (ValueError, ZeroDivisionError):
        return None


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


ALWAYS = "always"
_LARGEST_SHARE = Fraction(999_999, 1_000_000)
"""To see what is later than a larger one takes more than a million reactions, which nobody simulates or records."""


def read_deadline(
    body: MappingNode, key: str, chain_id: str, resolver: ReferenceResolver
) -> tuple[Quantity | None, Mapping[str, Quantity], Mapping[str, Span]]:
    """Return the deadline that always holds; those of shares of the reactions, the smallest share first, and their places."""
    node, diagnostics = body.get(key), resolver.diagnostics
    if not isinstance(node, MappingNode):
        return sanity_checks.read_positive(body, key, "duration", chain_id, diagnostics), {}, {}
    always = sanity_checks.read_positive(node, ALWAYS, "duration", chain_id, diagnostics)
    entries = dict(sorted(_read_shares(node, chain_id, diagnostics)))
    limits = {
        share: quantity
        for share, entry in entries.items()
        if (quantity := sanity_checks.read_positive(node, entry.key, "duration", chain_id, diagnostics)) is not None
    }
    rising = [*((entries[share].key, limit) for share, limit in limits.items()), (ALWAYS, always)]
    if any(
        sanity_checks.report_exchanged(node, smaller, larger, chain_id, diagnostics)
        for smaller, larger in pairwise(rising)
    ):
        return always, {}, {}
    names = {share: write_share(share) for share in limits}
    return (
        always,
        {name: limits[share] for share, name in names.items()},
        {name: entries[share].key_span for share, name in names.items()},
    )


def _read_shares(
    node: MappingNode, chain_id: str, diagnostics: list[Diagnostic]
) -> Iterator[tuple[Fraction, MappingEntry]]:
    """Yield the entries of shares that something can be said of, each share once; the others are reported."""
    seen_spans: dict[Fraction, Span] = {}
    for entry in node:
        share = parse_share(entry.key)
        # A key that is no share is reported by the schema, and a duration that is none as well.
        if share is None:
            continue
        if share in seen_spans:
            message, help_line = f"`{entry.key}` is written twice", "take one of them out"
        elif not share:
            message, help_line = "0 % of the reactions ask for nothing", "write a share above 0 %, such as `95 %`"
        elif share > _LARGEST_SHARE:
            message = f"no data can judge `{entry.key}`: fewer than one of a million reactions may be later"
            help_line = f"write 99.9999 % at most, or `{ALWAYS}`, which bounds judge"
        else:
            seen_spans[share] = entry.key_span
            yield share, entry
            continue
        labels = (Label(seen_spans[share], "first written here"),) if share in seen_spans else ()
        diagnostics.append(
            Diagnostic("wrong-value", message, entry.key_span, labels=labels, help=help_line, element=chain_id)
        )


# All keys of `timing` that people write, with the fields of Timing that hold their values; two fields are positions.
_FIELDS_OF_KEY = {
    **{f.name: (f.name,) for f in fields(Timing) if f.name not in {"places", "at", "measured_times"}},
    "wcet": ("wcet", "measured_times"),
}


@dataclass(frozen=True, slots=True)
class TimingMerger:
    """Merges the timing of nodes with that of their components, and appends findings to `diagnostics`.

    Components in `shared_components` have several nodes: their timing is a claim about all nodes together, and no node
    inherits it.
    """

    components: Mapping[str, Component]
    shared_components: Collection[str]
    diagnostics: list[Diagnostic]

    def merge_timing(
        self, node_id: str, written_timing: Timing | None, implements: Collection[str]
    ) -> dict[str, Timing]:
        """Return a node's timing by component; the key is "" for a node that implements nothing."""
        if not implements:
            return {"": written_timing} if written_timing else {}
        timings: dict[str, Timing] = {}
        for component in implements:
            # 10 Hz of a component with two nodes is not 10 Hz of each of them.
            component_timing = None if component in self.shared_components else self.components[component].timing
            # With one component every port belongs to it, and ports that could not be resolved stay as well.
            node_timing = (
                _restrict_timing(written_timing, component)
                if written_timing and len(implements) > 1
                else written_timing
            )
            timing = (
                _merge_over_component(node_id, node_timing, component_timing, self.diagnostics)
                if node_timing and component_timing
                else node_timing or component_timing
            )
            if timing:
                timings[component] = timing
        return timings


def find_shared_components(implements: Iterable[Iterable[str]]) -> frozenset[str]:
    """Return the components that several nodes implement, from the components of each node."""
    counts = Counter(component for components in implements for component in components)
    return frozenset(component for component, count in counts.items() if count > 1)


def _restrict_timing(timing: Timing, component: str) -> Timing:
    """Return a node's timing with only those triggers, inputs, outputs and calls that are ports of one of its components."""
    prefix = f"{component}."
    trigger = timing.trigger
    if trigger and trigger.inputs is not None:
        inputs = tuple(port for port in trigger.inputs if port.startswith(prefix))
        trigger = replace(trigger, inputs=inputs) if inputs else None
    return replace(
        timing,
        trigger=trigger,
        inputs={port: value for port, value in timing.inputs.items() if port.startswith(prefix)},
        outputs={port: value for port, value in timing.outputs.items() if port.startswith(prefix)},
        calls={port: value for port, value in timing.calls.items() if port.startswith(prefix)},
    )


def _merge_over_component(
    node_id: str, node_timing: Timing, component_timing: Timing, diagnostics: list[Diagnostic]
) -> Timing:
    """Merge a component's timing with that of its only node; a key that both write is reported, the node's counts."""
    doubled_keys = [key for key in _FIELDS_OF_KEY if key in node_timing.places and key in component_timing.places]
    diagnostics += (_diagnose_doubled_key(node_id, key, node_timing, component_timing) for key in doubled_keys)
    # `places` holds the keys that were written: a key that was written as `{}` must not be filled in.
    missing_values = {
        name: getattr(component_timing, name)
        for key, names in _FIELDS_OF_KEY.items()
        if key not in node_timing.places
        for name in names
    }
    merged = replace(node_timing, **missing_values, places={**component_timing.places, **node_timing.places})
    # Each of the two made sense alone; together they may not: a rate here and a period there, for instance.
    return sanity_checks.drop_senseless(merged, node_id, diagnostics)


def _diagnose_doubled_key(node_id: str, key: str, node_timing: Timing, component_timing: Timing) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{key}` is written at the node `{node_id}` and at the component that it implements",
        node_timing.places[key],
        labels=(Label(component_timing.places[key], "written here"),),
        help="keep one of them: a component with one node has one timing",
        element=node_id,
    )
