"""Timing as pictures: every activity filled by the period that results for it, the whole and group by group.

The period stands in every box as text; what has none (unknown, on an event, on demand, once) is told by frame and word.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
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
_BOUNDS = "<= at most, >= at least: a bound, where no exact figure follows from what is written."


@dataclass(frozen=True, slots=True)
class _Run:
    """All that runs from one activity to another, in the direction of drawing; requests from client to server."""

    tail: str
    head: str
    style: Literal["data", "service", "action"]
    arcs: tuple[Arc, ...]


def timing(view: Index, timed: Timed) -> Graph:
    """Draw all activities, framed by group."""
    activities = timed.analysis.system.activities
    home = {name: _home(view, activity) for name, activity in activities.items()}
    running = _runs(timed.analysis.system.arcs)
    arrows = _merged(view, running, home)
    graph = Graph(
        "timing",
        f"{view.architecture.project.title}: how often everything happens",
        "two-step",
        tuple(replace(_box(timed, each), cluster=home[each.id]) for each in activities.values()),
        arrows,
        tuple(_frame(view, each) for each in dict.fromkeys(home.values())),
        direction=view.architecture.layout.direction or "left-right",
        notes=_notes(timed, activities),
        alt=_alt(timed, list(activities), "All activities"),
        asked=sum(len(run.arcs) for run in running),
    )
    return fold(with_legend(graph))


def group_timing(view: Index, timed: Timed, name: str) -> Graph:
    """Draw the activities of one group, with the neighbours that feed it at the left and those that read it at the right."""
    found = view.architecture.groups[name]
    activities = timed.analysis.system.activities
    mine = {each: None for each, activity in activities.items() if _home(view, activity) == name}
    running = [run for run in _runs(timed.analysis.system.arcs) if run.tail in mine or run.head in mine]
    folded = sum(len(run.arcs) for run in running) > _MANY
    around = _neighbours(view, timed, running, mine, folded=folded)
    graph = Graph(
        f"timing/{name}",
        f"{found.title}: how often everything happens",
        "group",
        (*(replace(_box(timed, activities[each]), cluster=name) for each in mine), *around.values()),
        _placed(view, timed, running, mine, folded=folded),
        (boxes.frame(view, name),) if mine else (),
        direction=found.layout.direction or view.architecture.layout.direction or "left-right",
        notes=_notes(timed, mine) + (("Neighbours are folded: a box for each group.",) if folded else ()),
        alt=_alt(timed, tuple(mine), found.title),
        asked=sum(len(run.arcs) for run in running),
    )
    return with_legend(graph if mine else replace(graph, boxes=()))


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
    """Draw each pair inside a frame, and one counted arrow from frame to frame."""
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


def _ends(view: Index, timed: Timed, run: _Run, mine: Collection[str], *, folded: bool) -> tuple[str, str]:
    def outer(name: str, side: str) -> str:
        return side + (_home(view, timed.analysis.system.activities[name]) if folded else name)

    tail = run.tail if run.tail in mine else outer(run.tail, "<")
    return tail, run.head if run.head in mine else outer(run.head, ">")


def _neighbours(
    view: Index, timed: Timed, running: Sequence[_Run], mine: Collection[str], *, folded: bool
) -> dict[str, Box]:
    """Draw neighbours in grey, a box each or a box for each of their groups, at the side that they stand on."""
    found: dict[str, Box] = {}
    for run in running:
        for end, inner in zip(_ends(view, timed, run, mine, folded=folded), (run.tail, run.head), strict=True):
            if inner in mine or end in found:
                continue
            activity = timed.analysis.system.activities[inner]
            home = _home(view, activity)
            side: Literal["left", "right"] = "left" if end[0] == "<" else "right"
            if folded:
                frame = _frame(view, home)
                found[end] = Box(end, frame.title, style="group", emphasis="neighbour", side=side, ref=frame.ref)
            else:
                box = _box(timed, activity)
                found[end] = replace(box, id=end, emphasis="neighbour", side=side, fill=None)
    return found


def _placed(
    view: Index, timed: Timed, running: Sequence[_Run], mine: Collection[str], *, folded: bool
) -> tuple[Arrow, ...]:
    """Draw an arrow for each pair of boxes; a pace that differs from the producer's is written beside it."""
    bundles: dict[tuple[str, str, str], list[Arc]] = {}
    for run in running:
        ends = _ends(view, timed, run, mine, folded=folded)
        bundles.setdefault((*ends, run.style), []).extend(run.arcs)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}",
            tail,
            head,
            label=_label(timed, arcs) if not folded else str(len(arcs)) if len(arcs) > 1 else "",
            style=style,  # type: ignore[arg-type]
            count=len(arcs),
            flows=tuple(_sentence(arc) for arc in arcs),
        )
        for (tail, head, style), arcs in bundles.items()
    )


def _label(timed: Timed, arcs: Sequence[Arc]) -> str:
    """Give the paces of outputs that are not published at each activation of their producer."""
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
    """Say how many activities stand on which step of the scale."""
    steps = [paces.step(timed.analysis.paces.get(name)) for name in names]
    counts = [(name, steps.count(step)) for step, name in paces.NAMES.items() if step in steps]
    told = ", ".join(f"{count} {name}" for name, count in counts)
    return f"{what}: {plural(len(names), 'activity')} by period: {told}." if told else f"{what}: no activities."
