"""The picture of changed nodes: what they publish, subscribe, serve and call, with topics as boxes in between."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from archgen.compare import Change, Comparison
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Topic
from archgen.views.changes.change_wording import CHANGE_SIGNS, is_textual
from archgen.views.graphs import element_boxes
from archgen.views.graphs.changes.merged_versions import ConnectionLine, PictureBudget, bundle_arrows, fits_budget
from archgen.views.graphs.graph_folding import add_legend_keys
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import Box, ElementChange, Graph

GRAPH_ID = "changes/nodes"
UseKey = tuple[str, str, str]
"""A node, a topic, and how the node uses it."""


@dataclass(frozen=True, slots=True)
class _OverlaidNodes:
    """The two versions of the nodes, by common ids."""

    old_lookup: Lookup
    new_lookup: Lookup
    matched_ids: MatchedIds
    change_kinds: dict[str, ElementChange]
    node_sentences: defaultdict[str, list[str]]
    lines: tuple[ConnectionLine, ...]

    @property
    def topics(self) -> dict[str, Topic]:
        """Return all topics of both versions, the later one where both have it."""
        return {**self.old_lookup.architecture.topics, **self.new_lookup.architecture.topics}


def draw_node_changes(comparison: Comparison, budget: PictureBudget) -> Graph | None:
    """Draw what changed and its surroundings; None if no node changed, or if it does not fit the budget."""
    change_kinds, node_sentences, port_sentences = _sort_changes(comparison)
    if not change_kinds:
        return None
    lines = tuple(_use_lines(comparison, port_sentences))
    overlay = _OverlaidNodes(
        make_lookup(comparison.before.architecture),
        make_lookup(comparison.after.architecture, comparison.new_findings),
        comparison.matched_ids,
        change_kinds,
        node_sentences,
        lines,
    )
    drawn_lines = _drawn_lines(overlay, budget)
    box_ids = {box_id for line in drawn_lines for box_id in line.ends} | {f"node {name}" for name in change_kinds}
    graph = Graph(
        GRAPH_ID,
        "What changed: nodes and topics",
        "flow",
        tuple(_draw_box(overlay, box_id) for box_id in sorted(box_ids)),
        bundle_arrows(drawn_lines),
        direction=comparison.after.architecture.layout.direction,
        notes=("Only what changed is drawn.",) if len(drawn_lines) < len(_surrounding_lines(overlay)) else (),
        alt="; ".join(f"{CHANGE_SIGNS[change_kind]} {name}" for name, change_kind in sorted(change_kinds.items()))
        + ".",
        kind="node-changes",
    )
    # Nodes have no groups to fold.
    if not fits_budget(graph, budget):
        return None
    return add_legend_keys(replace(graph, asked=sum(arrow.count for arrow in graph.arrows)))


def _surrounding_lines(overlay: _OverlaidNodes) -> list[ConnectionLine]:
    """Return what the changed nodes use, and who else uses what changed of it."""
    changed_boxes = {f"node {name}" for name in overlay.change_kinds}
    touched_topics = {
        box_id for line in overlay.lines if line.change for box_id in line.ends if box_id.startswith("topic ")
    }
    return [
        line
        for line in overlay.lines
        if not changed_boxes.isdisjoint(line.ends) or not touched_topics.isdisjoint(line.ends)
    ]


def _drawn_lines(overlay: _OverlaidNodes, budget: PictureBudget) -> list[ConnectionLine]:
    surrounding_lines = _surrounding_lines(overlay)
    box_ids = {box_id for line in surrounding_lines for box_id in line.ends}
    return (
        surrounding_lines
        if len(box_ids) <= budget.boxes_with_neighbours
        else [line for line in surrounding_lines if line.change]
    )


def _sort_changes(
    comparison: Comparison,
) -> tuple[dict[str, ElementChange], defaultdict[str, list[str]], dict[UseKey, list[str]]]:
    """Sort the changes of nodes: their kinds and sentences by node, and the sentences by node, use and port."""
    change_kinds: dict[str, ElementChange] = {}
    node_sentences: defaultdict[str, list[str]] = defaultdict(list)
    port_sentences: defaultdict[UseKey, list[str]] = defaultdict(list)
    for change in _walk_changes(comparison.changes):
        if is_textual(change) or change.element_kind not in {"node", "port"}:
            continue
        common_id = (
            comparison.matched_ids.common_id("node", change.element_id)
            if change.kind == "removed"
            else change.element_id
        )
        node_id = common_id if change.element_kind == "node" else common_id.partition(".")[0]
        node_sentences[node_id].append(change.text)
        change_kind: ElementChange = "renamed" if change.kind == "moved" else change.kind
        if change.element_kind == "node" and change_kind != "changed":
            change_kinds[node_id] = change_kind
        change_kinds.setdefault(node_id, "changed")
        if change.element_kind == "port":
            use, _, port = common_id.partition(".")[2].removeprefix("internal.").partition(".")
            port_sentences[node_id, use, port].append(change.text)
    return change_kinds, node_sentences, port_sentences


def _walk_changes(changes: tuple[Change, ...]) -> Iterator[Change]:
    for change in changes:
        yield change
        # Ports that hang on a component belong to the picture of components.
        if change.element_kind not in {"component", "group", "input", "output"}:
            yield from _walk_changes(change.parts)


def _endpoints_by_use(architecture: Architecture, matched_ids: MatchedIds) -> dict[UseKey, Endpoint]:
    return {
        (matched_ids.common_id("node", endpoint.node), endpoint.label, endpoint.use): endpoint
        for endpoint in architecture.endpoints
    }


def _use_lines(comparison: Comparison, port_sentences: dict[UseKey, list[str]]) -> Iterator[ConnectionLine]:
    """Yield each use of a topic in either version with its change."""
    old_endpoints, new_endpoints = (
        _endpoints_by_use(comparison.before.architecture, comparison.matched_ids),
        _endpoints_by_use(comparison.after.architecture, MatchedIds()),
    )
    for key in (*new_endpoints, *(key for key in old_endpoints if key not in new_endpoints)):
        endpoint = new_endpoints.get(key) or old_endpoints[key]
        sentences = tuple(_sentences_about(key, endpoint, port_sentences))
        change_kind: ElementChange | None = "changed" if sentences else None
        if (key in new_endpoints) != (key in old_endpoints):
            change_kind = "added" if key in new_endpoints else "removed"
        node, topic, use = key
        tail, head = f"node {node}", f"topic {topic}"
        if use in {"subscribes", "serves"}:
            tail, head = head, tail
        use_text = f"{node} {use} {topic}"
        style = "data" if endpoint.flow == "topic" else endpoint.flow
        sentence = "\n".join((f"{CHANGE_SIGNS[change_kind]} {use_text}" if change_kind else use_text, *sentences))
        yield ConnectionLine(tail, head, style, use if change_kind else "", change_kind, sentence)


def _sentences_about(key: UseKey, endpoint: Endpoint, port_sentences: dict[UseKey, list[str]]) -> Iterator[str]:
    node, topic, use = key
    # A use is named by its port, by component and port if the node has several components, or by its internal key.
    port_names = {
        (endpoint.port or topic).rpartition(".")[2],
        ".".join((endpoint.port or "").split(".")[-2:]),
        topic.rpartition("/")[2],
    }
    for (owner, use_of_port, port), sentences in port_sentences.items():
        if (owner, use_of_port) == (node, use) and port in port_names:
            yield from sentences


def _draw_box(overlay: _OverlaidNodes, box_id: str) -> Box:
    kind, _, element_id = box_id.partition(" ")
    return _draw_topic(overlay, element_id) if kind == "topic" else _draw_node(overlay, element_id)


def _draw_node(overlay: _OverlaidNodes, node_id: str) -> Box:
    node = overlay.new_lookup.architecture.nodes.get(node_id)
    view = overlay.new_lookup if node else overlay.old_lookup
    if node is None:
        node = overlay.old_lookup.architecture.nodes[overlay.matched_ids.old_ids.get("node", {}).get(node_id, node_id)]
    node_box = element_boxes.node_box(view, node)
    plain_box = replace(node_box, id=f"node {node_id}", status=None, ref="changes:Nodes")
    change_kind = overlay.change_kinds.get(node_id) or _planned_node_change(overlay, node_id)
    if change_kind is None:
        return replace(plain_box, emphasis="neighbour", badge=None)
    tooltip = "\n".join((*overlay.node_sentences.get(node_id, ()), node_box.tooltip))
    return replace(
        plain_box, title=f"{CHANGE_SIGNS[change_kind]} {node_box.title}", change=change_kind, tooltip=tooltip
    )


def _planned_node_change(overlay: _OverlaidNodes, node_id: str) -> ElementChange | None:
    """Return whether a node that nobody wrote was added or removed with its component, None for neither."""
    old_id = overlay.matched_ids.old_ids.get("node", {}).get(node_id, node_id)
    is_old, is_new = old_id in overlay.old_lookup.architecture.nodes, node_id in overlay.new_lookup.architecture.nodes
    return None if is_old and is_new else "added" if is_new else "removed"


def _draw_topic(overlay: _OverlaidNodes, topic_name: str) -> Box:
    old_topic, new_topic = (
        overlay.old_lookup.architecture.topics.get(topic_name),
        overlay.new_lookup.architecture.topics.get(topic_name),
    )
    topic_box = replace(element_boxes.topic_box(overlay.topics[topic_name]), id=f"topic {topic_name}", ref=None)
    change_kind: ElementChange | None = "added" if old_topic is None else "removed" if new_topic is None else None
    if old_topic and new_topic and old_topic.messages != new_topic.messages:
        change_kind = "changed"
    return (
        replace(topic_box, title=f"{CHANGE_SIGNS[change_kind]} {topic_name}", change=change_kind)
        if change_kind
        else topic_box
    )
