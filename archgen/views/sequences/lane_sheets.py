"""Use cases of many participants: a lane for each partner, a card for each step, and what happens at once in one row.

A step begins a way of its own if its sender has had no part yet, or is a person whom nobody has addressed since; ways meet
at whom both reach. Upright, for paper and narrow screens, it is a list of the steps with the lanes as a narrow graph.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise, permutations

from archgen.frozen import dataclass
from archgen.model.architecture import UseCase
from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import StepEnd
from archgen.timing.chains.use_case_times import UseCaseTimes
from archgen.views.inline_text import count_noun, cut_text
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, SequenceChart, Sheet, SheetBar, SheetColour, SheetLine, SheetText
from archgen.views.sequences.sequence_charts import (
    CHART_PREFIX,
    describe_step_time,
    describe_total,
    find_times,
    name_participant,
)

MOST_LIFELINES = 8
"""Up to so many take part each has a line of its own."""
_CARD_WIDTH, _PERSON_WIDTH, _CARD_HEIGHT, _ROW_HEIGHT = 104.0, 72.0, 46.0, 67.0
_LANE_MARGIN, _LANE_GAP = 5.0, 3.0
_TIME_WIDTH = 40.0
_LETTER_WIDTH, _BOLD_WIDTH = 4.3, 4.5
"""The mean width of a letter of a card's words and of its title."""
_MOST_TRIED_LANES = 6
"""Of so many lanes all orders are tried, of more only exchanges."""
_LIST_ROW, _LIST_LANE, _LIST_WIDTH, _LIST_NAMES = 14.0, 13.0, 530.0, 200.0


@dataclass(frozen=True, slots=True)
class PlacedStep:
    """A step with its row, and how long its way has taken when it is done, in ns; None where that is not known."""

    step: ConnectedStep
    row: int
    done: Fraction | None


def place_steps(steps: Sequence[ConnectedStep], times: Sequence[Fraction | None]) -> tuple[PlacedStep, ...]:
    """Place steps in rows: one below all that its way has done so far; nobody sends twice in a row."""
    way_of: dict[str, int] = {}
    ends: list[tuple[int, Fraction | None]] = []
    addressed: dict[str, bool] = {}
    placed = []
    for each, time in zip(steps, times, strict=True):
        sender, receiver = each.step.source, each.step.target
        is_free = sender.kind == "actor" and addressed.get(sender.participant) is False
        if sender.participant not in way_of or is_free:
            way_of[sender.participant] = len(ends)
            ends.append((0, Fraction(0)))
        way = way_of[sender.participant]
        row, known = ends[way]
        done = None if known is None or time is None else known + time
        placed.append(PlacedStep(each, row, done))
        ends[way] = (row + 1, done)
        other = way_of.get(receiver.participant, way)
        if other != way:
            # Both have taken place when it goes on.
            (one_row, one), (other_row, two) = ends[way], ends[other]
            ends[way] = (max(one_row, other_row), None if one is None or two is None else max(one, two))
            way_of = {name: way if number == other else number for name, number in way_of.items()}
        way_of[receiver.participant] = way
        addressed[sender.participant] = False
        addressed[receiver.participant] = True
    return tuple(placed)


def has_lanes(steps: Sequence[ConnectedStep]) -> bool:
    """Whether so many take part that they share lanes."""
    return len({end.participant for each in steps for end in (each.step.source, each.step.target)}) > MOST_LIFELINES


def draw_lane_sheets(lookup: Lookup, use_case_id: str) -> tuple[Sheet, ...]:
    """Draw a use case with lanes, for screens and for paper; nothing where few take part."""
    use_case, steps = lookup.architecture.use_cases[use_case_id], lookup.steps.by_use_case[use_case_id]
    if not has_lanes(steps):
        return ()
    ends = [end for each in steps for end in (each.step.source, each.step.target)]
    found = find_times(lookup, use_case_id)
    # What takes no time of the architecture's adds none.
    values = [found.steps[each.number - 1] if found else None for each in steps]
    times = [Fraction(0) if value is None else value.value if value.complete else None for value in values]
    placed = place_steps(steps, times)
    lane_of = {end.participant: _find_lane(lookup, use_case, end) for end in ends}
    lanes = _order_lanes(
        [(lane_of[each.step.source.participant], lane_of[each.step.target.participant]) for each in steps]
    )
    drawing = _Drawing(lookup, use_case, placed, lane_of, lanes, found)
    return drawing.draw_cards(), drawing.draw_list()


