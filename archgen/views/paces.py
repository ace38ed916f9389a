"""How often things happen: in words, and as a step of the period scale."""

from __future__ import annotations

from fractions import Fraction

from archgen.timing import analysis
from archgen.views import figures
from archgen.views.shapes import Pace

_STEPS: tuple[tuple[int, Pace], ...] = (
    (10, "to_10_ms"),
    (30, "to_30_ms"),
    (100, "to_100_ms"),
    (300, "to_300_ms"),
    (1000, "to_1_s"),
)
"""Longest period of each step in ms, shortest first."""
NAMES: dict[Pace, str] = {
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
_LINE = 24
"""Characters on one line of a box."""
_WORDS = {"event": "event", "on_demand": "on demand", "once": "once"}


def step(pace: analysis.Pace | None) -> Pace:
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
        return next((name for most, name in _STEPS if milliseconds <= most), "slower")
    return "event" if pace.behaviour == "event" else "unknown"


def said(pace: analysis.Pace | None) -> str:
    """Format a rate on one line: `10 Hz · 100 ms`, `<= 10 Hz · >= 100 ms, event`, `on demand`, `?`."""
    return ", ".join(word for word in (_figure(pace, " · "), _kind(pace)) if word) or "?"


def lines(pace: analysis.Pace | None) -> tuple[str, ...]:
    """Format a rate for a box: rate and period, then the behaviour unless it is periodic."""
    figure = _figure(pace, " · ")
    # A long figure would widen the box; rate and period then get a line each.
    if len(figure) > _LINE:
        figure = _figure(pace, "\n")
    return tuple(word for word in (*figure.split("\n"), _kind(pace)) if word) or ("?",)


def _figure(pace: analysis.Pace | None, between: str) -> str:
    """Format rate and period; empty where the rate is unknown or zero."""
    if pace is None or not pace.rate.value:
        return ""
    return f"{figures.rate(pace.rate)}{between}{figures.period(pace.rate)}"


def _kind(pace: analysis.Pace | None) -> str:
    """Return the word for a behaviour; empty for periodic ones, whose figures speak for themselves."""
    return _WORDS.get(pace.behaviour or "", "") if pace else ""


def sentence(pace: analysis.Pace, origin: tuple[str, ...]) -> str:
    """Format a rate with its origins: `10 Hz, from scanner`; empty where nothing is known."""
    words = said(pace)
    if words == "?":
        return ""
    source = figures.from_words(origin) if pace.inferred and pace.rate.value else ""
    return f"{words}, {source}" if source else words
