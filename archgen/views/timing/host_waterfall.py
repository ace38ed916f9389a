"""Where the time of a host goes: its load against all of its cores, node by node, by partner and by core."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Literal

from archgen.timing.analysis import ChainResult, HostLoad
from archgen.timing.figures.timing_values import TimingValue
from archgen.views import element_references, inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import (
    Column,
    DashboardCard,
    Inlines,
    KeyFigure,
    Meter,
    Status,
    Table,
    Text,
    Waterfall,
    WaterfallPiece,
    WaterfallStep,
    make_columns,
)
from archgen.views.timing import chain_status, load_charts, value_format
from archgen.views.timing.chain_waterfall import list_known_kinds
from archgen.views.timing.timing_lookup import TimingLookup

_MAX_SCALE = Fraction(2)
"""The scale ends at twice the deadline: beyond that a bar is cut, or all the others would be too short to compare."""
_SLACK_TICKS = (0, 25, 50, 75, 100, 150)


def make_slack_waterfall(lookup: Lookup, timing_lookup: TimingLookup) -> Waterfall | None:
    """Show how much of its deadline each chain uses; None where no chain has a deadline."""
    shares = [
        (result, chain_status.used_share(result))
        for result in chain_status.rank_chains(timing_lookup.chains)
        if result.id in lookup.architecture.chains and result.terms and result.deadline and result.deadline.value
    ]
    if not shares:
        return None
    scale = min(_MAX_SCALE, max(Fraction(1), *(share or Fraction(0) for _, share in shares)))
    ticks = tuple((float(Fraction(tick, 100) / scale), f"{tick} %") for tick in _SLACK_TICKS if tick <= scale * 100)
    steps = tuple(_make_step(lookup, result, share, scale) for result, share in shares)
    is_cut = any(share is not None and share > scale for _, share in shares)
    return Waterfall(
        (),
        (),
        (),
        (None, float(1 / scale)),
        "",
        ticks,
        steps,
        f"What takes more than {int(scale * 100)} % of its deadline is drawn short." if is_cut else "",
        (),
        (),
        title="How much of its deadline each chain uses",
    )


def _make_step(lookup: Lookup, result: ChainResult, share: Fraction | None, scale: Fraction) -> WaterfallStep:
    title = Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}")
    bound = value_format.display_duration(result.bound)
    deadline = value_format.display_duration(result.deadline) if result.deadline else ""
    words = f"{bound}; deadline {deadline}"
    if share is not None:
        percent = f"{value_format.display_number(share * 100, 1)} %"
        words = f"{'' if result.bound.complete else '>= '}{percent} · {bound} of {deadline}"
    return WaterfallStep(title, chain_status.chain_chip(result), tuple(_make_slack_pieces(result, scale)), words)


def _make_slack_pieces(result: ChainResult, scale: Fraction) -> Iterator[WaterfallPiece]:
    """Yield how long a chain waits, works and is on links, as shares of the scale; what nobody knows up to the deadline."""
    deadline = (result.deadline.value if result.deadline else None) or Fraction(1)
    position = Fraction(0)
    for kind, length, words in list_known_kinds(result):
        end = position + length / deadline
        if position < scale:
            yield WaterfallPiece(kind, float(position / scale), float(min(end, scale) / scale), words, end > scale)
        position = end
    if (result.bound.value is None or not result.bound.complete) and position < 1:
        yield WaterfallPiece("unknown", float(position / scale), float(1 / scale), "unknown")


_MAX_STEPS = 40
"""A host with more nodes gets one line for all that do not fit."""
_UNKNOWN_LENGTH = 0.06
_TICKS = 5
"""About so many figures along the axis."""
Side = Literal["exact", "at least", "at most"]
_OTHER_SIDES: Mapping[Side, Side] = {"at most": "at least", "at least": "at most", "exact": "exact"}
_LEGEND = (("response", "busy"), ("unknown", "unknown"))


def make_host_waterfall(lookup: Lookup, timing_lookup: TimingLookup, host_id: str) -> Waterfall | None:
    """Show where the time of a host goes; None where nothing runs on it, nothing is known, or its cores are not."""
    load = timing_lookup.analysis.hosts.get(host_id)
    if load is None or load.cores is None:
        return None
    shares = sum_by_node(timing_lookup, load, load.cores)
    total = sum((share.value or Fraction(0) for share in shares.values()), Fraction(0))
    if not total:
        return None
    whole = max(Fraction(1), total)
    room = 1 - _UNKNOWN_LENGTH if any(not share.complete for share in shares.values()) else 1.0
    return Waterfall(
        inline_text.to_inlines(load_charts.describe_load(load)),
        tuple(_make_total(shares, whole)),
        ((0.0, "0"), (float(total / whole), _percent(total))),
        (float(1 / whole), float(room / total) if total > 1 else None),
        "all cores busy",
        tuple(_make_ticks(total, room)),
        tuple(_make_steps(lookup, shares, total, room)),
        "",
        tuple(_make_figures(load, load.cores)),
        tuple(_make_cards(lookup, shares, load)),
        title="Who takes the time",
        legend=_LEGEND,
    )


def _percent(share: Fraction) -> str:
    return f"{value_format.display_number(share * 100, 1)} %"


def sum_by_node(timing_lookup: TimingLookup, load: HostLoad, cores: int) -> dict[str, TimingValue]:
    """Return the share of so many cores that each node takes, the largest first."""
    sums: dict[str, TimingValue] = {}
    for name, value in load.activity_shares:
        activity = timing_lookup.analysis.system.activities.get(name)
        node = activity.node if activity else name
        old = sums.get(node, TimingValue(Fraction(0)))
        side = value.side if value.side != "exact" else old.side
        is_complete = old.complete and value.value is not None and value.complete
        sums[node] = TimingValue((old.value or 0) + (value.value or Fraction(0)) / cores, is_complete, side=side)
    return dict(sorted(sums.items(), key=lambda item: -(item[1].value or Fraction(0))))


def _make_total(shares: dict[str, TimingValue], whole: Fraction) -> Iterator[WaterfallPiece]:
    """Yield a piece for each node; neighbours differ in shade."""
    position = Fraction(0)
    for index, (name, share) in enumerate(shares.items()):
        if share.value:
            end = position + share.value
            tip = f"{name} {value_format.display_share(share)}"
            yield WaterfallPiece(
                "sampling" if index % 2 else "response", float(position / whole), float(end / whole), tip
            )
            position = end
    if any(not share.complete for share in shares.values()) and position < whole:
        yield WaterfallPiece("unknown", float(position / whole), 1.0, "unknown")


def _make_ticks(total: Fraction, room: float) -> Iterator[tuple[float, str]]:
    """Yield round shares along the axis, which ends at the sum."""
    step = next(
        (size for size in (Fraction(n, 1000) for n in (1, 2, 5, 10, 20, 50, 100, 200, 500)) if size * _TICKS >= total),
        Fraction(1),
    )
    tick = Fraction(0)
    while tick < total:
        place = room * float(tick / total)
        if place < 0.97:  # noqa: PLR2004 - the last figure would stand beyond the axis
            yield place, _percent(tick)
        tick += step


def _make_steps(
    lookup: Lookup, shares: dict[str, TimingValue], total: Fraction, room: float
) -> Iterator[WaterfallStep]:
    """Yield a line for each node, where the one before ends, and one for those that do not fit."""
    shown_names = list(shares) if len(shares) <= _MAX_STEPS else list(shares)[: _MAX_STEPS - 1]
    position = Fraction(0)
    for name in shown_names:
        share = shares[name]
        end = position + (share.value or 0)
        node = lookup.architecture.nodes.get(name)
        yield WaterfallStep(
            inline_text.node_link(node) if node else Text(name),
            inline_text.owner_links(
                lookup.architecture, element_references.list_node_owners(lookup.architecture, name)
            ),
            tuple(_make_pieces(position, end, total, room, is_known=share.complete)),
            value_format.display_share(share),
        )
        position = end
    rest = [share for name, share in shares.items() if name not in set(shown_names)]
    if rest:
        known = sum((share.value or Fraction(0) for share in rest), Fraction(0))
        value = TimingValue(known, all(share.complete for share in rest))
        pieces = tuple(_make_pieces(position, position + known, total, room, is_known=value.complete))
        yield WaterfallStep(Text(f"{len(rest)} more nodes"), (), pieces, value_format.display_share(value))


def _make_pieces(
    start: Fraction, end: Fraction, total: Fraction, room: float, *, is_known: bool
) -> Iterator[WaterfallPiece]:
    last = room * float(end / total)
    if end > start:
        yield WaterfallPiece("response", room * float(start / total), last)
    if not is_known:
        yield WaterfallPiece("unknown", last, last + _UNKNOWN_LENGTH, "how much, nobody knows")


def _make_figures(load: HostLoad, cores: int) -> Iterator[KeyFigure]:
    share = load_charts.share_of_cores(load.utilisation, cores)
    yield KeyFigure("Load", value_format.display_share(share), "", (), "")
    if share.value is not None:
        left = Fraction(1) - share.value
        # What is at most in use leaves at least the rest, and the other way round.
        side = _OTHER_SIDES[share.side if share.complete or share.side != "exact" else "at least"]
        left_value = TimingValue(max(left, Fraction(0)), side=side)
        title = "Left until all cores are busy"
        value = value_format.display_share(left_value) if left > 0 else "nothing"
        yield KeyFigure(title, value, "", (), "")
    yield KeyFigure("Cores", str(cores), "", (), "")
    places = [place for place in load.core_loads if place[2].value is not None]
    if len(load.core_loads) > 1 and places:
        name, count, busy_cores = max(places, key=lambda place: (place[2].value or Fraction(0)) / place[1])
        note = inline_text.to_inlines(Text(load_charts.name_cores(name, count), muted=True))
        core_share = load_charts.share_of_cores(busy_cores, count)
        yield KeyFigure("Fullest core", value_format.display_share(core_share), "", note, "")


def _make_cards(lookup: Lookup, shares: dict[str, TimingValue], load: HostLoad) -> Iterator[DashboardCard]:
    """Yield the load by partner, and by core where something is pinned."""
    has_cores = len(load.core_loads) > 1
    columns: tuple[Column, ...]
    partner_rows = tuple(_make_partner_rows(lookup, shares))
    if partner_rows:
        columns = make_columns(("Partner", 1.6), ("Nodes", 0.6, "right"), "Of all cores", ("", 0.8, "right"))
        table = Table("table:load/partners", "Load by partner", columns, partner_rows)
        yield DashboardCard("By partner", (table,), 6 if has_cores else 12)
    if has_cores:
        columns = (Column("Cores", 1.6), Column("Of its time"), Column("", 0.8, "right"))
        table = Table("table:load/cores", "Load by core", columns, tuple(_make_core_rows(load)))
        yield DashboardCard("By core", (table,), 6 if partner_rows else 12)


def _make_partner_rows(lookup: Lookup, shares: dict[str, TimingValue]) -> Iterator[tuple[Inlines, ...]]:
    """Yield a row for each partner, or partners together, whose nodes run on the host; the largest load first."""
    names_by_owners: dict[tuple[str, ...], list[str]] = {}
    for name in shares:
        names_by_owners.setdefault(element_references.list_node_owners(lookup.architecture, name), []).append(name)
    sums = [(owners, names, _add_shares(shares[name] for name in names)) for owners, names in names_by_owners.items()]
    for owners, names, share in sorted(sums, key=lambda entry: -(entry[2].value or Fraction(0))):
        title = inline_text.owner_links(lookup.architecture, owners) or (Text("nobody yet", muted=True),)
        yield (title, inline_text.to_inlines(str(len(names))), *_make_share_cells(share))


def _make_core_rows(load: HostLoad) -> Iterator[tuple[Inlines, ...]]:
    for name, count, value in load_charts.sort_cores(load):
        share = load_charts.share_of_cores(value, count)
        yield (inline_text.to_inlines(load_charts.name_cores(name, count)), *_make_share_cells(share))


def _make_share_cells(share: TimingValue) -> tuple[Inlines, Inlines]:
    number = str(share.value or 0)
    status: Status = "missed" if share.value is not None and share.value >= 1 else "met"
    meter = Meter(float(share.value or 0), status, is_partial=not share.complete)
    figure = Text(value_format.display_share(share), sort_number=number)
    return (Text("", meter=meter, sort_number=number),), (figure,)


def _add_shares(shares: Iterable[TimingValue]) -> TimingValue:
    shares = tuple(shares)
    side: Side = next((share.side for share in shares if share.side != "exact"), "exact")
    total = sum((share.value or Fraction(0) for share in shares), Fraction(0))
    return TimingValue(total, all(share.complete for share in shares), side=side)
