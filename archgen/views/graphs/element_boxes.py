"""Make the boxes and frames of the model's elements, the same in every picture; and those of what nodes exchange."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, cast

from archgen.diagnostics import Severity
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.component_nesting import find_component, list_members
from archgen.model.node import Endpoint, Node, Qos, Topic
from archgen.model.port_media import ROS, key_of_channel, label_of_carrier, name_medium, name_on_medium
from archgen.views.elements.element_names import join_surrounding_titles
from archgen.views.inline_text import count_noun, strip_marks
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Box, Cluster
from archgen.views.timing_words import format_short_timing
from archgen.views.type_names import name_component_type

BoxSide = Literal["left", "right"]


@dataclass(frozen=True, slots=True)
class NodeFlow:
    """What runs from one node to another over a topic; a service or action from client to server."""

    tail: str
    head: str
    topic: Topic
    sentence: str


def node_box(lookup: Lookup, node: Node, *, is_subject: bool = False) -> Box:
    """Return the box of a node, with its kind, status, rate and host where it is the subject."""
    return Box(
        node.id,
        node.id,
        _node_lines(lookup, node) if is_subject else (),
        style="node",
        emphasis="subject" if is_subject else "normal",
        status=node.status,
        ref=f"node:{node.id}",
        tooltip="\n".join([f"{node.full_name}", node.title, *_node_lines(lookup, node)]),
        badge=worst_severity(lookup, node.id),
    )


def neighbour_node_box(lookup: Lookup, node: Node, side: BoxSide) -> Box:
    """Return the box of a node that is not the subject: grey, at one side."""
    box = node_box(lookup, node)
    return replace(box, id=f"{'<' if side == 'left' else '>'}{node.id}", emphasis="neighbour", side=side, badge=None)


def _node_lines(lookup: Lookup, node: Node) -> tuple[str, ...]:
    kinds = " ".join(node.kinds) if node.kinds != ("node",) else ""
    timings = dict.fromkeys(format_short_timing(timing) for timing in node.timing.values())
    host = lookup.architecture.hosts.get(node.host or "")
    words = [[kinds, node.status or ""], list(timings), [host.title if host else ""]]
    return tuple(line for line in (" · ".join(word for word in row if word) for row in words) if line)


def topic_box(topic: Topic, endpoints: Iterable[Endpoint] = ()) -> Box:
    """Return the box of a topic, service or action: name, message, and the quality of service where it is not the
    default.
    """
    if topic.medium != ROS:
        return _draw_channel(topic)
    qos = dict.fromkeys(said for endpoint in endpoints for said in [_describe_qos(endpoint.qos)] if said)
    message = topic.messages or (("message open",) if topic.flow == "topic" else ())
    return Box(
        f"topic {topic.name}",
        topic.name,
        (*message[:3], *qos),
        style=topic.flow,
        ref=f"topic:{topic.name}",
        tooltip="\n".join([topic.name, *topic.messages, *topic.types]),
    )


def _draw_channel(channel: Topic) -> Box:
    """Return the box of what is no ROS: name, type, and the medium in brackets."""
    name, medium = name_on_medium(channel), f"({name_medium(channel.medium)})"
    lines = (*channel.types[:3], medium)
    return Box(
        f"topic {channel.name}",
        name,
        lines,
        style=channel.flow,
        ref=f"channel:{key_of_channel(channel)}",
        tooltip="\n".join((name, *channel.types, medium)),
    )


def _describe_qos(qos: Qos) -> str:
    """Describe in few words what differs from the default."""
    words = ["best effort"] if qos.reliability == "best_effort" else []
    words += ["latched"] if qos.durability == "transient_local" else []
    words += ["keep all"] if qos.history == "keep_all" else []
    words += [f"deadline {qos.deadline}"] if qos.deadline else []
    return ", ".join(words)


def list_node_flows(architecture: Architecture) -> tuple[NodeFlow, ...]:
    """Return all that runs between two nodes: each pair of a writer and a reader of a topic, once."""
    flows: dict[tuple[str, str, str], NodeFlow] = {}
    for _, topic in architecture.list_carriers():
        for writer in topic.writers:
            for reader in topic.readers:
                if writer.node == reader.node:
                    continue
                ends = (writer.node, reader.node) if topic.flow == "topic" else (reader.node, writer.node)
                sentence = f"{ends[0]} → {label_of_carrier(topic)} → {ends[1]}"
                flows.setdefault((*ends, topic.name), NodeFlow(*ends, topic, sentence))
    return tuple(flows.values())


BadgeSeverity = Literal["error", "warning", "note"]


def component_box(lookup: Lookup, component: Component, *, lines: tuple[str, ...] = ()) -> Box:
    """Return the box of a component, in the hue of its group. A composed one is closed: it says how many are inside, and its
    badge is that of the worst finding inside.
    """
    inner_findings = list_findings_inside(lookup, component) if component.children else []
    return Box(
        component.id,
        component.title,
        (*lines, *_count_inside(lookup, component)),
        style=_component_style(component),
        colour=group_hue(lookup, component.group),
        cluster=component.group,
        ref=f"component:{component.id}",
        tooltip=_component_tooltip(lookup, component),
        badge=name_severity(inner_findings) if inner_findings else worst_severity(lookup, component.id),
        badge_count=len(inner_findings),
    )


def type_lines(lookup: Lookup, component: Component) -> tuple[str, ...]:
    """Return a line with the type that a component is made from; none where its title says it already."""
    type_name = name_component_type(lookup.architecture, component)
    return (type_name,) if type_name not in {"", component.title} else ()


def _count_inside(lookup: Lookup, component: Component) -> tuple[str, ...]:
    """Return a line with the number of components in a composed one; no line for any other."""
    if component.id not in lookup.architecture.shells or not component.children:
        return ()
    leaves = [leaf for leaf in lookup.architecture.leaves_of(component.id) if leaf != component.id]
    return (count_noun(len(leaves), "component"),)


def _component_style(component: Component) -> Literal["component", "source", "sink", "reactive", "composed"]:
    if component.children:
        return "composed"
    return "component" if component.role is None or component.role == "filter" else component.role


def _component_tooltip(lookup: Lookup, component: Component) -> str:
    lines = [f"{component.title} ({component.id})", f"Group: {lookup.architecture.groups[component.group].title}"]
    lines += [f"Inside of: {title}"] if (title := join_surrounding_titles(lookup, component)) else []
    lines += [f"Type: {name_component_type(lookup.architecture, component)}"] if component.component_type else []
    lines += [f"Role: {component.role}"] if component.role else []
    lines += [f"Owner: {join_owner_titles(lookup, component.owners)}"] if component.owners else []
    lines += [strip_marks(component.functionality)] if component.functionality else []
    lines += _list_ports(component) if component.children else []
    return "\n".join(lines)


def _list_ports(component: Component) -> list[str]:
    uses = ("Inputs", component.inputs), ("Outputs", component.outputs)
    return [f"{use}: {', '.join(ports)}" for use, ports in uses if ports]


def name_in_place(lookup: Lookup, component: Component) -> str:
    """Return the title of a component, with those of the composed ones around it before it."""
    return " · ".join(filter(None, (join_surrounding_titles(lookup, component), component.title)))


def join_owner_titles(lookup: Lookup, partner_ids: Iterable[str]) -> str:
    """Join the titles of partners; empty where there are none."""
    # An owner that is no declared partner is a finding, not an error: it is shown as written.
    partners = lookup.architecture.partners
    return ", ".join(partners[partner].title if partner in partners else partner for partner in partner_ids)


def group_hue(lookup: Lookup, group: str) -> int:
    """Return a group's colour, an index of the palette's ten hues."""
    # Ten as in `palette.HUES`, which views must not import: emitters are above them.
    return lookup.group_hues[group] % 10


def worst_severity(lookup: Lookup, element_id: str) -> BadgeSeverity | None:
    """Return the severity of an element's worst finding."""
    return name_severity(finding.effective_severity for finding in lookup.findings_of.get(element_id, ()))


