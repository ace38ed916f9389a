"""Report figures that are well-formed but impossible, such as a period of zero or a best case above the worst.

They are left out of the model: whatever would follow from an impossible figure is noise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from archgen.diagnostic import Diagnostic, Label
from archgen.link import reading
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.source import Span
from archgen.syntax.tree import Listing, Table

_UNKNOWN = "leave it out where it is not known"


def sound(timing: Timing, element: str, found: list[Diagnostic]) -> Timing:
    """Report what makes no sense in a timing, and return the timing without it."""
    dropped: dict[str, Any] = {}
    for key, finding in senseless(timing, element):
        found.append(finding)
        dropped[key] = None
    return replace(timing, **dropped) if dropped else timing


def positive(of: Table, key: str, dimension: str, element: str, found: list[Diagnostic]) -> Quantity | None:
    """Read a quantity that cannot be zero; None, and a diagnostic, if it is."""
    measured = reading.measure(of, key, dimension)
    if measured is None or measured.value:
        return measured
    found.append(_wrong(f"`{key}` cannot be zero", reading.place(of, key), _UNKNOWN, element))
    return None


def no_entry(of: Table, key: str, what: str, element: str, found: list[Diagnostic]) -> None:
    """Report an empty list where it has no meaning."""
    value = of.get(key)
    if isinstance(value, Listing) and not value.items:
        found.append(_wrong(f"`{key}` names no {what}", value.at, f"name one or more, or leave `{key}` out", element))


def latency(of: Table, element: str, found: list[Diagnostic]) -> tuple[Quantity | None, Quantity | None]:
    """Read the best and the worst latency of a link; the best is None, and reported, if it is above the worst."""
    best, worst = reading.measure(of, "best", "duration"), reading.measure(of, "worst", "duration")
    if best is None or worst is None or best.value <= worst.value:
        return best, worst
    label = Label(reading.place(of, "worst"), "the worst")
    message = f"the best latency ({best}) is above the worst ({worst})"
    found.append(_wrong(message, reading.place(of, "best"), "exchange them", element, label))
    return None, worst


def senseless(timing: Timing, element: str) -> Iterator[tuple[str, Diagnostic]]:
    """Yield what makes no sense in a timing: the key to leave out, and the diagnostic that says why."""
    places = timing.places
    for key, quantity in (("period", timing.period), ("rate", timing.rate)):
        if quantity is not None and quantity.value == 0:
            yield key, _wrong(f"a {key} cannot be zero", places[key], _UNKNOWN, element)
    # Of two figures that contradict each other one is dropped: the rate here, the best case below.
    if timing.period is not None and timing.rate is not None:
        label = Label(places["period"], "the period")
        cure = "write one of them: each follows from the other"
        yield "rate", _wrong("`rate` and `period` are both written", places["rate"], cure, element, label)
    if timing.bcet is not None and timing.wcet is not None and timing.bcet.value > timing.wcet.value:
        label = Label(places["wcet"], "the worst case")
        message = f"the best case execution time (`bcet`, {timing.bcet}) is above the worst (`wcet`, {timing.wcet})"
        yield "bcet", _wrong(message, places["bcet"], "exchange them, or leave `bcet` out", element, label)
    if timing.every is not None and timing.every < 1:
        yield "every", _wrong("`every` is 1 or more", places["every"], "`every: 3` fires at each third input", element)


def _wrong(message: str, at: Span, cure: str, element: str, *labels: Label) -> Diagnostic:
    return Diagnostic("wrong-value", message, at, labels=labels, help=cure, element=element)
