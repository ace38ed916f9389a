"""The timers of a generated program: what runs by the clock."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.plugin.generating import make_snake_name
from archgen.plugin.model import Node

_NANOSECONDS = 10**9


def list_timers(node: Node) -> Iterator[dict[str, object]]:
    """Yield what runs by the clock: a timer for each component of the node that is periodic."""
    for component, timing in node.timing.items():
        period = timing.period.value if timing.period else None
        if period is None and timing.rate and timing.rate.value:
            period = Fraction(_NANOSECONDS) / timing.rate.value
        if period and timing.behaviour in {None, "periodic"}:
            name = "" if len(node.timing) == 1 else make_snake_name(component.rpartition(".")[2])
            yield {"key": name, "component": component, "period_ns": round(period), "period_s": _format_seconds(period)}


def _format_seconds(duration_ns: Fraction) -> str:
    """Return a duration in seconds as code has it: `0.1`."""
    return f"{float(duration_ns) / _NANOSECONDS:.9f}".rstrip("0").removesuffix(".") + (
        "" if duration_ns % _NANOSECONDS else ".0"
    )