def list_findings_inside(lookup: Lookup, shell: Component) -> list[Severity]:
    """Return the severities of the findings about a composed component and all that stands in it."""
    pending, severities = [shell.id], list[Severity]()
    while pending:
        component_id = pending.pop()
        severities += (finding.effective_severity for finding in lookup.findings_of.get(component_id, ()))
        inner_shell = lookup.architecture.shells.get(component_id)
        pending += inner_shell.children if inner_shell else ()
    return severities


def name_severity(severities: Iterable[Severity]) -> BadgeSeverity | None:
    """Return the worst of some severities as a badge names it."""
    worst = max(severities, default=None)
    return None if worst is None else cast("BadgeSeverity", worst.value)  # `off` is only a setting


def neighbour_box(lookup: Lookup, component: Component, side: Literal["left", "right"] | None) -> Box:
    """Return the box of a component of another group: grey, with its group's title below its own."""
    place = [lookup.architecture.groups[component.group].title, join_surrounding_titles(lookup, component)]
    return replace(
        component_box(lookup, component, lines=(" · ".join(filter(None, place)),)),
        style="composed" if component.children else "component",
        emphasis="neighbour",
        cluster=None,
        side=side,
        badge=None,
        badge_count=0,
    )


def group_box(lookup: Lookup, group_id: str, *, lines: Iterable[str] = ()) -> Box:
    """Return a group as one box."""
    group = lookup.architecture.groups[group_id]
    count = count_noun(len(group.components), "component")
    members = [find_component(lookup.architecture, name) for name in list_members(lookup.architecture, group_id)]
    summary_lines = [line for line in (join_owner_titles(lookup, group.owners), count) if line]
    return Box(
        group_id,
        group.title,
        (*summary_lines, *lines),
        style="group",
        colour=group_hue(lookup, group_id),
        ref=f"group:{group_id}",
        tooltip="\n".join([f"{group.title} ({group_id})", *summary_lines, *(c.title for c in members)]),
    )


def group_frame(lookup: Lookup, group_id: str) -> Cluster:
    """Return a group as a frame round its components."""
    group = lookup.architecture.groups[group_id]
    return Cluster(
        group_id,
        group.title,
        colour=group_hue(lookup, group_id),
        ref=f"group:{group_id}",
        tooltip=group.title,
    )
