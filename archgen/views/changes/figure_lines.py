"""Changed figures as sentences: of interfaces between partners, promises and freshness, the loads of hosts and links."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.compare import Comparison
from archgen.compare.comparison import ChangeKind
from archgen.compare.figure_changes import (
    ComparedFigure,
    FigureChange,
    FigureKey,
    LimitChange,
    LoadChange,
    TravelPath,
    WireNames,
)
from archgen.compare.figure_noise import FigureNoise
from archgen.compare.limit_wording import describe_growth, describe_limit
from archgen.compare.sentence_words import tick_names
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.rule_options import format_percentage
from archgen.frozen import dataclass, replace
from archgen.model.node import Qos
from archgen.timing.figures.figure_wording import round_compared
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.changes.partner_names import name_each
from archgen.views.inline_text import count_noun, list_qos_settings
from archgen.views.timing import value_format

_FIGURE_WORDS: Mapping[str, Callable[[TimingValue], str]] = {
    "rate": value_format.display_rate,
    "traffic": value_format.display_traffic,
    **dict.fromkeys(("largest gap", "answers within", "age on arrival"), value_format.display_duration),
}
"""How a figure is written, by its name; all others are sizes."""
_NO_FIGURE = "none"


@dataclass(frozen=True, slots=True)
class FigureLine:
    """A sentence about figures, with what happened to what it is about; names in backticks."""

    kind: ChangeKind
    text: str


def describe_figure(figure: FigureChange, kind: str) -> str:
    """Describe a figure before and after; of a new interface as it is."""
    name = f"{figure.key.name} of `{figure.key.node}`" if figure.key.node else figure.key.name
    before, after = figure.before, figure.after
    if kind == "added":
        return f"{name} {_format_figure(figure.key, after)}"
    if isinstance(before, Qos) and isinstance(after, Qos):
        old_settings, new_settings = list_qos_settings(before), list_qos_settings(after)
        lost = [setting for setting in old_settings if setting not in new_settings]
        gained = [setting for setting in new_settings if setting not in old_settings]
        return f"{name} {', '.join(lost) or _NO_FIGURE} → {', '.join(gained) or _NO_FIGURE}"
    if isinstance(before, TimingValue) and isinstance(after, TimingValue):
        return f"{name} {_format_pair(figure.key, before, after)}"
    lead = "travels" if isinstance(before, TravelPath) or isinstance(after, TravelPath) else name
    return f"{lead} {_format_figure(figure.key, before)} → {_format_figure(figure.key, after)}"


def _format_pair(key: FigureKey, before: TimingValue, after: TimingValue) -> str:
    """Return two figures with the digits that inputs carry; a rate is rounded down, all else up."""
    values = [each.value for each in (before, after) if each.value is not None]
    rounded = dict(zip(values, round_compared(values, upwards=key.name != "rate"), strict=True))
    texts = []
    for each in (before, after):
        told = each if each.value is None else replace(each, value=rounded[each.value])
        texts.append(("" if told == each else "~") + _format_figure(key, told))
    return " → ".join(texts)


def _format_figure(key: FigureKey, figure: ComparedFigure | None) -> str:
    if isinstance(figure, Qos):
        return ", ".join(list_qos_settings(figure))
    if isinstance(figure, TravelPath):
        return _format_path(figure)
    if isinstance(figure, WireNames):
        return tick_names(figure.names)
    return _FIGURE_WORDS.get(key.name, value_format.display_bytes)(figure) if figure else _NO_FIGURE


def _format_path(path: TravelPath) -> str:
    """Describe between which hosts data travels."""
    if path.senders == path.receivers:
        return f"within {tick_names(path.senders)}"
    link_note = f" over {tick_names(path.links)}" if path.links else ""
    return f"from {tick_names(path.senders)} to {tick_names(path.receivers)}{link_note}"


def write_load_lines(comparison: Comparison, partner_names: Mapping[str, str]) -> tuple[FigureLine, ...]:
    """Return a line for each host and link whose load changed noticeably."""
    noise = FigureNoise(comparison)
    return tuple(
        FigureLine("changed", _describe_load(change, partner_names))
        for change in comparison.loads
        if not noise.is_small_load(change)
    )


def _describe_load(change: LoadChange, partner_names: Mapping[str, str]) -> str:
    before = value_format.display_share(change.before) if change.before else _NO_FIGURE
    users = join_partners(sorted(change.users), partner_names)
    what = "bandwidth" if change.kind == "link" else "cores"
    user_note = f"; used by {users}" if users else ""
    return f"{change.kind} {tick_names([change.id])}: {before} → {value_format.display_share(change.after)} of its {what}{user_note}"


def join_partners(partners: Iterable[str], partner_names: Mapping[str, str]) -> str:
    """Return partners by what people call them, joined for a sentence."""
    return join_words(name_each(partners, partner_names))


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
