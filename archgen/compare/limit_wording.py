"""Promises and freshness in words: what is asked, and what follows from the figures of two versions."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.analyses.kept_promises import PROMISED_WORDS
from archgen.compare.figure_changes import LimitChange
from archgen.compare.sentence_words import tick_names
from archgen.timing.figures.figure_wording import format_compared, format_duration, format_rate
from archgen.timing.figures.timing_values import TimingValue


def describe_limit(limit: LimitChange) -> str:
    """Name what is asked: `the promise of x of gaps of at most 130 ms`."""
    if limit.key == "freshness":
        return f"the freshness of {limit.limit} of what {tick_names([limit.port])} reads"
    if limit.key == "qos.deadline":
        return f"the deadline of {limit.limit} that is offered for {tick_names([limit.port])}"
    if limit.key == "timing.max_gap":
        return f"the largest gap of {limit.limit} of {tick_names([limit.port])}"
    return f"the promise of {tick_names([limit.port])} of {PROMISED_WORDS[limit.key]}{limit.limit}"


def describe_growth(limit: LimitChange) -> str:
    """Return what followed from the figures before, and what does now: `112 ms → 172 ms`."""
    values = [value.value for value in (limit.before, limit.after) if value.value is not None]
    is_rate = limit.key == "rate"
    write = format_rate if is_rate else format_duration
    texts = iter(format_compared(values, write, upwards=not is_rate, limit=limit.limit.value))
    phrases = [_describe_value(value, texts) for value in (limit.before, limit.after)]
    return phrases[1] if phrases[0] == phrases[1] else " → ".join(phrases)


def _describe_value(value: TimingValue, texts: Iterator[str]) -> str:
    text = next(texts) if value.value is not None else "no bound"
    if value.missing and not value.complete:
        return f"not known without figures of {tick_names(sorted(value.missing), 4)}"
    return text
