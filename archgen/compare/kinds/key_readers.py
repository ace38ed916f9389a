"""What reads the keys for which the normal form of their type does not do.

A key with keys below it is read off what its function returns, key by key.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.bringup.start_plan import resolve_conditions
from archgen.compare.kinds import component_keys
from archgen.compare.kinds.key_spec import ReadContext, Reader
from archgen.compare.normal_values import freeze_value, last_part, parameter_leaves, unordered_values
from archgen.frozen import replace
from archgen.model.architecture import UseCase
from archgen.model.component import PATTERN_GROUP
from archgen.model.declared_timing import Timing, list_fair_figures
from archgen.model.deployment import Host
from archgen.model.message_types import ConceptualType, DataField
from archgen.model.node import Node
from archgen.model.quantity import Quantity
from archgen.model.requirement import Requirement
from archgen.model.start_up import StartTarget, StartUp
from archgen.model.use_case_steps import StepEnd
from archgen.timing.figures.figure_wording import format_rate


def is_own_type(conceptual_type: ConceptualType) -> bool:
    """Whether the project declares a type."""
    return conceptual_type.origin == "project" and bool(conceptual_type.at.file)


def _read_fields(conceptual_type: ConceptualType, context: ReadContext) -> Mapping[str, str]:
    """Return the conceptual types that fields hold, by the field; of a generic type all that is written."""
    if not is_own_type(conceptual_type):
        return {}
    types = context.architecture.types
    values = {
        f"{part}.{field.name}" if part else field.name: _describe_field(field, context)
        for part, field in conceptual_type.list_fields()
        if conceptual_type.generic or field.element_type in types
    }
    if conceptual_type.generic:
        values |= {each.name: f"{each.type} {each.value}" for each in conceptual_type.constants}
        values |= {name: str(number) for number, name in enumerate(conceptual_type.values)}
    return values


def _describe_field(field: DataField, context: ReadContext) -> str:
    if field.element_type in context.architecture.types:
        return f"{context.common_id('type', field.element_type)}{field.array}"
    default = field.default if isinstance(field.default, str | None) else f"[{', '.join(field.default)}]"
    return " ".join(filter(None, (field.type, default, field.meaning)))


def _read_host(node: Node, context: ReadContext) -> str | None:
    """Return the host of a node that says so itself."""
    own_container = context.architecture.containers.get(node.container) if node.container else None
    # A host that is the container's own adds nothing, and would change with it.
    is_inherited = own_container is not None and own_container.host == node.host
    return None if is_inherited else context.common_id("host", node.host)


def _read_callback_groups(node: Node, context: ReadContext) -> Mapping[str, object]:
    """Return the components of each callback group."""
    return {
        name: unordered_values(context.matched_ids.common_id("component", component) for component in members)
        for name, members in node.callback_groups.items()
    }


def _read_parameters(node: Node, _context: ReadContext) -> Mapping[str, object]:
    """Return what a node and its files set; that it stands in the one or the other is no difference."""
    values = {value.name: freeze_value(value.value) for value in node.file_values}
    return values | {
        key: value for name, parameter in node.parameters.items() for key, value in parameter_leaves(name, parameter)
    }


def _find_untold_timing(node: Node, context: ReadContext) -> Mapping[str, Timing]:
    """Return the timing that no component reports: of components with several nodes, and of a node without any."""
    return {
        f"{context.matched_ids.common_id('component', component)}." if len(node.implements) > 1 else "": timing
        for component, timing in node.timing.items()
        if component not in context.told_components
    }


def _find_start(node: Node, context: ReadContext) -> StartUp | None:
    """Return what a node says of its start-up, with the names of ROS that it waits for written out."""
    start = node.start
    if start is None:
        return None
    return replace(start, ready=resolve_conditions(start.ready, node, context.architecture.distro))


def _common_ids(targets: Iterable[StartTarget], context: ReadContext) -> tuple[str, ...]:
    # What a component type names inside of itself is another component in each instance: it is told there.
    own_targets = (target for target in targets if not target.id.startswith(f"{PATTERN_GROUP}."))
    return tuple(context.matched_ids.common_id(target.kind, target.id) for target in own_targets)


def _read_steps(use_case: UseCase, context: ReadContext) -> tuple[str, ...]:
    """Return the steps as one line each, with the ids of the second version."""
    return tuple(
        f"{_name_end(step.source, context)} → {_name_end(step.target, context)}"
        + (f": {' '.join(step.say.split())}" if step.say else "")
        for step in use_case.steps
    )


def _name_end(end: StepEnd, context: ReadContext) -> str:
    is_element = end.kind in {"component", "output"}
    return context.matched_ids.common_id(end.kind, end.id) if is_element else end.id


def _read_verifications(requirement: Requirement, context: ReadContext) -> frozenset[str]:
    """Return what verifies a requirement; use cases and chains by their common ids."""
    return frozenset(
        str(context.common_id(each.kind, each.text)) if each.kind in {"use_case", "chain"} else each.text
        for each in requirement.verified_by
    )


def _read_core_orders(host: Host, _context: ReadContext) -> Mapping[str, str]:
    """Return the order in which each core takes what is ready, and the figures of a fair one."""
    orders = {str(core): str(order) for core, order in host.core_scheduling.items()}
    return orders | {f"fair.{name}": figure for name, figure in list_fair_figures(host.fair)}


def _make_selector_reader(attribute: str) -> Reader:
    """Return a reader of a selector, with the ids of the second version; None where none is written."""

    def read(element: Any, context: ReadContext) -> str | None:  # noqa: ANN401 - whatever has such a selector
        return context.matched_ids.rename_in_text(" ".join((getattr(element, attribute) or "").split())) or None

    return read


_NS_PER_SECOND = 10**9


def _read_rate(timing: Timing, _context: ReadContext) -> Quantity | None:
    """Return the rate; a period as the rate that it amounts to."""
    if timing.period is None or not timing.period.value:
        return timing.rate
    # Periods are in ns. `period: 100 ms` and `rate: 10 Hz` mean the same and must compare equal.
    rate = Fraction(_NS_PER_SECOND) / timing.period.value
    return Quantity(rate, format_rate(rate))


def _name_port(kind: str, port: str, context: ReadContext) -> str:
    return f"{last_part(context.matched_ids.common_id(kind, port))}."


def _read_uses(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    """Return the longest use of each resource, and the shortest by `resource.min`."""
    values: dict[str, object] = {}
    for name, resource_time in timing.uses.items():
        resource = context.matched_ids.common_id("resource", name)
        values |= {resource: resource_time.max, f"{resource}.min": resource_time.min}
    return values


def _read_measured_times(timing: Timing, _context: ReadContext) -> Mapping[str, object]:
    """Return the measured percentiles, and whether the longest time is one that was seen."""
    times = timing.measured_times
    return {**times.percentiles, "measured": times.is_measured or None} if times else {}


def _read_trigger_facets(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    """Return which inputs fire a component, and how far apart matched messages may be."""
    trigger = timing.trigger
    return {"inputs": context.common_ids("input", trigger.inputs or ()), "within": trigger.within} if trigger else {}


READERS: Mapping[tuple[str, str], Reader] = {
    ("project", "id"): lambda project, context: None if "id" in context.version.unnamed_keys else project.id,
    ("project", "title"): lambda project, context: None if "title" in context.version.unnamed_keys else project.title,
    ("use_case", "actors."): lambda use_case, _: {actor.id: actor.title for actor in use_case.actors.values()},
    ("use_case", "steps"): _read_steps,
    ("requirement", "verified_by"): _read_verifications,
    ("component", "title"): component_keys.read_name_as_title,
    ("component", "is"): component_keys.read_component_type,
    ("component", "requirements"): component_keys.read_requirements,
    ("component", "performance."): component_keys.find_indicators,
    ("component", "inputs"): component_keys.read_inputs,
    ("component", "outputs"): component_keys.read_outputs,
    ("component", "parameters."): component_keys.read_parameters,
    ("component", "operations."): component_keys.read_operations,
    ("component", "timing."): component_keys.find_node_timing,
    ("component_type", "is"): component_keys.read_base,
    ("component_type", "deprecated."): component_keys.find_component_type_deprecation,
    ("input", "medium"): component_keys.read_medium,
    ("output", "medium"): component_keys.read_medium,
    ("output", "deprecated."): component_keys.find_output_deprecation,
    ("type", "fields."): _read_fields,
    ("type", "deprecated."): component_keys.find_type_deprecation,
    ("frame", "by"): lambda frame, context: context.common_id(frame.by_kind, frame.by),
    ("promise", "range"): component_keys.read_range,
    ("node", "name"): lambda node, _: None if node.name == node.id else node.name,
    ("node", "command"): lambda node, _: " ".join(map(shlex.quote, node.command)) or None,
    ("node", "arguments"): lambda node, _: " ".join(map(shlex.quote, node.arguments)) or None,
    ("node", "host"): _read_host,
    ("node", "callback_groups."): _read_callback_groups,
    ("node", "parameters."): _read_parameters,
    ("node", "parameter_commands."): lambda node, _: {
        name: " ".join(words) for name, words in node.parameter_commands.items()
    },
    ("node", "start."): _find_start,
    ("node", "timing."): _find_untold_timing,
    ("host", "scheduling."): _read_core_orders,
    # A link has the keys below `latency` itself, a policy those below `forbid`.
    ("link", "latency."): lambda link, _: link,
    ("start", "after"): lambda start, context: unordered_values(_common_ids(start.after, context)),
    ("start", "by"): lambda start, context: next(iter(_common_ids((start.by,) if start.by else (), context)), None),
    ("policy", "forbid."): lambda policy, _: policy,
    ("policy", "accepted."): lambda policy, context: {
        str(context.common_id("input", name)): reason for name, reason in policy.accepted.items()
    },
    ("forbid", "from"): _make_selector_reader("forbid_from"),
    ("forbid", "to"): _make_selector_reader("forbid_to"),
    ("require", "of"): _make_selector_reader("of"),
    ("require", "inputs_from"): _make_selector_reader("inputs_from"),
    ("timing", "rate"): _read_rate,
    ("timing", "wcet."): _read_measured_times,
    ("timing", "trigger"): lambda timing, _: timing.trigger.mode if timing.trigger else None,
    ("timing", "trigger."): _read_trigger_facets,
    ("timing", "inputs."): lambda timing, context: {
        _name_port("input", port, context): said for port, said in timing.inputs.items()
    },
    ("timing", "outputs."): lambda timing, context: {
        _name_port("output", port, context): said for port, said in timing.outputs.items()
    },
    ("timing", "calls."): lambda timing, context: {
        last_part(context.matched_ids.common_id("input", port)): count for port, count in timing.calls.items()
    },
    ("timing", "uses."): _read_uses,
    # `core: 3` and `cores: [3]` mean the same.
    ("timing", "core"): lambda timing, _: (
        timing.cores[0] if timing.core is None and timing.cores and len(timing.cores) == 1 else timing.core
    ),
    ("timing", "cores"): lambda timing, _: timing.cores if timing.cores and len(timing.cores) > 1 else None,
    ("timing_input", "stored"): lambda input_timing, _: "at_once" if input_timing.stored_at_once else None,
    ("chain", "through"): lambda chain, context: tuple(
        context.matched_ids.common_id(point.kind, point.id) for point in chain.through
    ),
    ("chain", "deadline."): lambda chain, _: chain.deadline_shares,
    ("view", "show"): _make_selector_reader("show"),
    ("variant", "without"): _make_selector_reader("without"),
    ("variant", "changes"): lambda variant, context: frozenset(
        context.matched_ids.rename_in_text(f"{each.path}: {each.value}") for each in variant.changes
    ),
}
"""By kind and key."""
