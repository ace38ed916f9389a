"""Keys and features that several kinds of elements have in the same form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, ReadContext, Worsening
from archgen.compare.normal_values import (
    freeze_value,
    list_data_leaves,
    normalize_text,
    normalize_title,
    unordered_values,
)
from archgen.model.declared_timing import Timing
from archgen.model.parameter import format_parameter
from archgen.model.path_resolver import title_from_id
from archgen.model.quantity import Quantity
from archgen.timing.figures.figure_wording import format_rate

_NS_PER_SECOND = 10**9

TITLE = KeySpec("title", lambda element, _: normalize_title(element.id, element.title), Effect.TEXT)
LAYOUT = KeySpec("layout", lambda element, _: element.layout.direction, Effect.TEXT)
TAGS = KeySpec(
    "tags",
    lambda element, _: unordered_values(element.tags),
    Effect.TEXT,
    list_verbs=("now has the tag", "no longer has the tag"),
)
URLS = KeySpec("urls.", lambda element, _: element.urls, Effect.TEXT)


def _read_hints(element: Any, _context: ReadContext) -> Mapping[str, object]:  # noqa: ANN401 - any element
    """Return the leaves of the hints by their path, which begins with the program that they are for; lists as a whole."""
    return {
        path: format_parameter(data) if isinstance(data, list) else freeze_value(data)
        for program, hints in element.annotations.hints.items()
        for path, data in list_data_leaves(program, hints)
    }


ANNOTATIONS = (
    KeySpec("properties.", lambda element, _: element.annotations.properties, Effect.SYSTEM),
    KeySpec("hints.", _read_hints, Effect.SYSTEM),
)
"""What any element may say beside its own keys."""


def read_owner(element: Any, context: ReadContext) -> str | None:  # noqa: ANN401 - groups, components and nodes
    """Return the common id of the partner who owns an element."""
    return context.common_id("partner", element.owner)


OWNER = KeySpec(
    "owner",
    read_owner,
    Effect.SYSTEM,
    refers_to="partner",
    verb="belongs to",
)
CO_OWNERS = KeySpec(
    "co_owners",
    lambda element, context: context.common_ids("partner", element.co_owners),
    Effect.SYSTEM,
    refers_to="partner",
    noun="further owners",
)


def prose_key(name: str) -> KeySpec:
    """Return the key of a text."""
    return KeySpec(name, lambda element, _: normalize_text(getattr(element, name)), effect=Effect.TEXT, is_prose=True)


DESCRIPTION = prose_key("description")


def requirements_key(read_ids: Callable[[Any], tuple[str, ...]]) -> KeySpec:
    """Return the key of the requirements that an element serves."""
    return KeySpec(
        "requirements",
        lambda element, context: context.common_ids("requirement", read_ids(element)),
        Effect.SYSTEM,
        refers_to="requirement",
        list_verbs=("now serves", "no longer serves"),
    )


def _read_rate(timing: Timing, _context: ReadContext) -> Quantity | None:
    """Return the rate; a period as the rate that it amounts to."""
    if timing.period is None or not timing.period.value:
        return timing.rate
    # Periods are in ns. `period: 100 ms` and `rate: 10 Hz` mean the same and must compare equal.
    rate = Fraction(_NS_PER_SECOND) / timing.period.value
    return Quantity(rate, format_rate(rate))


def _read_output_timing(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    return {
        f"{last_part(context.matched_ids.common_id('output', port))}.{key}": value
        for port, output_timing in timing.outputs.items()
        for key, value in (
            ("conditional", output_timing.conditional or None),
            ("max_gap", output_timing.max_gap),
        )
    }


def _read_calls(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    return {last_part(context.matched_ids.common_id("input", port)): count for port, count in timing.calls.items()}


def _read_input_timing(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    return {
        f"{last_part(context.matched_ids.common_id('input', port))}.{key}": value
        for port, input_timing in timing.inputs.items()
        for key, value in (
            ("wcet", input_timing.wcet),
            ("bcet", input_timing.bcet),
            ("stored", "at_once" if input_timing.stored_at_once else None),
        )
    }


def _read_uses(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    values: dict[str, object] = {}
    for name, resource_time in timing.uses.items():
        resource = context.matched_ids.common_id("resource", name)
        values |= {resource: resource_time.max, f"{resource}.min": resource_time.min}
    return values


def _read_measured_times(timing: Timing, _context: ReadContext) -> Mapping[str, object]:
    times = timing.measured_times
    return {**times.percentiles, "measured": times.is_measured or None} if times else {}


def _read_core(timing: Timing, _context: ReadContext) -> int | None:
    """Return the only core: `core: 3` and `cores: [3]` mean the same."""
    return timing.cores[0] if timing.core is None and timing.cores and len(timing.cores) == 1 else timing.core


def last_part(path: str, part_count: int = 1) -> str:
    """Return the last parts of a path."""
    return ".".join(path.split(".")[-part_count:])


TIMING_KEYS = (
    KeySpec("behaviour", worsening=Worsening.ALWAYS),
    KeySpec("rate", _read_rate, worsening=Worsening.ALWAYS, noun="rate"),
    KeySpec("jitter", worsening=Worsening.MORE),
    KeySpec("wcet", worsening=Worsening.MORE, noun="worst case execution time"),
    KeySpec("wcet.", _read_measured_times, Effect.SYSTEM),
    KeySpec("bcet", worsening=Worsening.MORE, noun="best case execution time"),
    KeySpec("every", worsening=Worsening.LESS),
    KeySpec("throttle", worsening=Worsening.LESS),
    KeySpec(
        "dropped",
        lambda timing, _: None if timing.dropped == "kept" else timing.dropped,
        worsening=Worsening.ALWAYS,
        noun="what becomes of dropped messages",
    ),
    KeySpec("priority", worsening=Worsening.ALWAYS),
    # A more urgent one is served sooner, and others later.
    KeySpec("deadline", worsening=Worsening.ALWAYS),
    KeySpec("core", _read_core, worsening=Worsening.ALWAYS),
    # Another set may be busier, even where it is larger.
    KeySpec(
        "cores",
        lambda timing, _: timing.cores if timing.cores and len(timing.cores) > 1 else None,
        worsening=Worsening.ALWAYS,
    ),
    KeySpec("response", worsening=Worsening.MORE, noun="stated response time"),
    KeySpec("trigger", lambda timing, _: timing.trigger and timing.trigger.mode, worsening=Worsening.ALWAYS),
    KeySpec(
        "trigger.inputs",
        lambda timing, context: context.common_ids("input", (timing.trigger and timing.trigger.inputs) or ()),
        worsening=Worsening.ALWAYS,
    ),
    KeySpec("trigger.within", lambda timing, _: timing.trigger and timing.trigger.within, worsening=Worsening.ALWAYS),
    KeySpec("inputs.", _read_input_timing, worsening=Worsening.MORE),
    KeySpec("uses.", _read_uses, worsening=Worsening.MORE),
    KeySpec("outputs.", _read_output_timing, worsening=Worsening.ALWAYS),
    KeySpec("calls.", _read_calls, worsening=Worsening.ALWAYS),
)


def timing_key(read_timing: Callable[[Any, ReadContext], Mapping[str, object]]) -> KeySpec:
    """Return the key of what an element says of timing."""
    return KeySpec("timing.", read_timing, worsening=Worsening.ALWAYS, inner=TIMING_KEYS)


def key_values(keys: tuple[KeySpec, ...], element: object, context: ReadContext) -> dict[str, object]:
    """Return the values of all keys of an element by name."""
    values: dict[str, object] = {}
    for key in keys:
        value = key.value_of(element, context)
        if not key.name.endswith("."):
            values[key.name] = value
        elif value:
            # Such a key reads a mapping, whatever its element; of most elements it is empty.
            values.update({f"{key.name}{name}": inner for name, inner in value.items()})  # type: ignore[attr-defined]
    return values


def mark_values(*values: object) -> frozenset[str]:
    """Return the values that are known as marks of a feature."""
    return frozenset(str(value) for value in values if value not in {None, ""})


NAME_FEATURES = (
    FeatureSpec("name", 2, lambda _, element: letter_pairs(element.id)),
    FeatureSpec(
        "title",
        2,
        lambda _, element: word_set(element.title),
        lambda element: element.title in {title_from_id(element.id), element.id},
    ),
)


def text_feature(weight: float, *names: str) -> FeatureSpec:
    """Return the feature of the words of some texts."""
    return FeatureSpec(
        "text",
        weight,
        lambda _, element: frozenset[str]().union(*(word_set(getattr(element, name)) for name in names)),
    )
