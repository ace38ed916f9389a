"""Charts of load: all hosts by activity, and each host activity by activity."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.timing.analysis import HostLoad
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar, SegmentKind
from archgen.views.timing import value_format
from archgen.views.timing.timing_lookup import TimingLookup

_MAX_BARS = 18
"""A host with more activities gets one bar for all that do not fit."""
OUTSIDE_NOTE = "Grey names stand outside of the selected part."
"""Note below a chart with bars outside of the selection."""


def is_outside_scope(lookup: Lookup, timing_lookup: TimingLookup, activity_id: str) -> bool:
    """Whether an activity lies outside of the shown part; False for unknown ids."""
    activity = timing_lookup.analysis.system.activities.get(activity_id)
    return activity is not None and not lookup.scope.shows_node(activity.node)


def to_float(value: Fraction) -> float:
    """Turn an exact value into a float for drawing."""
    return value.numerator / value.denominator


def make_load_charts(lookup: Lookup, timing_lookup: TimingLookup) -> Iterator[Chart]:
    """Yield the chart of all hosts with something shown, then one chart for each of them."""
    loads = {
        host: load
        for host, load in timing_lookup.analysis.hosts.items()
        # One shown activity is enough: the host is then charted with all of its load, since the limit applies to all.
        # Without a number of cores there is no 100 %.
        if load.activity_shares
        and load.cores is not None
        and not all(is_outside_scope(lookup, timing_lookup, name) for name, _ in load.activity_shares)
    }
    if loads:
        yield make_host_overview(lookup, loads)
    for host, load in loads.items():
        yield make_host_chart(lookup, timing_lookup, host, load)


def _count_cores(load: HostLoad) -> int:
    """Return the number of a host's cores; charts are drawn only where it is known."""
    return load.cores or 1


def make_host_overview(lookup: Lookup, loads_by_host: dict[str, HostLoad]) -> Chart:
    """Draw the load of every host as a share of all its cores, split by activity."""
    bars = tuple(
        ChartBar(
            f"{lookup.architecture.hosts[host].title} ({count_noun(_count_cores(load), 'core')})",
            (
                *_share_segments(load),
                *([BarSegment(None, "load", "?", _list_unknown_loads(load))] if _has_unknown_load(load) else []),
            ),
            value_format.display_share(share_of_cores(load.utilisation, _count_cores(load))),
            mark=_bound_mark(load),
            ref=f"host:{host}",
        )
        for host, load in loads_by_host.items()
    )
    return Chart(
        "load",
        f"{lookup.architecture.project.title}: load of the hosts",
        "%",
        bars,
        limit=(100.0, "all cores busy"),
        legend=(
            "load: activities, the largest first",
            *(["unknown"] if any(map(_has_unknown_load, loads_by_host.values())) else []),
            *(
                ["mark: rate-monotonic bound"]
                if any(_bound_mark(load) is not None for load in loads_by_host.values())
                else []
            ),
        ),
        alt="; ".join(f"{bar.title}: {bar.value}" for bar in bars),
    )


def _share_segments(load: HostLoad) -> Iterator[BarSegment]:
    """Yield the known parts of a load, largest first, alternating between two shades so that neighbours differ."""
    parts = [(name, value.value) for name, value in load.activity_shares if value.value]
    for index, (name, value) in enumerate(sorted(parts, key=lambda part: -part[1])):
        share = TimingValue(value / _count_cores(load))
        kind: SegmentKind = "other_load" if index % 2 else "load"
        length = to_float(value * 100 / _count_cores(load))
        yield BarSegment(length, kind, name, f"{name}: {value_format.display_share(share)}")


def share_of_cores(value: TimingValue, cores: int | None) -> TimingValue:
    """Turn a number of busy cores into a share of all cores (None: unknown); what is known about the value stays."""
    if cores is None:
        return UNKNOWN_VALUE
    share_value = None if value.value is None else value.value / cores
    return TimingValue(share_value, value.complete, value.missing, value.assumptions, value.side)


