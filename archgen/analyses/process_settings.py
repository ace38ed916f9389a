"""Does what is written of processes and resources count: threads, orders, callback groups, GPUs?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.node import Node


def idle_executor(architecture: Architecture) -> Iterator[Diagnostic]:
    """A key of a node that says how its callbacks run has no effect where it stands."""
    for node in architecture.nodes.values():
        container = architecture.containers.get(node.container or "")
        for key in ("threads", "scheduling") if container else ():
            if container and key in node.executor_places:
                yield Diagnostic(
                    "idle-executor",
                    f"`{key}` of `{node.id}` has no effect: it runs in the container `{container.id}`",
                    node.executor_places[key],
                    labels=(Label(node.container_at, "its container"),),
                    help=f"write it at the container: `containers: {{{container.id}: {{{key}: {getattr(node, key)}}}}}`",
                    element=node.id,
                )
        if node.callback_groups:
            yield from _find_idle_groups(node)


def _find_idle_groups(node: Node) -> Iterator[Diagnostic]:
    if node.reentrant:
        reason, help_line = "it is `reentrant`: all of its callbacks run side by side", "keep one of them"
    elif len(node.implements) == 1:
        reason = "it implements one component, whose callbacks are in one group anyway"
        help_line = "leave it out, or write `reentrant: true` where its callbacks run side by side"
    else:
        return
    yield Diagnostic(
        "idle-executor",
        f"`callback_groups` of `{node.id}` has no effect: {reason}",
        node.executor_places["callback_groups"],
        help=help_line,
        element=node.id,
    )


def remote_resource(architecture: Architecture) -> Iterator[Diagnostic]:
    """An element uses a resource of another computer."""
    # One `timing` may stand for several components of a node: its faults are reported once.
    reported_spans: set[Span] = set()
    for node in architecture.nodes.values():
        for timing in node.timing.values():
            for resource in (architecture.resources[name] for name in timing.uses):
                span = timing.places.get(f"uses {resource.id}", timing.at)
                if node.host and resource.host and node.host != resource.host and span not in reported_spans:
                    reported_spans.add(span)
                    yield Diagnostic(
                        "remote-resource",
                        f"`{node.id}` runs on `{node.host}`, but uses `{resource.id}` of `{resource.host}`",
                        span,
                        labels=(Label(resource.at, "the resource"),),
                        help="correct one of the two hosts; what asks a server there is a service, and the server a node",
                        element=node.id,
                    )


RULES = ((idle_executor, Severity.WARNING), (remote_resource, Severity.WARNING))
