"""What is known of a chain's deadline: the only place that judges it."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.timing.analysis import ChainVerdict
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound, is_unfound

VERDICT_WORDS: Mapping[ChainVerdict, str] = {
    "met": "met",
    "missed": "MISSED",
    "not proven": "not proven",
    "open": "open",
}
"""What a terminal calls the verdicts: what can go wrong for certain stands out."""
VERDICT_MEANINGS: Mapping[ChainVerdict, str] = {
    "met": "the bound is not above the deadline",
    "missed": "it can happen: the best case is above the deadline, a run was seen, or there is no bound at all",
    "not proven": "the bound is above the deadline, or none was found; the chain may still be in time",
    "open": "figures are missing",
}


def judge_deadline(bound: TimingValue, best: TimingValue, deadline: TimingValue | None) -> ChainVerdict:
    """Judge a chain by its bound and its best case, which may both be incomplete."""
    if deadline is None or deadline.value is None:
        return "open"
    if is_boundless(bound) or (best.value is not None and best.value > deadline.value):
        return "missed"
    if may_be_late(bound, deadline):
        return "not proven"
    return "met" if is_known_bound(bound) else "open"


def may_be_late(bound: TimingValue, deadline: TimingValue) -> bool:
    """Whether a bound does not keep a deadline, whatever the figures that are still missing may turn out to be."""
    if bound.value is not None and deadline.value is not None and bound.value > deadline.value:
        return True
    return is_boundless(bound) or (is_unfound(bound) and not bound.missing)