def choose_sequences(lookup: Lookup, chart: SequenceChart) -> tuple[SequenceChart | Sheet, ...]:
    """Return a sequence as it is, or with lanes where many take part."""
    return draw_lane_sheets(lookup, chart.id.removeprefix(CHART_PREFIX)) or (chart,)


def _find_card_width(lane: str) -> float:
    return _PERSON_WIDTH if lane[0] == "\0" else _CARD_WIDTH


def _find_lane(lookup: Lookup, use_case: UseCase, end: StepEnd) -> str:
    """Return the lane of who takes part: its partner's, a person's own."""
    component = lookup.architecture.find_component(end.participant) if end.kind != "actor" else None
    if component is None:
        return f"\0{name_participant(lookup, use_case, end)}"
    owner = component.owners[0] if component.owners else ""
    partner = lookup.architecture.partners.get(owner)
    return partner.title if partner else owner or "nobody yet"


def _order_lanes(ways: Sequence[tuple[str, str]]) -> list[str]:
    """Order lanes so that steps go sideways as little as can be."""
    lanes = list(dict.fromkeys(lane for way in ways for lane in way))

    def measure(order: Iterable[str]) -> int:
        places = {lane: at for at, lane in enumerate(order)}
        return sum(abs(places[one] - places[other]) for one, other in ways)

    if len(lanes) <= _MOST_TRIED_LANES:
        return list(min(permutations(lanes), key=measure))
    least, is_better = measure(lanes), True
    while is_better:
        is_better = False
        for one in range(len(lanes)):
            for other in range(one + 1, len(lanes)):
                order = lanes[:]
                order[one], order[other] = order[other], order[one]
                if (length := measure(order)) < least:
                    lanes, least, is_better = order, length, True
    return lanes


@dataclass(frozen=True, slots=True)
class _Card:
    """What stands in a lane: a step at its sender, or whom the last step of a way reaches."""

    row: int
    end: StepEnd
    words: str
    time: str


