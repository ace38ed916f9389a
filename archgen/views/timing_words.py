"""What is declared of timing, in words: a sentence, a table cell, callback groups and orders of cores."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.declared_timing import InputTiming, Timing, list_fair_figures
from archgen.model.deployment import Host
from archgen.model.node import Node
from archgen.model.process_scheduling import list_pinned_cores

BEHAVIOUR_WORDS = {
    "periodic": "periodic",
    "event": "event-driven",
    "on_demand": "on demand",
    "once": "once, at the start",
}


def format_timing_sentence(timing: Timing | None) -> str:
    """Write everything a `timing` section says on one line; empty for None."""
    if timing is None:
        return ""
    execution_range = f"{timing.bcet} to {timing.wcet}" if timing.bcet and timing.wcet else ""
    calls = [f"{name.rsplit('.', 1)[-1]} {count}" for name, count in timing.calls.items()]
    parts = (
        BEHAVIOUR_WORDS[timing.behaviour] if timing.behaviour else "",
        f"period {timing.period}" if timing.period else "",
        f"{timing.rate}" if timing.rate else "",
        f"jitter {timing.jitter}" if timing.jitter else "",
        f"triggered by {_describe_trigger(timing)}" if timing.trigger else "",
        f"fires at each {_write_ordinal(timing.every)}" if timing.every else "",
        f"at least {timing.throttle} apart" if timing.throttle else "",
        f"dropped messages are {timing.dropped}" if timing.dropped else "",
        f"execution {execution_range}" if execution_range else "",
        f"execution up to {timing.wcet}" if timing.wcet and not execution_range else "",
        f"execution at least {timing.bcet}" if timing.bcet and not execution_range else "",
        *_describe_measured_times(timing),
        f"storing inputs: {', '.join(_format_stored_inputs(timing))}" if timing.inputs else "",
        f"uses {', '.join(_format_uses(timing))}" if timing.uses else "",
        f"declared response {timing.response}" if timing.response else "",
        f"publishes only at times: {', '.join(_format_timed_outputs(timing))}" if timing.outputs else "",
        f"calls for each activation: {', '.join(calls)}" if calls else "",
        f"priority {timing.priority}" if timing.priority is not None else "",
        f"deadline {timing.deadline}" if timing.deadline else "",
        name_cores(list_pinned_cores(timing)),
    )
    return "; ".join(part for part in parts if part)


def name_cores(cores: Sequence[int]) -> str:
    """Return "core 2", "cores 0, 2", nothing where there are none."""
    return f"core{'s' if len(cores) > 1 else ''} {', '.join(map(str, cores))}" if cores else ""


def _write_ordinal(number: int) -> str:
    """Return `1st`, `2nd`, `3rd`, `4th`, `11th`, `22nd`."""
    suffix = "th" if number // 10 % 10 == 1 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{suffix}"


def _describe_trigger(timing: Timing) -> str:
    """Describe which inputs trigger an activation."""
    if timing.trigger is None:
        return ""
    if timing.trigger.inputs is None:
        return f"{timing.trigger.mode} of the inputs"
    names = ", ".join(name.rsplit(".", 1)[-1] for name in timing.trigger.inputs)
    if timing.trigger.mode == "match":
        return f"matching messages of {names}, at most {timing.trigger.within} apart"
    return f"{timing.trigger.mode} of {names}"


def _describe_measured_times(timing: Timing) -> Iterator[str]:
    """Describe what is written of measurements: whether the worst case is one, and percentiles."""
    times = timing.measured_times
    if times is not None:
        if times.is_measured:
            yield "the longest execution is measured, not proven"
        if times.percentiles:
            yield f"measured {', '.join(f'{name} {time}' for name, time in times.percentiles.items())}"


def _format_stored_inputs(timing: Timing) -> list[str]:
    """Format how long storing each input takes."""
    return [f"{name.rsplit('.', 1)[-1]} {_format_storing(each)}" for name, each in timing.inputs.items()]


def _format_storing(input_timing: InputTiming) -> str:
    is_range = input_timing.bcet and input_timing.wcet
    time = f"{f'{input_timing.bcet} to ' if is_range else ''}{input_timing.wcet or '?'}"
    is_plain = input_timing.memory and not input_timing.wcet
    said = ("at once",) if input_timing.stored_at_once else () if is_plain else (time,)
    return ", ".join((*said, *(("the last of each source",) if input_timing.memory else ())))


def _format_uses(timing: Timing) -> list[str]:
    """Format how long each resource is used."""
    return [f"{name} {f'{each.min} to ' if each.min else ''}{each.max}" for name, each in timing.uses.items()]


def format_callback_groups(node: Node) -> str:
    """Format a node's callback groups: `fast: obstacle_stop; slow: planner, mapper`."""
    return "; ".join(
        f"{name}: {', '.join(component.rpartition('.')[2] for component in members)}"
        for name, members in node.callback_groups.items()
    )


def format_core_orders(host: Host) -> str:
    """Format the figures of a fair order and the orders of single cores: `slice 3 ms, core 0 edf, core 3 fifo`."""
    figures = [f"{name.replace('_', ' ')} {figure}" for name, figure in list_fair_figures(host.fair)]
    return ", ".join([*figures, *(f"core {core} {order}" for core, order in host.core_scheduling.items())])


def _format_timed_outputs(timing: Timing) -> list[str]:
    """Format the outputs that are not published at every activation."""
    return [
        f"{name.rsplit('.', 1)[-1]}" + (f" (at least each {output.max_gap})" if output.max_gap else "")
        for name, output in timing.outputs.items()
    ]


def format_short_timing(timing: Timing | None) -> str:
    """Write rate or period and worst-case execution time for a table cell: `10 Hz, up to 80 ms`."""
    if timing is None:
        return ""
    rate = timing.rate or timing.period
    timing_parts = [str(rate) if rate else BEHAVIOUR_WORDS.get(timing.behaviour, "") if timing.behaviour else ""]
    timing_parts.append(f"up to {timing.wcet}" if timing.wcet else "")
    return ", ".join(part for part in timing_parts if part)
