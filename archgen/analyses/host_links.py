"""Are hosts that exchange messages joined by a link?"""

from __future__ import annotations

from collections import defaultdict
from itertools import combinations
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.model.architecture import Architecture
    from archgen.model.node import Topic

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


RULES = ((unlinked_hosts, Severity.WARNING),)
