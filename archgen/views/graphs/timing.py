"""Draw timing: every activity filled by the period that results for it, all of them and group by group.

The period is in every box as text. Boxes without one (unknown, on an event, on demand, once) differ by frame and word.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from archgen.timing.system import Activity, Arc
from archgen.views import figures, paces
from archgen.views.graphs import boxes
from archgen.views.graphs.folding import fold
from archgen.views.graphs.legend import with_legend
from archgen.views.graphs.ros import home_of
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Cluster, Graph
from archgen.views.timed import Timed
from archgen.views.words import plural

_MANY = 45
_NAMED = 3
"""This many neighbours are named in a grey box."""
_BOUNDS = "<= at most, >= at least: a bound, where no exact figure follows from what is written."


@dataclass(frozen=True, slots=True)
class _Run:
    """All that runs from one activity to another, in the direction of drawing; requests from client to server."""

    tail: str
    head: str
    style: Literal["data", "service", "action"]
    arcs: tuple[Arc, ...]


@dataclass(frozen=True, slots=True)
class _Whole:
    """The data of all timing pictures: activities by frame, and what runs among them, found once."""

    view: Index
    timed: Timed
    home: Mapping[str, str]
    running: Sequence[_Run]

    def inside(self, frame: str) -> dict[str, Activity]:
        """Return the activities of a frame, by id."""
        activities = self.timed.analysis.system.activities
        return {name: activities[name] for name, home in self.home.items() if home == frame}


def pictures(
    view: Index, timed: Timed, groups: Iterable[str], selected: Collection[str] | None = None
) -> Iterator[Graph]:
    """Draw all activities, or those of selected nodes with their neighbours in grey; then some groups."""
    system = timed.analysis.system
    home = {name: _home(view, activity) for name, activity in system.activities.items()}
    everything = _Whole(view, timed, home, _runs(system.arcs))
    yield _timing(everything) if selected is None else _selected(everything, selected)
    # Flows are assigned to groups in one pass: searching all of them for each group is quadratic.
    touching: dict[str, list[_Run]] = {}
    for run in everything.running:
        for group in dict.fromkeys((home[run.tail], home[run.head])):
            touching.setdefault(group, []).append(run)
    for name in groups:
        yield _group(replace(everything, running=touching.get(name, [])), name)


def _timing(whole: _Whole) -> Graph:
    """Draw all activities, framed by group."""
    view, timed = whole.view, whole.timed
    activities = timed.analysis.system.activities
    graph = Graph(
        "timing",
        f"{view.architecture.project.title}: how often everything happens",
        "two-step",
        tuple(replace(_box(timed, each), cluster=whole.home[each.id]) for each in activities.values()),
        _merged(view, whole.running, whole.home),
        tuple(_frame(view, each) for each in dict.fromkeys(whole.home.values())),
        direction=view.architecture.layout.direction or "left-right",
        notes=_notes(timed, activities),
        alt=_alt(timed, list(activities), "All activities"),
        asked=sum(len(run.arcs) for run in whole.running),
    )
    return fold(with_legend(graph))


def _selected(whole: _Whole, nodes: Collection[str]) -> Graph:
    """Draw the activities of some nodes, framed by group. What feeds and reads them is a grey box for each group."""
    view, timed = whole.view, whole.timed
    activities = timed.analysis.system.activities
    mine = {name: each for name, each in activities.items() if each.node in nodes}
    running = [run for run in whole.running if run.tail in mine or run.head in mine]
    home = {name: frame if name in mine else f"around {frame}" for name, frame in whole.home.items()}
    outside = dict.fromkeys(end for run in running for end in (run.tail, run.head) if end not in mine)
    around: dict[str, list[str]] = {}
    for name in outside:
        around.setdefault(whole.home[name], []).append(name)
    graph = Graph(
        "timing",
        "The selected part: how often everything happens",
        "two-step",
        (
            *(replace(_box(timed, each), cluster=home[each.id]) for each in mine.values()),
            *(_around(view, frame, names) for frame, names in around.items()),
        ),
        # Only arrows that come from a frame of the selection have a hue; all others are drawn pale.
        tuple(replace(each, faded=each.colour is None) for each in _merged(view, running, home)),
        tuple(_frame(view, each) for each in dict.fromkeys(home[name] for name in mine)),
        direction=view.architecture.layout.direction or "left-right",
        notes=_notes(timed, mine),
        alt=_alt(timed, tuple(mine), "The selected part"),
        asked=sum(len(run.arcs) for run in running),
    )
    return fold(with_legend(graph))


def _around(view: Index, frame: str, names: Sequence[str]) -> Box:
    """Return the neighbours in one frame as a grey box that names them."""
    shown = names if len(names) <= _NAMED + 1 else [*names[:_NAMED], f"and {len(names) - _NAMED} more"]
    found = _frame(view, frame)
    return Box(
        f"around {frame}",
        found.title,
        tuple(shown),
        style="group",
        emphasis="neighbour",
        ref=found.ref,
        tooltip="\n".join(names),
    )


def _group(whole: _Whole, name: str) -> Graph:
    """Draw the activities of one group; neighbours that feed it are at the left, those that read it at the right."""
    view, timed = whole.view, whole.timed
    found, mine = view.architecture.groups[name], whole.inside(name)
    count = sum(len(run.arcs) for run in whole.running)
    folded = count > _MANY
    graph = Graph(
        f"timing/{name}",
        f"{found.title}: how often everything happens",
        "group",
        (
            *(replace(_box(timed, each), cluster=name) for each in mine.values()),
            *_neighbours(whole, mine, folded=folded).values(),
        ),
        _placed(whole, mine, folded=folded),
        (boxes.frame(view, name),),
        direction=found.layout.direction or view.architecture.layout.direction or "left-right",
        notes=_notes(timed, mine) + (("Neighbours are folded: a box for each group.",) if folded else ()),
        alt=_alt(timed, tuple(mine), found.title),
        asked=count,
    )
    return with_legend(graph)


def _home(view: Index, activity: Activity) -> str:
    component = view.architecture.components.get(activity.component or "")
    if component is None:  # an activity may know its component by the last part of the id
        names = [
            each
            for each in view.architecture.nodes[activity.node].implements
            if each.endswith(f".{activity.component}")
        ]
        component = view.architecture.components.get(names[0]) if names else None
    return component.group if component else home_of(view, view.architecture.nodes[activity.node])


def _frame(view: Index, home: str) -> Cluster:
    if home in view.architecture.groups:
        return boxes.frame(view, home)
    return Cluster(home, home.removeprefix("namespace "))


def _box(timed: Timed, activity: Activity) -> Box:
    pace = timed.analysis.paces.get(activity.id)
    response = timed.analysis.responses.get(activity.id)
    tooltip = [activity.id, paces.said(pace)]
    tooltip += [f"longest gap {figures.duration(pace.gap)}"] if pace and pace.gap.value is not None else []
    tooltip += [f"responds within {figures.duration(response.worst)}"] if response and response.worst.value else []
    tooltip += [reason.text for reason in pace.reasons[:6]] if pace else []
    return Box(
        activity.id,
        activity.id,
        paces.lines(pace),
        ref=f"node:{activity.node}",
        tooltip="\n".join(tooltip),
        fill=paces.step(pace),
    )


def _runs(arcs: Iterable[Arc]) -> list[_Run]:
    """Bundle what runs between two activities. Answers run back along their requests and are not drawn."""
    bundles: dict[tuple[str, str, Literal["data", "service", "action"]], list[Arc]] = {}
    for arc in arcs:
        if arc.role != "answer" and arc.source != arc.target:
            style: Literal["data", "service", "action"] = "data" if arc.flow == "topic" else arc.flow
            bundles.setdefault((arc.source, arc.target, style), []).append(arc)
    return [_Run(*ends, tuple(found)) for ends, found in bundles.items()]


def _sentence(arc: Arc) -> str:
    return f"{arc.source} → {arc.topic} → {arc.target}"


def _merged(view: Index, running: Sequence[_Run], home: Mapping[str, str]) -> tuple[Arrow, ...]:
    """Merge flows: an arrow for each pair inside a frame, and one counted arrow from frame to frame."""
    bundles: dict[tuple[str, str, str], list[Arc]] = {}
    for run in running:
        inside = home[run.tail] == home[run.head]
        ends = (run.tail, run.head, run.style) if inside else (home[run.tail], home[run.head], "data")
        bundles.setdefault(ends, []).extend(run.arcs)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            style=style,  # type: ignore[arg-type]
            count=len(arcs),
            colour=boxes.hue(view, tail) if tail in view.hues and tail not in home else None,
            flows=tuple(_sentence(arc) for arc in arcs),
        )
        for (tail, head, style), arcs in bundles.items()
    )


def _ends(whole: _Whole, run: _Run, mine: Collection[str], *, folded: bool) -> tuple[str, str]:
    """Return the ids of the boxes that a flow joins: neighbours are at the left where they feed, at the right where
    they read.
    """

    def outer(name: str, side: str) -> str:
        return side + (whole.home[name] if folded else name)

    tail = run.tail if run.tail in mine else outer(run.tail, "<")
    return tail, run.head if run.head in mine else outer(run.head, ">")


def _neighbours(whole: _Whole, mine: Collection[str], *, folded: bool) -> dict[str, Box]:
    """Return the neighbours in grey, a box each or one for each of their groups, at the side where they belong."""
    found: dict[str, Box] = {}
    for run in whole.running:
        for end, inner in zip(_ends(whole, run, mine, folded=folded), (run.tail, run.head), strict=True):
            if inner not in mine and end not in found:
                found[end] = _grey(whole, inner, end, folded=folded)
    return found


def _grey(whole: _Whole, name: str, end: str, *, folded: bool) -> Box:
    side: Literal["left", "right"] = "left" if end[0] == "<" else "right"
    if folded:
        frame = _frame(whole.view, whole.home[name])
        return Box(end, frame.title, style="group", emphasis="neighbour", side=side, ref=frame.ref)
    box = _box(whole.timed, whole.timed.analysis.system.activities[name])
    # Without the fill: neighbours are grey in every picture; the period is in their text.
    return replace(box, id=end, emphasis="neighbour", side=side, fill=None)


def _placed(whole: _Whole, mine: Collection[str], *, folded: bool) -> tuple[Arrow, ...]:
    """Draw an arrow for each pair of boxes. A rate that differs from the producer's is written beside it."""
    bundles: dict[tuple[str, str, str], list[Arc]] = {}
    for run in whole.running:
        ends = _ends(whole, run, mine, folded=folded)
        bundles.setdefault((*ends, run.style), []).extend(run.arcs)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            label=_label(whole.timed, arcs) if not folded else str(len(arcs)) if len(arcs) > 1 else "",
            style=style,  # type: ignore[arg-type]
            count=len(arcs),
            flows=tuple(_sentence(arc) for arc in arcs),
        )
        for (tail, head, style), arcs in bundles.items()
    )


def _label(timed: Timed, arcs: Sequence[Arc]) -> str:
    """Return the rates of outputs that are not published at each activation of their producer, two at most."""
    words = []
    for arc in arcs:
        output = timed.analysis.outputs.get((arc.source, arc.output))
        own = timed.analysis.paces.get(arc.source)
        if arc.role == "data" and output and own and output.rate != own.rate and output.rate.value is not None:
            words.append(figures.rate(output.rate))
    return "\n".join(list(dict.fromkeys(words))[:2])


def _notes(timed: Timed, names: Iterable[str]) -> tuple[str, ...]:
    found = [timed.analysis.paces.get(name) for name in names]
    return (_BOUNDS,) if any(pace and figures.side(pace.rate) for pace in found if pace and pace.rate.value) else ()


def _alt(timed: Timed, names: Sequence[str], what: str) -> str:
    """Describe how many activities have which period."""
    steps = [paces.step(timed.analysis.paces.get(name)) for name in names]
    counts = [(name, steps.count(step)) for step, name in paces.NAMES.items() if step in steps]
    told = ", ".join(f"{count} {name}" for name, count in counts)
    return f"{what}: {plural(len(names), 'activity')} by period: {told}." if told else f"{what}: no activities."
