"""Cards of the implementation level: nodes, and what they exchange over ROS and other media."""

from __future__ import annotations

import shlex

from archgen.diagnostics.source_span import Span
from archgen.model.node import Endpoint, Node, Topic
from archgen.model.port_media import ROS, name_medium, name_on_medium
from archgen.views import inline_text, timing_words
from archgen.views.elements.card_parts import (
    ElementCard,
    drop_empty_lists,
    format_fact,
    known_facts,
    list_finding_lines,
)
from archgen.views.elements.parameter_blocks import list_effective_lines
from archgen.views.lookup import Lookup
from archgen.views.start_phrases import describe_override, describe_start, list_running_facts


def make_node_card(lookup: Lookup, node: Node) -> ElementCard:
    """Make the card of a node."""
    endpoints = lookup.endpoints_of.get(node.id, ())
    facts = [
        ("implements", ", ".join(node.implements)),
        ("owner", ", ".join(node.owners) or "?"),
        ("ROS name", "" if node.is_program else node.full_name),
        ("kind", ", ".join(node.kinds)),
        ("status", node.status or "?"),
        ("package", node.package or "?"),
        ("executable", node.executable or ""),
        ("command", shlex.join(node.command)),
        ("start", describe_start(node)),
        *list_running_facts(endpoints),
        ("host", node.host or "?"),
        ("container", node.container or ""),
        ("threads", format_fact(node.threads)),
        ("scheduling", node.scheduling or ""),
        ("callback_groups", timing_words.format_callback_groups(node)),
        ("reentrant", "yes" if node.reentrant else ""),
        (
            "timing",
            "; ".join(filter(None, (timing_words.format_short_timing(timing) for timing in node.timing.values()))),
        ),
    ]
    lines = tuple(
        f"{inline_text.ENDPOINT_USE_WORDS[endpoint.use]} {_describe_endpoint(endpoint)}{describe_move(endpoint)}"
        f"{_tell_override(endpoint)}"
        for endpoint in endpoints
    )
    lists = (
        ("topics, services and actions", lines),
        *drop_empty_lists(("parameters", tuple(list_effective_lines(lookup, node)))),
        ("findings", tuple(list_finding_lines(lookup, node.id))),
    )
    return ElementCard("node", node.id, node.title, node.at, known_facts(facts), lists)


def _describe_endpoint(endpoint: Endpoint) -> str:
    """Return the name of what a node uses with its message; over another medium than ROS, with its type."""
    if endpoint.medium == ROS:
        return f"{endpoint.label} ({endpoint.message or '?'})"
    return f"{name_on_medium(endpoint)} ({name_medium(endpoint.medium)}: {endpoint.type or '?'})"


def _tell_override(endpoint: Endpoint) -> str:
    words = describe_override(endpoint)
    return f", QoS {words}" if words else ""


def describe_move(endpoint: Endpoint) -> str:
    """Return what a launch makes of the name that the program says, with the place of the rule; nothing where it is the same."""
    if not endpoint.is_moved:
        return ""
    at = endpoint.evidence["name"].at
    place = f" by {at.file}:{at.line}" if at.line else ""
    return f"; says `{endpoint.program_name}`, is on `{endpoint.label}`{place}"


def make_topic_card(lookup: Lookup, topic: Topic) -> ElementCard:
    """Make the card of a topic, service or action."""
    facts = [
        ("message", ", ".join(topic.messages) or "?"),
        ("types", ", ".join(topic.types)),
        ("size", lookup.format_size(topic)),
    ]
    endpoints_by_role = (("from", topic.writers), ("to", topic.readers))
    lists = tuple(
        (name, tuple(f"{endpoint.node} ({inline_text.format_qos(endpoint.qos)})" for endpoint in endpoints))
        for name, endpoints in endpoints_by_role
    )
    # Nothing declares a topic by itself: its first endpoint that stands in a file has to do.
    span = next(
        (endpoint.at for endpoint in (*topic.writers, *topic.readers) if endpoint.at.file), Span("", 0, 0, 0, 0)
    )
    return ElementCard(topic.flow, topic.name, topic.name, span, known_facts(facts), lists)


def make_channel_card(lookup: Lookup, channel: Topic) -> ElementCard:
    """Make the card of what nodes exchange over another medium."""
    facts = [
        ("medium", name_medium(channel.medium)),
        ("types", ", ".join(channel.types)),
        ("size", lookup.format_size(channel)),
    ]
    users = (*channel.writers, *channel.readers)
    lists = tuple(
        (role, tuple(dict.fromkeys(endpoint.node for endpoint in endpoints)))
        for role, endpoints in (("from", channel.writers), ("to", channel.readers))
    )
    span = next((each.at for each in users if each.at.file), Span("", 0, 0, 0, 0))
    name = name_on_medium(channel)
    return ElementCard(channel.flow, name, name, span, known_facts(facts), lists)
