"""Does a message of each publisher find a place in the queue of a subscription?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.derivation.wire.running_state import domain_of
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.ros_distro import is_ros_1

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, Topic

_TAKEN_TURNS = frozenset({"/tf", "/tf_static", "/diagnostics", "/cmd_vel"})
"""Topics on which many send: whoever reads them knows."""
_MAX_SHOWN = 3


def shared_memory(architecture: Architecture) -> Iterator[Diagnostic]:
    """A subscription keeps fewer messages than there are publishers on its topic: they push out one another's."""
    if is_ros_1(architecture.distro):
        return
    for topic in architecture.topics.values():
        if topic.flow == "topic" and len(topic.writers) > 1:
            for reader in topic.readers:
                yield from _judge_queue(architecture, topic, reader)


def _judge_queue(architecture: Architecture, topic: Topic, reader: Endpoint) -> Iterator[Diagnostic]:
    depth = reader.qos.depth
    if not reader.qos.written or reader.qos.history == "keep_all" or depth is None:
        return
    nodes = architecture.nodes
    writers = {
        each.node: each
        for each in topic.writers
        if domain_of(each) == domain_of(reader) and each.runs != "off" and nodes[each.node].written
    }
    latched = [each for each in writers.values() if each.qos.durability == "transient_local"]
    is_latched = reader.qos.durability == "transient_local" and len(latched) > max(depth, 1)
    if len(writers) <= max(depth, 1) or not nodes[reader.node].written:
        return
    names = [f"`{name}`" for name in writers]
    shown_names = join_words(
        names if len(names) <= _MAX_SHOWN else [*names[:_MAX_SHOWN], f"{len(names) - _MAX_SHOWN} more"]
    )
    kept = "one message" if depth <= 1 else f"{depth} messages"
    loss = "what others sent before it started is lost to it" if is_latched else "one may push out what another sent"
    yield Diagnostic(
        "shared-memory",
        f"`{reader.node}` keeps {kept} of `{topic.name}` in all, on which {shown_names} publish: {loss}",
        next((span for span in (reader.qos.at, reader.at) if span.file), nodes[reader.node].at),
        severity=Severity.WARNING if is_latched and topic.name not in _TAKEN_TURNS else None,
        labels=tuple(Label(each.at, "published here") for each in list(writers.values())[:2] if each.at.file),
        help=f"give it a `depth` of {len(writers)} or more, or a topic of its own to each publisher",
        element=reader.node,
    )


RULES = ((shared_memory, Severity.NOTE),)
