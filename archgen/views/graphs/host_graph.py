"""Draw where nodes run: hosts as frames, with their containers and single nodes, and the links between hosts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.model.deployment import Container, Host, Link
from archgen.views.graph_shapes import Arrow, Box, Cluster, Graph
from archgen.views.graphs import node_boxes
from archgen.views.graphs.graph_folding import fold_graph
from archgen.views.graphs.legend_keys import add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup

_MAX_LISTED_NODES = 12


def draw_hosts(lookup: Lookup) -> Graph:
    """Draw hosts, containers, nodes and links."""
    architecture = lookup.architecture
    links = list(architecture.links.values())
    frames = tuple(_host_frame(host, at) for at, host in enumerate(architecture.hosts.values()))
    arrows = tuple(arrow for link in links for arrow in _draw_link(lookup, link))
    graph = Graph(
        "hosts",
        f"{architecture.project.title}: hosts and containers",
        "two-step",
        (*_draw_processes(lookup), *(_link_hub(link) for link in links if len(_linked_hosts(lookup, link)) > 2)),  # noqa: PLR2004
        arrows,
        frames,
        direction=architecture.layout.direction,
        alt=f"{count_noun(len(architecture.hosts), 'host')} with {count_noun(len(architecture.containers), 'container')} "
        f"and {count_noun(len(links), 'link')}: {', '.join(host.title for host in architecture.hosts.values())}.",
        asked=len(arrows),
        kind="hosts",
    )
    return fold_graph(add_legend_keys(graph))


def _host_frame(host: Host, index: int) -> Cluster:
    lines = (count_noun(host.cores, "core"),) if host.cores is not None else ()
    return Cluster(host.id, host.title, lines, colour=index % 10, ref=f"host:{host.id}", tooltip=host.title)


def _draw_processes(lookup: Lookup) -> Iterator[Box]:
    """Yield the containers, and the nodes with a process of their own. All without a host are one box."""
    architecture = lookup.architecture
    for container in architecture.containers.values():
        yield _container_box(lookup, container)
    standalone_nodes = [node for node in architecture.nodes.values() if node.container not in architecture.containers]
    for node in standalone_nodes:
        if node.host in architecture.hosts:
            yield replace(node_boxes.node_box(lookup, node), cluster=node.host)
    homeless_ids = [node.id for node in standalone_nodes if node.host not in architecture.hosts]
    # Where no host is declared at all, nothing is deployed yet: a box of all nodes would say nothing.
    if homeless_ids and architecture.hosts:
        yield Box(
            "no host",
            f"{count_noun(len(homeless_ids), 'node')} without a host",
            style="fold",
            emphasis="neighbour",
            tooltip="\n".join(["No host is decided yet for", *homeless_ids]),
        )


def _container_box(lookup: Lookup, container: Container) -> Box:
    node_ids = [node.id for node in lookup.architecture.nodes.values() if node.container == container.id]
    shown_lines = (
        node_ids
        if len(node_ids) <= _MAX_LISTED_NODES
        else [*node_ids[: _MAX_LISTED_NODES - 1], f"and {len(node_ids) - _MAX_LISTED_NODES + 1} more"]
    )
    threads = (count_noun(container.threads, "thread"),) if container.threads is not None else ()
    return Box(
        f"container {container.id}",
        container.title,
        (*threads, *shown_lines),
        style="container",
        cluster=container.host if container.host in lookup.architecture.hosts else None,
        ref=f"container:{container.id}",
        tooltip="\n".join([container.title, *node_ids]),
    )


def _linked_hosts(lookup: Lookup, link: Link) -> list[str]:
    return [host for host in dict.fromkeys(link.connects) if host in lookup.architecture.hosts]


def _link_label(link: Link) -> str:
    times = [quantity.text for quantity in (link.best, link.worst) if quantity]
    rows = [link.title, link.bandwidth.text if link.bandwidth else "", " to ".join(dict.fromkeys(times))]
    return "\n".join(word for word in rows if word)


def _link_hub(link: Link) -> Box:
    title, *lines = _link_label(link).split("\n")
    return Box(f"link {link.id}", title, tuple(lines), style="link", ref=f"link:{link.id}", tooltip=_link_label(link))


def _draw_link(lookup: Lookup, link: Link) -> Iterator[Arrow]:
    """Yield the arrows of a link: a line between two hosts, or a line from its own box to each of more."""
    host_ids = _linked_hosts(lookup, link)
    if len(host_ids) == 2:  # noqa: PLR2004
        yield Arrow(f"link {link.id}", host_ids[0], host_ids[1], _link_label(link), style="link", ref=f"link:{link.id}")
    elif len(host_ids) > 2:  # noqa: PLR2004
        for end in host_ids:
            yield Arrow(f"link {link.id} {end}", f"link {link.id}", end, style="link", ref=f"link:{link.id}")
