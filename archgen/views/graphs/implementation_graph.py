"""Draw the implementation level: the nodes of one component with topics as boxes between them, and the whole ROS graph."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.port_media import ROS, key_of_carrier, label_of_medium
from archgen.views.graphs import element_boxes
from archgen.views.graphs.element_boxes import NodeFlow
from archgen.views.graphs.graph_folding import add_legend_keys, fold_graph
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph

_MIN_STARRED = 3
"""From this many topics on, if all are taken, an asterisk stands for them."""
_MAX_LISTED_TOPICS = 8
"""How many topics the asterisk's box lists."""
_MAX_TOPICS = 60
"""Of more topics those that the same nodes use are one box."""


@dataclass(frozen=True, slots=True)
class _TopicArrow:
    """One arrow between a node (its id; of a neighbour with `<` or `>`, its side, before it) and a topic or channel."""

    node: str
    topic: str
    style: str
    medium: str
    to_topic: bool


def draw_implementation(lookup: Lookup, component_id: str) -> Graph:
    """Draw the nodes of one component, what they publish and subscribe to, and with whom."""
    component = lookup.architecture.components[component_id]
    subject_ids = {node.id for node in lookup.nodes_of.get(component_id, ())}
    # A node may use a topic at several endpoints: still one arrow.
    topic_arrows = list(dict.fromkeys(_list_topic_arrows(lookup, subject_ids)))
    star_of_topic = _find_stars(lookup, topic_arrows)
    if len({end.topic for end in topic_arrows} - star_of_topic.keys()) > _MAX_TOPICS:
        star_of_topic = _bundle_topics(topic_arrows)
    drawn_arrows = [replace(end, topic=star_of_topic.get(end.topic, end.topic)) for end in topic_arrows]
    arrows = tuple(_draw_arrow(end) for end in dict.fromkeys(drawn_arrows))
    topics = {box.id: box for box in _draw_topics(lookup, topic_arrows, star_of_topic, subject_ids)}
    neighbour_boxes = {
        end.node: _neighbour_box(lookup, end.node) for end in drawn_arrows if end.node not in subject_ids
    }
    subject_boxes = tuple(
        element_boxes.node_box(lookup, lookup.architecture.nodes[each], is_subject=True) for each in sorted(subject_ids)
    )
    graph = Graph(
        f"implementation/{component_id}",
        f"{component.title}: implementation",
        "flow",
        (*subject_boxes, *topics.values(), *neighbour_boxes.values()),
        arrows,
        direction=component.layout.direction or lookup.architecture.layout.direction,
        alt=_describe_implementation(component.title, sorted(subject_ids), [box.title for box in topics.values()]),
        asked=len(arrows),
        kind="implementation",
    )
    return add_legend_keys(graph, *(["star"] if any(star[0] == "*" for star in star_of_topic.values()) else []))


def _list_topic_arrows(lookup: Lookup, subject_ids: set[str]) -> Iterator[_TopicArrow]:
    endpoints = [each for subject in sorted(subject_ids) for each in lookup.endpoints_of.get(subject, ())]
    for key in dict.fromkeys(key_of_carrier(endpoint) for endpoint in endpoints):
        topic = lookup.architecture.find_carrier(key)
        if topic is not None:
            yield from _arrows_at_topic(key, topic, subject_ids)


def _arrows_at_topic(key: str, topic: Topic, subject_ids: set[str]) -> Iterator[_TopicArrow]:
    """Yield the arrows at a topic: into it from publishers and clients, out of it to subscribers and servers."""
    entering, leaving = (topic.writers, topic.readers) if topic.flow == "topic" else (topic.readers, topic.writers)
    own_entering = [each for each in entering if each.node in subject_ids]
    own_leaving = [each for each in leaving if each.node in subject_ids]
    # Others that write are drawn only where the component reads, and the reverse: co-publishers are not its neighbours.
    for endpoint in entering if own_leaving else own_entering:
        yield _make_arrow(key, endpoint, _place_node(endpoint, subject_ids, "<"), to_topic=True)
    for endpoint in leaving if own_entering else own_leaving:
        yield _make_arrow(key, endpoint, _place_node(endpoint, subject_ids, ">"), to_topic=False)


