"""The functional level: groups, components, their ports, and the connections between these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.compare.compared_elements import MAPPED_KEY, SOME_PORTS
from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations, ports_of
from archgen.compare.kinds.frame_kind import frame_reference
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext, Worsening
from archgen.compare.kinds.promise_keys import OUTPUT_KEYS, read_port_words
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    CO_OWNERS,
    DESCRIPTION,
    LAYOUT,
    NAME_FEATURES,
    OWNER,
    TAGS,
    TIMING_KEYS,
    TITLE,
    URLS,
    key_values,
    mark_values,
    prose_key,
    read_owner,
    requirements_key,
    text_feature,
    timing_key,
)
from archgen.compare.normal_values import freeze_value, normalize_text, normalize_title, unordered_values
from archgen.model.component import Component, Input, Output
from archgen.model.generic_names import read_generic_name
from archgen.model.parameter import format_parameter
from archgen.model.path_resolver import title_from_id

GROUP = KindSpec(
    "group",
    None,
    (
        TITLE,
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        TAGS,
        LAYOUT,
        URLS,
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.groups,
    features=(
        *NAME_FEATURES,
        # The names of its components outweigh all else: a group is what it holds.
        FeatureSpec("components", 8, lambda _, group: frozenset(group.components), is_decisive=True),
        text_feature(2, "description"),
        FeatureSpec("owner", 0.5, lambda relations, group: relations.common_ids("partner", [group.owner])),
    ),
    owner=read_owner,
)


def _describe_ports(*, is_known: bool, ports: Mapping[str, object]) -> str | None:
    """Return whether there are ports: these are elements of their own."""
    return SOME_PORTS if ports else "none" if is_known else None


def _read_performance(component: Component, _context: ReadContext) -> Mapping[str, object]:
    return {
        f"{performance.id}.{key}": value
        for performance in component.performance
        for key, value in (
            ("title", normalize_title(performance.id, performance.title)),
            ("accuracy", performance.accuracy),
            ("execution_time", performance.execution_time),
        )
    }


def _read_timing(component: Component, context: ReadContext) -> Mapping[str, object]:
    """Return a component's timing: that of its node if it has exactly one, else what it says itself."""
    component_nodes = context.nodes_by_component.get(component.id, [])
    has_one_node = (
        len(component_nodes) == 1
        and context.matched_ids.common_id("component", component.id) not in context.split_components
    )
    timing = component_nodes[0].timing.get(component.id) if has_one_node else component.timing
    return key_values(TIMING_KEYS, timing, context) if timing else {}


def _read_parameters(component: Component, _context: ReadContext) -> Mapping[str, object]:
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


def _read_operations(component: Component, _context: ReadContext) -> Mapping[str, object]:
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
        values |= {f"{name}:{key}": _describe_types(value) for key, value in facets.items() if value is not None}
    return values


def _describe_types(value: str | Mapping[str, str]) -> str:
    return value if isinstance(value, str) else ", ".join(f"{name}: {type_name}" for name, type_name in value.items())


def _is_mapped(component: Component, context: ReadContext) -> bool | None:
    return any(node.written for node in context.nodes_by_component.get(component.id, ())) or None


def _mark_ports(_relations: ElementRelations, component: Component) -> frozenset[str]:
    # The direction is part of the mark, so that an input and an output of one name are not alike.
    ports = [f"> {port.name}" for port in component.inputs.values()]
    ports += [f"{port.name} >" for port in component.outputs.values()]
    return mark_values(*ports, *(port.type for port in ports_of(component)))


def _mark_neighbours(relations: ElementRelations, component: Component) -> frozenset[str]:
    sources = [source for port in component.inputs.values() for source in relations.outputs_by_input[port.id]]
    readers = [reader for port in component.outputs.values() for reader in relations.readers_by_output[port.id]]
    return relations.common_ids("component", _components_of([*sources, *readers]))


def _names_of(component_ids: Sequence[str]) -> list[str]:
    return [component_id.rpartition(".")[2] for component_id in component_ids]


def _components_of(ports: Sequence[str]) -> list[str]:
    return [port.rpartition(".")[0] for port in ports]


def _mark_performance(_relations: ElementRelations, component: Component) -> frozenset[str]:
    return mark_values(
        *(
            f"{performance.id} {performance.accuracy} {performance.execution_time}"
            for performance in component.performance
        )
    )


