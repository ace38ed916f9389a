"""The `timing` of an element in the resolved record."""

from __future__ import annotations

from archgen.model.declared_timing import Timing, Trigger
from archgen.views.records.record_values import drop_unknown, record_quantity, to_number


def record_timing(timing: Timing | None) -> dict[str, object] | None:
    """Return what is written of timing, None for nothing at all."""
    if timing is None:
        return None
    durations = ("period", "jitter", "wcet", "bcet", "throttle", "deadline", "response")
    return drop_unknown(
        {
            "behaviour": timing.behaviour,
            "rate": record_quantity(timing.rate, "Hz"),
            **{key: record_quantity(getattr(timing, key), "ns") for key in durations},
            **_record_measured_times(timing),
            "trigger": _record_trigger(timing.trigger) if timing.trigger else None,
            "every": timing.every,
            "dropped": timing.dropped,
            "inputs": {
                name: drop_unknown(
                    {
                        **{key: record_quantity(getattr(each, key), "ns") for key in ("wcet", "bcet")},
                        "stored": "at_once" if each.stored_at_once else None,
                    }
                )
                for name, each in timing.inputs.items()
            },
            "outputs": {
                name: drop_unknown({"conditional": o.conditional or None, "max_gap": record_quantity(o.max_gap, "ns")})
                for name, o in timing.outputs.items()
            },
            "calls": {name: to_number(count) for name, count in timing.calls.items()},
            "uses": {
                name: drop_unknown({key: record_quantity(getattr(each, key), "ns") for key in ("max", "min")})
                for name, each in timing.uses.items()
            },
            "priority": timing.priority,
            "core": timing.core,
            "cores": list(timing.cores or ()),
        }
    )


def _record_trigger(trigger: Trigger) -> dict[str, object]:
    fields = {"mode": trigger.mode, "inputs": list(trigger.inputs or ())}
    return drop_unknown({**fields, "within": record_quantity(trigger.within, "ns")})


def _record_measured_times(timing: Timing) -> dict[str, object]:
    """Return what is written beside the worst execution time: measured percentiles, and whether it is measured itself."""
    if timing.measured_times is None:
        return {}
    percentiles = timing.measured_times.percentiles
    return {
        "percentiles": {name: record_quantity(time, "ns") for name, time in percentiles.items()},
        "wcet_measured": timing.measured_times.is_measured or None,
    }
