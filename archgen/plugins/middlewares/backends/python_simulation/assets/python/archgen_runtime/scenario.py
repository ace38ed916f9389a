"""What comes from outside of the architecture: a text with a line for each value."""

import re
from fractions import Fraction

from .errors import SimulationError
from .values import write_value

_LINE = re.compile(r"([^ \t]+)[ \t]+([<>])[ \t]+([^ \t]+)[ \t]+(.*)", re.DOTALL)
_TIME = re.compile(r"([0-9]{1,30}(?:\.[0-9]{1,30})?)(ns|us|ms|s)?")
_FACTORS = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9}
_MOST_NS = 2**63 - 1


def apply_scenario(text, name, simulation):
    """Give a run what a scenario says: lines as `100ms < group.component.input VALUE`."""
    for number, raw in enumerate(text.split("\n"), start=1):
        line = raw.removesuffix("\r")
        if not line.strip(" \t") or line.startswith("#"):
            continue
        try:
            _apply_line(line, simulation)
        except SimulationError as error:
            raise SimulationError(f"{name}:{number}: {error}") from None


def _apply_line(line, simulation):
    parts = _LINE.fullmatch(line)
    if parts is None:
        raise SimulationError("a line is TIME < INPUT VALUE or TIME > OUTPUT VALUE")
    time_text, mark, port, value = parts.groups()
    if mark == "<":
        simulation.arrive(read_time(time_text), port, value)
    else:
        simulation.emit(read_time(time_text), port, value)


def read_time(text):
    """Return a time such as `0.5s` in whole nanoseconds; without a unit it is in them."""
    parts = _TIME.fullmatch(text)
    if parts is None:
        raise SimulationError(f"a time is a number with ns, us, ms or s, not {write_value(text)}")
    time_ns = Fraction(parts[1]) * _FACTORS[parts[2] or "ns"]
    if time_ns.denominator != 1 or time_ns > _MOST_NS:
        raise SimulationError(f"the time {text} is no whole number of nanoseconds")
    return int(time_ns)
