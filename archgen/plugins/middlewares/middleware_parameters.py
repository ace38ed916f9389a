"""What of a component can be set at run time: rule R4. Each middleware holds other values, and what it does not is told."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import GenerationContext, find_text_fault, tell_left_out
from archgen.plugin.model import Component
from archgen.plugins.middlewares.middleware_names import drop_clashes, name_member
from archgen.plugins.middlewares.simulated_parameters import record_simulated_parameters

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
