"""Two versions as one: the change of each component, connection and type, by common ids; groups, and what surrounds a
change, are folded until a picture fits its budget, with a note of what was folded.

Common ids are those of the second version; what was removed keeps its old one.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import get_args

from archgen.compare import Change, Comparison
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.views.changes.change_wording import BREAK_SIGN, CHANGE_SIGNS, is_textual
from archgen.views.graphs.drawn_level import FlowStyle, flow_style
from archgen.views.inline_text import count_noun
from archgen.views.picture_shapes import Arrow, Box, Cluster, ElementChange, Graph

_PORT_KINDS = frozenset({"input", "output"})


@dataclass(frozen=True, slots=True)
class MergedEdge:
    """A connection from one output to one input. `tail` and `head` are components, in the direction of drawing."""

    output_id: str
    input_id: str
    tail: str
    head: str
    style: FlowStyle
    label: str
    optional: bool


@dataclass(slots=True)
class ChangeNotes:
    """What changed, by common ids: kinds of changes, and the sentences that describe them."""

    component_changes: dict[str, ElementChange] = field(default_factory=dict)
    sentences: defaultdict[str, list[str]] = field(default_factory=lambda: defaultdict(list))
    """Sentences by component, and by input for connections."""
    flow_sentences: dict[str, str] = field(default_factory=dict)
    """The sentence for each output, input and type with a change of what flows."""
    text_only_components: set[str] = field(default_factory=set)
    """Components with changes of texts only."""


def collect_change_notes(comparison: Comparison) -> ChangeNotes:
    """Collect the changes by the elements that they happened to."""
    change_notes = ChangeNotes()
    for change in comparison.changes:
        _note_change(change, comparison.matched_ids, change_notes)
    return change_notes


def _note_change(change: Change, matched_ids: MatchedIds, change_notes: ChangeNotes, whole_sentence: str = "") -> None:
    """Note a change and its parts; parts of an added or removed element are described by the whole."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    common_id = matched_ids.common_id(kind, change.element_id) if change.kind == "removed" else change.element_id
    sentence = whole_sentence or change.text
    if kind == "component":
        _note_component(change, common_id, sentence, change_notes)
    elif kind in _PORT_KINDS:
        _note_port(change, common_id, sentence, change_notes)
    elif kind in {"type", "message"} and not is_textual(change):
        change_notes.flow_sentences[common_id] = sentence
    for part in change.parts:
        # A group is no box here: what was added with it is described part by part.
        inner_sentence = sentence if change.kind in {"added", "removed"} and change.element_kind != "group" else ""
        _note_change(part, matched_ids, change_notes, inner_sentence)


def _note_component(change: Change, component_id: str, sentence: str, change_notes: ChangeNotes) -> None:
    if is_textual(change):
        change_notes.text_only_components.add(component_id)
        return
    change_notes.sentences[component_id].append(sentence)
    change_kind: ElementChange = "renamed" if change.kind == "moved" else change.kind
    # Added, removed and renamed win over changed, whichever comes first.
    if change_kind != "changed" or component_id not in change_notes.component_changes:
        change_notes.component_changes[component_id] = change_kind


def _note_port(change: Change, port_id: str, sentence: str, change_notes: ChangeNotes) -> None:
    component_id = port_id.rpartition(".")[0]
    change_notes.sentences[port_id].append(sentence)
    if change.element_kind == "connection":
        return
    if is_textual(change):
        change_notes.text_only_components.add(component_id)
        return
    if sentence not in change_notes.sentences[component_id]:
        change_notes.sentences[component_id].append(sentence)
    change_notes.component_changes.setdefault(component_id, "changed")
    if change.kind == "changed":
        change_notes.flow_sentences[port_id] = sentence


