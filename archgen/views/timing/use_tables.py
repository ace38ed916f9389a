"""Tables of what is used together and of what is used in turn: fused inputs, resources, measured execution times."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.timing_system import Activity
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Column, Fact, Table, Text
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import TimingLookup

if TYPE_CHECKING:
    from archgen.timing.chains.fused_inputs import FusedInputs

_VERDICT_WORDS = {"bearable": "bearable", "overload": "overloaded", "unknown": "unknown"}


def make_fused_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List the activities that use messages of several inputs together: how old these are, and how far apart."""
    rows = tuple(
        (
            timing_tables.activity_link(timing_lookup, fused.activity),
            inline_text.to_inlines(_describe_fusion(fused)),
            timing_tables.duration_cell(fused.apart),
            inline_text.to_inlines(_describe_ages(fused)),
        )
        for fused in timing_lookup.fused_inputs
        if lookup.scope.shows_node(timing_lookup.analysis.system.activities[fused.activity].node)
    )
    columns = (
        Column("Activity", 1.5),
        Column("Takes", 1.2),
        Column("Apart, at most", 0.8, "right"),
        Column("Age when it begins, at most", 2.5),
    )
    return Table("table:fused", "Messages that are used together", columns, rows) if rows else None


def _describe_fusion(fused: FusedInputs) -> str:
    return "all inputs" if fused.within is None else f"what is at most {format_duration(fused.within)} apart"


def _describe_ages(fused: FusedInputs) -> str:
    return ", ".join(
        f"{key.rpartition('.')[2]} {value_format.display_duration(age)}" for key, age in fused.ages.items()
    )


def make_resource_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List resources such as GPUs with their load, and how long each use takes at most, waiting included."""
    analysis = timing_lookup.analysis
    rows = tuple(
        (
            inline_text.to_inlines(name),
            inline_text.to_inlines(load.host or ""),
            timing_tables.share_cell(load.utilisation),
            inline_text.to_inlines(_VERDICT_WORDS[load.verdict]),
            inline_text.join_inlines(
                (*timing_tables.activity_link(timing_lookup, user), Text(f" {value_format.display_duration(wait)}"))
                for user, wait in load.waits.items()
                if lookup.scope.shows_node(analysis.system.activities[user].node)
            ),
        )
        for name, load in analysis.resources.items()
    )
    columns = (
        Column("Resource", 1),
        Column("Host", 0.8),
        Column("Load", 0.6, "right"),
        Column("Verdict", 0.8),
        Column("Longest use, waiting included", 2.5),
    )
    return Table("table:resources", "Resources that work on one use at a time", columns, rows) if rows else None


def make_measured_table(lookup: Lookup, timing_lookup: TimingLookup) -> Table | None:
    """List measured percentiles of execution times beside the longest, on which alone bounds rest."""
    tick = timing_lookup.analysis.system.tick
    rows = tuple(
        (
            timing_tables.activity_link(timing_lookup, activity.id),
            inline_text.to_inlines(describe_percentiles(activity, tick)),
            timing_tables.duration_cell(_find_longest(activity, tick)),
            inline_text.to_inlines("longest seen, not proven" if activity.wcet_measured else "written"),
        )
        for activity in timing_lookup.analysis.system.activities.values()
        if (activity.percentiles or activity.wcet_measured) and lookup.scope.shows_node(activity.node)
    )
    columns = (
        Column("Activity", 1.5),
        Column("Measured", 2),
        Column("Longest", 0.8, "right"),
        Column("Where the longest is from", 1.4),
    )
    return (
        Table("table:measured", "Measured execution times: bounds rest on the longest", columns, rows) if rows else None
    )


def describe_percentiles(activity: Activity, tick: Fraction) -> str:
    """Return the measured percentiles of an execution time: `p50 1 ms, p99 3 ms`."""
    return ", ".join(f"{key} {format_duration(Fraction(ticks * tick))}" for key, ticks in activity.percentiles.items())


def _find_longest(activity: Activity, tick: Fraction) -> TimingValue:
    return TimingValue(None, complete=False) if activity.wcet is None else TimingValue(activity.wcet * tick)


def list_use_facts(timing_lookup: TimingLookup, activity: Activity, suffix: str) -> Iterator[Fact]:
    """Yield what is known of one activity: what it fuses, which resources it uses, how long it was seen to take."""
    analysis = timing_lookup.analysis
    for fused in timing_lookup.fused_inputs:
        if fused.activity == activity.id:
            text = (
                f"{_describe_fusion(fused)}; at most {value_format.display_duration(fused.apart)} apart; age at most: "
            )
            words = inline_text.to_inlines(text + _describe_ages(fused))
            yield Fact("activity", f"Uses together{suffix}", words)
    for resource_id in activity.uses:
        load = analysis.resources.get(resource_id)
        wait = load.waits.get(activity.id) if load else None
        if wait is not None:
            text = f"{value_format.display_duration(wait)} at most for each use, waiting included"
            yield Fact("", f"{resource_id}{suffix}", inline_text.to_inlines(text))
    if activity.percentiles:
        words = inline_text.to_inlines(describe_percentiles(activity, analysis.system.tick))
        yield Fact("", f"Execution time{suffix}, measured", words)