def _make_arrow(key: str, endpoint: Endpoint, node: str, *, to_topic: bool) -> _TopicArrow:
    return _TopicArrow(node, key, _endpoint_style(endpoint), label_of_medium(endpoint), to_topic)


def _place_node(endpoint: Endpoint, subject_ids: set[str], side: str) -> str:
    return endpoint.node if endpoint.node in subject_ids else side + endpoint.node


def _endpoint_style(endpoint: Endpoint) -> str:
    if endpoint.flow != "topic":
        return endpoint.flow
    return "internal" if endpoint.internal else "data"


def _find_stars(lookup: Lookup, topic_arrows: list[_TopicArrow]) -> dict[str, str]:
    """Find the neighbours all of whose topics go to the same nodes. Map each such topic to its common name."""
    star_of_topic: dict[str, str] = {}
    for neighbour in dict.fromkeys(end.node for end in topic_arrows if end.node[0] == "<" and _is_ros_data(end)):
        node = neighbour[1:]
        published = {
            key_of_carrier(e)
            for e in lookup.endpoints_of.get(node, ())
            if e.use == "publishes" and not e.internal and e.medium == ROS
        }
        drawn_topics = {end.topic for end in topic_arrows if end.node == neighbour and _is_ros_data(end)}
        nodes_of_topic = {
            name: {end.node for end in topic_arrows if end.topic == name} for name in sorted(drawn_topics)
        }
        same_nodes = all(user == next(iter(nodes_of_topic.values())) for user in nodes_of_topic.values())
        # All of the neighbour's topics, and each used by the same nodes: else the asterisk would show flows that are
        # not there.
        if len(published) >= _MIN_STARRED and published == drawn_topics and same_nodes:
            star_of_topic.update(dict.fromkeys(nodes_of_topic, f"* {node}"))
    return star_of_topic


def _bundle_topics(topic_arrows: list[_TopicArrow]) -> dict[str, str]:
    """Map each topic that has the same arrows as others to the first one of them, with a sign before it."""
    arrows_of_topic: dict[str, set[_TopicArrow]] = {}
    for end in topic_arrows:
        arrows_of_topic.setdefault(end.topic, set()).add(replace(end, topic=""))
    bundles = group_pairs((frozenset(ends), topic) for topic, ends in arrows_of_topic.items())
    return {topic: f"+ {names[0]}" for names in bundles.values() if len(names) >= _MIN_STARRED for topic in names}


def _is_ros_data(end: _TopicArrow) -> bool:
    return end.style == "data" and not end.medium


def _draw_topics(
    lookup: Lookup, topic_arrows: list[_TopicArrow], star_of_topic: dict[str, str], subject_ids: set[str]
) -> Iterator[Box]:
    for name in dict.fromkeys(end.topic for end in topic_arrows):
        topic = lookup.architecture.find_carrier(name)
        if topic is not None and name not in star_of_topic:
            own_endpoints = [each for each in (*topic.writers, *topic.readers) if each.node in subject_ids]
            yield replace(element_boxes.topic_box(topic, own_endpoints), id=f"topic {name}")
    for star in dict.fromkeys(star_of_topic.values()):
        names = [name for name, stands in star_of_topic.items() if stands == star]
        is_whole, first = star[0] == "*", lookup.architecture.find_carrier(names[0])
        yield Box(
            f"topic {star}",
            f"* all topics of {star[2:]}" if is_whole else count_noun(len(names), first.flow if first else "topic"),
            tuple(fit_lines(names, _MAX_LISTED_TOPICS)),
            style="topic",
            ref=f"node:{star[2:]}" if is_whole else None,
            tooltip="\n".join(names),
        )


def _neighbour_box(lookup: Lookup, name: str) -> Box:
    return element_boxes.neighbour_node_box(
        lookup, lookup.architecture.nodes[name[1:]], "left" if name[0] == "<" else "right"
    )