class _Drawing:
    def __init__(  # noqa: PLR0913, PLR0917 - what is drawn
        self,
        lookup: Lookup,
        use_case: UseCase,
        placed: Sequence[PlacedStep],
        lane_of: Mapping[str, str],
        lanes: Sequence[str],
        times: UseCaseTimes | None,
    ) -> None:
        self.lookup, self.use_case, self.placed = lookup, use_case, placed
        self.lane_of, self.lanes, self.has_times = lane_of, lanes, times is not None
        self.total = times.total.value if times and times.total.complete else None
        self.row_count = 1 + max(each.row for each in placed)

    def draw_cards(self) -> Sheet:
        """Draw a card for each step, with arrows to what follows."""
        cards = [self._make_card(each) for each in self.placed]
        links: list[tuple[int, int]] = []
        for at, each in enumerate(self.placed):
            receiver = each.step.step.target.participant
            following = next(
                (
                    to
                    for to in range(at + 1, len(self.placed))
                    if self.placed[to].step.step.source.participant == receiver
                ),
                None,
            )
            is_inner = each.step.step.is_inner
            if following is None and not is_inner:
                following = len(cards)
                words = cards[at].words if each.step.step.target.kind == "actor" else ""
                cards.append(_Card(each.row + 1, each.step.step.target, words, ""))
            if following is not None and cards[following].row > each.row:
                links.append((at, following))
        lefts, places, width = self._place_cards(cards)
        rows = 1 + max(card.row for card in cards)
        bars, texts = self._draw_lanes(lefts, rows)
        for card, place in zip(cards, places, strict=True):
            card_bars, card_texts = self._draw_card(card, *place)
            bars += card_bars
            texts += card_texts
        lines = [line for at, link in enumerate(links) for line in self._draw_link(at, *link, cards, places, lefts)]
        more_bars, more_texts = self._draw_times(width + 14)
        return self._finish("", bars + more_bars, texts + more_texts, lines)

    def _make_card(self, each: PlacedStep) -> _Card:
        step = each.step.step
        return _Card(each.row, step.source, " ".join((step.say or "").split()), self._write_step_time(each))

    def _write_step_time(self, each: PlacedStep) -> str:
        return _shorten(describe_step_time(self.lookup, self.use_case.id, each.step.number))

    def _place_cards(
        self, cards: Sequence[_Card]
    ) -> tuple[dict[str, tuple[float, float]], list[tuple[float, float, float]], float]:
        """Return left and width of each lane, the left upper corner and the width of each card, and the width of all lanes."""
        side_by_side: dict[tuple[str, int], int] = {}
        for card in cards:
            key = (self.lane_of[card.end.participant], card.row)
            side_by_side[key] = side_by_side.get(key, 0) + 1
        lefts: dict[str, tuple[float, float]] = {}
        x = 0.0
        for lane in self.lanes:
            count = max((number for (name, _), number in side_by_side.items() if name == lane), default=1)
            width = count * (_find_card_width(lane) + _LANE_MARGIN) + _LANE_MARGIN
            lefts[lane] = (x, width)
            x += width + _LANE_GAP
        seen: dict[tuple[str, int], int] = {}
        places = []
        for card in cards:
            key = (self.lane_of[card.end.participant], card.row)
            at, number = seen.get(key, 0), side_by_side[key]
            seen[key] = at + 1
            left, width = lefts[key[0]]
            card_width = _find_card_width(key[0])
            total = number * (card_width + _LANE_MARGIN) - _LANE_MARGIN
            card_left = left + (width - total) / 2 + at * (card_width + _LANE_MARGIN)
            places.append((card_left, card.row * _ROW_HEIGHT + 12, card_width))
        return lefts, places, x

    def _draw_lanes(
        self, lefts: Mapping[str, tuple[float, float]], rows: int
    ) -> tuple[list[SheetBar], list[SheetText]]:
        bars, texts = list[SheetBar](), list[SheetText]()
        for lane, (left, width) in lefts.items():
            is_outside = lane[0] == "\0"
            bars.append(
                SheetBar(
                    left,
                    -20,
                    width,
                    rows * _ROW_HEIGHT + 22,
                    "tint",
                    "amber" if is_outside else None,
                    behind=True,
                    dashed=is_outside,
                    rounded=True,
                )
            )
            title = cut_text(lane.lstrip("\0"), int(width / 5.4))
            ink: SheetColour = "amber" if is_outside else "blue"
            texts.append(
                SheetText(
                    left + width / 2, -8, title, 9.5, bold=True, side="middle", ink=ink, tooltip=lane.lstrip("\0")
                )
            )
        return bars, texts

    def _draw_card(self, card: _Card, x: float, y: float, width: float) -> tuple[list[SheetBar], list[SheetText]]:
        is_outside = card.end.kind == "actor"
        title = name_participant(self.lookup, self.use_case, card.end)
        component = None if is_outside else self.lookup.architecture.find_component(card.end.participant)
        ref = f"component:{component.id}" if component else None
        tooltip = "\n".join(filter(None, (title, card.words, card.time)))
        letters = int((width - 11) / _LETTER_WIDTH)
        lines = _wrap(card.words, (letters, letters, letters - len(card.time)))
        bar = SheetBar(
            x,
            y,
            width,
            _CARD_HEIGHT,
            "paper",
            "amber" if is_outside else "line",
            rounded=True,
            ref=ref,
            tooltip=tooltip,
        )
        texts = [SheetText(x + 6, y + 9, cut_text(title, int((width - 11) / _BOLD_WIDTH)), 8, bold=True)]
        texts += [SheetText(x + width - 6, y + 38.5, card.time, 8, side="right", ink="muted")] if card.time else []
        texts += [SheetText(x + 6, y + 19.5 + at * 9.5, words, 8, ink="muted") for at, words in enumerate(lines)]
        return [bar], texts

    def _draw_link(  # noqa: PLR0913, PLR0917 - two cards and where things stand
        self,
        number: int,
        tail: int,
        head: int,
        cards: Sequence[_Card],
        places: Sequence[tuple[float, float, float]],
        lefts: Mapping[str, tuple[float, float]],
    ) -> Iterator[SheetLine]:
        """Yield the line to what follows: below its row to the side, past other rows beside the cards of the lane."""
        (x, y, width), (to_x, to_y, to_width) = places[tail], places[head]
        x, to_x, start = x + width / 2, to_x + to_width / 2, y + _CARD_HEIGHT
        level = start + 5 + (number % 3) * 3.5
        if cards[head].row == cards[tail].row + 1:
            middle = [(x, level), (to_x, level)] if x != to_x else []
        else:
            gutter = lefts[self.lane_of[cards[head].end.participant]][0] + 3 + (number % 2) * 3
            last = to_y - 8
            middle = [(x, level), (gutter, level), (gutter, last), (to_x, last)]
        yield SheetLine(((x, start), *middle, (to_x, to_y)), 1.0)

    def _draw_times(self, left: float) -> tuple[list[SheetBar], list[SheetText]]:
        """Draw how long it has taken at the end of each row, by the way that takes longest."""
        if not self.has_times:
            return [], []
        texts = [
            SheetText(left, -12, "at the latest", bold=True),
            SheetText(left, -2, "after it began", 8, ink="muted"),
        ]
        bars, dones = list[SheetBar](), self._sum_rows()
        total = max((done for done in dones if done is not None), default=Fraction(0)) or Fraction(1)
        for row, done in enumerate(dones):
            y = row * _ROW_HEIGHT + 12 + _CARD_HEIGHT / 2
            texts.append(SheetText(left, y - 4, _write_time(done), bold=True))
            bars += [SheetBar(left, y + 4, max(1.0, _TIME_WIDTH * float(done / total)), 5)] if done else []
        return bars, texts

    def _sum_rows(self) -> list[Fraction | None]:
        """Return when all up to a row is done, None from the first row on of which that is not known."""
        dones: list[Fraction | None] = []
        for row in range(self.row_count):
            known = [each.done for each in self.placed if each.row <= row]
            values = [done for done in known if done is not None]
            done = max(values) if len(values) == len(known) else None
            # All steps together may take less than their sum: what runs one after the other waits for others only once.
            dones.append(done if done is None or self.total is None else min(done, self.total))
        return dones

    def draw_list(self) -> Sheet:
        """Draw the steps as a list, with their lanes as a graph of dots at its left."""
        left = len(self.lanes) * _LIST_LANE + 6
        texts, bars, lines = list[SheetText](), list[SheetBar](), list[SheetLine]()
        order = sorted(self.placed, key=lambda each: (each.row, each.step.number))
        last_dot: dict[str, tuple[float, float]] = {}
        top = 15.0 * len(self.lanes) + 8
        for at, lane in enumerate(self.lanes):
            x, y = at * _LIST_LANE + 4, at * 15.0
            texts.append(
                SheetText(x + 5, y, lane.lstrip("\0"), 8, bold=True, ink="amber" if lane[0] == "\0" else "blue")
            )
            lines.append(SheetLine(((x, y + 5), (x, top + len(order) * _LIST_ROW)), 0.6, "blank", head=False))
        total = max((done for done in self._sum_rows() if done is not None), default=Fraction(0)) or Fraction(1)
        for at, each in enumerate(order):
            step, y = each.step.step, top + at * _LIST_ROW + _LIST_ROW / 2
            ends = [
                (self.lanes.index(self.lane_of[end.participant]) * _LIST_LANE + 4, y)
                for end in (step.source, step.target)
            ]
            before = last_dot.get(step.source.participant, ends[0])
            if before != ends[1]:
                lines.append(SheetLine((before, ends[1]), 0.9, "line", head=False))
            last_dot[step.target.participant] = ends[1]
            bars.append(
                SheetBar(
                    ends[1][0] - 2.5, y - 2.5, 5, 5, "amber" if step.target.kind == "actor" else "blue", rounded=True
                )
            )
            names = [name_participant(self.lookup, self.use_case, end) for end in (step.source, step.target)]
            is_begin = before == ends[0] and step.source.participant not in {
                other.step.step.target.participant for other in order[:at]
            }
            title = f"{names[0]} → {names[1]}" if is_begin else names[1]
            texts.append(SheetText(left, y, f"{each.step.number}", 8, side="left", ink="muted"))
            texts.append(
                SheetText(
                    left + 14,
                    y,
                    cut_text(title, int((_LIST_NAMES - 20) / _BOLD_WIDTH)),
                    8,
                    bold=True,
                    tooltip=" → ".join(names),
                )
            )
            words = " ".join((step.say or "").split())
            room = min(44, int((_LIST_WIDTH - 90 - left - _LIST_NAMES) / _LETTER_WIDTH))
            texts.append(SheetText(left + _LIST_NAMES, y, cut_text(words, room), 8, ink="muted", tooltip=words))
            if time := self._write_step_time(each):
                texts.append(SheetText(_LIST_WIDTH - 52, y, time, 8, side="right"))
            if each.done:
                bars.append(SheetBar(_LIST_WIDTH - 48, y - 2.5, max(1.0, 48 * float(each.done / total)), 5))
        return self._finish(UPRIGHT, bars, texts, lines)

    def _finish(self, suffix: str, bars: list[SheetBar], texts: list[SheetText], lines: list[SheetLine]) -> Sheet:
        names = [
            name_participant(self.lookup, self.use_case, end)
            for each in self.placed
            for end in (each.step.step.source, each.step.step.target)
        ]
        rows = "" if suffix else "; what stands in one row happens at the same time"
        notes = [f"{count_noun(len(self.placed), 'step')}, {len(dict.fromkeys(names))} take part{rows}."]
        total = _shorten(describe_total(self.lookup, self.use_case.id))
        done = self._sum_rows()[-1]
        if done:
            notes.append(
                f"Done after {_write_time(done)} at the latest; all steps one after the other: {total}. What people take is not in it."
            )
        elif total:
            notes.append(f"All steps one after the other: {total}.")
        alt = f"A sequence of {count_noun(len(self.placed), 'step')} of {self.use_case.id}. " + " ".join(
            f"{each.step.number}: {one} to {other}."
            for each, (one, other) in zip(self.placed, _pairs(names), strict=True)
        )
        return Sheet(
            f"{CHART_PREFIX}{self.use_case.id}{suffix}",
            self.use_case.title,
            tuple(bars),
            tuple(texts),
            tuple(lines),
            tuple(notes),
            alt,
        )


def _pairs(names: Sequence[str]) -> Iterator[tuple[str, str]]:
    return ((one, other) for at, (one, other) in enumerate(pairwise(names)) if at % 2 == 0)


def _write_time(value: Fraction | None) -> str:
    """Write a time in ns with three digits, rounded up; a question mark for one that is not known."""
    from archgen.timing.figures.timing_values import TimingValue
    from archgen.views.timing.value_format import display_duration

    return (
        "?" if value is None else _shorten(f"at most {display_duration(TimingValue(value))}").removeprefix("at most ")
    )


def _shorten(text: str) -> str:
    from archgen.views.short_figures import shorten_text

    return shorten_text(text)


def _wrap(text: str, widths: Sequence[int]) -> Iterator[str]:
    """Cut a text into lines at blanks; what is longer than all of them ends in an ellipsis."""
    for width in widths[:-1]:
        if len(text) <= width:
            yield text
            return
        at = text.rfind(" ", 0, width + 1)
        at = at if at > 0 else width
        yield text[:at]
        text = text[at:].strip()
    yield cut_text(text, widths[-1])
