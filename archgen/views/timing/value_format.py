"""Exact values of the timing analysis in human units, with their bounds and with what is missing."""

from __future__ import annotations

from collections.abc import Callable
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Decimal
from fractions import Fraction
from functools import lru_cache, partial

from archgen.diagnostics import join_first
from archgen.frozen import replace
from archgen.timing import analysis
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.core_placement import is_missing_cores
from archgen.views.picture_shapes import PeriodStep
from archgen.views.short_figures import shorten_text

_SIDE_SIGNS = {"exact": "", "at least": ">= ", "at most": "<= "}
_BYTE_UNITS = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"), (1, "B"))
"""Units of size, largest first: the first one that is not too large is used."""
_SECONDS_FROM = 10 * 10**9
"""Durations from ten seconds on are written in s instead of ms; in ns."""
_MAX_NAMED_ORIGINS = 3
"""At most this many origins of a rate are named."""
_DEFAULT_DIGITS = 3
UNKNOWN_FIGURE = "unknown"
"""What every formatter returns for an unknown value; callers compare with it to mute the cell."""
_UNBOUNDED_WORDS = {
    "overload": "no bound: the host is overloaded",
    "unbounded": "unbounded",
    "diverged": "no bound found",
}
"""Words for a value that does not exist, by the first word of the assumption that explains it."""


@lru_cache(8192)
def display_number(value: Fraction, decimals: int = _DEFAULT_DIGITS, rounding: str = ROUND_HALF_UP) -> str:
    """Format a number with at most `decimals` decimals, rounded half up unless `rounding` says otherwise.

    Numbers below one get as many significant digits instead.
    """
    if not value:
        return "0"
    # Decimal, not float: otherwise "half up" would depend on how a half is represented in binary.
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    places = decimals if abs(value) >= 1 else decimals - 1 - exact.adjusted()
    rounded = exact.quantize(Decimal(1).scaleb(-places), rounding)
    text = f"{rounded:f}"
    # Only behind a decimal point: the zeros of 100 are part of the number.
    return text.rstrip("0").rstrip(".") if "." in text else text


def display_duration(value: TimingValue) -> str:
    """Format the upper bound of a duration (in ns) in ms, or in s from ten seconds on.

    "At most" goes without a sign because documents present these figures as bounds. A sum with gaps gets ">=", since it
    is no upper bound at all.
    """
    is_partial = not value.complete and value.side != "at most"
    return _format_value(
        replace(value, side="at least" if is_partial else "exact", complete=not is_partial),
        partial(_format_time, rounding=ROUND_FLOOR if is_partial else ROUND_CEILING),
    )


def display_lower_bound(value: TimingValue) -> str:
    """Format the lower bound of a duration (in ns)."""
    # Without `complete` and `side`: a lower bound stays one, whatever was left out of it.
    lower_bound = TimingValue(value.value, assumptions=value.assumptions)
    return _format_value(lower_bound, partial(_format_time, rounding=ROUND_FLOOR))


@lru_cache(8192)  # a large architecture has few different figures, each on several pages and pictures
def _format_time(nanoseconds: Fraction, rounding: str) -> str:
    factor, unit = (10**6, "ms") if nanoseconds < _SECONDS_FROM else (10**9, "s")
    return f"{display_number(nanoseconds / factor, rounding=rounding)} {unit}"


def display_rate(value: TimingValue) -> str:
    """Format a rate in Hz."""
    return _format_value(value, lambda hertz: f"{display_number(hertz)} Hz")


def display_share(value: TimingValue) -> str:
    """Format a share of a whole in percent."""
    return _format_value(value, lambda fraction: f"{display_number(fraction * 100, 1)} %")


def display_bytes(value: TimingValue) -> str:
    """Format a number of bytes in the largest unit that leaves at least one."""
    return _format_value(value, _format_size)


def display_traffic(value: TimingValue) -> str:
    """Format bytes per second in the largest unit that leaves at least one."""
    return _format_value(value, lambda byte_rate: f"{_format_size(byte_rate)}/s")


@lru_cache(8192)
def _format_size(byte_count: Fraction) -> str:
    factor, unit = next(((factor, unit) for factor, unit in _BYTE_UNITS if byte_count >= factor), (1, "B"))
    return f"{display_number(byte_count / factor)} {unit}"


def bound_sign(value: TimingValue) -> str:
    """Return the sign before a value that bounds from one side; a sum with gaps is at least what is known."""
    if value.side == "exact" and not value.complete:
        return ">= "
    return _SIDE_SIGNS[value.side]


