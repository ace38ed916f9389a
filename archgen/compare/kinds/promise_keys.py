"""What interfaces promise, their versions, and that they are going away."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from archgen.compare.kinds.kind_spec import Effect, KeySpec, ReadContext
from archgen.model.architecture import Architecture
from archgen.model.component import Component, ComponentType, Output
from archgen.model.message_types import ConceptualType
from archgen.model.promise import format_range

NO_DAY = "no day"
"""What is compared where something is deprecated and nobody has said until when."""


def _read_promise(output: Output, context: ReadContext) -> Mapping[str, object]:
    promise = output.promise
    if promise is None:
        return {}
    return {
        "rate": promise.rate,
        "max_gap": promise.max_gap,
        "max_age": promise.max_age,
        "unit": promise.unit,
        "frame": context.common_id("frame", promise.frame),
        "range": format_range(promise.range) if promise.range else None,
    }


def _read_deprecation(
    holder: Output | ConceptualType | ComponentType,
    kind: Literal["output", "type", "component_type"],
    context: ReadContext,
) -> Mapping[str, object]:
    deprecated = holder.deprecated
    if deprecated is None:
        return {}
    use = deprecated.use
    if deprecated.target:
        use = context.common_id(kind, deprecated.target)
        # As people write it: instances of a type say the same of their own outputs.
        if kind == "output" and isinstance(holder, Output) and deprecated.target.rpartition(".")[0] == holder.component:
            use = (use or "").rpartition(".")[2]
    return {"until": deprecated.until or NO_DAY, "use": use}


VERSION = KeySpec("version", effect=Effect.SYSTEM)
PROMISE = KeySpec(
    "promise.",
    _read_promise,
    Effect.SYSTEM,
    inner=(
        KeySpec("rate", effect=Effect.SYSTEM, noun="promised rate"),
        KeySpec("max_gap", effect=Effect.SYSTEM, noun="promised largest gap"),
        KeySpec("max_age", effect=Effect.SYSTEM, noun="promised greatest age"),
        KeySpec("unit", effect=Effect.SYSTEM, noun="promised unit"),
        KeySpec("frame", effect=Effect.SYSTEM, refers_to="frame", noun="promised frame"),
        KeySpec("range", effect=Effect.SYSTEM, noun="promised range"),
    ),
)
_DEPRECATION_KEYS = (
    KeySpec("until", effect=Effect.SYSTEM, noun="last day"),
    KeySpec("use", effect=Effect.SYSTEM, noun="replacement"),
)


def deprecation_key(kind: Literal["output", "type", "component_type"]) -> KeySpec:
    """Return the key of until when an element of a kind may be used, and of what replaces it."""
    return KeySpec(
        "deprecated.",
        lambda holder, context: _read_deprecation(holder, kind, context),
        Effect.SYSTEM,
        inner=_DEPRECATION_KEYS,
    )


OUTPUT_KEYS = (PROMISE, VERSION, deprecation_key("output"))


def read_own_output_words(shell: Component, context: ReadContext) -> Mapping[str, object]:
    """Return what a composed component says itself of its outputs, by `output:key`; what it passes on is told there."""
    return {
        f"{output.name}:{key}": value
        for output in shell.outputs.values()
        if output.promise or output.version or output.deprecated
        for key, value in _read_own_words(output, context).items()
    }


def _read_own_words(output: Output, context: ReadContext) -> Mapping[str, object]:
    given = _find_given(context.architecture, output)
    given_words = read_words(given, context) if given else {}
    return {key: value for key, value in read_words(output, context).items() if given_words.get(key) != value}


def read_words(output: Output, context: ReadContext) -> dict[str, object]:
    """Return all that is said of an output, by the keys of its kind."""
    words: dict[str, object] = {"version": output.version}
    words |= {f"promise.{key}": value for key, value in _read_promise(output, context).items()}
    words |= {f"deprecated.{key}": value for key, value in _read_deprecation(output, "output", context).items()}
    return {key: value for key, value in words.items() if value is not None}


def _find_given(architecture: Architecture, output: Output) -> Output | None:
    """Return the one output that an output of a composed component passes on, None for none and for several."""
    targets = architecture.shell_ports.get(f"output {output.id}", ())
    component = architecture.find_component(targets[0].rpartition(".")[0]) if len(targets) == 1 else None
    return component.outputs.get(targets[0].rpartition(".")[2]) if component else None
