"""What of a class of components can be set: types, ranges, choices, and the values of each instance.

For a simulation, and by rule R4 for middlewares at run time: each of these holds other values, and what it does not is told.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.findings import Diagnostic, Span, first_written_span
from archgen.plugin.generating import (
    GenerationContext,
    SetParameter,
    convert_ros_value,
    find_name_clashes,
    find_text_fault,
    infer_ros_type,
    list_set_parameters,
    make_identifier_in,
    make_snake_name,
    tell_left_out,
    to_plain,
    write_place,
)
from archgen.plugin.model import Component
from archgen.plugins.middlewares.middleware_names import drop_clashes, name_member
from archgen.plugins.middlewares.simulated_types import name_java_field

_PLAYER_WORDS = frozenset(("alwayson", "name", "period", "plugin", "provides", "requires"))
_PLAYER_TEXT = 900
"""Player reads a word of its configuration into 1,024 bytes, and does not look where they end."""


def record_middleware_parameters(
    context: GenerationContext, components: Sequence[Component]
) -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """Return the public parameters of a class with their `values` by component, and what is left out of them."""
    recorded, findings = record_simulated_parameters(context, components)
    first = components[0]
    span = first.at
    public = [each for each in recorded if each["visibility"] in {None, "public"}]
    clashing, clashes = drop_clashes(
        [(name_member(str(each["name"])), f"{first.id} {each['name']}", span) for each in public], "parameter"
    )
    findings += clashes
    records: list[dict[str, Any]] = []
    for each in public:
        if f"{first.id} {each['name']}" in clashing:
            continue
        values: Mapping[str, Any] = dict(each["values"]) if isinstance(each["values"], Mapping) else {}
        written: dict[str, Any] = {}
        for component_id, value in values.items():
            fault = next(_find_faults(value, context.backend), None)
            if fault is None:
                written[component_id] = value
            else:
                findings.append(
                    tell_left_out(
                        f"the value of `{each['name']}` of `{component_id}` is left out: it {fault}",
                        span,
                        element=component_id,
                    )
                )
        base = str(each["type"]).removesuffix("_array")
        records.append(
            {
                **each,
                "key": name_member(str(each["name"])),
                "wire": _name_option(name_member(str(each["name"]))),
                "type": base,
                "values": written,
                "default": next(iter(written.values()), None),
                "is_small": all(
                    -(2**31) <= value < 2**31 for value in _flatten(values.values()) if isinstance(value, int)
                ),
            }
        )
    return records, findings


def _name_option(name: str) -> str:
    """Return a name as a section of Player's configuration can have it beside the server's own words."""
    return f"{name}_" if name in _PLAYER_WORDS or name.endswith("_sources") else name


def _flatten(values: Iterable[object]) -> Iterator[object]:
    for each in values:
        if isinstance(each, list | tuple):
            yield from each
        else:
            yield each


def _find_faults(value: object, backend: str) -> Iterator[str]:
    """Yield why the configuration of a backend cannot hold a value."""
    for each in _flatten([value]):
        if isinstance(each, str):
            fault = find_text_fault(each)
            if fault:
                yield fault[0]
            if backend in _FAULTS:
                yield from _FAULTS[backend](each, isinstance(value, list))


def _find_player_fault(text: str, is_listed: bool) -> Iterator[str]:  # noqa: ARG001, FBT001 - as the other
    if '"' in text:
        yield "has a double quote, which ends a text of Player"
    if len(text.encode()) > _PLAYER_TEXT:
        yield f"has more than {_PLAYER_TEXT} bytes, which Player does not read"


def _find_openrtm_fault(text: str, is_listed: bool) -> Iterator[str]:  # noqa: FBT001
    if is_listed and ("," in text or text != text.strip() or not text):
        yield "is a list of texts with commas, blanks at their ends or nothing in them, which OpenRTM-aist cannot tell apart"
    if text != text.strip() or text.endswith("\\"):
        yield "has blanks at its ends, or ends in a backslash, which OpenRTM-aist takes away"


_FAULTS: Mapping[str, Callable[[str, bool], Iterator[str]]] = {
    "player": _find_player_fault,
    "openrtm": _find_openrtm_fault,
}


_KINDS = {
    "bool": ("boolean", "Boolean"),
    "integer": ("long", "Long"),
    "double": ("double", "Double"),
    "string": ("String",) * 2,
}
_DECLARED_TYPES = {"boolean": "bool", "integer": "integer", "float": "double", "string": "string"}
_MOST_WHOLE = 2**63


def record_simulated_parameters(
    context: GenerationContext, components: Sequence[Component]
) -> tuple[list[dict[str, object]], list[Diagnostic]]:
    """Return the parameters that any of the components has, with their `values` by component, and what is left out."""
    given: dict[str, dict[str, SetParameter]] = {}
    for component in components:
        node = context.nodes_by_component.get(component.id)
        for each in list_set_parameters(context.architecture, component, node):
            given.setdefault(".".join(each.path), {})[component.id] = each
    findings: list[Diagnostic] = []
    for namer in (name_java_field, _name_python_parameter):
        first = components[0]
        names = [(namer(name), f"{first.id} {name}", _find_span(each.values(), first)) for name, each in given.items()]
        for clash in find_name_clashes(names, "parameter"):
            findings.append(clash)
            del given[(clash.element or "").partition(" ")[2]]
    records: list[dict[str, object]] = []
    for name, by_component in given.items():
        record = _record_parameter(name, by_component, components)
        if record is None:
            findings.append(
                tell_left_out(
                    f"the parameter `{name}` of `{components[0].id}` is left out: it is no boolean, number of 64 bits, text, "
                    "or list of one of these",
                    _find_span(by_component.values(), components[0]),
                    element=components[0].id,
                    help_line="make a set of parameters of it, or text",
                )
            )
        else:
            records.append(record)
    return records, findings


def _name_python_parameter(name: str) -> str:
    return make_identifier_in("python", make_snake_name(name))


def _find_span(parameters: Iterable[SetParameter], component: Component) -> Span:
    spans = (each.declaration.at if each.declaration else each.at for each in parameters)
    return first_written_span(*spans, component.at)


def _record_parameter(
    name: str, by_component: dict[str, SetParameter], components: Sequence[Component]
) -> dict[str, object] | None:
    values = {component: to_plain(each.value) for component, each in by_component.items() if each.value is not None}
    first = next(iter(by_component.values()))
    declaration = first.declaration
    ros_type = _find_type(
        [each.declaration.type for each in by_component.values() if each.declaration], values.values()
    )
    if ros_type is None:
        return None
    base = ros_type.removesuffix("_array")
    converted = {component: convert_ros_value(value, ros_type) for component, value in values.items()}
    limits = [float(each) for each in (declaration.range if declaration else None) or ()]
    choices = [convert_ros_value(to_plain(each), base) for each in (declaration.choices if declaration else None) or ()]
    java, boxed = _KINDS[base]
    is_list = ros_type != base
    is_optional = len(values) < len(components)
    java_type = f"List<{boxed}>" if is_list else java
    return {
        "name": name,
        "java_name": name_java_field(name),
        "python_name": _name_python_parameter(name),
        "java": f"Optional<{java_type if is_list else boxed}>" if is_optional else java_type,
        "type": ros_type,
        "visibility": declaration.visibility if declaration else None,
        "read_only": declaration.read_only if declaration else False,
        "is_optional": is_optional,
        "is_list": is_list,
        "lowest": limits[0] if limits and base in {"integer", "double"} else None,
        "highest": limits[-1] if limits and base in {"integer", "double"} else None,
        "choices": choices,
        "unit": (declaration.unit if declaration else None) or "",
        "description": (declaration.description if declaration else None) or "",
        "place": write_place(_find_span(by_component.values(), components[0])),
        "values": converted,
    }


def _find_type(declared: Iterable[str | None], values: Iterable[object]) -> str | None:
    """Return the type, in the words of ROS; None for what is none of them."""
    for written in declared:
        if written:
            base = _DECLARED_TYPES.get(written.removesuffix("[]"))
            found = f"{base}_array" if base and written.endswith("[]") else base
            return found if all(_fits_type(each, found) for each in values) else None
    found_types = {infer_ros_type(each) for each in values}
    for suffix in ("", "_array"):
        if found_types == {f"integer{suffix}", f"double{suffix}"}:
            found_types = {f"double{suffix}"}
    found = min(found_types) if len(found_types) == 1 else None if found_types else "string"
    return found if found and all(_fits_type(each, found) for each in values) else None


def _fits_type(value: object, ros_type: str | None) -> bool:
    """Whether Java has the value as a value of the type."""
    if ros_type is None:
        return False
    if ros_type.endswith("_array"):
        return isinstance(value, list | tuple) and all(
            _fits_type(each, ros_type.removesuffix("_array")) for each in value
        )
    if ros_type in {"string", "bool"} or isinstance(value, bool):
        return isinstance(value, str if ros_type == "string" else bool) and ros_type in {"string", "bool"}
    is_small = isinstance(value, int | float) and -_MOST_WHOLE <= value < _MOST_WHOLE
    if isinstance(value, float):
        return ros_type == "double" or (is_small and value.is_integer())
    return is_small