def _bound_mark(load: HostLoad) -> float | None:
    """Return the rate-monotonic bound in percent; None where it is unknown or the host has several cores."""
    bound = load.rate_monotonic_bound.value
    # The bound is a theorem about one core.
    return to_float(bound * 100) if bound is not None and _count_cores(load) == 1 else None


def _has_unknown_load(load: HostLoad) -> bool:
    return any(value.value is None for _, value in load.activity_shares)


def _list_unknown_loads(load: HostLoad) -> str:
    return "not known: " + ", ".join(name for name, value in load.activity_shares if value.value is None)


def make_host_chart(lookup: Lookup, timing_lookup: TimingLookup, host_id: str, load: HostLoad) -> Chart:
    """Draw the load of one host, activity by activity, largest first, and their sum."""
    # Unknown loads come last: their bars have no length.
    ordered_parts = sorted(load.activity_shares, key=lambda part: (part[1].value is None, -(part[1].value or 0)))
    # One fewer than fits, because the bar for the remaining ones needs a row, too.
    shown_parts = ordered_parts if len(ordered_parts) <= _MAX_BARS else ordered_parts[: _MAX_BARS - 1]
    total_share = share_of_cores(load.utilisation, _count_cores(load))
    activity_bars = tuple(_activity_bars(lookup, timing_lookup, load, shown_parts, ordered_parts[len(shown_parts) :]))
    return Chart(
        f"load/{host_id}",
        f"{lookup.architecture.hosts[host_id].title}: load by activity",
        "%",
        (*activity_bars, _total_bar(load, total_share), *_core_bars(load)),
        limit=(100.0, "all cores busy" if _count_cores(load) > 1 else "busy all the time"),
        conclusion=describe_load(load),
        legend=(
            *(["unknown"] if _has_unknown_load(load) else []),
            *(["mark: rate-monotonic bound"] if _bound_mark(load) is not None else []),
        ),
        notes=(OUTSIDE_NOTE,) if any(bar.is_outside for bar in activity_bars) else (),
        alt=f"{lookup.architecture.hosts[host_id].title}: {value_format.display_share(total_share)} of {count_noun(_count_cores(load), 'core')}. "
        + describe_load(load),
    )


def _activity_bars(
    lookup: Lookup,
    timing_lookup: TimingLookup,
    load: HostLoad,
    shown_parts: list[tuple[str, TimingValue]],
    remaining_parts: list[tuple[str, TimingValue]],
) -> Iterator[ChartBar]:
    """Yield a bar for each listed activity, starting where the one before ends, and one for the remaining ones."""
    start = Fraction(0)
    for name, value in shown_parts:
        share = share_of_cores(value, _count_cores(load))
        activity = timing_lookup.analysis.system.activities.get(name)
        ref = f"node:{activity.node}" if activity else None
        yield ChartBar(
            name,
            (_load_segment(share, name),),
            value_format.display_share(share),
            to_float(start * 100),
            ref=ref,
            is_outside=is_outside_scope(lookup, timing_lookup, name),
        )
        # Bars stand end to end, so the last one ends at the sum below them.
        start += share.value or 0
    if remaining_parts:
        remaining_sum = sum((value.value or Fraction(0) for _, value in remaining_parts), Fraction(0))
        remaining_load = remaining_sum / _count_cores(load)
        has_gap = any(value.value is None for _, value in remaining_parts)
        share = TimingValue(remaining_load, not has_gap)
        unknown_segments = (BarSegment(None, "load", "?", _list_unknown_loads(load)),) if has_gap else ()
        yield ChartBar(
            f"{len(remaining_parts)} more",
            (_load_segment(share, "the rest"), *unknown_segments),
            value_format.display_share(share),
            to_float(start * 100),
        )


def _load_segment(share: TimingValue, label: str) -> BarSegment:
    length = None if share.value is None else to_float(share.value * 100)
    return BarSegment(length, "load", "", f"{label}: {value_format.display_share(share)}")


