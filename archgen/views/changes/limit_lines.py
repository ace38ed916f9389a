"""What became of promises and freshness, as lines of a comparison; and one line for all figures that hardly moved."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.compare import Comparison
from archgen.compare.figure_changes import LimitChange
from archgen.compare.figure_noise import FigureNoise
from archgen.compare.limit_wording import describe_growth, describe_limit
from archgen.compare.sentence_words import tick_names
from archgen.diagnostics.rule_options import format_percentage
from archgen.views.changes.figure_lines import FigureLine
from archgen.views.inline_text import count_noun

_WORDS = {
    ("kept", "unknown"): "{} is no longer shown to be kept",
    ("broken", "kept"): "{} is kept again",
    ("unknown", "kept"): "{} is shown to be kept now",
    ("broken", "unknown"): "{} was broken, and nobody knows it any more",
    ("broken", "broken"): "{} is broken by more than before",
}
"""What is told of the states before and after. What is broken newly is a finding, and mostly a break."""


def write_limit_lines(comparison: Comparison) -> Iterator[FigureLine]:
    """Yield a line for each promise and each freshness that is kept otherwise than before, where no break says so."""
    told = {each.fallen for change in comparison.changes for each in change.breaks}
    noise = comparison.after.architecture.review.noise
    for limit in comparison.limits:
        words = _WORDS.get((limit.old_state, limit.new_state))
        is_silent = limit.new_state == "broken" and not _is_worse(limit, noise)
        if words and not is_silent and (limit.port, limit.key) not in told:
            lead = "warning: " if limit.has_fallen else ""
            yield FigureLine("changed", f"{lead}{words.format(describe_limit(limit))} ({describe_growth(limit)})")


def _is_worse(limit: LimitChange, noise: Fraction) -> bool:
    old_value, new_value = limit.before.value, limit.after.value
    if old_value is None or new_value is None:
        return new_value is None and old_value is not None
    return new_value < old_value * (1 - noise) if limit.key == "rate" else new_value > old_value * (1 + noise)


def write_noise_line(noise: FigureNoise) -> Iterator[FigureLine]:
    """Yield one line for all figures that moved too little to be told one by one: how many, and the largest."""
    moves = list(noise.list_moves())
    if moves:
        largest = max(moves, key=lambda move: move.share)
        which = f"{largest.figure} of {tick_names([largest.element])}"
        share = format_percentage(max(Fraction(round(largest.share * 1000), 1000), Fraction(1, 1000)))
        threshold = format_percentage(noise.threshold)
        yield FigureLine(
            "changed",
            f"{count_noun(len(moves), 'figure')} moved by less than {threshold} and changed no verdict"
            f"{'; the most' if len(moves) > 1 else ''}: {which}, by {share}",
        )
