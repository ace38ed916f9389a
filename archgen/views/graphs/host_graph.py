"""Draw where nodes run: a card for each host with its load, its containers and nodes; the links between hosts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.component_nesting import find_component
from archgen.model.deployment import Host, Link
from archgen.model.node import Node
from archgen.model.port_media import name_medium
from archgen.model.runtime_facts import find_container_threads
from archgen.views.graphs.graph_folding import add_legend_keys, fold_graph
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Graph
from archgen.views.timing_words import format_short_timing

_MAX_DEVICES = 4
"""How many devices a link's box names; more are counted, and the tooltip has them all."""

_MAX_ROWS = 36
"""How many rows a card has; of more the rest is counted, and the tooltip has them all."""
CardRow = tuple[str, str]


def draw_hosts(lookup: Lookup) -> Graph:
    """Draw hosts, containers, nodes and links."""
    architecture = lookup.architecture
    links = list(architecture.links.values())
    arrows = tuple(arrow for link in links for arrow in _draw_link(lookup, link))
    graph = Graph(
        "hosts",
        f"{architecture.project.title}: hosts and containers",
        "two-step",
        (
            *(_host_card(lookup, host, at) for at, host in enumerate(architecture.hosts.values())),
            *_draw_homeless(lookup),
            *(_link_hub(lookup, link) for link in links if _has_hub(lookup, link)),
        ),
        arrows,
        direction=architecture.layout.direction,
        alt=f"{count_noun(len(architecture.hosts), 'host')} with {count_noun(len(architecture.containers), 'container')} "
        f"and {count_noun(len(links), 'link')}: {', '.join(host.title for host in architecture.hosts.values())}.",
        asked=len(arrows),
        kind="hosts",
    )
    return fold_graph(add_legend_keys(graph))


def _host_card(lookup: Lookup, host: Host, index: int) -> Box:
    rows = tuple(_list_rows(lookup, host))
    shown_rows = rows if len(rows) <= _MAX_ROWS else rows[: _MAX_ROWS - 1]
    hidden = len(rows) - len(shown_rows)
    nodes = [node for node in lookup.architecture.nodes.values() if _runs_on(lookup, node, host.id)]
    cores = [count_noun(host.cores, "core")] if host.cores is not None else []
    return Box(
        f"host {host.id}",
        host.title,
        (", ".join([*cores, count_noun(len(nodes), "node")]),),
        style="host",
        colour=index % 10,
        rows=(*shown_rows, *([(f"and {hidden} more", "")] if hidden else [])),
        load=_host_load(lookup, host),
        ref=f"host:{host.id}",
        tooltip="\n".join([host.title, *(node.id for node in nodes)]),
    )


def _host_load(lookup: Lookup, host: Host) -> tuple[float | None, str] | None:
    """Return how busy all cores are together, where the timing analysis knows anything of it."""
    load = lookup.timing.analysis.hosts.get(host.id) if lookup.timing else None
    if load is None or not load.activity_shares or load.cores is None:
        return None
    # Imported here because the engine's words take time to load, and most commands show no timing.
    from archgen.views.timing.load_charts import share_of_cores, to_float
    from archgen.views.timing.value_format import UNKNOWN_FIGURE, display_share

    share = share_of_cores(load.utilisation, load.cores)
    words = display_share(share)
    percent = None if share.value is None else to_float(share.value * 100)
    return percent, "load not known" if words == UNKNOWN_FIGURE else f"load {words}"


def _list_rows(lookup: Lookup, host: Host) -> Iterator[CardRow]:
    """Yield the containers with their nodes, then the nodes with a process of their own."""
    architecture = lookup.architecture
    containers = [each for each in architecture.containers.values() if each.host == host.id]
    for container in containers:
        count = find_container_threads(architecture, container)
        threads = f" ({count_noun(count, 'thread')})" if count is not None else ""
        yield f"{container.title}{threads}", ""
        yield from _node_rows([node for node in architecture.nodes.values() if node.container == container.id])
    standalone = [node for node in _list_standalone(lookup) if node.host == host.id]
    if containers and standalone:
        yield "Nodes with a process of their own", ""
    yield from _node_rows(standalone)


def _node_rows(nodes: Sequence[Node]) -> Iterator[CardRow]:
    for node in nodes:
        timings = dict.fromkeys(format_short_timing(timing) for timing in node.timing.values())
        yield node.id, "\n".join(word for word in timings if word) or "\u2013"


def _list_standalone(lookup: Lookup) -> list[Node]:
    architecture = lookup.architecture
    return [node for node in architecture.nodes.values() if node.container not in architecture.containers]


def _runs_on(lookup: Lookup, node: Node, host_id: str) -> bool:
    container = lookup.architecture.containers.get(node.container or "")
    return (container.host if container else node.host) == host_id


def _draw_homeless(lookup: Lookup) -> Iterator[Box]:
    """Yield one box for the containers and nodes without a host."""
    architecture = lookup.architecture
    homeless = [f"{each.title}" for each in architecture.containers.values() if each.host not in architecture.hosts]
    homeless += [node.id for node in _list_standalone(lookup) if node.host not in architecture.hosts]
    # Where no host is declared at all, nothing is deployed yet: a box of all nodes would say nothing.
    if homeless and architecture.hosts:
        yield Box(
            "no host",
            f"{len(homeless)} without a host",
            style="fold",
            emphasis="neighbour",
            tooltip="\n".join(["No host is decided yet for", *homeless]),
        )


def _linked_hosts(lookup: Lookup, link: Link) -> list[str]:
    return [host for host in dict.fromkeys(link.connects) if host in lookup.architecture.hosts]


def _link_label(link: Link) -> str:
    times = [quantity.text for quantity in (link.best, link.worst) if quantity]
    rows = [
        link.title,
        name_medium(link.protocol or ""),
        link.bandwidth.text if link.bandwidth else "",
        " to ".join(dict.fromkeys(times)),
    ]
    return "\n".join(word for word in rows if word)


def _has_hub(lookup: Lookup, link: Link) -> bool:
    """Whether a link has a box of its own: one that joins more than two hosts, or a host with devices."""
    hosts = _linked_hosts(lookup, link)
    return len(hosts) > 2 or bool(hosts and link.devices)  # noqa: PLR2004


def _link_hub(lookup: Lookup, link: Link) -> Box:
    title, *lines = _link_label(link).split("\n")
    devices = [find_component(lookup.architecture, device).title for device in link.devices]
    shown = devices if len(devices) <= _MAX_DEVICES else [count_noun(len(devices), "device")]
    return Box(
        f"link {link.id}",
        title,
        (*lines, *shown),
        style="link",
        ref=f"link:{link.id}",
        tooltip="\n".join([_link_label(link), *devices]),
    )


def _draw_link(lookup: Lookup, link: Link) -> Iterator[Arrow]:
    """Yield the arrows of a link: a line between two hosts, or a line from its own box to each."""
    host_ids = _linked_hosts(lookup, link)
    if _has_hub(lookup, link):
        for end in host_ids:
            yield Arrow(f"link {link.id} {end}", f"link {link.id}", f"host {end}", style="link", ref=f"link:{link.id}")
    elif len(host_ids) == 2:  # noqa: PLR2004
        tail, head = (f"host {each}" for each in host_ids)
        yield Arrow(f"link {link.id}", tail, head, _link_label(link), style="link", ref=f"link:{link.id}")
