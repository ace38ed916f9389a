"""How chains of effect stand: worst first, with a chip for the verdict, the margin, and a bar of the deadline used."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction

from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_verdicts import find_lateness
from archgen.views.shapes import Inlines, Meter, Status, Text
from archgen.views.short_figures import round_number

_VERDICT_RANKS = {"missed": 0, "not proven": 1, "open": 2, "met": 3}
_SHORT_UNITS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))
NO_DEADLINE: Inlines = (Text("no deadline", muted=True),)


def rank_chains(results: Iterable[ChainResult]) -> tuple[ChainResult, ...]:
    """Sort chains, the worst first: missed, not proven, open, met; then by the share of the deadline that is used.

    Chains without a deadline come last: there is nothing to be late for.
    """
    return tuple(sorted(results, key=_chain_rank))


def _chain_rank(result: ChainResult) -> tuple[int, Fraction]:
    if lacks_deadline(result):
        return (len(_VERDICT_RANKS), Fraction(0))
    return (_VERDICT_RANKS[result.verdict], -(used_share(result) or Fraction(0)))


def lacks_deadline(result: ChainResult) -> bool:
    """Whether a chain has no deadline: there is nothing to judge, whatever is known of it."""
    return result.deadline is None


def find_status(result: ChainResult) -> Status | None:
    """Return the verdict on a chain as a status; None where it has no deadline."""
    return None if lacks_deadline(result) else result.verdict


def used_share(result: ChainResult) -> Fraction | None:
    """Return how much of the deadline the known part of the bound takes; None where either is unknown."""
    deadline = result.deadline.value if result.deadline else None
    return result.bound.value / deadline if deadline and result.bound.value is not None else None


def chain_chip(result: ChainResult) -> Inlines:
    """Return the verdict on a chain as a chip, with its margin."""
    if lacks_deadline(result):
        return NO_DEADLINE
    margin = describe_margin(result)
    return (Text(f"{result.verdict} · {margin}" if margin else result.verdict, strong=True, status=result.verdict),)


def verdict_chip(result: ChainResult) -> Inlines:
    """Return the verdict on a chain as a chip, without its margin: that has a column of its own."""
    if lacks_deadline(result):
        return NO_DEADLINE
    return (Text(result.verdict, strong=result.verdict != "met", status=result.verdict),)


def margin_cell(result: ChainResult) -> Inlines:
    """Return the margin of a chain for a table, sorted by it; empty where it is not known."""
    margin = _find_margin(result)
    return (Text(describe_margin(result), sort_number=str(margin)),) if margin is not None else ()


def describe_margin(result: ChainResult) -> str:
    """Describe what is left of the deadline, `629 ms left`, or by how much it is exceeded, `+23.8 ms`."""
    late = find_lateness(result)
    if late:
        # What was seen, and what is known of a bound, may be more: as the best case, it is exceeded by at least that.
        sign = "<= " if late.kind == "at most" else ">= "
        return f"{'seen ' if late.kind == 'seen' else sign}+{round_duration(late.excess, sign)}"
    margin = _find_margin(result)
    if margin is None:
        return ""
    # What is left is at least so much; where figures are missing, at most.
    return (
        f"<= {round_duration(margin, '<')} left" if result.verdict == "open" else f"{round_duration(margin, '>')} left"
    )


def _find_margin(result: ChainResult) -> Fraction | None:
    """Return what is left of the deadline in ns, negative where it is exceeded; None where nothing can be said."""
    late, deadline = find_lateness(result), result.deadline.value if result.deadline else None
    if late:
        return -late.excess
    # A verdict that rests on something else (no bound was found, an overload) has no figure for how much.
    if deadline is None or result.bound.value is None or result.verdict in {"missed", "not proven"}:
        return None
    margin = deadline - result.bound.value
    return margin if margin or result.verdict == "met" else None


def round_duration(nanoseconds: Fraction, sign: str = "") -> str:
    """Format a duration with three significant digits, in the largest unit that leaves at least one.

    What is at least or at most so much (`sign`) stays true.
    """
    factor, unit = next(((factor, unit) for factor, unit in _SHORT_UNITS if nanoseconds >= factor), (1, "ns"))
    return f"{round_number(Decimal(nanoseconds.numerator) / Decimal(nanoseconds.denominator * factor), sign)} {unit}"


def chain_meter(result: ChainResult) -> Inlines:
    """Return a bar of how much of its deadline a chain uses; empty where nobody knows."""
    share = used_share(result)
    if share is None:
        return ()
    meter = Meter(float(share), result.verdict, is_partial=not result.bound.complete)
    return (Text("", meter=meter, sort_number=str(share)),)
