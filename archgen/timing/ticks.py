"""The unit of a project's durations: the largest of which all that is written is a whole multiple."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from math import gcd, lcm

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing

SECOND = 10**9
_LONGEST = 4096
"""Bits of the common denominator. Beyond, arithmetic on rates that nobody could mean would take all day."""
_FINE = 2**64


@dataclass(frozen=True, slots=True)
class Ticks:
    """Turns durations into whole ticks; `exact` is False where the unit had to be rounded."""

    tick: Fraction
    exact: bool = True

    def of(self, quantity: Quantity | None) -> int | None:
        """Give a duration in ticks."""
        return None if quantity is None else self.count(quantity.value)

    def count(self, duration: Fraction) -> int:
        """Give a duration (ns) in ticks, rounded up where the unit is not exact."""
        return -(-duration.numerator * self.tick.denominator // (duration.denominator * self.tick.numerator))


def ticks(architecture: Architecture) -> Ticks:
    """Find the unit; it divides by the number of cores of every host, so that shares of a core are whole, too."""
    durations = {d for d in _durations(architecture) if d}
    denominator = lcm(*(d.denominator for d in durations))
    cores = lcm(*(host.cores or 1 for host in architecture.hosts.values()))
    threads = lcm(*(container.threads or 1 for container in architecture.containers.values()))
    parts = lcm(cores, threads)
    if denominator.bit_length() + parts.bit_length() > _LONGEST:
        return Ticks(Fraction(1, _FINE), exact=False)
    numerator = gcd(*(d.numerator * (denominator // d.denominator) for d in durations)) or 1
    return Ticks(Fraction(numerator, denominator * parts))


def period(timing: Timing) -> Fraction | None:
    """Give the written period in ns, whether it stands there as a period or as a rate; None where neither makes sense."""
    if timing.period is not None and timing.period.value > 0:
        return timing.period.value
    if timing.rate is not None and timing.rate.value > 0:
        return SECOND / timing.rate.value
    return None


def _durations(architecture: Architecture) -> Iterator[Fraction]:
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            yield from _of_timing(timing)
    for link in architecture.links.values():
        yield from _values((link.best, link.worst))
        if link.bandwidth is not None and link.bandwidth.value:
            yield 8 * SECOND / link.bandwidth.value  # a byte: what waits in front of a link is counted in these


def _of_timing(timing: Timing) -> Iterator[Fraction]:
    yield from _values((timing.jitter, timing.wcet, timing.bcet, timing.throttle, timing.response))
    yield from _values(output.max_gap for output in timing.outputs.values())
    written = period(timing)
    if written is not None:
        yield written


def _values(quantities: Iterable[Quantity | None]) -> Iterator[Fraction]:
    return (quantity.value for quantity in quantities if quantity is not None)
