"""Where the time of a chain goes: the known part on a true scale to the deadline, step by step, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Literal

from archgen.frozen import dataclass, replace
from archgen.timing.analysis import ChainResult, ChainTerm
from archgen.timing.chains.chain_advice import advise_on_chain, find_deciding_term, sum_known_parts
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue, sum_fractions
from archgen.views import element_references, inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Bullets,
    DashboardCard,
    Inlines,
    KeyFigure,
    Text,
    Waterfall,
    WaterfallPiece,
    WaterfallStep,
)
from archgen.views.timing import chain_charts, chain_status, element_timing, timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

PieceKind = Literal["sampling", "response", "link", "unknown"]
WATERFALL_FACTS = ("verdict", "why", "advice", "latest", "earliest", "requirements", "assumptions")
"""The keys of the facts of `element_timing.make_chain_blocks` that a waterfall says as well."""
_KINDS: tuple[tuple[PieceKind, str], ...] = (("sampling", "waits"), ("response", "responds"), ("link", "link"))
_CUT_SHARE = Fraction(1, 2)
"""A piece that is longer than this share of all is drawn short: else the others could not be told apart."""
_CUT_LENGTH = 0.1
_UNKNOWN_LENGTH, _UNKNOWN_ROOM = 0.12, 0.5
"""The share of the axis for a part that nobody knows, and for all of them together at most."""
_TICKS = 6
"""About so many figures along the axis."""


@dataclass(frozen=True, slots=True)
class _CutAxis:
    """Turns times (ns) into shares of an axis, on which one stretch is drawn short."""

    total: Fraction
    cut: tuple[Fraction, Fraction] | None
    room: float
    """The share of the axis that the known time takes; the rest are gaps, one for each part that nobody knows."""
    gap: float = 0.0
    known_until: Fraction | None = None
    """Where the first such part begins: from there on times are no places on the axis. None: they all are."""

    def find_share(self, time: Fraction) -> float:
        """Return the share of the axis at a time."""
        if self.cut is None:
            return self.room * float(time / self.total) if self.total else 0.0
        start, end = self.cut
        scale = (self.room - _CUT_LENGTH) / float(self.total - (end - start))
        if time <= start:
            return scale * float(time)
        if time <= end:
            return scale * float(start) + _CUT_LENGTH * float((time - start) / (end - start))
        return scale * float(time - (end - start)) + _CUT_LENGTH


def make_waterfall(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Waterfall | None:
    """Show where the time of a chain goes; None for one without steps."""
    if not result.terms:
        return None
    advice = advise_on_chain(timing_lookup.analysis, result)
    lead = advice.lateness if advice else chain_charts.describe_chain_verdict(result, timing_lookup)
    total = sum_fractions(map(sum_known_parts, result.terms))
    deadline = result.deadline.value if result.deadline else None
    axis = _make_axis(result.terms, total)
    reach = total if axis.known_until is None else axis.known_until
    step_limit = axis.find_share(deadline) if deadline is not None and deadline <= reach else None
    whole = max(total, deadline or Fraction(0)) or Fraction(1)
    return Waterfall(
        inline_text.message_to_inlines(lead),
        tuple(_make_total(result, total, whole)),
        tuple(_make_labels(result, total, whole)),
        (float(deadline / whole) if deadline is not None else None, step_limit),
        f"deadline {_format_time(deadline, '>')}" if deadline is not None else "",
        tuple(_make_ticks(axis)),
        tuple(_make_steps(lookup, timing_lookup, result.terms, axis)),
        _describe_cut(axis),
        tuple(_make_figures(lookup, result)),
        tuple(_make_cards(lookup, timing_lookup, result)),
    )


def _describe_cut(axis: _CutAxis) -> str:
    """Say what is drawn short; nothing where all is on one scale."""
    if axis.cut is None:
        return ""
    start, end = axis.cut
    length = _format_time(end - start)
    return (
        f"The {length} from {_format_time(start)} on are drawn short."
        if start
        else f"The first {length} are drawn short."
    )


def _format_time(time: Fraction, sign: str = "<") -> str:
    return chain_status.round_duration(time, sign) if time else "0"


def _list_parts(term: ChainTerm) -> Iterator[tuple[PieceKind, str, TimingValue]]:
    """Yield the parts of a step in the order of time: over the link, waiting, at work."""
    by_kind = {"sampling": term.sampling, "response": term.response, "link": term.link}
    yield from ((kind, word, by_kind[kind]) for kind, word in (_KINDS[2], _KINDS[0], _KINDS[1]))


def _make_axis(terms: Sequence[ChainTerm], total: Fraction) -> _CutAxis:
    """Choose the axis: a gap for each part that is unknown, and the longest piece cut if it dwarfs all others."""
    time, unknown_starts = Fraction(0), list[Fraction]()
    for term in terms:
        for _, _, value in _list_parts(term):
            unknown_starts += [time] if value.value is None else []
            time += value.value or 0
    gap = min(_UNKNOWN_LENGTH, _UNKNOWN_ROOM / len(unknown_starts)) if unknown_starts else 0.0
    room, known_until = 1 - gap * len(unknown_starts), min(unknown_starts, default=None)
    longest = max(_list_stretches(terms), key=lambda stretch: stretch[1] - stretch[0], default=None)
    if longest is None or not _CUT_SHARE * total < longest[1] - longest[0] < total:
        return _CutAxis(total, None, room, gap, known_until)
    return _CutAxis(total, longest, room, gap, known_until)


def _list_stretches(terms: Sequence[ChainTerm]) -> Iterator[tuple[Fraction, Fraction]]:
    """Yield start and end of each known part, in ns."""
    time = Fraction(0)
    for term in terms:
        for _, _, value in _list_parts(term):
            if value.value:
                yield time, time + value.value
                time += value.value


def _make_total(result: ChainResult, total: Fraction, whole: Fraction) -> Iterator[WaterfallPiece]:
    """Yield the known parts by kind, and what is left for what nobody knows."""
    position = Fraction(0)
    for kind, length, words in list_known_kinds(result):
        end = position + length
        yield WaterfallPiece(kind, float(position / whole), float(end / whole), words)
        position = end
    if not result.bound.complete and position < whole:
        yield WaterfallPiece("unknown", float(total / whole), 1.0, "unknown")


def list_known_kinds(result: ChainResult) -> Iterator[tuple[PieceKind, Fraction, str]]:
    """Yield how long a chain waits, works and is on links, in ns and in words, as far as that is known."""
    for kind, word in _KINDS:
        length = sum((getattr(term, kind).value or Fraction(0) for term in result.terms), Fraction(0))
        if length:
            yield kind, length, f"{word} {_format_time(length)}"


def _make_labels(result: ChainResult, total: Fraction, whole: Fraction) -> Iterator[tuple[float, str]]:
    yield 0.0, "0"
    yield float(total / whole), _format_time(total) if result.bound.complete else f"{_format_time(total, '>')} known"


def _make_ticks(axis: _CutAxis) -> Iterator[tuple[float, str]]:
    """Yield round times along the axis; none inside of what is drawn short."""
    yield 0.0, "0"
    start, end = axis.cut or (Fraction(0), Fraction(0))
    step = _choose_step(axis.total - (end - start)) or axis.total + 1
    # Behind the cut first: there is the room.
    times = [end] if axis.cut else []
    multiple = step
    while multiple < axis.total:
        if not start <= multiple <= end:
            times.append(multiple)
        multiple = (multiple // step + 1) * step if multiple < start or multiple > end else (end // step + 1) * step
    end_place = 1.0 if axis.known_until is None else axis.find_share(axis.known_until)
    last_place = 0.0
    for time in sorted(times):
        place = axis.find_share(time)
        if place - last_place > 0.06 and place < end_place - 0.03:  # noqa: PLR2004 - shares that keep two figures apart
            yield place, _format_time(time)
            last_place = place
    if axis.known_until is not None:
        # Figures behind what nobody knows would be no times: the axis ends.
        yield end_place + axis.gap / 2, "+ ?"


def _choose_step(length: Fraction) -> Fraction:
    """Return a round time (1, 2 or 5 times a power of ten) that fits about `_TICKS` times into a length."""
    if length <= 0:
        return Fraction(0)
    step = Fraction(1)
    while step * _TICKS * 10 < length:
        step *= 10
    return next((step * factor for factor in (1, 2, 5, 10) if step * factor * _TICKS >= length), step * 10)


def _make_steps(
    lookup: Lookup, timing_lookup: TimingLookup, terms: Sequence[ChainTerm], axis: _CutAxis
) -> Iterator[WaterfallStep]:
    time, pushed = Fraction(0), 0.0
    for term in terms:
        pieces: list[WaterfallPiece] = []
        for kind, word, value in _list_parts(term):
            tip = f"{word} {value_format.display_duration(value)}"
            if value.value:
                start, time = time, time + value.value
                is_cut = axis.cut == (start, time)
                places = (axis.find_share(start) + pushed, axis.find_share(time) + pushed)
                pieces.append(WaterfallPiece(kind, *places, tip, is_cut))
            elif value.value is None:
                # It has no length: a gap stands for it, which pushes all that follows.
                start_share = axis.find_share(time) + pushed
                pushed += axis.gap
                words = f"{word} for how long, nobody knows"
                pieces.append(WaterfallPiece("unknown", start_share, start_share + axis.gap, words))
        owners = inline_text.owner_links(
            lookup.architecture, element_references.list_activity_owners(lookup, term.activity)
        )
        activity = timing_lookup.analysis.system.activities.get(term.activity)
        host = inline_text.host_link(lookup.architecture, activity.host) if activity and activity.host else ()
        yield WaterfallStep(
            timing_tables.activity_link(timing_lookup, term.activity)[0],
            inline_text.join_inlines(tuple(part for part in (owners, host) if part)),
            tuple(pieces),
            _describe_step(term),
        )


def _describe_step(term: ChainTerm) -> str:
    """Describe the parts of a step and why: `waits <= 30 s, responds 150 ms · samples the world every 30 s`."""
    phrases = [
        f"{word} {value_format.display_duration(value)}"
        for _, word, value in _list_parts(term)
        if value.value or value.value is None
    ]
    return " · ".join(filter(None, (", ".join(phrases) or "adds no time", term.why)))


def _make_figures(lookup: Lookup, result: ChainResult) -> Iterator[KeyFigure]:
    yield KeyFigure("At the latest", value_format.display_duration(result.bound), "", (), "")
    if result.deadline is not None:
        yield KeyFigure("Deadline", value_format.display_duration(result.deadline), "", (), "")
    for each in result.shares:
        note = "only simulation and recordings judge it" if each.verdict == "open" else each.verdict
        limit_text = format_duration(each.limit)
        yield KeyFigure(f"{each.name} of its reactions", limit_text, "", inline_text.to_inlines(note), "")
    margin = chain_status.describe_margin(result)
    if margin:
        yield KeyFigure("Margin", margin, "", (), "")
    if result.best.value is not None:
        yield KeyFigure("At the earliest", value_format.display_lower_bound(result.best), "", (), "")
    requirements = lookup.architecture.chains[result.id].requirements
    if requirements:
        links = inline_text.join_inlines(
            inline_text.requirement_link(lookup.architecture, name)[:1] for name in requirements
        )
        yield KeyFigure("Requirements", str(len(requirements)), "", links, "")


def _make_cards(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Iterator[DashboardCard]:
    """Yield what to do, and what is taken for granted."""
    steps = tuple(_list_steps(lookup, timing_lookup, result))
    assumptions = tuple(
        inline_text.message_to_inlines(word)
        for word in dict.fromkeys(element_timing.describe_assumptions(timing_lookup, result))
    )
    if steps:
        yield DashboardCard("What to do", (Bullets(steps, ordered=True),), 8 if assumptions else 12, kind="to-do")
    if assumptions:
        yield DashboardCard("Taken for granted", (Bullets(assumptions),), 4 if steps else 12)


def _list_steps(lookup: Lookup, timing_lookup: TimingLookup, result: ChainResult) -> Iterator[Inlines]:
    """Yield what would mend a chain that is not sure to be in time, each with owner and place."""
    advice = advise_on_chain(timing_lookup.analysis, result)
    if advice is None:
        return
    largest_term = max(result.terms, key=sum_known_parts)
    if advice.first_step:
        yield _join_step(lookup, inline_text.message_to_inlines(advice.first_step), find_deciding_term(result))
    largest_parts = element_timing.link_names(lookup, timing_lookup, advice.largest_parts)
    yield _join_step(lookup, largest_parts, largest_term)


def _join_step(lookup: Lookup, words: Inlines, term: ChainTerm) -> Inlines:
    owners = inline_text.owner_links(
        lookup.architecture, element_references.list_activity_owners(lookup, term.activity)
    )
    place = element_references.place_run(lookup, term.at)
    parts = [part for part in (owners, (replace(place, muted=True),) if place else ()) if part]
    ending = inline_text.join_inlines(parts)
    return (
        *words,
        *((Text("", line_break=True), Text("Owner ", muted=True), *ending) if owners else ending),
    )
