"""How often things happen: in words, and as a step of the period scale."""

from __future__ import annotations

from fractions import Fraction

from archgen.timing import analysis
from archgen.views.graph_shapes import PeriodStep
from archgen.views.short_figures import shorten_text
from archgen.views.timing import value_format

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
    return _add_behaviour(_format_rate_figure(pace, " · "), pace)


def format_short_rate(pace: analysis.EventPace | None) -> str:
    """Format a rate on one line, of one that is bounded the bound only: `10 Hz · 100 ms`, `<= 10 Hz, event`."""
    return _add_behaviour(_format_short_figure(pace, " · "), pace)


def format_box_lines(pace: analysis.EventPace | None) -> tuple[str, ...]:
    """Format a rate for a box: rate and period, then the behaviour unless it is periodic."""
    rate_text = shorten_text(_format_short_figure(pace, " · "))
    # A long figure would widen the box: rate and period then get a line each.
    if len(rate_text) > _BOX_LINE_LENGTH:
        rate_text = rate_text.replace(" · ", "\n")
    return tuple(word for word in (*rate_text.split("\n"), _behaviour_word(pace)) if word) or ("?",)


def _add_behaviour(figure: str, pace: analysis.EventPace | None) -> str:
    return ", ".join(word for word in (figure, _behaviour_word(pace)) if word) or "?"


def _format_rate_figure(pace: analysis.EventPace | None, separator: str) -> str:
    """Format rate and period; empty where the rate is unknown or zero."""
    if pace is None or not pace.rate.value:
        return ""
    return f"{value_format.display_rate(pace.rate)}{separator}{value_format.display_period(pace.rate)}"


def _format_short_figure(pace: analysis.EventPace | None, separator: str) -> str:
    """Format rate and period; at most 10 Hz is at least 100 ms, which need not be said again."""
    if pace is None or not pace.rate.value or not value_format.bound_sign(pace.rate):
        return _format_rate_figure(pace, separator)
    return value_format.display_rate(pace.rate)


def _behaviour_word(pace: analysis.EventPace | None) -> str:
    """Return the word for a behaviour; empty for periodic ones, whose figures speak for themselves."""
    return _BEHAVIOUR_WORDS.get(pace.behaviour or "", "") if pace else ""
