"""The site's pages of hosts and containers: what they have, what runs there, and what they are joined by."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.frozen import replace
from archgen.model.deployment import Container, Host
from archgen.model.parameter import format_parameter
from archgen.model.port_media import name_medium
from archgen.model.runtime_facts import find_container_threads
from archgen.views import inline_text, timing_words
from archgen.views.elements.annotation_facts import list_annotation_facts
from archgen.views.lookup import Lookup
from archgen.views.pages import context_pages
from archgen.views.pages.context_pages import FigureFilter
from archgen.views.shapes import Block, Inlines, Markdown, Page, Section, Text, show_known
from archgen.views.tables import deployment_tables
from archgen.views.timing import element_timing
from archgen.views.timing.host_waterfall import make_host_waterfall

_CRUMB = ("Hosts and containers", "page:hosts")


def make_host_pages(lookup: Lookup, keep_drawn: FigureFilter) -> Iterator[Page]:
    """Make a page for each host and container."""
    for host in lookup.architecture.hosts.values():
        yield _host_page(lookup, host, keep_drawn)
    for container in lookup.architecture.containers.values():
        yield _container_page(lookup, container)


def _host_page(lookup: Lookup, host: Host, keep_drawn: FigureFilter) -> Page:
    architecture = lookup.architecture
    order = ", ".join(filter(None, (host.scheduling, timing_words.format_core_orders(host))))
    facts = [
        ("Cores", inline_text.count_to_inlines(host.cores)),
        ("Address", inline_text.to_inlines(host.address)),
        ("Discovery server", inline_text.to_inlines(f"port {host.discovery_server}" if host.discovery_server else "")),
        ("Scheduling", inline_text.to_inlines(order)),
        ("Environment", inline_text.join_inlines((Text(f"{each[0]}={each[1]}"),) for each in host.environment.items())),
        ("Tags", inline_text.to_inlines(", ".join(host.tags))),
        *list_annotation_facts(lookup, host),
        ("Resources", inline_text.join_inlines(map(inline_text.to_inlines, _name_resources(lookup, host)))),
        *_list_link_facts(lookup, host),
        (
            "Containers",
            inline_text.join_inlines(
                inline_text.to_inlines(Text(container.title, ref=f"container:{container.id}"))
                for container in architecture.containers.values()
                if container.host == host.id
            ),
        ),
    ]
    blocks: list[Block] = [show_known(facts)]
    blocks += [Markdown(host.description)] if host.description else []
    waterfall = make_host_waterfall(lookup, lookup.timing, host.id) if lookup.timing else None
    # The waterfall says the same at a glance; the chart has a page of the report, which has no waterfall.
    blocks += keep_drawn(element_timing.make_load_blocks(lookup, host.id)) if waterfall is None else ()
    blocks += context_pages.make_node_table(
        lookup, [node for node in lookup.shown_nodes() if node.host == host.id], host_id=host.id
    )
    section = Section(f"host:{host.id}", host.title, tuple(blocks))
    return replace(context_pages.make_page(section, "hosts", _CRUMB, "Host"), waterfall=waterfall)


def _list_link_facts(lookup: Lookup, host: Host) -> Iterator[tuple[str, Inlines]]:
    """Yield the links of a host, each with what is spoken on it, and the devices on them, each with its link."""
    links = [link for link in lookup.architecture.links.values() if host.id in link.connects]
    yield (
        "Links",
        inline_text.join_inlines(
            inline_text.to_inlines(
                Text(link.title, ref=f"link:{link.id}"), f" ({name_medium(link.protocol)})" if link.protocol else ""
            )
            for link in links
        ),
    )
    yield (
        "Devices",
        inline_text.join_inlines(
            inline_text.to_inlines(*deployment_tables.device_link(lookup, device), f" (on {link.title})")
            for link in links
            for device in link.devices
        ),
    )


def _name_resources(lookup: Lookup, host: Host) -> Iterator[str]:
    """Yield the titles of a host's resources, each with its users."""
    for resource in lookup.architecture.resources.values():
        if resource.host == host.id:
            users = ", ".join(node.id for node in lookup.architecture.nodes_using(resource.id))
            yield f"{resource.title} (used by {users})" if users else resource.title


def _container_page(lookup: Lookup, container: Container) -> Page:
    threads = find_container_threads(lookup.architecture, container)
    text = "as many as are asked for" if threads is None else str(threads)
    is_named = container.name is not None or container.namespace != "/"
    lines = (inline_text.to_code(f"{name}: {format_parameter(value)}") for name, value in container.parameters.items())
    facts = (
        ("Host", inline_text.host_link(lookup.architecture, container.host)),
        ("Threads", inline_text.to_inlines(text if container.threads is not None else f"{text} (nothing is written)")),
        ("Scheduling", inline_text.to_inlines(container.scheduling)),
        ("ROS name", inline_text.to_code(container.full_name if is_named else None)),
        ("Package", inline_text.to_code(container.package)),
        ("Executable", inline_text.to_code(container.executable)),
        ("Parameters", inline_text.join_lines(lines)),
    )
    nodes = context_pages.make_node_table(
        lookup, [node for node in lookup.shown_nodes() if node.container == container.id]
    )
    section = Section(f"container:{container.id}", container.title, (show_known(facts), *nodes))
    return context_pages.make_page(section, "containers", _CRUMB, "Container")
