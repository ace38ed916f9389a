"""What is left of each chain's deadline: all chains side by side on one scale, the worst first."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import ChainResult
from archgen.views.lookup import Lookup
from archgen.views.shapes import Text, Waterfall, WaterfallPiece, WaterfallStep
from archgen.views.timing import chain_status, value_format
from archgen.views.timing.chain_waterfall import list_known_kinds
from archgen.views.timing.timing_lookup import TimingLookup

_MAX_SCALE = Fraction(2)
"""The scale ends at twice the deadline: beyond that a bar is cut, or all the others would be too short to compare."""
_TICKS = (0, 25, 50, 75, 100, 150)


def make_slack_waterfall(lookup: Lookup, timing_lookup: TimingLookup) -> Waterfall | None:
    """Show how much of its deadline each chain uses; None where no chain has a deadline and a known time."""
    results = [
        (result, share)
        for result in chain_status.rank_chains(timing_lookup.chains)
        if result.id in lookup.architecture.chains and (share := chain_status.used_share(result)) is not None
    ]
    if not results:
        return None
    scale = min(_MAX_SCALE, max(Fraction(1), *(share for _, share in results)))
    ticks = tuple((float(Fraction(tick, 100) / scale), f"{tick} %") for tick in _TICKS if tick <= scale * 100)
    steps = tuple(_make_step(lookup, result, share, scale) for result, share in results)
    is_cut = any(share > scale for _, share in results)
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


def _make_step(lookup: Lookup, result: ChainResult, share: Fraction, scale: Fraction) -> WaterfallStep:
    title = Text(lookup.architecture.chains[result.id].title, ref=f"chain:{result.id}")
    words = (
        f"{value_format.display_duration(result.bound)} of {value_format.display_duration(result.deadline)}"
        if result.deadline
        else ""
    )
    percent = f"{value_format.display_number(share * 100, 1)} %"
    words = f"{'' if result.bound.complete else '>= '}{percent} · {words}"
    return WaterfallStep(title, chain_status.chain_chip(result), tuple(_make_pieces(result, scale)), words)


def _make_pieces(result: ChainResult, scale: Fraction) -> Iterator[WaterfallPiece]:
    """Yield how long a chain waits, works and is on links, as shares of the scale; what nobody knows up to the deadline."""
    deadline = (result.deadline.value if result.deadline else None) or Fraction(1)
    position = Fraction(0)
    for kind, length, words in list_known_kinds(result):
        end = position + length / deadline
        if position < scale:
            yield WaterfallPiece(kind, float(position / scale), float(min(end, scale) / scale), words, end > scale)
        position = end
    if not result.bound.complete and position < 1:
        yield WaterfallPiece("unknown", float(position / scale), float(1 / scale), "unknown")