def merged_edges(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[tuple[str, str], MergedEdge]:
    """Return all connections of a version by the common ids of their ends."""
    return {(edge.output_id, edge.input_id): edge for edge in _list_edges(architecture, matched_ids)}


def _list_edges(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[MergedEdge]:
    for connection in architecture.connections:
        port = architecture.inputs[connection.input]
        reader = matched_ids.common_id("component", port.component)
        for name in connection.outputs:
            output = architecture.outputs.get(name)
            if output is None:
                continue
            style = flow_style(architecture, name)
            writer = matched_ids.common_id("component", output.component)
            # Services and actions are drawn from client to server, against the direction of the output.
            ends = (reader, writer) if style in {"service", "action"} else (writer, reader)
            label = output.type or output.name
            yield MergedEdge(
                matched_ids.common_id("output", name),
                matched_ids.common_id("input", port.id),
                *ends,
                style,
                label,
                optional=port.optional,
            )


def describe_changed_flows(architecture: Architecture, edge: MergedEdge, change_notes: ChangeNotes) -> Iterable[str]:
    """Return the sentences about a change of what flows along a connection that is in both versions."""
    output = architecture.outputs.get(edge.output_id)
    carrier_names = [edge.output_id, edge.input_id]
    if output is not None:
        carrier_names += [name for name in (output.type, architecture.message_of(output)) if name]
    return [
        change_notes.flow_sentences[name]
        for name in dict.fromkeys(carrier_names)
        if name in change_notes.flow_sentences
    ]


_MAX_LABELS = 3
ArrowKey = tuple[str, str, FlowStyle, ElementChange | None, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class ConnectionLine:
    """One connection of either version with its change; `sentence` describes it."""

    tail: str
    head: str
    style: FlowStyle
    label: str
    change: ElementChange | None
    sentence: str
    optional: bool = False
    ports: tuple[str, str] = ("", "")
    """The output and the input that it connects."""
    broken_partners: tuple[str, ...] = ()
    """What people call the partners for whom it breaks."""

    @property
    def ends(self) -> frozenset[str]:
        """Return both ends."""
        return frozenset((self.tail, self.head))


def bundle_arrows(lines: Iterable[ConnectionLine]) -> tuple[Arrow, ...]:
    """Return one arrow for each bundle of lines; only changed ones have a label."""
    bundles: dict[ArrowKey, list[ConnectionLine]] = {}
    for line in lines:
        bundles.setdefault((line.tail, line.head, line.style, line.change, line.broken_partners), []).append(line)
    return tuple(_draw_bundle(key, bundle) for key, bundle in bundles.items())


def _draw_bundle(key: ArrowKey, bundle: Sequence[ConnectionLine]) -> Arrow:
    tail, head, style, change, broken_partners = key
    label = _bundle_label(bundle, BREAK_SIGN if broken_partners else CHANGE_SIGNS[change or "changed"])
    return Arrow(
        f"{tail}>{head}:{style}:{change or 'same'}{':broken' if broken_partners else ''}",
        tail,
        head,
        label if change or broken_partners else "",
        style=style,
        count=len(bundle),
        optional=all(line.optional for line in bundle),
        faded=change is None and not broken_partners,
        flows=tuple(line.sentence for line in bundle),
        change=change,
        broken=bool(broken_partners),
    )


def _bundle_label(bundle: Sequence[ConnectionLine], sign: str) -> str:
    labels = list(dict.fromkeys(line.label for line in bundle if line.label))
    return "\n".join(f"{sign} {name}" for name in fit_lines(labels, _MAX_LABELS, "{} more"))


@dataclass(frozen=True, slots=True)
class PictureBudget:
    """`boxes_with_neighbours` is the maximal number of boxes including unchanged neighbours, `boxes` without them."""

    boxes_with_neighbours: int
    boxes: int
    arrows: int


LARGE_BUDGET = PictureBudget(boxes_with_neighbours=30, boxes=45, arrows=70)
"""For a page or a screen."""
SMALL_BUDGET = PictureBudget(boxes_with_neighbours=14, boxes=25, arrows=40)
"""For a comment on a pull request."""


_CHANGE_KINDS: tuple[ElementChange, ...] = get_args(ElementChange)


def fold_to_budget(graph: Graph, budget: PictureBudget) -> Graph:
    """Fold as few groups as possible. If that is not enough, a note says that the picture is larger."""
    member_counts = Counter(box.cluster for box in graph.boxes)
    # Folding a group of one box would save nothing.
    largest = sorted(
        (cluster.id for cluster in graph.clusters if member_counts[cluster.id] > 1),
        key=lambda name: -member_counts[name],
    )
    folded_graph = graph
    for count in range(len(largest) + 1):
        folded_graph = _fold_groups(graph, set(largest[:count])) if count else graph
        if fits_budget(folded_graph, budget):
            return folded_graph
    size_note = (
        f"This picture is larger than {budget.boxes} boxes and {budget.arrows} arrows: `--select` shows a part of it."
    )
    return replace(folded_graph, notes=(*folded_graph.notes, size_note))


def fits_budget(graph: Graph, budget: PictureBudget) -> bool:
    """Whether a graph keeps to a budget."""
    return len(graph.boxes) <= budget.boxes and len(graph.arrows) <= budget.arrows


def _fold_groups(graph: Graph, group_ids: set[str]) -> Graph:
    new_box_ids = {box.id: f"group {box.cluster}" if box.cluster in group_ids else box.id for box in graph.boxes}
    outer_arrows = [arrow for arrow in graph.arrows if new_box_ids[arrow.tail] != new_box_ids[arrow.head]]
    inner_arrows = [arrow for arrow in graph.arrows if new_box_ids[arrow.tail] == new_box_ids[arrow.head]]
    boxes = [box for box in graph.boxes if box.cluster not in group_ids]
    boxes += [_folded_box(graph, cluster, inner_arrows) for cluster in graph.clusters if cluster.id in group_ids]
    note = f"{count_noun(len(group_ids), 'group')} folded to one box each, because the picture would be too large."
    return replace(
        graph,
        boxes=tuple(boxes),
        arrows=_merge_arrows(outer_arrows, new_box_ids),
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in group_ids),
        notes=(*graph.notes, note),
    )


def _folded_box(graph: Graph, cluster: Cluster, inner_arrows: Sequence[Arrow]) -> Box:
    inner_boxes = [box for box in graph.boxes if box.cluster == cluster.id]
    lines = [
        f"{CHANGE_SIGNS[change_kind]} {count_noun(count, 'component')}"
        for change_kind, count in _count_kinds(inner_boxes)
    ]
    inner_ids = {box.id for box in inner_boxes}
    flows = Counter(arrow.change for arrow in inner_arrows for _ in range(arrow.count) if arrow.tail in inner_ids)
    lines += [
        f"{CHANGE_SIGNS[change_kind]} {count_noun(flows[change_kind], 'connection')} inside"
        for change_kind in _CHANGE_KINDS
        if flows[change_kind]
    ]
    change_kinds = [change_kind for change_kind, _ in _count_kinds(inner_boxes)]
    changed_titles = [box.title for box in inner_boxes if box.change]
    return Box(
        f"group {cluster.id}",
        cluster.title,
        tuple(lines),
        style="fold",
        emphasis="normal" if change_kinds else "neighbour",
        ref=cluster.ref,
        tooltip="\n".join([cluster.title, *changed_titles]),
        # Different changes inside make the group as a whole "changed".
        change=(change_kinds[0] if len(change_kinds) == 1 else "changed") if change_kinds else None,
    )


def _count_kinds(inner_boxes: Sequence[Box]) -> list[tuple[ElementChange, int]]:
    kind_counts = Counter(box.change for box in inner_boxes)
    return [(kind, kind_counts[kind]) for kind in _CHANGE_KINDS if kind_counts[kind]]


def _merge_arrows(arrows: Sequence[Arrow], new_box_ids: dict[str, str]) -> tuple[Arrow, ...]:
    """Return one arrow for all that now have the same ends and the same change."""
    kept_arrows = [
        arrow for arrow in arrows if (new_box_ids[arrow.tail], new_box_ids[arrow.head]) == (arrow.tail, arrow.head)
    ]
    bundles: dict[tuple[str, str, ElementChange | None], list[Arrow]] = {}
    for arrow in arrows:
        if arrow not in kept_arrows:
            bundles.setdefault((new_box_ids[arrow.tail], new_box_ids[arrow.head], arrow.change), []).append(arrow)
    return (*kept_arrows, *(_join_arrows(bundle, *key) for key, bundle in bundles.items()))


def _join_arrows(bundle: Sequence[Arrow], tail: str, head: str, change: ElementChange | None) -> Arrow:
    count = sum(arrow.count for arrow in bundle)
    single_label = bundle[0].label if len(bundle) == 1 else ""
    return replace(
        bundle[0],
        id=f"{tail}>{head}:{change or 'same'}",
        tail=tail,
        head=head,
        label=single_label or (f"{CHANGE_SIGNS[change]} {count_noun(count, 'connection')}" if change else ""),
        style=bundle[0].style if len({arrow.style for arrow in bundle}) == 1 else "data",
        count=count,
        optional=False,
        flows=tuple(flow for arrow in bundle for flow in arrow.flows),
    )


_MAX_NAMES = 6
"""A folded group of more components names all but the last ones; its tooltip names all."""
_FEEDER, _READER = "<", ">"


def fold_neighbours(graph: Graph) -> Graph:
    """Return a picture of changes with frames only where something changed, and a box for each group beside them."""
    quiet_frames = {
        cluster.id: cluster
        for cluster in graph.clusters
        # A sign before the title tells of a change of the group itself.
        if cluster.title == cluster.tooltip and not any(_is_changed(box) for box in _list_members(graph, cluster))
    }
    loud_ends = {end for arrow in graph.arrows if arrow.change or arrow.broken for end in (arrow.tail, arrow.head)}
    folded = {box.id: box for box in graph.boxes if box.cluster in quiet_frames and box.id not in loud_ends}
    arrows = _join_side_arrows(graph.arrows, folded)
    touched = {end for arrow in arrows for end in (arrow.tail, arrow.head)}
    boxes = [
        _name_group(box, quiet_frames[box.cluster]) if box.cluster in quiet_frames else box
        for box in graph.boxes
        if box.id not in folded
    ]
    for cluster in quiet_frames.values():
        members = [box for box in folded.values() if box.cluster == cluster.id]
        boxes += _draw_sides(cluster, members, graph.arrows, touched)
    return replace(
        graph,
        boxes=tuple(boxes),
        arrows=arrows,
        clusters=tuple(cluster for cluster in graph.clusters if cluster.id not in quiet_frames),
    )


def _is_changed(box: Box) -> bool:
    return box.change is not None or box.broken


def _list_members(graph: Graph, cluster: Cluster) -> list[Box]:
    return [box for box in graph.boxes if box.cluster == cluster.id]


def _name_group(box: Box, cluster: Cluster) -> Box:
    """Return the box of a component without its frame: the group is said below the title."""
    place = " · ".join((cluster.title, *box.lines[:1]))
    return replace(box, lines=(place, *box.lines[1:]), cluster=None)


def _join_side_arrows(arrows: Sequence[Arrow], folded: Mapping[str, Box]) -> tuple[Arrow, ...]:
    """Return the arrows with those from or to a folded group as one."""
    bundles: dict[tuple[str, str, str], list[Arrow]] = {}
    for arrow in arrows:
        tail, head = _name_side(arrow.tail, _FEEDER, folded), _name_side(arrow.head, _READER, folded)
        is_kept = (tail, head) == (arrow.tail, arrow.head)
        bundles.setdefault((tail, head, arrow.id if is_kept else arrow.style), []).append(arrow)
    return tuple(_join_bundle(tail, head, bundle) for (tail, head, _), bundle in bundles.items())


def _name_side(box_id: str, side: str, folded: Mapping[str, Box]) -> str:
    return f"{side}{folded[box_id].cluster}" if box_id in folded else box_id


def _join_bundle(tail: str, head: str, bundle: Sequence[Arrow]) -> Arrow:
    first = bundle[0]
    if (tail, head) == (first.tail, first.head):
        return first
    return replace(
        first,
        id=f"{tail}>{head}:{first.style}:same",
        tail=tail,
        head=head,
        count=sum(arrow.count for arrow in bundle),
        optional=all(arrow.optional for arrow in bundle),
        flows=tuple(flow for arrow in bundle for flow in arrow.flows),
    )


def _draw_sides(cluster: Cluster, members: Sequence[Box], arrows: Sequence[Arrow], touched: set[str]) -> Iterator[Box]:
    """Yield the box of a folded group that feeds what changed, and the one that reads from it."""
    tails, heads = {arrow.tail for arrow in arrows}, {arrow.head for arrow in arrows}
    for side, ends in ((_FEEDER, tails), (_READER, heads)):
        if f"{side}{cluster.id}" in touched:
            yield _draw_group(f"{side}{cluster.id}", cluster, [box for box in members if box.id in ends])


def _draw_group(box_id: str, cluster: Cluster, members: Sequence[Box]) -> Box:
    if len(members) == 1:
        return replace(_name_group(members[0], cluster), id=box_id)
    names = [" · ".join((*box.lines[:1], box.title)) for box in members]
    return Box(
        box_id,
        cluster.title,
        tuple(fit_lines(names, _MAX_NAMES)),
        style="group",
        emphasis="neighbour",
        ref=cluster.ref,
        tooltip="\n".join((cluster.title, *names)),
    )
