"""Can each program and node be started as it is described: a port of its own, somebody who activates it, a way to start?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from archgen.bringup.start_plan import describes_start
from archgen.derivation.wire.running_state import ANY_NODE, RunningStates
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.start_up import NO_START

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.diagnostics.source_span import Span
    from archgen.model.architecture import Architecture
    from archgen.model.node import Endpoint, Node


def shared_port(architecture: Architecture) -> Iterator[Diagnostic]:
    """Two programs on one host are to listen on the same port."""
    first_nodes: dict[tuple[str | None, int], Node] = {}
    for node in architecture.nodes.values():
        port = node.start.ready.port if node.start else None
        if port is None:
            continue
        first = first_nodes.setdefault((node.host, port), node)
        if first is not node:
            place = f"on `{node.host}`" if node.host else "and on no host that is named"
            yield Diagnostic(
                "shared-port",
                f"`{first.id}` and `{node.id}` are both to listen on the port {port} {place}",
                _find_port_span(node),
                labels=(Label(_find_port_span(first), f"`{first.id}`"),),
                help="give one of them another port" + ("" if node.host else ", or each its host"),
                element=node.id,
            )


def _find_port_span(node: Node) -> Span:
    places = node.start.ready.places if node.start else {}
    return places.get("port", node.at)


def silent_node(architecture: Architecture) -> Iterator[Diagnostic]:
    """A lifecycle node is never activated, or stays short of it while others wait for what it sends."""
    if not describes_start(architecture):
        return
    yield from _find_unactivated(architecture)
    on_chains = {point.id for chain in architecture.chains.values() for point in chain.through}
    silent: dict[str, list[tuple[Endpoint, Endpoint]]] = defaultdict(list)
    for topic in architecture.topics.values():
        for writer in topic.writers:
            # What somebody brings into a state, he may bring further.
            if writer.runs == "inactive" and not (architecture.nodes[writer.node].start or NO_START).by_written:
                silent[writer.node] += (
                    (writer, each) for each in topic.readers if architecture.nodes[each.node].written
                )
    for node_id, ends in silent.items():
        writer, reader = ends[0]
        is_on_chain = any(not on_chains.isdisjoint((end.node, end.component, writer.port)) for writer, end in ends)
        names = list(dict.fromkeys(f"`{end.name}`" for end, _ in ends))
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        yield Diagnostic(
            "silent-node",
            f"`{node_id}` is left `{(architecture.nodes[node_id].start or NO_START).state}`: "
            f"`{reader.node}` waits for {names[0]}{more} in vain",
            writer.evidence["runs"].at,
            severity=Severity.ERROR if is_on_chain else None,
            labels=(Label(reader.at, "read here"),) if reader.at.file else (),
            help="write `start: {state: active}`, or `start: {by: NODE}` with the node that activates it",
            element=node_id,
        )


def _find_unactivated(architecture: Architecture) -> Iterator[Diagnostic]:
    """Yield the lifecycle nodes that nobody activates; none where a manager activates nodes that are not known."""
    managed_names = RunningStates(architecture).managers
    if ANY_NODE in managed_names:
        return
    managers: dict[str, list[str]] = defaultdict(list)
    for node in architecture.nodes.values():
        if node.start and node.start.by:
            managers[node.start.by.id].append(node.id)
    usual = max(managers, key=lambda name: len(managers[name]), default=None)
    for node in architecture.nodes.values():
        is_left = (node.start or NO_START).wanted_state is None and node.full_name not in managed_names
        if "lifecycle" in node.kinds and is_left:
            by_help = f"`start: {{by: {usual}}}`" if usual else "`start: {by: NODE}` with the node that manages it"
            yield Diagnostic(
                "silent-node",
                f"nobody activates the lifecycle node `{node.id}`",
                node.kind_at,
                help=f"write `start: {{state: active}}`, or {by_help}",
                element=node.id,
            )


def unstarted_program(architecture: Architecture) -> Iterator[Diagnostic]:
    """A program has no command and no package, and nothing shows that it is up."""
    if not describes_start(architecture):
        return
    for node in architecture.nodes.values():
        has_command = bool(node.command or (node.package and node.executable))
        is_known = has_command or node.status == "planned" or (node.start or NO_START).ready.has_sign
        if node.is_program and node.written and not is_known:
            yield Diagnostic(
                "unstarted-program",
                f"nothing says how the program `{node.id}` is started, nor how one sees that it is up",
                node.kind_at,
                help="write its `command`, or `start: {ready: ...}` where somebody else starts it; while it is not "
                "decided, `status: planned`",
                element=node.id,
            )


RULES = (
    (shared_port, Severity.WARNING),
    (silent_node, Severity.WARNING),
    (unstarted_program, Severity.WARNING),
)
