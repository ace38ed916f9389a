"""What is known of a limit, and of a chain's deadline: the only place that judges it.

How old what is read at an input may be, against the freshness that its reader needs.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Literal

from archgen.frozen import NamedTuple, dataclass, replace
from archgen.model.architecture import Chain
from archgen.model.quantity import parse_share
from archgen.timing.analysis import Analysis, ChainResult, ChainVerdict, ShareDeadline
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.figures.timing_values import (
    ZERO_VALUE,
    TimingValue,
    is_boundless,
    is_known_bound,
    is_unfound,
    sum_bounds,
)
from archgen.timing.system.timing_system import Arc, best_response

LimitState = Literal["kept", "broken", "unknown"]


def judge_upper_limit(bound: TimingValue, limit: Fraction) -> LimitState:
    """Return whether a duration stays within a limit; one without a bound, though no figure is missing, does not."""
    if bound.value is not None and bound.value > limit:
        return "broken"
    if is_known_bound(bound):
        return "kept"
    is_without_bound = (is_unfound(bound) or (bound.value is None and bound.complete)) and not bound.missing
    return "broken" if is_boundless(bound) or is_without_bound else "unknown"


def judge_lower_limit(rate: TimingValue, limit: Fraction) -> LimitState:
    """Return whether a rate is at least as high as a limit."""
    if rate.value is None or not (rate.complete or rate.side != "exact"):
        return "unknown"
    is_kept = rate.value >= limit
    # What is only known from the other side may be more, or less.
    return "unknown" if rate.side == ("at most" if is_kept else "at least") else "kept" if is_kept else "broken"


def find_worst_state(states: Iterable[LimitState]) -> LimitState:
    """Return the state of a limit that several figures have to keep: one that breaks it is enough."""
    found = set(states)
    return "broken" if "broken" in found else "unknown" if "unknown" in found else "kept"


SeenVerdict = Literal["kept", "late", "too few"]
"""What simulated or recorded reactions say of the deadline of a share: `too few` of them to say anything."""
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


def judge_chain(result: ChainResult, deadline: TimingValue | None) -> ChainVerdict:
    """Judge a chain against any deadline, by its bounds and by the run in which it was late."""
    run = result.late_run
    if run and deadline and deadline.value is not None and run.longest > deadline.value:
        return "missed"
    return judge_deadline(result.bound, result.best, deadline)


class Lateness(NamedTuple):
    """By how much a chain is above its deadline (`excess`), of which time (`duration`), both in ns, and what that time is:
    the least that it takes, what it took in a run, the most that it takes, or what is known of the most.
    """

    kind: Literal["at least", "seen", "at most", "known"]
    duration: Fraction
    excess: Fraction


def find_lateness(result: ChainResult) -> Lateness | None:
    """Return by how much a chain is above its deadline, by the strongest evidence; None where no figure is above it."""
    deadline = result.deadline.value if result.deadline else None
    run, bound = result.late_run, result.bound
    figures: tuple[tuple[Literal["at least", "seen", "at most", "known"], Fraction | None], ...] = (
        ("at least", result.best.value),
        ("seen", run.longest if run else None),
        ("at most" if is_known_bound(bound) else "known", bound.value),
    )
    for kind, duration in figures if deadline is not None else ():
        if duration is not None and deadline is not None and duration > deadline:
            return Lateness(kind, duration, duration - deadline)
    return None


def may_be_late(bound: TimingValue, deadline: TimingValue) -> bool:
    """Whether a bound does not keep a deadline, whatever the figures that are still missing may turn out to be."""
    if bound.value is not None and deadline.value is not None and bound.value > deadline.value:
        return True
    return is_boundless(bound) or (is_unfound(bound) and not bound.missing)


def judge_shares(bound: TimingValue, best: TimingValue, asked_chain: Chain) -> tuple[ShareDeadline, ...]:
    """Judge the deadlines of shares as far as bounds can: what all reactions keep, and what not a single one does."""
    found: list[ShareDeadline] = []
    for name, quantity in asked_chain.deadline_shares.items():
        is_met = judge_deadline(bound, best, TimingValue(quantity.value)) == "met"
        is_missed = best.value is not None and best.value > quantity.value
        verdict: Literal["met", "missed", "open"] = "missed" if is_missed else "met" if is_met else "open"
        found.append(ShareDeadline(parse_share(name) or Fraction(0), quantity.value, verdict))
    return tuple(found)


def judge_seen_share(share: Fraction, limit: Fraction, seen: Fraction | None, count: int) -> SeenVerdict:
    """Judge a share by what it took among so many reactions that were seen, which proves nothing."""
    if seen is not None and seen > limit:
        return "late"
    # Of fewer none would be beyond the share.
    return "kept" if seen is not None and count * (1 - share) >= 1 else "too few"


@dataclass(frozen=True, slots=True)
class ReadAge:
    """How old (ns) what is read over an arc may be, from when its source sends it until the last job that reads it begins."""

    arc: Arc
    age: TimingValue
    limit: Fraction

    @property
    def state(self) -> LimitState:
        """Whether nothing older than the limit is read."""
        return judge_upper_limit(self.age, self.limit)


def find_read_ages(analysis: Analysis, limits: Mapping[str, Fraction] | None = None) -> Iterator[ReadAge]:
    """Yield the ages of what is read at all inputs that have a freshness, in the order of the elements.

    `limits` (ns), by input, are others than those that are written.
    """
    steps = StepDelays.of_analysis(analysis)
    tick = analysis.system.tick
    for activity in analysis.system.activities.values():
        own_limits = (
            {port: Fraction(limit * tick) for port, limit in activity.freshness.items()}
            if limits is None
            else {port: limits[port] for port in activity.inputs if port in limits}
        )
        for arc in analysis.system.arcs_into.get(activity.id, ()) if own_limits else ():
            if arc.input in own_limits and arc.role == "data":
                yield ReadAge(arc, _find_age(analysis, steps, arc), own_limits[arc.input])


def find_sent_ages(analysis: Analysis, outputs: Collection[str]) -> Iterator[tuple[Arc, TimingValue]]:
    """Yield how old (ns) what is sent at some outputs may be where it is read, by each way to a reader."""
    steps = StepDelays.of_analysis(analysis)
    for arcs in analysis.system.arcs_from.values():
        for arc in arcs:
            if arc.output in outputs and arc.role == "data":
                yield arc, _find_age(analysis, steps, arc)


def _find_age(analysis: Analysis, steps: StepDelays, arc: Arc) -> TimingValue:
    """Return the link's latency, the age at the activation that uses the message, and the time until that begins."""
    starting = ZERO_VALUE
    if steps.arrivals.fires_reader(arc):
        reader = analysis.system.activities[arc.target]
        response = steps.response_value(reader.id)
        starting = (
            response
            if response.value is None
            else replace(
                response, value=max(response.value - best_response(reader) * analysis.system.tick, Fraction(0))
            )
        )
    return sum_bounds((steps.link_latency(arc), steps.holding_age(arc), starting))
