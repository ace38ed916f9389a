"""Draw where nodes run: hosts as frames, with their containers and single nodes, and the links between hosts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.model.deployment import Container, Host, Link
from archgen.views.graphs import nodes
from archgen.views.graphs.folding import fold
from archgen.views.graphs.legend import with_legend
from archgen.views.index import Index
from archgen.views.shapes import Arrow, Box, Cluster, Graph
from archgen.views.words import plural

_LISTED = 12


def hosts(view: Index) -> Graph:
    """Draw hosts, containers, nodes and links."""
    architecture = view.architecture
    links = list(architecture.links.values())
    frames = tuple(_frame(host, at) for at, host in enumerate(architecture.hosts.values()))
    arrows = tuple(arrow for link in links for arrow in _arrows(view, link))
    graph = Graph(
        "hosts",
        f"{architecture.project.title}: hosts and containers",
        "two-step",
        (*_inside(view), *(_hub(link) for link in links if len(_ends(view, link)) > 2)),  # noqa: PLR2004
        arrows,
        frames,
        direction=architecture.layout.direction or "left-right",
        alt=f"{plural(len(architecture.hosts), 'host')} with {plural(len(architecture.containers), 'container')} "
        f"and {plural(len(links), 'link')}: {', '.join(host.title for host in architecture.hosts.values())}.",
        asked=len(arrows),
    )
    return fold(with_legend(graph))


def _frame(host: Host, at: int) -> Cluster:
    lines = (plural(host.cores, "core"),) if host.cores is not None else ()
    return Cluster(host.id, host.title, lines, colour=at % 10, ref=f"host:{host.id}", tooltip=host.title)


def _inside(view: Index) -> Iterator[Box]:
    """Yield the containers, and the nodes with a process of their own. All without a host are one box."""
    architecture = view.architecture
    for container in architecture.containers.values():
        yield _container(view, container)
    alone = [node for node in architecture.nodes.values() if node.container not in architecture.containers]
    for node in alone:
        if node.host in architecture.hosts:
            yield replace(nodes.node(view, node), cluster=node.host)
    homeless = [node.id for node in alone if node.host not in architecture.hosts]
    # Where no host is declared at all, nothing is deployed yet: a box of all nodes would say nothing.
    if homeless and architecture.hosts:
        yield Box(
            "no host",
            f"{plural(len(homeless), 'node')} without a host",
            style="fold",
            emphasis="neighbour",
            tooltip="\n".join(["No host is decided yet for", *homeless]),
        )


def _container(view: Index, item: Container) -> Box:
    names = [node.id for node in view.architecture.nodes.values() if node.container == item.id]
    shown = names if len(names) <= _LISTED else [*names[: _LISTED - 1], f"and {len(names) - _LISTED + 1} more"]
    threads = (plural(item.threads, "thread"),) if item.threads is not None else ()
    return Box(
        f"container {item.id}",
        item.title,
        (*threads, *shown),
        style="container",
        cluster=item.host if item.host in view.architecture.hosts else None,
        ref=f"container:{item.id}",
        tooltip="\n".join([item.title, *names]),
    )


def _ends(view: Index, link: Link) -> list[str]:
    return [host for host in dict.fromkeys(link.connects) if host in view.architecture.hosts]


def _label(link: Link) -> str:
    times = [quantity.text for quantity in (link.best, link.worst) if quantity]
    said = [link.title, link.bandwidth.text if link.bandwidth else "", " to ".join(dict.fromkeys(times))]
    return "\n".join(word for word in said if word)


def _hub(link: Link) -> Box:
    title, *lines = _label(link).split("\n")
    return Box(f"link {link.id}", title, tuple(lines), style="link", ref=f"link:{link.id}", tooltip=_label(link))


def _arrows(view: Index, link: Link) -> Iterator[Arrow]:
    """Yield the arrows of a link: a line between two hosts, or a line from its own box to each of more."""
    ends = _ends(view, link)
    if len(ends) == 2:  # noqa: PLR2004
        yield Arrow(f"link {link.id}", ends[0], ends[1], _label(link), style="link", ref=f"link:{link.id}")
    elif len(ends) > 2:  # noqa: PLR2004
        for end in ends:
            yield Arrow(f"link {link.id} {end}", f"link {link.id}", end, style="link", ref=f"link:{link.id}")
