"""What interfaces promise in the resolved record, their versions, and that they are going away."""

from __future__ import annotations

import math

from archgen.model.component import ComponentType, Output
from archgen.model.message_types import ConceptualType
from archgen.model.promise import Deprecation, Promise, describe_deprecation, format_range
from archgen.views.records.record_values import drop_unknown, record_quantity


def record_words(output: Output) -> dict[str, object]:
    """Return what is said of an output."""
    return {"promise": _record_promise(output.promise), **record_life(output)}


def record_life(holder: Output | ConceptualType | ComponentType) -> dict[str, object]:
    """Return the version of something, and until when it may be used."""
    return {"version": holder.version, "deprecated": _record_deprecation(holder.deprecated)}


def _record_promise(promise: Promise | None) -> dict[str, object] | None:
    if promise is None:
        return None
    return drop_unknown(
        {
            "rate": record_quantity(promise.rate, "Hz"),
            "max_gap": record_quantity(promise.max_gap, "ns"),
            "max_age": record_quantity(promise.max_age, "ns"),
            "unit": promise.unit,
            "frame": promise.frame,
            "range": _record_range(promise.range, promise.unit),
        }
    )


def _record_range(limits: tuple[float, float] | None, unit: str | None) -> dict[str, object] | None:
    if limits is None:
        return None
    # JSON has no infinity.
    least, greatest = (limit if math.isfinite(limit) else None for limit in limits)
    return drop_unknown({"text": format_range(limits, unit), "least": least, "greatest": greatest})


def _record_deprecation(deprecated: Deprecation | None) -> dict[str, object] | None:
    if deprecated is None:
        return None
    return drop_unknown(
        {
            "text": describe_deprecation(deprecated),
            "until": deprecated.until,
            "use": deprecated.use,
            "replacement": deprecated.target,
        }
    )
