"""What all timing pictures share: activities as boxes, what runs among them, and the words below a picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

from archgen.frozen import dataclass
from archgen.timing.system.timing_system import Activity, Arc
from archgen.views.graphs.implementation_graph import find_home_frame
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Box
from archgen.views.timing import value_format
from archgen.views.timing.timing_lookup import TimingLookup

_BOUNDS_NOTE = "<= at most, >= at least: a bound, where no exact figure follows from what is written."


@dataclass(frozen=True, slots=True)
class ActivityFlow:
    """All that runs from one activity to another, in the direction of drawing; requests from client to server."""

    tail: str
    head: str
    style: Literal["data", "service", "action"]
    arcs: tuple[Arc, ...]


@dataclass(frozen=True, slots=True)
class TimingGraphData:
    """The data of all timing pictures: activities by frame, and what runs among them, found once."""

    lookup: Lookup
    timed: TimingLookup
    home_frames: Mapping[str, str]
    flows: Sequence[ActivityFlow]

    def activities_in(self, frame: str) -> dict[str, Activity]:
        """Return the activities of a frame, by id."""
        activities = self.timed.analysis.system.activities
        return {name: activities[name] for name, home in self.home_frames.items() if home == frame}


def find_activity_home(lookup: Lookup, activity: Activity) -> str:
    """Return the frame of an activity: its component's group, or its node's frame where it has no component."""
    component = lookup.architecture.components.get(activity.component or "")
    if component is None:  # an activity may know its component by the last part of the id
        names = [
            each
            for each in lookup.architecture.nodes[activity.node].implements
            if each.endswith(f".{activity.component}")
        ]
        component = lookup.architecture.components.get(names[0]) if names else None
    return component.group if component else find_home_frame(lookup, lookup.architecture.nodes[activity.node])


def make_activity_box(timed: TimingLookup, activity: Activity) -> Box:
    """Draw an activity as a box: its rate as text, its period as fill, reasons as tooltip."""
    pace = timed.analysis.paces.get(activity.id)
    response = timed.analysis.responses.get(activity.id)
    tooltip = [activity.id, value_format.format_rate_words(pace)]
    tooltip += [f"longest gap {value_format.display_duration(pace.gap)}"] if pace and pace.gap.value is not None else []
    tooltip += (
        [f"responds within {value_format.display_duration(response.worst)}"]
        if response and response.worst.value
        else []
    )
    tooltip += [reason.text for reason in pace.reasons[:6]] if pace else []
    return Box(
        activity.id,
        activity.id,
        value_format.format_box_lines(pace),
        ref=f"node:{activity.node}",
        tooltip="\n".join(tooltip),
        fill=value_format.find_period_step(pace),
    )


def bundle_arcs(arcs: Iterable[Arc]) -> list[ActivityFlow]:
    """Bundle what runs between two activities. Answers run back along their requests and are not drawn."""
    bundles: dict[tuple[str, str, Literal["data", "service", "action"]], list[Arc]] = {}
    for arc in arcs:
        if arc.role != "answer" and arc.source != arc.target:
            style: Literal["data", "service", "action"] = "data" if arc.flow == "topic" else arc.flow
            bundles.setdefault((arc.source, arc.target, style), []).append(arc)
    return [ActivityFlow(*ends, tuple(bundle)) for ends, bundle in bundles.items()]


def describe_arc(arc: Arc) -> str:
    """Say what runs along an arc."""
    return f"{arc.source} → {arc.topic} → {arc.target}"


def note_bounds(timed: TimingLookup, activity_ids: Iterable[str]) -> tuple[str, ...]:
    """Return the note that explains the signs of bounds, where a box shows one."""
    activity_rates = [timed.analysis.paces.get(name) for name in activity_ids]
    return (
        (_BOUNDS_NOTE,)
        if any(pace and value_format.bound_sign(pace.rate) for pace in activity_rates if pace and pace.rate.value)
        else ()
    )


def describe_periods(timed: TimingLookup, activity_ids: Sequence[str], subject: str) -> str:
    """Describe how many activities have which period."""
    steps = [value_format.find_period_step(timed.analysis.paces.get(name)) for name in activity_ids]
    counts = [(name, steps.count(step)) for step, name in value_format.PERIOD_STEP_WORDS.items() if step in steps]
    period_words = ", ".join(f"{count} {name}" for name, count in counts)
    return (
        f"{subject}: {count_noun(len(activity_ids), 'activity')} by period: {period_words}."
        if period_words
        else f"{subject}: no activities."
    )
