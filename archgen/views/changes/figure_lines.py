"""Changed figures as sentences (of interfaces between partners, of hosts and links) and as rows of the table of chains."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.compare import ChainChange, Comparison
from archgen.compare.asked_limits import describe_growth, describe_limit
from archgen.compare.comparison import (
    ChangeKind,
    ComparedFigure,
    FigureChange,
    FigureKey,
    LimitChange,
    LoadChange,
    TravelPath,
    WireNames,
)
from archgen.compare.figure_noise import FigureNoise
from archgen.compare.key_phrases import name_key, tick_names
from archgen.diagnostics import join_words, keep_first
from archgen.diagnostics.rule_options import format_percentage
from archgen.frozen import dataclass, replace
from archgen.model.node import Qos
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import (
    format_compared,
    format_compared_bounds,
    format_duration,
    round_compared,
)
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.changes.named_elements import name_each
from archgen.views.inline_text import count_noun, list_qos_settings
from archgen.views.timing import value_format

_MAX_CAUSES = 3
MINUS_SIGN = "\u2212"


@dataclass(frozen=True, slots=True)
class ChainRow:
    """A chain whose bound or deadline changed. `growth`, `deadline` and `verdict` are empty where there is none."""

    id: str
    before: str
    after: str
    growth: str
    """Signed: `+40 ms`, or with a true minus."""
    deadline: str
    verdict: str
    reason: str
    """What made the bound another: elements, with what changed of them; names in backticks."""

    @property
    def says_a_change(self) -> bool:
        """Whether anything reads otherwise than before."""
        return self.before != self.after or bool(self.growth) or "→" in self.deadline or "(was " in self.verdict


def make_chain_row(chain_change: ChainChange, *, is_only_edit: bool = False) -> ChainRow:
    """Return the row of a chain. Where there is only one edit, nobody asks for the reason."""
    before, after = _format_bounds(chain_change)
    return ChainRow(
        chain_change.id,
        before,
        after,
        _format_growth(chain_change),
        _format_deadline(chain_change),
        _format_verdict(chain_change),
        "" if is_only_edit else _format_causes(chain_change),
    )


def _format_causes(chain_change: ChainChange) -> str:
    """Name the elements behind another bound, each with what changed of it; the sentences stand with the changes."""
    keys_by_element: dict[str, list[str]] = {}
    for change in chain_change.causes:
        if (change.element_kind, change.element_id) == ("chain", chain_change.id):
            return "where it leads now"  # nothing else is looked for then
        words = name_key(change.element_kind, change.key) if change.key else change.kind
        keys_by_element.setdefault(change.element_id, []).append(words)
    phrases = [f"`{name}` ({join_words(list(dict.fromkeys(words)))})" for name, words in keys_by_element.items()]
    return join_words(keep_first(phrases, _MAX_CAUSES))


def _format_bounds(chain_change: ChainChange) -> Iterator[str]:
    """Yield how long a chain takes at most, before and after."""
    results = chain_change.before, chain_change.after
    deadline = chain_change.deadline.value if chain_change.deadline else None
    texts = iter(format_compared_bounds([each.bound for each in results if each], deadline))
    yield from ("not there" if result is None else next(texts) for result in results)


def _format_growth(chain_change: ChainChange) -> str:
    """Format by how much a bound grew or shrank; empty if that is unknown or nothing."""
    # The difference to an "at least" is no difference.
    old_bound, new_bound = (
        chain_result.bound.value if chain_result and chain_result.bound.complete else None
        for chain_result in (chain_change.before, chain_change.after)
    )
    if old_bound is None or new_bound is None or old_bound == new_bound:
        return ""
    return f"{'+' if new_bound > old_bound else MINUS_SIGN}{format_compared([abs(new_bound - old_bound)], format_duration)[0]}"


def _format_deadline(chain_change: ChainChange) -> str:
    """Format the deadline of the second version; if it changed, with the old one."""
    old_deadline, new_deadline = (
        _format_result_deadline(chain_result) for chain_result in (chain_change.before, chain_change.after)
    )
    if chain_change.before and chain_change.after and old_deadline != new_deadline:
        return f"{old_deadline or 'none'} → {new_deadline or 'none'}"
    return new_deadline or old_deadline


def _format_result_deadline(result: ChainResult | None) -> str:
    return format_duration(result.deadline.value) if result and result.deadline and result.deadline.value else ""


def _format_verdict(chain_change: ChainChange) -> str:
    """Format whether the deadline is met, and whether it was before if that differs."""
    old_verdict, new_verdict = (
        chain_result.verdict if chain_result and chain_result.deadline and chain_result.deadline.value else ""
        for chain_result in (chain_change.before, chain_change.after)
    )
    if not new_verdict:
        return ""
    return f"{new_verdict} (was {old_verdict})" if old_verdict and old_verdict != new_verdict else new_verdict


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
    """Describe a figure before and after, empty where both read the same; of a new interface as it is."""
    name = f"{figure.key.name} of `{figure.key.node}`" if figure.key.node else figure.key.name
    before, after = figure.before, figure.after
    if kind == "added":
        return f"{name} {_format_figure(figure.key, after)}"
    if isinstance(before, Qos) and isinstance(after, Qos):
        old_settings, new_settings = list_qos_settings(before), list_qos_settings(after)
        lost = [setting for setting in old_settings if setting not in new_settings]
        gained = [setting for setting in new_settings if setting not in old_settings]
        texts = [", ".join(settings) or _NO_FIGURE for settings in (lost, gained)]
    elif isinstance(before, TimingValue) and isinstance(after, TimingValue):
        texts = _format_pair(figure.key, before, after)
    else:
        name = "travels" if isinstance(before, TravelPath) or isinstance(after, TravelPath) else name
        texts = [_format_figure(figure.key, each) for each in (before, after)]
    return f"{name} {texts[0]} → {texts[1]}" if texts[0] != texts[1] else ""


def _format_pair(key: FigureKey, before: TimingValue, after: TimingValue) -> list[str]:
    """Return two figures with the digits that inputs carry; a rate is rounded down, all else up."""
    values = [each.value for each in (before, after) if each.value is not None]
    rounded = dict(zip(values, round_compared(values, upwards=key.name != "rate"), strict=True))
    texts = []
    for each in (before, after):
        told = each if each.value is None else replace(each, value=rounded[each.value])
        texts.append(("" if told == each else "~") + _format_figure(key, told))
    return texts


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
    readers: dict[tuple[str, str], list[str]] = {}
    for limit in comparison.limits:
        words = _WORDS.get((limit.old_state, limit.new_state))
        is_silent = limit.new_state == "broken" and not _is_worse(limit, noise)
        if words and not is_silent and (limit.port, limit.key) not in told:
            lead = "warning: " if limit.has_fallen else ""
            sentence = f"{lead}{words.format(describe_limit(limit))}"
            readers.setdefault((sentence, describe_growth(limit)), []).append(limit.reader)
    for (sentence, growth), names in readers.items():
        # An age is told where it is read; readers of whom the same holds stand in one line.
        where = f", where {tick_names(names, 3)} read{'s' * (len(names) == 1)} it" if any(names) else ""
        yield FigureLine("changed", f"{sentence}{where} ({growth})")


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