def _format_value(value: TimingValue, format_known: Callable[[Fraction], str]) -> str:
    """Format a value with its sign, or say why there is none."""
    if value.value is None:
        reasons = (text.partition(":")[0].strip() for text in value.assumptions)
        return next((_UNBOUNDED_WORDS[reason] for reason in reasons if reason in _UNBOUNDED_WORDS), UNKNOWN_FIGURE)
    if not value.value and bound_sign(value) == ">= ":
        return UNKNOWN_FIGURE  # at least zero says nothing, and a zero would look as if somebody had written it
    return bound_sign(value) + format_known(value.value)


def display_period(value: TimingValue) -> str:
    """Format the period in ms of a rate in Hz; a rate of at most r has a period of at least 1/r."""
    if not value.value:
        return ""
    inverse_sign = {">= ": "<= ", "<= ": ">= "}.get(bound_sign(value), "")
    return inverse_sign + _format_time(10**9 / value.value, ROUND_HALF_UP)


def display_bound(value: TimingValue, analysis: Analysis) -> str:
    """Format a duration with what is missing for a bound: `>= 468 ms; no bound: execution time of x, y unknown`."""
    missing_text = describe_missing(value, analysis)
    duration_text = display_duration(value)
    if not missing_text:
        return duration_text
    return f"no bound: {missing_text}" if value.value is None else f"{duration_text}; no bound: {missing_text}"


def describe_missing(value: TimingValue, analysis: Analysis, limit: int | None = None) -> str:
    """Describe which figures of which elements are missing: `execution time of x, y unknown`; empty for none.

    At most `limit` elements are named for each kind of figure, None for all.
    """
    if not value.missing:
        return ""
    names_by_lack: dict[str, list[str]] = {}
    for name in dict.fromkeys(value.missing):
        names_by_lack.setdefault(_describe_lack(name, analysis), []).append(name)
    # What is no figure of an element has words of its own.
    other_phrases = [_describe_other_lack(name) for name in names_by_lack.pop("", ())]
    phrases = [f"{lack} {join_first(names, limit or len(names))}" for lack, names in names_by_lack.items()]
    unknown_text = [f"{' and '.join(phrases)} unknown"] if phrases else []
    return "; ".join((*unknown_text, *other_phrases))


def _describe_other_lack(missing_name: str) -> str:
    """Describe a lack that is no element's: `cores of pc not written`, `no link joins head and tablet`."""
    if is_missing_cores(missing_name):
        return f"{missing_name} not written"
    return f"no link joins {' and '.join(missing_name.split(' - '))}"


def _describe_lack(element_id: str, analysis: Analysis) -> str:
    """Describe what is missing of an element: a link's latency, an execution time, a rate, else "figures".

    Empty for what is missing beside all elements: a number of cores, a link between two hosts.
    """
    activity = analysis.system.activities.get(element_id)
    if is_missing_cores(element_id) or " - " in element_id:
        return ""
    if activity is None:
        return "latency of" if element_id in analysis.links else "figures of"
    # The most basic lack first: without an execution time there is no response, and without that no bound.
    if activity.wcet is None and activity.response is None:
        return "execution time of"
    pace = analysis.paces.get(element_id)
    return "rate of" if pace is None or pace.gap.value is None else "figures of"


def find_rate_origins(analysis: Analysis) -> dict[str, tuple[str, ...]]:
    """Find for each activity with an inferred rate the activities that it is inferred from, at most four.

    Rates spread along triggers from the activities where they were written. Rings end: the sets only grow and are
    bounded. Returns ids in the order of the analysis.
    """
    origin_ids: dict[str, tuple[str, ...]] = {
        name: (name,) for name, pace in analysis.paces.items() if not pace.inferred and pace.rate.value is not None
    }
    declared_ids = set(origin_ids)
    pending = list(origin_ids)
    while pending:
        name = pending.pop()
        for arc in analysis.system.arcs_from.get(name, ()):
            target = analysis.system.activities.get(arc.target)
            # A written rate is an origin of its own, so those before it do not count.
            if target is None or arc.role == "answer" or arc.target in declared_ids:
                continue
            # Data that is read but triggers nothing has no influence on the rate.
            if arc.role == "data" and arc.input not in target.triggers:
                continue
            # One more than is named, so that "and others" can be told from exactly three.
            merged_origins = tuple(dict.fromkeys((*origin_ids.get(arc.target, ()), *origin_ids[name])))[
                : _MAX_NAMED_ORIGINS + 1
            ]
            if merged_origins != origin_ids.get(arc.target):
                origin_ids[arc.target] = merged_origins
                pending.append(arc.target)
    order = {name: position for position, name in enumerate(analysis.paces)}
    return {
        name: tuple(sorted(root_ids, key=order.__getitem__))
        for name, root_ids in origin_ids.items()
        if name not in declared_ids
    }


