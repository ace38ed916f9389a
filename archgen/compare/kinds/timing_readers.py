"""How the keys of `timing` are read for comparing."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.normal_values import last_part
from archgen.model.declared_timing import InputTiming, OutputTiming, Timing
from archgen.model.quantity import Quantity
from archgen.timing.figures.figure_wording import format_rate

_NS_PER_SECOND = 10**9


def read_rate(timing: Timing, _context: ReadContext) -> Quantity | None:
    """Return the rate; a period as the rate that it amounts to."""
    if timing.period is None or not timing.period.value:
        return timing.rate
    # Periods are in ns. `period: 100 ms` and `rate: 10 Hz` mean the same and must compare equal.
    rate = Fraction(_NS_PER_SECOND) / timing.period.value
    return Quantity(rate, format_rate(rate))


def find_output_timing(timing: Timing, context: ReadContext) -> Mapping[str, OutputTiming]:
    """Return the outputs that are not published at each activation, each by what stands before its keys."""
    return {_name_port("output", port, context): said for port, said in timing.outputs.items()}


def find_input_timing(timing: Timing, context: ReadContext) -> Mapping[str, InputTiming]:
    """Return the inputs whose messages a callback stores, each by what stands before its keys."""
    return {_name_port("input", port, context): said for port, said in timing.inputs.items()}


def _name_port(kind: str, port: str, context: ReadContext) -> str:
    return f"{last_part(context.matched_ids.common_id(kind, port))}."


def read_stored(input_timing: InputTiming, _context: ReadContext) -> str | None:
    """Return whether no callback stores the messages of an input, in the word of the language."""
    return "at_once" if input_timing.stored_at_once else None


def read_calls(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    """Return how often each service or action is called in one activation."""
    return {last_part(context.matched_ids.common_id("input", port)): count for port, count in timing.calls.items()}


def read_uses(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    """Return the longest use of each resource, and the shortest by `resource.min`."""
    values: dict[str, object] = {}
    for name, resource_time in timing.uses.items():
        resource = context.matched_ids.common_id("resource", name)
        values |= {resource: resource_time.max, f"{resource}.min": resource_time.min}
    return values


def read_measured_times(timing: Timing, _context: ReadContext) -> Mapping[str, object]:
    """Return the measured percentiles, and whether the longest time is one that was seen."""
    times = timing.measured_times
    return {**times.percentiles, "measured": times.is_measured or None} if times else {}


def read_core(timing: Timing, _context: ReadContext) -> int | None:
    """Return the only core: `core: 3` and `cores: [3]` mean the same."""
    return timing.cores[0] if timing.core is None and timing.cores and len(timing.cores) == 1 else timing.core


def read_cores(timing: Timing, _context: ReadContext) -> tuple[int, ...] | None:
    """Return a set of several cores."""
    return timing.cores if timing.cores and len(timing.cores) > 1 else None


def read_trigger(timing: Timing, _context: ReadContext) -> str | None:
    """Return how inputs fire a component."""
    return timing.trigger.mode if timing.trigger else None


def read_trigger_facets(timing: Timing, context: ReadContext) -> Mapping[str, object]:
    """Return which inputs fire a component, and how far apart matched messages may be."""
    trigger = timing.trigger
    return {"inputs": context.common_ids("input", trigger.inputs or ()), "within": trigger.within} if trigger else {}
