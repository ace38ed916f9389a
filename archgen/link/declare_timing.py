"""Declare the timing of an element: its figures, its ports resolved, and nothing in it that makes no sense."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.diagnostic import Diagnostic
from archgen.link import reading, sense
from archgen.link.references import Ports
from archgen.model.timing import OutputTiming, Timing, Trigger
from archgen.source import Span
from archgen.syntax.tree import Entry, Listing, Scalar, Table

_NUMBER_LENGTH = 40
"""Longer than any number that the schema allows in `calls`; it bounds the time that Fraction takes."""


def declare_timing(owner: Entry, ports: Ports, found: list[Diagnostic]) -> Timing | None:
    """Read the `timing` of an element; None if none is written."""
    entry = reading.body(owner).entries.get("timing")
    if entry is None or type(entry.value) is not Table:
        return None
    below = entry.value
    behaviour = reading.text(below, "behaviour")
    calls = list(_calls(below, ports))
    timing = Timing(
        behaviour=behaviour if behaviour in {"periodic", "event", "on_demand", "once"} else None,  # type: ignore[arg-type]
        period=reading.measure(below, "period", "duration"),
        rate=reading.measure(below, "rate", "frequency"),
        jitter=reading.measure(below, "jitter", "duration"),
        wcet=reading.measure(below, "wcet", "duration"),
        bcet=reading.measure(below, "bcet", "duration"),
        trigger=_trigger(below, ports, found),
        every=reading.whole(below, "every"),
        throttle=reading.measure(below, "throttle", "duration"),
        outputs=dict(_outputs(below, ports, found)),
        calls={port: count for port, count, _ in calls},
        priority=reading.whole(below, "priority"),
        core=reading.whole(below, "core"),
        response=reading.measure(below, "response", "duration"),
        # Positions by key; each call has its own, under a key that no YAML key can be (it holds a blank).
        places={e.key: e.value.at for e in below} | {f"calls {port}": at for port, _, at in calls},
        at=entry.at,
    )
    return sense.sound(timing, ports.owner, found)


def _trigger(below: Table, ports: Ports, found: list[Diagnostic]) -> Trigger | None:
    entry = below.entries.get("trigger")
    if entry is None:
        return None
    value = entry.value
    if type(value) is Scalar:
        return Trigger(value.text, None, value.at) if value.text in {"any", "all"} else None  # type: ignore[arg-type]
    if type(value) is Listing:
        inputs = _inputs(below, "trigger", ports, found)
        return None if inputs is None else Trigger("any", inputs, value.at)
    if type(value) is Table and value.get("all") is not None:
        inputs = _inputs(value, "all", ports, found)
        return None if inputs is None else Trigger("all", inputs, value.at)
    return None


def _inputs(of: Table, key: str, ports: Ports, found: list[Diagnostic]) -> tuple[str, ...] | None:
    """Resolve a list of inputs; None if it is empty or nothing in it can be resolved."""
    sense.no_entry(of, key, "input", ports.owner, found)
    named = [ports.follow(written.text, written.at, "input") for written in reading.scalars(of, key)]
    resolved = tuple(dict.fromkeys(port for port in named if port))
    return resolved or None


def _outputs(below: Table, ports: Ports, found: list[Diagnostic]) -> Iterator[tuple[str, OutputTiming]]:
    for key, entry, parts in reading.elements(below, "outputs"):
        port = ports.follow(key, entry.at, "output")
        if port:
            max_gap = sense.positive(parts, "max_gap", "duration", ports.owner, found)
            yield port, OutputTiming(reading.flag(parts, "conditional"), max_gap, entry.at)


def _calls(below: Table, ports: Ports) -> Iterator[tuple[str, Fraction, Span]]:
    for entry in reading.table(below, "calls"):
        port = ports.follow(entry.key, entry.at, "input")
        count = _fraction(entry.value.text) if type(entry.value) is Scalar else None
        if port and count is not None:
            yield port, count, entry.at


def _fraction(text: str) -> Fraction | None:
    try:
        return Fraction(text) if len(text) <= _NUMBER_LENGTH else None
    except (ValueError, ZeroDivisionError):
        return None


def senseless(timing: Timing, element: str) -> Iterator[Diagnostic]:
    """Yield what makes no sense in a timing, wherever its figures come from."""
    return (finding for _, finding in sense.senseless(timing, element))