_PERIOD_STEPS: tuple[tuple[int, PeriodStep], ...] = (
    (10, "to_10_ms"),
    (30, "to_30_ms"),
    (100, "to_100_ms"),
    (300, "to_300_ms"),
    (1000, "to_1_s"),
)
"""Longest period of each step in ms, shortest first."""
PERIOD_STEP_WORDS: dict[PeriodStep, str] = {
    "to_10_ms": "up to 10 ms",
    "to_30_ms": "up to 30 ms",
    "to_100_ms": "up to 100 ms",
    "to_300_ms": "up to 300 ms",
    "to_1_s": "up to 1 s",
    "slower": "longer",
    "event": "on an event, rate not known",
    "on_demand": "on demand",
    "once": "once, at the start",
    "unknown": "unknown",
}
"""The steps of the scale in words, in the order of legends and tables."""
_BOX_LINE_LENGTH = 24
"""Characters on one line of a box."""
_BEHAVIOUR_WORDS = {"event": "event", "on_demand": "on demand", "once": "once"}


def longest_period(step: PeriodStep) -> str | None:
    """Return the longest period of a step in ns, as the number that tables sort by; None where it has none."""
    return next((str(milliseconds * 10**6) for milliseconds, name in _PERIOD_STEPS if name == step), None)


def find_period_step(pace: analysis.EventPace | None) -> PeriodStep:
    """Return the step of the scale: by the period where a rate is known, else by the behaviour."""
    if pace is None:
        return "unknown"
    # Before the rate: an activity that is called on demand may have a rate, but no period of its own to colour it by.
    if pace.behaviour == "once":
        return "once"
    if pace.behaviour == "on_demand":
        return "on_demand"
    if pace.rate.value:
        milliseconds = Fraction(1000) / pace.rate.value
        return next(
            (period_step for longest_period, period_step in _PERIOD_STEPS if milliseconds <= longest_period), "slower"
        )
    return "event" if pace.behaviour == "event" else "unknown"


def format_rate_words(pace: analysis.EventPace | None) -> str:
    """Format a rate on one line: `10 Hz · 100 ms`, `<= 10 Hz · >= 100 ms, event`, `on demand`, `?`."""
    return _add_behaviour(_format_rate_figure(pace), pace)


def format_short_rate(pace: analysis.EventPace | None) -> str:
    """Format a rate on one line, of one that is bounded the bound only: `10 Hz · 100 ms`, `<= 10 Hz, event`."""
    return _add_behaviour(_format_short_figure(pace), pace)


def format_box_lines(pace: analysis.EventPace | None) -> tuple[str, ...]:
    """Format a rate for a box: rate and period, then the behaviour unless it is periodic."""
    rate_text = shorten_text(_format_short_figure(pace))
    # A long figure would widen the box: rate and period then get a line each.
    if len(rate_text) > _BOX_LINE_LENGTH:
        rate_text = rate_text.replace(" · ", "\n")
    return tuple(word for word in (*rate_text.split("\n"), _behaviour_word(pace)) if word) or ("?",)


def _add_behaviour(figure: str, pace: analysis.EventPace | None) -> str:
    return ", ".join(word for word in (figure, _behaviour_word(pace)) if word) or "?"


def _format_rate_figure(pace: analysis.EventPace | None) -> str:
    """Format rate and period; empty where the rate is unknown or zero."""
    if pace is None or not pace.rate.value:
        return ""
    return f"{display_rate(pace.rate)} · {display_period(pace.rate)}"


def _format_short_figure(pace: analysis.EventPace | None) -> str:
    """Format rate and period; at most 10 Hz is at least 100 ms, which need not be said again."""
    if pace is None or not pace.rate.value or not bound_sign(pace.rate):
        return _format_rate_figure(pace)
    return display_rate(pace.rate)


def _behaviour_word(pace: analysis.EventPace | None) -> str:
    """Return the word for a behaviour; empty for periodic ones, whose figures speak for themselves."""
    return _BEHAVIOUR_WORDS.get(pace.behaviour or "", "") if pace else ""
