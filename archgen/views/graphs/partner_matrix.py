"""The overview where boxes and lines would cross too often: a matrix of who gives how much to whom, by partner."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from archgen.diagnostics.natural_order import order_naturally
from archgen.frozen import dataclass
from archgen.model.feedback_order import order_by_feedback
from archgen.views.graphs.drawn_level import list_flows
from archgen.views.graphs.group_columns import FEWEST_CROSSINGS, count_least_crossings
from archgen.views.graphs.group_graphs import weigh_group_flows
from archgen.views.inline_text import count_noun, cut_text
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import UPRIGHT, Sheet, SheetBar, SheetColour, SheetText

_MOST_ROWS, _MOST_UPRIGHT_ROWS = 24, 14
_FEW_ROWS = 12
"""Up to here a cell is large."""
_MOST_BOXES = 20
"""More of them, each with more than four others, are no picture."""
_HEAVIEST = 12
_TITLE_CHARACTERS, _UPRIGHT_TITLE_CHARACTERS = 34, 24
_BAR_WIDTH = 110.0


@dataclass(frozen=True, slots=True)
class _Exchange:
    """Who gives how much to whom: names in order, their titles, what each has, the weights, what is folded into the last."""

    names: Sequence[str]
    titles: Mapping[str, str]
    details: Mapping[str, str]
    refs: Mapping[str, str]
    weights: Mapping[tuple[str, str], int]


def is_too_dense(lookup: Lookup) -> bool:
    """Whether the groups can in no drawing have few crossings, or are so many that nobody could follow their lines."""
    pair_count, least = _count_least(lookup)
    group_count = len(lookup.architecture.groups)
    return least > FEWEST_CROSSINGS or (group_count > _MOST_BOXES and pair_count > 2 * group_count)


def _count_least(lookup: Lookup) -> tuple[int, int]:
    pairs = {frozenset(ends) for ends in weigh_group_flows(lookup)}
    return len(pairs), count_least_crossings(len(lookup.architecture.groups), len(pairs))


def draw_partner_matrices(lookup: Lookup) -> tuple[Sheet, Sheet]:
    """Draw the matrix for screens and slides, and for paper and narrow screens."""
    return draw_partner_matrix(lookup), draw_partner_matrix(lookup, upright=True)


def draw_partner_matrix(lookup: Lookup, *, upright: bool = False) -> Sheet:
    """Draw the matrix of partners, of groups where they are of fewer than three partners; upright it is for paper."""
    exchange = _fold_rows(_measure_exchange(lookup), _MOST_UPRIGHT_ROWS if upright else _MOST_ROWS)
    cell = 20.0 if upright or len(exchange.names) > _FEW_ROWS else 30.0
    bars, texts = _draw_cells(exchange, cell, _UPRIGHT_TITLE_CHARACTERS if upright else _TITLE_CHARACTERS)
    if not upright:
        left = len(exchange.names) * cell + 18
        more_bars, more_texts = _draw_sums(exchange, cell, left)
        bars, texts = bars + more_bars, texts + more_texts + _draw_heaviest(exchange, left + _BAR_WIDTH + 46)
    pair_count, least = _count_least(lookup)
    places = {name: at for at, name in enumerate(exchange.names)}
    counts = [(places[giver] > places[taker], count) for (giver, taker), count in exchange.weights.items()]
    back = sum(count for runs_back, count in counts if runs_back)
    total = sum(count for _, count in counts)
    return Sheet(
        f"overview{UPRIGHT if upright else ''}",
        f"{lookup.architecture.project.title}: who gives what to whom",
        tuple(bars),
        tuple(texts),
        notes=(
            f"Rows give, columns take, in the order in which least runs back: {back} of {count_noun(total, 'flow')}, dashed.",
            (
                f"Why no boxes and lines: the {pair_count} pairs of {len(lookup.architecture.groups)} groups between "
                + (
                    f"which something flows cross at least {least} times in any drawing."
                    if least > FEWEST_CROSSINGS
                    else "which something flows are more lines than an eye can follow."
                )
            ),
        ),
        alt=f"{count_noun(total, 'flow')} between {len(exchange.names)}: "
        + ", ".join(exchange.titles[name] for name in exchange.names),
    )


def _measure_exchange(lookup: Lookup) -> _Exchange:
    architecture = lookup.architecture
    owner_of = {each.id: each.owners[0] for each in architecture.components.values() if each.owners}
    used_owners = set(owner_of.values())
    owners = [partner for partner in architecture.partners if partner in used_owners]
    if len(owners) < 3:  # noqa: PLR2004 - of two a matrix has two cells
        groups = architecture.groups
        return _Exchange(
            list(groups),
            {name: group.title for name, group in groups.items()},
            {name: count_noun(len(group.components), "component") for name, group in groups.items()},
            {name: f"group:{name}" for name in groups},
            weigh_group_flows(lookup),
        )
    ends = ((owner_of.get(flow.tail), owner_of.get(flow.head)) for flow in list_flows(architecture))
    weights = Counter((tail, head) for tail, head in ends if tail in owners and head in owners and tail != head)
    group_counts = Counter(
        owner for owner, _ in {(each, name.partition(".")[0]): None for name, each in owner_of.items()}
    )
    component_counts = Counter(owner_of.values())
    return _Exchange(
        owners,
        {owner: architecture.partners[owner].title for owner in owners},
        {
            owner: f"{count_noun(group_counts[owner], 'group')}, {count_noun(component_counts[owner], 'component')}"
            for owner in owners
        },
        {owner: f"partner:{owner}" for owner in owners},
        {(str(tail), str(head)): weight for (tail, head), weight in weights.items()},
    )


_REST = "\0rest"


def _fold_rows(exchange: _Exchange, most: int) -> _Exchange:
    """Order the rows by least feedback; of too many those with most flows stay, and one row stands for all others."""
    sums = Counter[str]()
    for (giver, taker), weight in exchange.weights.items():
        sums.update({giver: weight, taker: weight})
    kept = exchange.names
    if len(kept) > most:
        kept = sorted(kept, key=lambda name: -sums[name])[: most - 1]
    rest = len(exchange.names) - len(kept)
    weights: Counter[tuple[str, str]] = Counter()
    for (giver, taker), weight in exchange.weights.items():
        ends = (giver if giver in kept else _REST, taker if taker in kept else _REST)
        if ends[0] != ends[1]:
            weights[ends] += weight
    inner = {ends: weight for ends, weight in weights.items() if _REST not in ends}
    order = [*order_by_feedback([name for name in exchange.names if name in kept], inner).elements]
    more_title = {_REST: f"{rest} more"} if rest else {}
    return _Exchange(
        [*order, *more_title],
        {**exchange.titles, **more_title},
        {**exchange.details, **({_REST: "with fewer flows"} if rest else {})},
        exchange.refs,
        weights,
    )


def _draw_cells(exchange: _Exchange, cell: float, characters: int) -> tuple[list[SheetBar], list[SheetText]]:
    bars, texts = list[SheetBar](), list[SheetText]()
    most = max(exchange.weights.values(), default=1)
    for row, giver in enumerate(exchange.names):
        y = row * cell
        title, ref = cut_text(exchange.titles[giver], characters), exchange.refs.get(giver)
        middle = y + cell / 2
        texts.append(SheetText(-8, middle, str(row + 1), bold=True, side="right", ink="muted"))
        if cell > 24:  # noqa: PLR2004 - room for two lines
            texts.append(SheetText(-24, middle - 6, title, 9.5, bold=True, side="right", ref=ref))
            texts.append(SheetText(-24, middle + 6.5, exchange.details[giver], 8, side="right", ink="muted"))
        else:
            texts.append(
                SheetText(-24, middle, title, 9, bold=True, side="right", ref=ref, tooltip=exchange.details[giver])
            )
        texts.append(
            SheetText(middle, -9, str(row + 1), bold=True, side="middle", ink="muted", tooltip=exchange.titles[giver])
        )
        for column, taker in enumerate(exchange.names):
            weight = exchange.weights.get((giver, taker), 0)
            fill: SheetColour = "blank" if row == column else _choose_step(weight, most)
            words = f"{exchange.titles[giver]} to {exchange.titles[taker]}: {count_noun(weight, 'flow')}"
            runs_back = bool(weight) and row > column
            bars.append(
                SheetBar(
                    column * cell + 0.8,
                    y + 0.8,
                    cell - 1.6,
                    cell - 1.6,
                    fill,
                    "amber" if runs_back else "blank",
                    dashed=runs_back,
                    label=str(weight) if weight else "",
                    ref=_pair_ref(exchange, giver, taker) if weight else None,
                    tooltip=words if row != column else exchange.titles[giver],
                )
            )
    return bars, texts


def _pair_ref(exchange: _Exchange, giver: str, taker: str) -> str | None:
    refs = (exchange.refs.get(giver, ""), exchange.refs.get(taker, ""))
    if not all(ref.startswith("partner:") for ref in refs):
        return None
    first, second = sorted((giver, taker), key=list(exchange.refs).index)
    return f"pair:{first}:{second}"


def _choose_step(weight: int, most: int) -> SheetColour:
    steps: tuple[SheetColour, ...] = ("step1", "step2", "step3", "step4")
    return steps[min(3, math.ceil(weight * 4 / most) - 1)] if weight else "paper"


def _draw_sums(exchange: _Exchange, cell: float, left: float) -> tuple[list[SheetBar], list[SheetText]]:
    """Draw how much each gives and takes, as two bars."""
    gives, takes = Counter[str](), Counter[str]()
    for (giver, taker), weight in exchange.weights.items():
        gives[giver] += weight
        takes[taker] += weight
    longest = max([*gives.values(), *takes.values()], default=1)
    texts = [
        SheetText(left, -9, "gives", bold=True, ink="blue"),
        SheetText(left + 34, -9, "takes", bold=True, ink="amber"),
    ]
    bars = list[SheetBar]()
    for row, name in enumerate(exchange.names):
        height = cell * 0.3
        for at, (sums, colour) in enumerate(((gives, "blue"), (takes, "amber"))):
            y = row * cell + cell / 2 + (at - 1) * (height + 1) + 0.5
            width = _BAR_WIDTH * sums[name] / longest
            ink: SheetColour = "blue" if colour == "blue" else "amber"
            bars += [SheetBar(left, y, width, height, ink)] if width else []
            texts.append(SheetText(left + width + 4, y + height / 2, str(sums[name]), 7.5, bold=True))
    return bars, texts


def _draw_heaviest(exchange: _Exchange, left: float) -> list[SheetText]:
    texts = [SheetText(left, -9, "Most flows", bold=True)]
    heaviest = sorted(
        (each for each in exchange.weights.items() if _REST not in each[0]),
        key=lambda each: (-each[1], *map(order_naturally, each[0])),
    )
    for row, ((giver, taker), weight) in enumerate(heaviest[:_HEAVIEST]):
        y = row * 29 + 8.0
        texts += [
            SheetText(left, y, str(weight), 9, bold=True),
            SheetText(left + 18, y, cut_text(exchange.titles[giver], _TITLE_CHARACTERS), 8.5),
            SheetText(
                left + 18, y + 11.5, f"→ {cut_text(exchange.titles[taker], _TITLE_CHARACTERS)}", 8.5, ink="muted"
            ),
        ]
    return texts