def _mark_timing(_relations: ElementRelations, component: Component) -> frozenset[str]:
    timing = component.timing
    return mark_values(timing.behaviour, timing.rate, timing.wcet) if timing else frozenset()


def name_common_type(type_text: str | None, context: ReadContext) -> str | None:
    """Return the name of a component type with common ids in it, `lib.filter<Pose>`; None for none."""
    return None if type_text is None else _name_with_common_ids(type_text.strip(), "component_type", context)


def _name_with_common_ids(text: str, kind: str, context: ReadContext) -> str:
    name, arguments = read_generic_name(text)
    bound_names = ", ".join(_name_with_common_ids(each, "type", context) for each in arguments)
    return f"{context.common_id(kind, name)}<{bound_names}>" if arguments else str(context.common_id(kind, name))


def _read_component_type(component: Component, context: ReadContext) -> str | None:
    """Return the component type that a component is made from; one that is exactly it says so."""
    type_name = name_common_type(component.component_type, context)
    return f"exactly {type_name}" if component.is_reference else type_name


def _read_claimed_timing(shell: Component, context: ReadContext) -> Mapping[str, object]:
    """Return what a composed component says of the timing of the whole."""
    return key_values(TIMING_KEYS, shell.timing, context) if shell.timing else {}


_SETTING_KEYS = (
    KeySpec("parameters.", _read_parameters, Effect.SYSTEM),
    KeySpec("open", lambda component, _: unordered_values(component.open), Effect.SYSTEM, noun="open sets"),
    KeySpec("operations.", _read_operations, Effect.SYSTEM),
)
_PLAIN_KEYS = (
    KeySpec("status", effect=Effect.SYSTEM, verb="is"),
    KeySpec("contact", effect=Effect.TEXT),
    KeySpec("image", effect=Effect.TEXT, noun="picture"),
)
_PERFORMANCE = KeySpec("performance.", _read_performance, Effect.SYSTEM)
_IS = KeySpec("is", _read_component_type, Effect.SYSTEM, verb="is made from", noun="component type")
COMPOSED = KindSpec(
    "composed",
    None,
    (
        KeySpec("title", lambda shell, _: normalize_title(shell.name, shell.title), Effect.TEXT),
        prose_key("functionality"),
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        _IS,
        requirements_key(lambda shell: tuple(use.text for use in shell.requirements)),
        TAGS,
        LAYOUT,
        *_SETTING_KEYS,
        URLS,
        *_PLAIN_KEYS,
        _PERFORMANCE,
        timing_key(_read_claimed_timing),
        KeySpec("outputs.", read_port_words, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
    Effect.SYSTEM,
    elements=lambda version: version.architecture.shells,
    features=(
        FeatureSpec("name", 2, lambda _, shell: letter_pairs(shell.name)),
        FeatureSpec(
            "title",
            2,
            lambda _, shell: word_set(shell.title),
            lambda shell: shell.title in {title_from_id(shell.name), shell.name},
        ),
        # What it holds and gives on. Instances of one type are alike in this: of these the name decides.
        FeatureSpec("components", 6, lambda _, shell: frozenset(_names_of(shell.children))),
        FeatureSpec("ports", 2, _mark_ports),
        text_feature(3, "functionality", "description"),
    ),
    word="composed component",
    has_path_id=True,
    parent_kind="group",
    parent=lambda shell, context: ("group", context.matched_ids.common_id("group", shell.group)),
    owner=read_owner,
)
COMPONENT = KindSpec(
    "component",
    None,
    (
        KeySpec("title", lambda component, _: normalize_title(component.name, component.title), Effect.TEXT),
        prose_key("functionality"),
        DESCRIPTION,
        OWNER,
        CO_OWNERS,
        KeySpec("role", effect=Effect.SYSTEM, verb="is a"),
        _IS,
        requirements_key(lambda component: tuple(use.text for use in component.requirements)),
        TAGS,
        LAYOUT,
        KeySpec("inputs", lambda each, _: _describe_ports(is_known=each.inputs_known, ports=each.inputs)),
        KeySpec("outputs", lambda each, _: _describe_ports(is_known=each.outputs_known, ports=each.outputs)),
        *_SETTING_KEYS,
        URLS,
        *_PLAIN_KEYS,
        _PERFORMANCE,
        timing_key(_read_timing),
        KeySpec(MAPPED_KEY, _is_mapped, Effect.SYSTEM),
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.components,
    features=(
        FeatureSpec("name", 2, lambda _, component: letter_pairs(component.name)),
        FeatureSpec(
            "title",
            2,
            lambda _, component: word_set(component.title),
            lambda component: component.title in {title_from_id(component.name), component.name},
        ),
        FeatureSpec("ports", 4, _mark_ports),
        text_feature(3, "functionality", "description"),
        FeatureSpec("near", 3, _mark_neighbours),
        FeatureSpec(
            "nodes",
            3,
            lambda relations, component: relations.common_ids(
                "node", relations.nodes_by_place[f"component:{component.id}"]
            ),
        ),
        FeatureSpec("group", 0.5, lambda relations, component: relations.common_ids("group", [component.group])),
        FeatureSpec("owner", 0.5, lambda relations, component: relations.common_ids("partner", [component.owner])),
        FeatureSpec("requirements", 1, lambda _, component: mark_values(*(use.text for use in component.requirements))),
        FeatureSpec("performance", 1, _mark_performance),
        FeatureSpec("timing", 1, _mark_timing),
        FeatureSpec("tags", 0.5, lambda _, component: frozenset(component.tags)),
    ),
    has_path_id=True,
    parent_kind="group",
    parent=lambda component, context: ("group", context.matched_ids.common_id("group", component.group)),
    owner=read_owner,
    components=lambda component, context: (context.matched_ids.common_id("component", component.id),),
)


def _port_owner(port: Input | Output, context: ReadContext) -> str | None:
    return context.common_id("partner", context.architecture.components[port.component].owner)


def _port_parent(port: Input | Output, context: ReadContext) -> tuple[str, str]:
    return ("component", context.matched_ids.common_id("component", port.component))


_PORT_KEYS = (
    KeySpec("medium", lambda port, _: port.medium if port.medium_written else None),
    prose_key("external"),
    DESCRIPTION,
    URLS,
)
_PORT_FEATURES = (
    FeatureSpec("name", 2, lambda _, port: letter_pairs(port.name)),
    FeatureSpec("type", 4, lambda _, port: mark_values(port.type)),
    FeatureSpec("topics", 3, lambda relations, port: frozenset(relations.topics_by_port[port.id])),
    text_feature(1, "description", "external"),
)
OUTPUT = KindSpec(
    "output",
    None,
    (
        KeySpec("type", lambda port, context: context.common_id("type", port.type), refers_to="type", verb="carries"),
        *_PORT_KEYS,
        frame_reference("is given in"),
        *OUTPUT_KEYS,
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.outputs,
    features=(
        *_PORT_FEATURES,
        FeatureSpec(
            "readers",
            5,
            lambda relations, port: relations.common_ids(
                "component", _components_of(relations.readers_by_output[port.id])
            ),
        ),
    ),
    has_path_id=True,
    parent_kind="component",
    stays_in_parent=True,
    parent=_port_parent,
    owner=_port_owner,
    components=lambda port, context: (_port_parent(port, context)[1],),
)
INPUT = KindSpec(
    "input",
    None,
    (
        KeySpec("type", lambda port, context: context.common_id("type", port.type), refers_to="type", verb="expects"),
        *_PORT_KEYS,
        KeySpec("optional", lambda port, _: port.optional or None, Effect.SYSTEM),
        KeySpec("freshness", worsening=Worsening.LESS, verb="must be no older than"),
        frame_reference("is expected in"),
        *ANNOTATIONS,
    ),
    elements=lambda version: version.architecture.inputs,
    features=(
        *_PORT_FEATURES,
        FeatureSpec(
            "sources",
            5,
            lambda relations, port: relations.common_ids("output", relations.outputs_by_input[port.id]),
        ),
    ),
    has_path_id=True,
    parent_kind="component",
    stays_in_parent=True,
    parent=_port_parent,
    owner=_port_owner,
    components=lambda port, context: (_port_parent(port, context)[1],),
)
# Which outputs an input reads: compared by `connection_maps`, since it has no keys.
CONNECTION = KindSpec("connection", None)
FUNCTIONAL_KINDS = (GROUP, COMPOSED, COMPONENT, OUTPUT, INPUT, CONNECTION)
