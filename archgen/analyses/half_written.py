"""Is what the project has begun to write about nodes, links and chains enough to mean something?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import combinations

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, join_words
from archgen.model.architecture import Architecture
from archgen.model.node import Node, Topic
from archgen.model.port_media import ROS
from archgen.model.ros_distro import is_ros_1

_KEY_MEANINGS = {"plugin": "the class in `plugin`", "container": "the container that loads it in `container`"}


def half_written(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node, a link or a chain lacks its other half."""
    # In ROS 1 the kind itself is wrong, which `other-ros-generation` reports.
    for node in architecture.nodes.values() if not is_ros_1(architecture.distro) else ():
        missing_keys = _list_missing_keys(node)
        if missing_keys:
            yield Diagnostic(
                "half-written",
                f"the composable node `{node.id}` has no {' and no '.join(f'`{key}`' for key in missing_keys)}",
                node.kind_at,
                help=f"write {join_words([_KEY_MEANINGS[key] for key in missing_keys])}; while it is not decided, write "
                "`status: planned`",
                element=node.id,
            )
    for link in architecture.links.values():
        ends = (*link.connects, *link.devices)
        if len(ends) == 1 and not link.unresolved:
            yield Diagnostic(
                "half-written",
                f"the link `{link.id}` connects only one {'host' if link.connects else 'device'}, `{ends[0]}`",
                link.connects_at,
                help="name what is at both of its ends in `connects`",
                element=link.id,
            )
    for chain in architecture.chains.values():
        if len(chain.through) == 1 and not chain.unresolved:
            yield Diagnostic(
                "half-written",
                f"the chain `{chain.id}` goes through one element only, `{chain.through[0].id}`",
                chain.through[0].at,
                help="name where it begins and where it ends in `through`; how long one component may take stands in its "
                "`performance`",
                element=chain.id,
            )


def _list_missing_keys(node: Node) -> list[str]:
    """Return what a composable node lacks: nothing while it is planned, or if a program of its own starts it."""
    if "composable" not in node.kinds or node.status == "planned" or node.executable:
        return []
    # A container that is written, but not declared, is reported by the linker.
    # Without a package its code is generated, and so is the name of its class.
    missing_keys = {
        "plugin": node.plugin is None and node.package is not None,
        "container": node.container_at == NO_SPAN,
    }
    return [key for key, is_missing in missing_keys.items() if is_missing]


def uncomposable_node(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node stands in a container that loads composable nodes, and is none itself."""
    loaded_nodes = {node.container: node for node in architecture.nodes.values() if _is_loadable(node)}
    for node in architecture.nodes.values():
        container = architecture.containers.get(node.container or "")
        if node.language == "python" and container and not container.package and architecture.project.middleware == ROS:
            yield Diagnostic(
                "uncomposable-node",
                f"`{node.id}` is written in Python, but its container `{container.id}` loads classes of C++ only",
                node.at,
                labels=(Label(container.at, "the container"),),
                help="leave `container` out: programs in Python run in processes of their own",
                element=node.id,
            )
            continue
        loaded_node = loaded_nodes.get(node.container) if node.container else None
        if loaded_node is not None and not _is_loadable(node) and not node.plugin and node.status != "planned":
            kind = "nodelet" if "nodelet" in loaded_node.kinds else "composable"
            yield Diagnostic(
                "uncomposable-node",
                f"`{node.id}` is not `{kind}`, but its container `{node.container}` loads nodes that are, such as "
                f"`{loaded_node.id}`",
                node.at,
                labels=(Label(loaded_node.at, "loaded there"),),
                help=f"write `kind: {kind}` and its `plugin`, or leave `container` out",
                element=node.id,
            )


def _is_loadable(node: Node) -> bool:
    return not {"composable", "nodelet"}.isdisjoint(node.kinds)


HostPair = tuple[str, str]


def unlinked_hosts(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nodes on two hosts exchange messages, and no link joins these hosts."""
    # A host that a link names wrongly, or a file that could not be read, may hold what is missing.
    if architecture.partial or any(link.unresolved for link in architecture.links.values()):
        return
    if not architecture.links and not any(chain.deadline for chain in architecture.chains.values()):
        return
    # Each pair in alphabetical order, as in `_list_topics`.
    joined_pairs = {pair for link in architecture.links.values() for pair in combinations(sorted(link.connects), 2)}
    # Which host a link of one end was to join is open: `half-written` reports it.
    open_hosts = {
        link.connects[0] for link in architecture.links.values() if len(link.connects) == 1 and not link.devices
    }
    for (host, other_host), topics in _list_topics(architecture).items():
        if (host, other_host) not in joined_pairs and open_hosts.isdisjoint((host, other_host)):
            yield Diagnostic(
                "unlinked-hosts",
                f"`{host}` and `{other_host}` exchange {_count_topics(topics)}, and no link joins them",
                architecture.hosts[host].at,
                labels=(Label(architecture.hosts[other_host].at, "the other host"),),
                help=f"write a link with `connects: [{host}, {other_host}]`; without it, timing leaves open what depends on "
                "these",
                element=host,
            )


def _list_topics(architecture: Architecture) -> Mapping[HostPair, list[str]]:
    """Return what nodes on two hosts exchange (topics, services and actions, channels of other media), by pair of hosts.

    Topics that all nodes share are left out: nobody writes down who reads them.
    """
    topics_by_pair = defaultdict[HostPair, list[str]](list)
    for _, topic in architecture.list_carriers():
        if not topic.shared:
            for pair in _list_host_pairs(architecture, topic):
                topics_by_pair[pair].append(topic.name)
    return topics_by_pair


def _list_host_pairs(architecture: Architecture, topic: Topic) -> list[HostPair]:
    """Return the pairs of hosts between which a topic flows, sorted, each in alphabetical order."""
    writing_hosts = {architecture.nodes[writer.node].host for writer in topic.writers}
    reading_hosts = {architecture.nodes[reader.node].host for reader in topic.readers}
    pairs = {(min(a, b), max(a, b)) for a in writing_hosts if a for b in reading_hosts if b and a != b}
    return sorted(pairs)


def _count_topics(topics: list[str]) -> str:
    if len(topics) == 1:
        return f"`{topics[0]}`"
    return f"{len(topics)} topics, services or actions (`{topics[0]}` for one)"


RULES = (
    (half_written, Severity.WARNING),
    (uncomposable_node, Severity.WARNING),
    (unlinked_hosts, Severity.WARNING),
)
