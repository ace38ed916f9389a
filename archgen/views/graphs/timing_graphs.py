"""Draw timing: every activity filled by the period that results for it, all of them and group by group.

The period is in every box as text. Boxes without one (unknown, on an event, on demand, once) differ by frame and word.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Literal

from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.timing.system.timing_system import Activity, Arc
from archgen.views.graphs import element_boxes
from archgen.views.graphs.graph_folding import add_legend_keys, fold_graph
from archgen.views.graphs.implementation_graph import draw_home_frame, find_home_frame
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from archgen.views.short_figures import shorten_text
from archgen.views.timing import value_format
from archgen.views.timing.timing_lookup import TimingLookup

_MAX_ARCS = 45
_MAX_LINES = 4
"""A grey box has no more lines than this with names of neighbours."""


def draw_timing_graphs(
    lookup: Lookup, timed: TimingLookup, group_ids: Iterable[str], node_ids: Collection[str] | None = None
) -> Iterator[Graph]:
    """Draw all activities, or those of selected nodes with their neighbours in grey; then some groups."""
    system = timed.analysis.system
    home_frames = {name: find_activity_home(lookup, activity) for name, activity in system.activities.items()}
    graph_data = TimingGraphData(lookup, timed, home_frames, bundle_arcs(system.arcs))
    yield _draw_all_activities(graph_data) if node_ids is None else _draw_selected_nodes(graph_data, node_ids)
    # Flows are assigned to groups in one pass: searching all of them for each group is quadratic.
    touching_flows: dict[str, list[ActivityFlow]] = {}
    for run in graph_data.flows:
        for group in dict.fromkeys((home_frames[run.tail], home_frames[run.head])):
            touching_flows.setdefault(group, []).append(run)
    for name in group_ids:
        yield _draw_group(replace(graph_data, flows=touching_flows.get(name, [])), name)


def _draw_all_activities(graph_data: TimingGraphData) -> Graph:
    """Draw all activities, framed by group."""
    lookup, timed = graph_data.lookup, graph_data.timed
    activities = timed.analysis.system.activities
    graph = Graph(
        "timing",
        f"{lookup.architecture.project.title}: how often everything happens",
        "two-step",
        tuple(
            replace(make_activity_box(timed, each), cluster=graph_data.home_frames[each.id])
            for each in activities.values()
        ),
        _merge_flows(lookup, graph_data.flows, graph_data.home_frames),
        tuple(draw_home_frame(lookup, each) for each in dict.fromkeys(graph_data.home_frames.values())),
        direction=lookup.architecture.layout.direction,
        notes=note_bounds(timed, activities),
        alt=describe_periods(timed, list(activities), "All activities"),
        asked=sum(len(run.arcs) for run in graph_data.flows),
        kind="timing",
    )
    return fold_graph(add_legend_keys(graph))


def _draw_selected_nodes(graph_data: TimingGraphData, node_ids: Collection[str]) -> Graph:
    """Draw the activities of some nodes, framed by group. What feeds and reads them is a grey box for each group."""
    lookup, timed = graph_data.lookup, graph_data.timed
    activities = timed.analysis.system.activities
    own_activities = {name: each for name, each in activities.items() if each.node in node_ids}
    touching_flows = [run for run in graph_data.flows if run.tail in own_activities or run.head in own_activities]
    home_frames = {
        name: frame if name in own_activities else f"around {frame}" for name, frame in graph_data.home_frames.items()
    }
    outside_ids = dict.fromkeys(
        end for run in touching_flows for end in (run.tail, run.head) if end not in own_activities
    )
    neighbours_by_frame = group_pairs((graph_data.home_frames[name], name) for name in outside_ids)
    graph = Graph(
        "timing",
        "The selected part: how often everything happens",
        "two-step",
        (
            *(
                replace(make_activity_box(timed, each), cluster=home_frames[each.id])
                for each in own_activities.values()
            ),
            *(_frame_of_neighbours(lookup, frame, names) for frame, names in neighbours_by_frame.items()),
        ),
        # Only arrows that come from a frame of the selection have a hue; all others are drawn pale.
        tuple(replace(each, faded=each.colour is None) for each in _merge_flows(lookup, touching_flows, home_frames)),
        tuple(draw_home_frame(lookup, each) for each in dict.fromkeys(home_frames[name] for name in own_activities)),
        direction=lookup.architecture.layout.direction,
        notes=note_bounds(timed, own_activities),
        alt=describe_periods(timed, tuple(own_activities), "The selected part"),
        asked=sum(len(run.arcs) for run in touching_flows),
        kind="timing",
    )
    return fold_graph(add_legend_keys(graph))


def _frame_of_neighbours(lookup: Lookup, frame: str, activity_ids: Sequence[str]) -> Box:
    """Return the neighbours in one frame as a grey box that names them."""
    cluster = draw_home_frame(lookup, frame)
    return Box(
        f"around {frame}",
        cluster.title,
        tuple(fit_lines(activity_ids, _MAX_LINES)),
        style="group",
        emphasis="neighbour",
        ref=cluster.ref,
        tooltip="\n".join(activity_ids),
    )


def _draw_group(graph_data: TimingGraphData, group_id: str) -> Graph:
    """Draw the activities of one group; neighbours that feed it are at the left, those that read it at the right."""
    lookup, timed = graph_data.lookup, graph_data.timed
    group, own_activities = lookup.architecture.groups[group_id], graph_data.activities_in(group_id)
    count = sum(len(run.arcs) for run in graph_data.flows)
    is_folded = count > _MAX_ARCS
    graph = Graph(
        f"timing/{group_id}",
        f"{group.title}: how often everything happens",
        "group",
        (
            *(replace(make_activity_box(timed, each), cluster=group_id) for each in own_activities.values()),
            *_draw_neighbours(graph_data, own_activities, is_folded=is_folded).values(),
        ),
        _draw_arrows(graph_data, own_activities, is_folded=is_folded),
        (element_boxes.group_frame(lookup, group_id),),
        direction=group.layout.direction or lookup.architecture.layout.direction,
        notes=note_bounds(timed, own_activities)
        + (("Neighbours are folded: a box for each group.",) if is_folded else ()),
        alt=describe_periods(timed, tuple(own_activities), group.title),
        asked=count,
        kind="group-timing",
    )
    return add_legend_keys(graph)


def _merge_flows(lookup: Lookup, flows: Sequence[ActivityFlow], home_frames: Mapping[str, str]) -> tuple[Arrow, ...]:
    """Merge flows: an arrow for each pair inside a frame, and one counted arrow from frame to frame."""
    bundles: dict[tuple[str, str, str], list[Arc]] = {}
    for run in flows:
        is_inside = home_frames[run.tail] == home_frames[run.head]
        ends = (run.tail, run.head, run.style) if is_inside else (home_frames[run.tail], home_frames[run.head], "data")
        bundles.setdefault(ends, []).extend(run.arcs)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            style=style,  # type: ignore[arg-type]
            count=len(arcs),
            colour=element_boxes.group_hue(lookup, tail)
            if tail in lookup.group_hues and tail not in home_frames
            else None,
            flows=tuple(describe_arc(arc) for arc in arcs),
        )
        for (tail, head, style), arcs in bundles.items()
    )


def _find_ends(
    graph_data: TimingGraphData, flow: ActivityFlow, own_ids: Collection[str], *, is_folded: bool
) -> tuple[str, str]:
    """Return the ids of the boxes that a flow joins: neighbours are at the left where they feed, at the right where
    they read.
    """

    def neighbour_id(activity_id: str, side: str) -> str:
        return side + (graph_data.home_frames[activity_id] if is_folded else activity_id)

    tail = flow.tail if flow.tail in own_ids else neighbour_id(flow.tail, "<")
    return tail, flow.head if flow.head in own_ids else neighbour_id(flow.head, ">")


def _draw_neighbours(graph_data: TimingGraphData, own_ids: Collection[str], *, is_folded: bool) -> dict[str, Box]:
    """Return the neighbours in grey, a box each or one for each of their groups, at the side where they belong."""
    boxes_by_id: dict[str, Box] = {}
    for run in graph_data.flows:
        for end, activity_id in zip(
            _find_ends(graph_data, run, own_ids, is_folded=is_folded), (run.tail, run.head), strict=True
        ):
            if activity_id not in own_ids and end not in boxes_by_id:
                boxes_by_id[end] = _neighbour_box(graph_data, activity_id, end, is_folded=is_folded)
    return boxes_by_id


def _neighbour_box(graph_data: TimingGraphData, activity_id: str, box_id: str, *, is_folded: bool) -> Box:
    side: Literal["left", "right"] = "left" if box_id[0] == "<" else "right"
    if is_folded:
        frame = draw_home_frame(graph_data.lookup, graph_data.home_frames[activity_id])
        return Box(box_id, frame.title, style="group", emphasis="neighbour", side=side, ref=frame.ref)
    box = make_activity_box(graph_data.timed, graph_data.timed.analysis.system.activities[activity_id])
    # Without the fill: neighbours are grey in every picture; the period is in their text.
    return replace(box, id=box_id, emphasis="neighbour", side=side, fill=None)


def _draw_arrows(graph_data: TimingGraphData, own_ids: Collection[str], *, is_folded: bool) -> tuple[Arrow, ...]:
    """Draw an arrow for each pair of boxes. A rate that differs from the producer's is written beside it."""
    bundles: dict[tuple[str, str, str], list[Arc]] = {}
    for run in graph_data.flows:
        ends = _find_ends(graph_data, run, own_ids, is_folded=is_folded)
        bundles.setdefault((*ends, run.style), []).extend(run.arcs)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            label=_rate_label(graph_data.timed, arcs) if not is_folded else str(len(arcs)) if len(arcs) > 1 else "",
            style=style,  # type: ignore[arg-type]
            count=len(arcs),
            flows=tuple(describe_arc(arc) for arc in arcs),
        )
        for (tail, head, style), arcs in bundles.items()
    )


def _rate_label(timed: TimingLookup, arcs: Sequence[Arc]) -> str:
    """Return the rates of outputs that are not published at each activation of their producer, two at most."""
    words = []
    for arc in arcs:
        output = timed.analysis.outputs.get((arc.source, arc.output))
        producer_rates = timed.analysis.paces.get(arc.source)
        if (
            arc.role == "data"
            and output
            and producer_rates
            and output.rate != producer_rates.rate
            and output.rate.value is not None
        ):
            words.append(shorten_text(value_format.display_rate(output.rate)))
    return "\n".join(list(dict.fromkeys(words))[:2])


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
