"""The unit of a project's durations: the largest of which every written duration is a whole multiple.

Response-time analysis in integer ticks is some forty times faster than in Fractions (100 hosts of 100 tasks: 0.2 s
instead of 8.9 s).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from math import gcd, lcm

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing

SECOND = 10**9
"""Nanoseconds in a second: durations are in ns, rates in Hz."""
_LONGEST = 4096
"""Largest size in bits of the common denominator. Rates of absurd precision would make each number that long."""
_FINE = 2**64
"""Ticks per ns where no common unit of reasonable size exists: durations are rounded up then, the safe side."""


@dataclass(frozen=True, slots=True)
class Ticks:
    """Converts durations to whole ticks of `tick` ns; `exact` is False where they have to be rounded."""

    tick: Fraction
    exact: bool = True

    def of(self, quantity: Quantity | None) -> int | None:
        """Return a written duration in ticks, None where it is not written."""
        return None if quantity is None else self.count(quantity.value)

    def count(self, duration: Fraction) -> int:
        """Return a duration (ns) in ticks, rounded up where the unit is not exact."""
        return -(-duration.numerator * self.tick.denominator // (duration.denominator * self.tick.numerator))


def ticks(architecture: Architecture) -> Ticks:
    """Return the unit: the greatest common divisor of all durations, divided by all numbers of cores and threads."""
    durations = {d for d in _durations(architecture) if d}
    denominator = lcm(*(d.denominator for d in durations))
    # Work is divided by the number of cores (multicore_response): with this divisor such quotients are whole ticks.
    cores = lcm(*(host.cores or 1 for host in architecture.hosts.values()))
    threads = lcm(*(container.threads or 1 for container in architecture.containers.values()))
    parts = lcm(cores, threads)
    if denominator.bit_length() + parts.bit_length() > _LONGEST:
        return Ticks(Fraction(1, _FINE), exact=False)
    # gcd of fractions: of the numerators over the common denominator. `or 1`: a project without any duration.
    numerator = gcd(*(d.numerator * (denominator // d.denominator) for d in durations)) or 1
    return Ticks(Fraction(numerator, denominator * parts))


def period(timing: Timing) -> Fraction | None:
    """Return the period in ns, written as a period or as a rate; None where neither is written or both are nonsense."""
    if timing.period is not None and timing.period.value > 0:
        return timing.period.value
    if timing.rate is not None and timing.rate.value > 0:
        return SECOND / timing.rate.value
    return None


def _durations(architecture: Architecture) -> Iterator[Fraction]:
    """Yield all durations of an architecture, in ns."""
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            yield from _of_timing(timing)
    for link in architecture.links.values():
        yield from _values((link.best, link.worst))
        if link.bandwidth is not None and link.bandwidth.value:
            yield 8 * SECOND / link.bandwidth.value  # the time of one byte: link_queueing counts in these


def _of_timing(timing: Timing) -> Iterator[Fraction]:
    """Yield the durations of one `timing` mapping, in ns."""
    yield from _values((timing.jitter, timing.wcet, timing.bcet, timing.throttle, timing.response))
    yield from _values(output.max_gap for output in timing.outputs.values())
    written = period(timing)
    if written is not None:
        yield written


def _values(quantities: Iterable[Quantity | None]) -> Iterator[Fraction]:
    """Yield the values of those quantities that are written."""
    return (quantity.value for quantity in quantities if quantity is not None)
