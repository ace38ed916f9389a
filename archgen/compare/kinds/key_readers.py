"""What reads the keys for which the normal form of their type does not do: those of components and types first.

A key with keys below it is read off what its function returns, key by key.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.bringup.start_plan import resolve_conditions
from archgen.compare.kinds.key_spec import ReadContext, Reader
from archgen.compare.normal_values import (
    freeze_value,
    last_part,
    normalize_text,
    normalize_title,
    parameter_leaves,
    unordered_values,
)
from archgen.compare.version_pair import SOME_PORTS
from archgen.frozen import replace
from archgen.model.architecture import UseCase
from archgen.model.component import PATTERN_GROUP, Component, Input, Output
from archgen.model.declared_timing import Timing, list_fair_figures
from archgen.model.deployment import Host
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import ConceptualType, DataField
from archgen.model.node import Node, StartTarget, StartUp
from archgen.model.parameter import describe_types, format_parameter
from archgen.model.path_resolver import title_from_id
from archgen.model.promise import Deprecation, format_range
from archgen.model.quantity import Quantity
from archgen.model.requirement import Requirement
from archgen.model.use_case_steps import StepEnd
from archgen.timing.figures.figure_wording import format_rate


def read_requirements(component: Component, context: ReadContext) -> frozenset[str]:
    """Return the requirements that a component serves: ids, and what it writes in words."""
    return context.common_ids("requirement", [use.text for use in component.requirements])


def read_inputs(component: Component, _context: ReadContext) -> str | None:
    """Return whether there are inputs: these are elements of their own."""
    return _describe_ports(component.inputs, is_known=component.inputs_known)


def read_outputs(component: Component, _context: ReadContext) -> str | None:
    """Return whether there are outputs: these are elements of their own."""
    return _describe_ports(component.outputs, is_known=component.outputs_known)


def _describe_ports(ports: Mapping[str, object], *, is_known: bool) -> str | None:
    return SOME_PORTS if ports else "none" if is_known else None


def read_medium(port: Input | Output, _context: ReadContext) -> str | None:
    """Return the medium that a port says itself."""
    return port.medium if port.medium_written else None


def find_node_timing(component: Component, context: ReadContext) -> Timing | None:
    """Return a component's timing: that of its node if it has exactly one, else what it says itself."""
    component_nodes = context.nodes_by_component.get(component.id, [])
    has_one_node = (
        len(component_nodes) == 1
        and context.matched_ids.common_id("component", component.id) not in context.split_components
    )
    return component_nodes[0].timing.get(component.id) if has_one_node else component.timing


def read_parameters(component: Component, _context: ReadContext) -> Mapping[str, object]:
    """Return the declared parameters: each value by the parameter's name, what else is declared by `name:key`."""
    values: dict[str, object] = {}
    for name, parameter in component.parameters.items():
        # Without a value there is a parameter all the same.
        values[name] = _freeze_parameter(parameter.value)
        facets = {
            "type": parameter.type,
            "unit": parameter.unit,
            "range": parameter.range and " to ".join(map(format_parameter, parameter.range)),
            "choices": parameter.choices and ", ".join(map(format_parameter, parameter.choices)),
            "description": normalize_text(parameter.description),
            "read_only": parameter.read_only or None,
            "visibility": parameter.visibility,
            "from": parameter.handed_from,
            "hints": format_parameter(parameter.hints) if parameter.hints else None,
        }
        values |= {f"{name}:{key}": freeze_value(value) for key, value in facets.items() if value is not None}
    return values


def _freeze_parameter(value: object) -> object:
    """Return a value for comparing; a list as a whole, since sentences would tell its items apart."""
    if value is None:
        return "no value"
    return format_parameter(value) if isinstance(value, list) else freeze_value(value)


def read_operations(component: Component, _context: ReadContext) -> Mapping[str, object]:
    """Return the operations: whether there is one by its id, what is said of it by `id:key`."""
    values: dict[str, object] = {}
    for name, operation in component.operations.items():
        values[name] = "there"
        facets = {
            "title": None if operation.title in {title_from_id(name), name} else operation.title,
            "request": operation.request,
            "response": operation.response,
            "call": operation.call,
            "visibility": operation.visibility,
            "description": normalize_text(operation.description),
        }
        values |= {f"{name}:{key}": describe_types(value) for key, value in facets.items() if value is not None}
    return values


def is_mapped(component: Component, context: ReadContext) -> bool | None:
    """Whether a node that is written implements a component; None where none does."""
    return any(node.written for node in context.nodes_by_component.get(component.id, ())) or None


def name_common_type(type_text: str | None, context: ReadContext) -> str | None:
    """Return the name of a component type with common ids in it, `lib.filter<Pose>`; None for none."""
    return None if type_text is None else _name_with_common_ids(type_text.strip(), "component_type", context)


def _name_with_common_ids(text: str, kind: str, context: ReadContext) -> str:
    name, arguments = read_generic_name(text)
    bound_names = ", ".join(_name_with_common_ids(each, "type", context) for each in arguments)
    return f"{context.common_id(kind, name)}<{bound_names}>" if arguments else str(context.common_id(kind, name))


def read_component_type(component: Component, context: ReadContext) -> str | None:
    """Return the component type that a component is made from; one that is exactly it says so."""
    type_name = name_common_type(component.component_type, context)
    return f"exactly {type_name}" if component.is_reference else type_name


NO_DAY = "no day"
"""What is compared where something is deprecated and nobody has said until when."""


def find_output_deprecation(output: Output, context: ReadContext) -> Deprecation | None:
    """Return until when an output is there, and what replaces it."""
    found = _find_deprecation(output.deprecated, "output", context)
    if found is None or found.use is None or not found.target or found.target.rpartition(".")[0] != output.component:
        return found
    # As people write it: instances of a type say the same of their own outputs.
    return replace(found, use=found.use.rpartition(".")[2])


def _find_deprecation(written: Deprecation | None, kind: str, context: ReadContext) -> Deprecation | None:
    if written is None:
        return None
    use = context.common_id(kind, written.target) if written.target else written.use
    return replace(written, until=written.until or NO_DAY, use=use)


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
    ("component", "title"): lambda each, _: normalize_title(each.name, each.title),
    ("component", "is"): read_component_type,
    ("component", "requirements"): read_requirements,
    ("component", "performance."): lambda each, _: {f"{indicator.id}.": indicator for indicator in each.performance},
    ("component", "inputs"): read_inputs,
    ("component", "outputs"): read_outputs,
    ("component", "parameters."): read_parameters,
    ("component", "operations."): read_operations,
    ("component", "timing."): find_node_timing,
    ("component_type", "is"): lambda each, context: name_common_type(each.base, context),
    ("component_type", "deprecated."): lambda each, context: _find_deprecation(
        each.deprecated, "component_type", context
    ),
    ("input", "medium"): read_medium,
    ("output", "medium"): read_medium,
    ("output", "deprecated."): find_output_deprecation,
    ("type", "fields."): _read_fields,
    ("type", "deprecated."): lambda each, context: _find_deprecation(each.deprecated, "type", context),
    ("frame", "by"): lambda frame, context: context.common_id(frame.by_kind, frame.by),
    ("promise", "range"): lambda promise, _: format_range(promise.range) if promise.range else None,
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