def _draw_arrow(topic_arrow: _TopicArrow) -> Arrow:
    box = f"topic {topic_arrow.topic}"
    tail, head = (topic_arrow.node, box) if topic_arrow.to_topic else (box, topic_arrow.node)
    sentence = f"{topic_arrow.node.lstrip('<>')} {'to' if topic_arrow.to_topic else 'from'} {topic_arrow.topic}"
    return Arrow(
        f"{tail}>{head}",
        tail,
        head,
        style=topic_arrow.style,  # type: ignore[arg-type]
        flows=(sentence,),
        medium=topic_arrow.medium,
    )


def _describe_implementation(title: str, subjects: list[str], topics: list[str]) -> str:
    sentence = f"{title} is implemented by {', '.join(subjects)}." if subjects else f"No node implements {title}."
    return (
        f"{sentence} It uses {count_noun(len(topics), 'topic, service or action')[2:] if len(topics) == 1 else len(topics)}"
        + (f": {', '.join(topics)}." if topics else " topics.")
    )


def draw_ros_graph(lookup: Lookup) -> Graph:
    """Draw all nodes."""
    title = f"{lookup.architecture.project.title}: nodes"
    return draw_nodes(lookup, "ros", title, set(lookup.architecture.nodes))


def draw_nodes(lookup: Lookup, graph_id: str, title: str, node_ids: Collection[str]) -> Graph:
    """Draw some nodes and all that runs among them."""
    chosen_nodes = [node for node in lookup.architecture.nodes.values() if node.id in node_ids]
    home_frames = {node.id: find_home_frame(lookup, node) for node in chosen_nodes}
    node_flows = [
        each
        for each in element_boxes.list_node_flows(lookup.architecture)
        if each.tail in home_frames and each.head in home_frames
    ]
    frames = tuple(draw_home_frame(lookup, each) for each in dict.fromkeys(home_frames.values()))
    arrows = _merge_node_flows(lookup, node_flows, home_frames)
    graph = Graph(
        graph_id,
        title,
        "two-step",
        tuple(replace(element_boxes.node_box(lookup, node), cluster=home_frames[node.id]) for node in chosen_nodes),
        arrows,
        frames,
        direction=lookup.architecture.layout.direction,
        alt=f"{count_noun(len(chosen_nodes), 'node')} in {count_noun(len(frames), 'frame')}; "
        f"{count_noun(len(node_flows), 'flow')} over topics, services and actions among them.",
        asked=len(node_flows),
        kind="ros",
    )
    return fold_graph(add_legend_keys(graph))


def find_home_frame(lookup: Lookup, node: Node) -> str:
    """Return the id of a node's frame: the first group of what it implements, else its namespace."""
    groups = [component.split(".", 1)[0] for component in node.implements]
    return next((group for group in groups if group in lookup.architecture.groups), f"namespace {node.namespace}")


def draw_home_frame(lookup: Lookup, home: str) -> Cluster:
    """Return the frame of a group or a namespace."""
    if home in lookup.architecture.groups:
        return element_boxes.group_frame(lookup, home)
    return Cluster(home, home.removeprefix("namespace "), tooltip=f"Nodes in {home} that implement no component")


def _merge_node_flows(lookup: Lookup, node_flows: Sequence[NodeFlow], home_frames: dict[str, str]) -> tuple[Arrow, ...]:
    bundles: dict[tuple[str, str, str, str], list[NodeFlow]] = {}
    for each in node_flows:
        tail, head = home_frames[each.tail], home_frames[each.head]
        is_inside = tail == head
        style = "data" if each.topic.flow == "topic" else each.topic.flow
        medium = label_of_medium(each.topic)
        ends = (each.tail, each.head, style, medium) if is_inside else (tail, head, "data", medium)
        bundles.setdefault(ends, []).append(each)
    return tuple(
        Arrow(
            f"{tail}>{head}:{style}" + (f":{medium}" if medium else ""),
            tail,
            head,
            style=style,  # type: ignore[arg-type]
            label=(f"({medium})" if len(bundle) == 1 else f"{len(bundle)} ({medium})") if medium else "",
            medium=medium,
            count=len(bundle),
            # A frame may be a namespace, which has no hue, and a node may have the id of a group.
            colour=element_boxes.group_hue(lookup, tail)
            if tail in lookup.group_hues and tail not in home_frames
            else None,
            flows=tuple(each.sentence for each in bundle),
        )
        for (tail, head, style, medium), bundle in bundles.items()
    )
