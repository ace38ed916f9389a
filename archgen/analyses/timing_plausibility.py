"""Are the figures of timing plausible? Values that are legal, but usually a mistake."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.rule_options import RuleOption, format_percentage

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.declared_timing import Timing
    from archgen.model.quantity import Quantity

_NS_PER_SECOND = 10**9


def long_execution(architecture: Architecture, *, limit: Fraction) -> Iterator[Diagnostic]:
    """An execution takes longer, at worst, than the period in which it is to be done."""
    yield from _find_above_period(architecture, ("wcet", "the worst case execution time"), "long-execution", limit)


def large_jitter(architecture: Architecture, *, limit: Fraction) -> Iterator[Diagnostic]:
    """An activation may come later than the period after which the next one is due."""
    yield from _find_above_period(architecture, ("jitter", "the jitter"), "large-jitter", limit)


def _find_above_period(
    architecture: Architecture, described_key: tuple[str, str], rule_name: str, limit: Fraction
) -> Iterator[Diagnostic]:
    """Yield a finding for each figure that is above this share of the period, if both are written.

    `described_key` is the figure's key in `Timing`, and its name in a sentence.
    """
    key, description = described_key
    limit_phrase = "" if limit == 1 else f"{format_percentage(limit)} of "
    # A node that implements several components may have one `timing` for all of them: the same span comes up again.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            # `key` is an attribute of `Timing` and the key in the YAML (and in `places`) alike.
            quantity: Quantity | None = getattr(timing, key)
            period = _period_of(timing) if quantity else None
            if (
                quantity
                and period
                and quantity.value > (period if limit == 1 else limit * period)
                and timing.places[key] not in reported_spans
            ):
                reported_spans.add(timing.places[key])
                message = f"{description} of `{node.id}` (`{key}`, {quantity}) is above {limit_phrase}its period"
                cure = "this is legal: correct it only where a figure or a unit is wrong"
                period_key = "period" if timing.period else "rate"
                label = Label(timing.places[period_key], f"its {period_key}")
                yield Diagnostic(rule_name, message, timing.places[key], labels=(label,), help=cure, element=node.id)


def _period_of(timing: Timing) -> Fraction | None:
    """Return the period in ns, written as such or as a rate; None if neither is written."""
    if timing.period:
        return timing.period.value
    return _NS_PER_SECOND / timing.rate.value if timing.rate else None


RULES = (
    (
        long_execution,
        Severity.NOTE,
        (RuleOption("limit", 100, 1, 100, "The share of its period that an execution may take."),),
    ),
    (
        large_jitter,
        Severity.NOTE,
        (RuleOption("limit", 100, 1, 1000, "The share of the period by which an activation may come late."),),
    ),
)
