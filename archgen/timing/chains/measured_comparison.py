"""Designed against measured: figures observed on the running robot, beside what follows from the design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Literal

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.frozen import dataclass, field, replace
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis, ChainResult, EventPace
from archgen.timing.chains.chain_verdicts import SeenVerdict, judge_seen_share
from archgen.timing.chains.sample_statistics import SampleStatistics
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue, add_values, is_known_bound, smallest_value

MEASURED_KEYS = {
    "rate": "frequency",
    "period": "duration",
    "min_period": "duration",
    "max_period": "duration",
    "bcet": "duration",
    "wcet": "duration",
    "response": "duration",
}
"""What can be observed, and its dimension. Periods are gaps between two events: mean, smallest, largest."""
RECORDED_KEYS = ("storing", "latency", "delay")
"""What only recordings give: the longest callback that stores an input, the largest latency of a chain, the largest time from
a message's stamp until it arrived.
"""
RATE_TOLERANCE = Fraction(1, 10)
"""A measured mean may differ by this share before it is an outlier."""

_BROKEN_ABOVE = {
    "max_period": "gaps are larger than the bounds rest on",
    "wcet": "takes longer than the design says",
    "response": "the bound on the response time does not hold",
    "storing": "takes longer than the design says",
    "latency": "the bound of the chain does not hold",
    "delay": "",
}
_OPPOSITE_SIDES: Mapping[str, Literal["exact", "at least", "at most"]] = {
    "exact": "exact",
    "at least": "at most",
    "at most": "at least",
}
_BROKEN_BELOW = {
    "min_period": "they come closer than the bounds rest on",
    "bcet": "is quicker than the design says: jitter grows",
}


@dataclass(frozen=True, slots=True)
class Observation:
    """What was observed of one activity or topic, or of an input (`storing`) or a chain (`latency`)."""

    id: str
    figures: Mapping[str, Quantity]
    at: Span
    samples: Mapping[str, SampleStatistics] = field(default_factory=dict)
    """Where all samples were recorded, their statistics: of `execution`, `storing`, `period`, `latency`."""
    inaccuracies: Mapping[str, Fraction] = field(default_factory=dict)
    """How far a figure may be off by the way in which it was recorded: no outlier is made of that."""


@dataclass(frozen=True, slots=True)
class MeasuredComparison:
    """One figure, designed and measured. `verdict` says whether the design holds, `why` what it means if not."""

    id: str
    key: str
    designed: TimingValue
    measured: Fraction
    verdict: Literal["as designed", "outlier", "not designed"]
    why: str = ""

    @property
    def ratio(self) -> Fraction | None:
        """Return measured by designed, None where nothing (or zero) is designed."""
        return self.measured / self.designed.value if self.designed.value else None


def compare_measured(
    analysis: Analysis, observations: tuple[Observation, ...], chain_results: Mapping[str, ChainResult] | None = None
) -> tuple[tuple[MeasuredComparison, ...], tuple[Diagnostic, ...]]:
    """Compare observations with the design; ids that the design does not have are findings."""
    comparisons: list[MeasuredComparison] = []
    findings: list[Diagnostic] = []
    senders_by_topic = _find_senders(analysis)
    for observation in observations:
        if not observation.figures.keys().isdisjoint(RECORDED_KEYS):
            # Whoever recorded these has found their ids in the design.
            comparisons += _compare_recorded(analysis, observation, chain_results or {})
            continue
        is_topic = observation.id in senders_by_topic
        if not is_topic and observation.id not in analysis.system.activities:
            findings.append(_report_unknown(observation, [*analysis.system.activities, *senders_by_topic]))
            continue
        pace = (
            _merge_paces([analysis.outputs.get(sender) for sender in senders_by_topic[observation.id]])
            if is_topic
            else analysis.paces.get(observation.id)
        )
        for key, quantity in observation.figures.items():
            comparisons.append(_compare_figure(analysis, observation, key, quantity.value, pace))
    return tuple(comparisons), tuple(findings)


def _compare_recorded(
    analysis: Analysis, observation: Observation, chain_results: Mapping[str, ChainResult]
) -> Iterator[MeasuredComparison]:
    """Yield the comparisons of what only recordings give."""
    system = analysis.system
    for key, quantity in observation.figures.items():
        designed = UNKNOWN_VALUE
        if key == "latency":
            designed = chain_results[observation.id].bound
            yield from _compare_shares(observation, chain_results[observation.id])
        elif key == "storing":
            callback = next(
                (a.storing[observation.id] for a in system.activities.values() if observation.id in a.storing), None
            )
            # Zero stands for a time that nobody wrote.
            designed = TimingValue(callback.wcet * system.tick) if callback and callback.wcet else UNKNOWN_VALUE
        yield _compare_bound(observation, key, designed, quantity.value)


def _compare_shares(observation: Observation, result: ChainResult) -> Iterator[MeasuredComparison]:
    """Yield the deadlines of shares of a chain's reactions beside what these took, from the first sample on."""
    samples = observation.samples.get("latency")
    if samples is None:
        return
    for asked in result.shares:
        seen = Fraction(samples.find_percentile(asked.share))
        answers: dict[SeenVerdict, tuple[Literal["as designed", "outlier", "not designed"], str]] = {
            "kept": ("as designed", ""),
            "late": ("outlier", f"{asked.name} of its reactions take longer than their deadline"),
            "too few": ("not designed", f"{samples.count} reactions are too few to judge {asked.name} of them"),
        }
        verdict, why = answers[judge_seen_share(asked.share, asked.limit, seen, samples.count)]
        key, limit = f"latency of {asked.name}", TimingValue(asked.limit)
        yield MeasuredComparison(observation.id, key, limit, seen, verdict, why)


