"""What was measured on the robot, beside what is promised and what is expected of an interface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.figures.figure_wording import format_duration, format_rate
from archgen.timing.system import activity_builder
from archgen.views.agreement.promise_rows import MAX_AGE, MAX_GAP, RATE, PromiseRow
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text

_NS_PER_SECOND = 10**9
_ROW_ASPECTS = {RATE.key: "rate", MAX_GAP.key: "gap", MAX_AGE.key: "max_age"}
_PROMISED_ASPECTS = {MAX_GAP.key: ("gap", "max_gap"), RATE.key: ("rate",), MAX_AGE.key: ("max_age",)}


def add_measured(
    lookup: Lookup,
    activity_names: activity_builder.ActivityNames,
    interface: PartnerInterface,
    rows: Sequence[PromiseRow],
    observations: Sequence[Observation],
) -> tuple[PromiseRow, ...]:
    """Return rows with what was measured of the interface's topics, else of who sends it.

    A row of one of several nodes (`Rate of NODE`) has what was measured of that node alone.
    """
    if interface.flow != "topic":
        return tuple(rows)
    givers = {
        endpoint.node: activity_builder.activity_of_endpoint(activity_names, endpoint)
        for endpoint in list_givers(lookup.architecture, interface)
    }
    topic_figures = _collect_figures(observations, set(interface.topic_names))
    all_figures = topic_figures or _collect_figures(observations, set(givers.values()) if len(givers) == 1 else set())
    figures_by_row = {
        row.name: _collect_figures(observations, {givers.get(row.name.node, "")})
        if row.name.node and row.name.key in _ROW_ASPECTS
        else all_figures
        for row in rows
    }
    measured_rows = [_measure_row(row, figures_by_row[row.name]) for row in rows]
    if "max_age" in all_figures and not any(row.name == MAX_AGE for row in rows):
        measured_rows.append(_measure_row(PromiseRow(MAX_AGE), all_figures))
    return tuple(measured_rows)


def _collect_figures(observations: Sequence[Observation], ids: set[str]) -> dict[str, Fraction]:
    """Return the worst that was seen of some topics or activities: rate in Hz, gap and age in ns."""
    figures: dict[str, list[Fraction]] = {}
    for observation in observations:
        if observation.id in ids:
            for aspect, value in _list_figures(observation):
                figures.setdefault(aspect, []).append(value)
    return {aspect: min(values) if aspect == "rate" else max(values) for aspect, values in figures.items()}


def _list_figures(observation: Observation) -> Iterator[tuple[str, Fraction]]:
    figures = observation.figures
    if "rate" in figures:
        yield "rate", figures["rate"].value
    elif "period" in figures and figures["period"].value:
        yield "rate", _NS_PER_SECOND / figures["period"].value
    if "max_period" in figures:
        yield "gap", figures["max_period"].value
    if "delay" in figures:
        yield "max_age", figures["delay"].value


def _measure_row(row: PromiseRow, figures: dict[str, Fraction]) -> PromiseRow:
    value = figures.get(_ROW_ASPECTS.get(row.name.key, ""))
    return row if value is None else replace(row, measured=_write_figure(row, value))


def _write_figure(row: PromiseRow, value: Fraction) -> Inlines:
    """Return a measured figure, marked where it is worse than what is promised."""
    key = row.name.key
    promised = next((row.strength[each] for each in _PROMISED_ASPECTS[key] if each in row.strength), None)
    if key == RATE.key:
        text, is_worse = format_rate(value), promised is not None and value < promised
    else:
        text, is_worse = format_duration(value), promised is not None and value > -promised
    words = f"{text} on arrival" if key == MAX_AGE.key else text
    if is_worse:
        return (Text(f"{words}, worse than promised", status="missed", sort_number=str(value)),)
    return (Text(words, sort_number=str(value)),)
