"""What changed between partners, as few lines as say it: each interface by itself, and once what happened to many of them.

The same change at several interfaces is one line. So is all that arrives sooner, and all that is no longer known or has no
bound any more: these follow from one cause, which stands among the changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.compare import Comparison
from archgen.compare.comparison import BoundaryChange, ChangeKind, FigureChange, TravelPath
from archgen.compare.figure_noise import FigureNoise
from archgen.compare.interface_figures import DELAY_NAMES
from archgen.compare.key_phrases import tick_names
from archgen.diagnostics import join_words
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.timing.figures.figure_wording import format_compared, format_duration
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.changes.figure_lines import FigureLine, describe_figure, join_partners
from archgen.views.timing.value_format import UNKNOWN_FIGURE, display_duration

_GAP, _AGE = "largest gap", "age on arrival"
_UNKNOWN_LEAD, _UNBOUNDED_LEAD = "no figures any more", "no bound any more"
_PHRASES = {"answers within": "the time of an answer"}
_MAX_NAMES, _MAX_ENDS = 4, 4
"""How many kinds of figures, and how many pairs of partners, one line names; the rest is counted."""
_NEW_OUTPUT_NAMES = frozenset({"rate", "answers within"})
"""What is told about the interface of a new output, which is a change of its own."""


@dataclass(frozen=True, slots=True)
class _Boundary:
    """A changed interface with the figures that are told of it, and those that it has no longer."""

    change: BoundaryChange
    figures: tuple[FigureChange, ...]
    lost_lead: str
    lost_names: tuple[str, ...]

    @property
    def is_sooner(self) -> bool:
        """Whether all that changed is that something arrives or is answered sooner."""
        is_told = self.change.kind == "changed" and not self.change.old_givers and not self.change.old_takers
        return bool(is_told and self.figures and not self.change.old_id and all(map(_is_sooner, self.figures)))


def write_boundary_lines(comparison: Comparison, partner_names: Mapping[str, str]) -> tuple[FigureLine, ...]:
    """Return what changed between partners: lines of single interfaces, then those of many."""
    elements_after, noise = comparison.versions.elements_after, FigureNoise(comparison)
    boundaries = [
        _describe_boundary(change, comparison, noise)
        for change in comparison.boundaries
        # An output that is gone is a change of its own.
        if change.kind != "removed"
        or ("output", change.interface_id) in elements_after
        or "." not in change.interface_id
    ]
    sooner = [boundary for boundary in boundaries if boundary.is_sooner]
    is_joint = len(sooner) > 1
    singles = [boundary for boundary in boundaries if not (is_joint and boundary.is_sooner)]
    lines = [*_write_singles(singles, partner_names)]
    if is_joint:
        lines += _write_sooner(sooner, partner_names)
    for lead in (_UNBOUNDED_LEAD, _UNKNOWN_LEAD):
        losers = [boundary for boundary in boundaries if boundary.lost_lead == lead]
        lines += (FigureLine("changed", f"{lead}: {text}") for text in _list_by_names(losers, partner_names))
    return tuple(lines)


def _describe_boundary(change: BoundaryChange, comparison: Comparison, noise: FigureNoise) -> _Boundary:
    if change.kind != "changed":
        is_new = ("output", change.interface_id) not in comparison.versions.elements_before
        figures = [figure for figure in change.figures if _is_told_of_new(figure, is_new=is_new)]
        return _Boundary(change, tuple(figures), "", ())
    leads = {figure: _find_loss(figure) for figure in change.figures}
    names_by_lead = {
        lead: tuple(dict.fromkeys(figure.key.name for figure in change.figures if leads[figure] == lead))
        for lead in (_UNBOUNDED_LEAD, _UNKNOWN_LEAD)
    }
    # How old data without a bound is, nobody asks.
    lost_lead = next((lead for lead, names in names_by_lead.items() if names), "")
    remaining = [figure for figure in change.figures if not leads[figure]]
    figures = [
        figure
        for figure in remaining
        if not (
            _follows_from_others(figure, change.figures)
            or _has_same_hosts(figure)
            or noise.is_small_figure(change, figure)
        )
    ]
    return _Boundary(change, tuple(figures), lost_lead, names_by_lead.get(lost_lead, ()))


def _is_told_of_new(figure: FigureChange, *, is_new: bool) -> bool:
    names = _NEW_OUTPUT_NAMES
    is_known = isinstance(figure.after, TimingValue) and figure.after.value is not None
    return is_known and (figure.key.name in names if is_new else figure.key.name not in {_AGE, "traffic"})


def _find_loss(figure: FigureChange) -> str:
    """Return the lead of the line of what is lost: a figure that nobody knows any more, or that has no bound; else nothing."""
    before, after = figure.before, figure.after
    if before is None or (isinstance(before, TimingValue) and before.value is None):
        return ""
    if after is None:
        return _UNKNOWN_LEAD
    if not isinstance(before, TimingValue) or not isinstance(after, TimingValue):
        return ""
    if after.value is None:
        return _UNKNOWN_LEAD if display_duration(after) == UNKNOWN_FIGURE else _UNBOUNDED_LEAD
    return _UNKNOWN_LEAD if before.complete and not after.complete else ""


def _follows_from_others(figure: FigureChange, figures: Iterable[FigureChange]) -> bool:
    """Whether a figure follows from another one that is told: traffic from the rate, an age from what comes later anyway."""
    others = {other.key.name: other for other in figures if other.key.node in {"", figure.key.node}}
    if figure.key.name == "traffic":
        return "rate" in others and "size" not in others
    gap = others.get(_GAP)
    return figure.key.name == _AGE and gap is not None and _grows_within(_measure_growth(figure), _measure_growth(gap))


def _has_same_hosts(figure: FigureChange) -> bool:
    """Whether data only takes other links between the same hosts: that is the change of a link, told there."""
    ends = [(path.senders, path.receivers) for path in (figure.before, figure.after) if isinstance(path, TravelPath)]
    return len(ends) > 1 and ends[0] == ends[1]


def _grows_within(growth: Fraction | None, limit: Fraction | None) -> bool:
    return growth is not None and limit is not None and growth * limit > 0 and abs(growth) <= abs(limit)


def _measure_growth(figure: FigureChange) -> Fraction | None:
    before, after = figure.before, figure.after
    if not isinstance(before, TimingValue) or not isinstance(after, TimingValue):
        return None
    return None if before.value is None or after.value is None else after.value - before.value


def _is_sooner(figure: FigureChange) -> bool:
    growth = _measure_growth(figure)
    return figure.key.name in DELAY_NAMES and growth is not None and growth < 0


def _write_sooner(boundaries: Sequence[_Boundary], partner_names: Mapping[str, str]) -> Iterator[FigureLine]:
    gains = [-(_measure_growth(figure) or 0) for boundary in boundaries for figure in boundary.figures]
    (most,) = format_compared([Fraction(max(gains))], format_duration)
    named = [
        _Boundary(boundary.change, (), "", tuple(figure.key.name for figure in boundary.figures))
        for boundary in boundaries
    ]
    for text in _list_by_names(named, partner_names):
        yield FigureLine("changed", f"sooner by up to {most}: {text}")


def _list_by_names(boundaries: Iterable[_Boundary], partner_names: Mapping[str, str]) -> Iterator[str]:
    """Yield which figures of which interfaces: `rate and largest gap of `a` from X to Y`."""
    changes_by_names = group_pairs((boundary.lost_names, boundary.change) for boundary in boundaries)
    for names, changes in changes_by_names.items():
        figures = f"{join_words([_PHRASES.get(name, name) for name in names])} of " if len(names) <= _MAX_NAMES else ""
        yield f"{figures}{_name_interfaces(changes, partner_names)}"


def _write_singles(boundaries: Iterable[_Boundary], partner_names: Mapping[str, str]) -> Iterator[FigureLine]:
    """Yield a line for each change, with all interfaces of which it is the same."""
    changes_by_figures: dict[tuple[ChangeKind, str, bool], list[BoundaryChange]] = {}
    for boundary in boundaries:
        change = boundary.change
        text = "; ".join(_describe_figures(boundary))
        text = "no longer" if change.kind == "removed" else text
        has_moved = change.old_givers or change.old_takers or change.kind == "added"
        if text or has_moved:
            changes_by_figures.setdefault((change.kind, text, bool(change.old_takers)), []).append(change)
    for (kind, text, _), changes in changes_by_figures.items():
        yield FigureLine(kind, _name_interfaces(changes, partner_names) + (f": {text}" if text else ""))


def _describe_figures(boundary: _Boundary) -> Iterator[str]:
    change, deadline = boundary.change, boundary.change.missed_deadline
    for figure in boundary.figures:
        limit = f", over the deadline of {display_duration(deadline)} asked for" if deadline else ""
        if text := describe_figure(figure, change.kind):
            yield text + (limit if figure.key.name == _GAP else "")


def _name_interfaces(changes: Iterable[BoundaryChange], partner_names: Mapping[str, str]) -> str:
    """Return interfaces with their ends: `a` and `b` from X to Y, `c` from X to Z."""
    names_by_ends: dict[str, dict[str, None]] = {}
    for change in _join_takers(changes):
        givers, old_givers, takers, old_takers = (
            join_partners(partners, partner_names)
            for partners in (change.givers, change.old_givers, change.takers, change.old_takers)
        )
        ends = f"from {givers}{_note_before(old_givers)} to {takers}{_note_before(old_takers)}"
        name = tick_names([change.interface_id]) + (f" (was {tick_names([change.old_id])})" if change.old_id else "")
        names_by_ends.setdefault(ends, {})[name] = None
    phrases = [f"{join_words(list(names))} {ends}" for ends, names in names_by_ends.items()]
    surplus = sum(map(len, list(names_by_ends.values())[_MAX_ENDS:]))
    return ", ".join([*phrases[:_MAX_ENDS], *([f"and {surplus} more"] if surplus else [])])


def _join_takers(changes: Iterable[BoundaryChange]) -> Iterable[BoundaryChange]:
    joined: dict[object, BoundaryChange] = {}
    for change in changes:
        key = change.interface_id, change.givers, change.old_givers, change.old_takers
        known = joined.get(key, change)
        joined[key] = replace(change, takers=tuple(dict.fromkeys((*known.takers, *change.takers))))
    return joined.values()


def _note_before(partner_phrase: str) -> str:
    return f" (before: {partner_phrase})" if partner_phrase else ""