def _find_senders(analysis: Analysis) -> dict[str, list[tuple[str, str]]]:
    """Return the outputs that send on each topic; of a service it is its clients."""
    senders_by_topic: dict[str, dict[tuple[str, str], None]] = {}
    for arc in analysis.system.arcs:
        if arc.role != "answer":
            senders_by_topic.setdefault(arc.topic, {})[arc.source, arc.output] = None
    return {topic: list(senders) for topic, senders in senders_by_topic.items()}


def _merge_paces(paces: Sequence[EventPace | None]) -> EventPace | None:
    """Return the pace of what several outputs send together: an observation of a topic sees all of them."""
    if len(paces) == 1 or None in paces:
        return paces[0] if len(paces) == 1 else None
    known_paces = [pace for pace in paces if pace is not None]
    # The largest gap is at most that of each; how close samples of different outputs come, nobody knows.
    return EventPace(
        None, add_values(pace.rate for pace in known_paces), smallest_value(pace.gap for pace in known_paces)
    )


def _compare_figure(
    analysis: Analysis, observation: Observation, key: str, measured: Fraction, pace: EventPace | None
) -> MeasuredComparison:
    """Compare one figure with what the design has for it."""
    name = observation.id
    if key in {"rate", "period"}:
        return _compare_rate(observation, key, measured, pace)
    activity, response = analysis.system.activities.get(name), analysis.responses.get(name)
    if key == "max_period":
        designed = pace.gap if pace else UNKNOWN_VALUE
    elif key == "min_period":
        designed = pace.distance if pace else UNKNOWN_VALUE
    elif key == "response":
        designed = response.worst if response else UNKNOWN_VALUE
    else:
        ticks = (activity.wcet if key == "wcet" else activity.bcet) if activity else None
        designed = TimingValue(ticks * analysis.system.tick) if ticks is not None else UNKNOWN_VALUE
    return _compare_bound(observation, key, designed, measured)


def _compare_rate(observation: Observation, key: str, measured: Fraction, pace: EventPace | None) -> MeasuredComparison:
    """Compare a mean rate or period: outlier if it is off by more than the tolerance, beyond the side of a bound."""
    name = observation.id
    rate = designed = pace.rate if pace else UNKNOWN_VALUE
    if key == "period":
        designed = (
            replace(rate, value=10**9 / rate.value, side=_OPPOSITE_SIDES[rate.side]) if rate.value else UNKNOWN_VALUE
        )
    if designed.value is None:
        return MeasuredComparison(name, key, designed, measured, "not designed")
    is_slower = (measured < designed.value) is (key == "rate")
    # What is sent at most so often (a conditional output) may come as rarely as it likes, and the reverse.
    is_allowed = rate.side == ("at most" if is_slower else "at least")
    allowed_difference = RATE_TOLERANCE * designed.value + observation.inaccuracies.get(key, 0)
    is_off = not is_allowed and abs(measured - designed.value) > allowed_difference
    why = (
        f"{'slower' if is_slower else 'faster'} than designed by more than {int(100 * RATE_TOLERANCE)} %"
        if is_off
        else ""
    )
    return MeasuredComparison(name, key, designed, measured, "outlier" if is_off else "as designed", why)


def _compare_bound(observation: Observation, key: str, designed: TimingValue, measured: Fraction) -> MeasuredComparison:
    """Compare an extreme: outlier only if it breaks the bound. A measurement never proves one."""
    name = observation.id
    is_upper_bound = key in _BROKEN_ABOVE
    if designed.value is None or not is_known_bound(designed, "at most" if is_upper_bound else "at least"):
        return MeasuredComparison(name, key, designed, measured, "not designed")
    excess = measured - designed.value if is_upper_bound else designed.value - measured
    is_broken = excess > observation.inaccuracies.get(key, 0)
    why = {**_BROKEN_ABOVE, **_BROKEN_BELOW}[key] if is_broken else ""
    return MeasuredComparison(name, key, designed, measured, "outlier" if is_broken else "as designed", why)


def _report_unknown(observation: Observation, known_ids: list[str]) -> Diagnostic:
    """Report an id that the design does not have."""
    message = f"no node, activity or topic is called `{observation.id}`"
    return Diagnostic("unknown-reference", message, observation.at, help=did_you_mean(observation.id, known_ids))