def _total_bar(load: HostLoad, total_share: TimingValue) -> ChartBar:
    """Draw the sum, coloured by the verdict; unknown parts follow as a hatched piece."""
    segment_kinds: dict[str, SegmentKind] = {"schedulable": "met", "overload": "missed"}
    length = None if total_share.value is None else to_float(total_share.value * 100)
    kind: SegmentKind = segment_kinds.get(load.verdict, "open")
    known_segments = (BarSegment(length, kind, "", value_format.display_share(total_share)),)
    unknown_segments = (
        (BarSegment(None, "open", "?", _list_unknown_loads(load)),)
        if length is not None and _has_unknown_load(load)
        else ()
    )
    return ChartBar(
        "Together",
        (*known_segments, *unknown_segments),
        value_format.display_share(total_share),
        mark=_bound_mark(load),
        strong=True,
    )


def _core_bars(load: HostLoad) -> Iterator[ChartBar]:
    """Yield a bar for each pinned core and for the cores that all else shares, each compared with itself."""
    if len(load.core_loads) < 2:  # noqa: PLR2004 - one place is the host
        return
    for name, cores, core_load in sort_cores(load):
        share = share_of_cores(core_load, cores)
        is_full = core_load.value is not None and core_load.value >= cores
        known_length = None if share.value is None else to_float(share.value * 100)
        title = name_cores(name, cores)
        tooltip = f"{title}: {value_format.display_share(share)} of {count_noun(cores, 'core')}"
        segments: tuple[BarSegment, ...] = (BarSegment(known_length, "missed" if is_full else "best", "", tooltip),)
        if known_length is not None and not core_load.complete:
            segments += (BarSegment(None, "open", "?", tooltip),)
        yield ChartBar(title, segments, value_format.display_share(share))


def sort_cores(load: HostLoad) -> list[tuple[str, int, TimingValue]]:
    """Return the pinned cores of a host by number, then those that all else shares."""
    # Pinned cores have a blank in their name (`pc core 7`), the shared ones do not. Length before text, so that core 10
    # follows core 9.
    return sorted(load.core_loads, key=lambda place: (" " not in place[0], len(place[0]), place[0]))


def name_cores(place_name: str, cores: int) -> str:
    """Name the cores of a place: `core 7`, or those that all else shares."""
    return place_name.partition(" ")[2] or f"the other {count_noun(cores, 'core')}"


def describe_load(load: HostLoad) -> str:
    """Describe in one sentence how a host copes with its load."""
    if load.cores is None:
        busy_cores = value_format.display_share(load.utilisation)
        return f"How many cores it has is not written; what is known of its load takes {busy_cores} of one."
    share_text = value_format.display_share(share_of_cores(load.utilisation, load.cores))
    core_count = count_noun(_count_cores(load), "core")
    if load.verdict == "overload":
        # A host may be overloaded although its total is below 100 %: one pinned core is enough, so it is named.
        full_cores = [
            name_cores(name, count)
            for name, count, core_load in load.core_loads
            if core_load.value is not None and core_load.value >= count
        ]
        location = f" ({', '.join(full_cores)})" if full_cores and len(load.core_loads) > 1 else ""
        return f"Overloaded{location}: {share_text} of {core_count}."
    if load.verdict == "schedulable":
        how = "priorities by rate are sure to do" if load.unproven else "everything is done before it is due again"
        return f"In time: {share_text} of {core_count}, and {how}."
    unknown_count = sum(value.value is None for _, value in load.activity_shares)
    # Nothing at all is known, so there is no figure to begin the sentence with.
    if unknown_count and share_text == value_format.UNKNOWN_FIGURE:
        return f"The load is not known: that of {count_noun(unknown_count, 'activity')} is missing."
    if unknown_count:
        return f"{share_text[0].upper()}{share_text[1:]} of {core_count}; the load of {count_noun(unknown_count, 'activity')} is not known."
    parts = f"{len(load.unproven)} of {count_noun(len(load.activity_shares), 'activity')}"
    return (
        f"{share_text} of {core_count}: below full load, but nothing proves of {parts} that their work is done in time."
    )
