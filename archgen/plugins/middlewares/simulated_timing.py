"""When the components of a simulation are active: by the clock, by what arrives, once, or never by themselves."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from archgen.plugin.findings import Diagnostic, first_written_span
from archgen.plugin.generating import GenerationContext, tell_left_out
from archgen.plugin.model import Component, Timing

_NANOSECONDS = 10**9


def find_timing(context: GenerationContext, component: Component) -> Timing:
    """Return the timing of a component: what its node says of it, else its own."""
    node = context.nodes_by_component.get(component.id)
    return (node.timing.get(component.id) if node else None) or component.timing or Timing()


def find_period(timing: Timing) -> Fraction | None:
    """Return the written period in ns, which may follow from the rate; None where there is none."""
    period = timing.period.value if timing.period else None
    if period is None and timing.rate and timing.rate.value:
        return Fraction(_NANOSECONDS) / timing.rate.value
    return period


def record_activation(
    context: GenerationContext, component: Component, input_names: Sequence[str]
) -> tuple[dict[str, object], Diagnostic | None]:
    """Return when a component is active; `input_names` are its inputs for messages. Times are nanoseconds."""
    timing = find_timing(context, component)
    period = find_period(timing)
    mode, finding = _choose_mode(timing, period, component, input_names)
    trigger = timing.trigger
    written = (
        [each.rpartition(".")[2] for each in trigger.inputs] if trigger and trigger.inputs is not None else input_names
    )
    within = trigger.within.value if trigger and trigger.within else None
    return {
        "mode": mode,
        "period_ns": max(1, round(period)) if mode == "periodic" and period else 0,
        "triggers": [each for each in input_names if each in written] if mode in {"any", "all", "match"} else [],
        "within_ns": round(within or 0),
        "every": timing.every or 1,
        "throttle_ns": round(timing.throttle.value or 0) if timing.throttle else 0,
        "keeps_dropped": timing.dropped != "forgotten",
    }, finding


def _choose_mode(
    timing: Timing, period: Fraction | None, component: Component, input_names: Sequence[str]
) -> tuple[str, Diagnostic | None]:
    if timing.behaviour == "once":
        return "once", None
    if timing.behaviour == "on_demand":
        return "never", None
    if timing.behaviour == "periodic" and not period:
        return "never", tell_left_out(
            f"`{component.id}` is periodic, and nobody says how often: in the simulation it is never active",
            first_written_span(timing.at, component.at),
            element=component.id,
            help_line="write its `period` or `rate`",
        )
    if period and timing.behaviour in {None, "periodic"}:
        return "periodic", None
    if not input_names:
        return "never", None
    return timing.trigger.mode if timing.trigger else "any", None
