"""All that the site's search finds, in the order in which it is loaded: names before ports, ports before texts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.known_interfaces import Interface
from archgen.model.port_media import key_of_channel, name_medium, name_on_medium
from archgen.views import inline_text
from archgen.views.elements.frame_users import list_shown_frames, name_writer
from archgen.views.elements.port_tables import list_text_remarks
from archgen.views.lookup import Lookup, collect_messages
from archgen.views.search import functional_entries, search_entry
from archgen.views.search.functional_entries import list_owner_titles, make_owner_keys, make_property_keys
from archgen.views.search.search_entry import SearchEntry, join_entry_parts, to_plain_text
from archgen.views.shapes import Page
from archgen.views.start_phrases import describe_start


def make_search_entries(lookup: Lookup, pages: Sequence[Page]) -> tuple[SearchEntry, ...]:
    """Make the search entries of a site with these pages. Entries of one kind follow one another."""
    entries = [
        *functional_entries.make_component_entries(lookup),
        *functional_entries.make_composed_entries(lookup),
        *functional_entries.make_component_type_entries(lookup),
        *functional_entries.make_group_entries(lookup),
        *make_node_entries(lookup),
        *make_topic_entries(lookup),
        *make_channel_entries(lookup),
        *make_type_entries(lookup),
        *functional_entries.make_requirement_entries(lookup),
        *functional_entries.make_chain_entries(lookup),
        *functional_entries.make_partner_entries(lookup),
        *functional_entries.make_vocabulary_entries(lookup),
        *make_host_entries(lookup),
        *make_frame_entries(lookup),
        *make_message_entries(lookup),
        *search_entry.make_finding_entries(lookup),
        *functional_entries.make_port_entries(lookup),
        *functional_entries.make_connection_entries(lookup),
    ]
    listed_anchors = frozenset(ref for entry in entries for ref in entry.refs[:1])
    return (*entries, *search_entry.make_page_entries(pages, listed_anchors))


def make_node_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the shown nodes."""
    architecture = lookup.architecture
    for node in lookup.shown_nodes():
        implemented = ", ".join(architecture.components[name].title for name in node.implements)
        host = architecture.hosts.get(node.host or "")
        keys = (*([f"host:{host.id}"] if host else []), *make_owner_keys(node.owners, node.tags))
        yield SearchEntry(
            "node",
            node.full_name,
            join_entry_parts(
                host.title if host else None,
                f"implements {implemented}" if implemented else None,
                list_owner_titles(lookup, node.owners),
            ),
            (f"node:{node.id}",),
            (node.id, *([node.package] if node.package else []), *keys, *make_property_keys(node)),
            to_plain_text(node.description, *node.parameters, " ".join(node.command), describe_start(node)),
        )


def make_topic_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield topics, services and actions."""
    nodes = lookup.architecture.nodes
    for topic in lookup.architecture.topics.values():
        writers = dict.fromkeys(nodes[writer.node].id for writer in topic.writers)
        source = f"from {', '.join(writers)}" if writers else "from nobody"
        readers = len({reader.node for reader in topic.readers})
        reader_word = "reader" if topic.flow == "topic" else "client"
        yield SearchEntry(
            topic.flow,
            topic.name,
            join_entry_parts(", ".join(topic.messages), source, inline_text.count_noun(readers, reader_word)),
            (f"topic:{topic.name}",),
        )


def make_channel_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield what nodes exchange over other media than ROS."""
    for channel in lookup.architecture.channels.values():
        writers = ", ".join(dict.fromkeys(writer.node for writer in channel.writers))
        line = join_entry_parts(name_medium(channel.medium), ", ".join(channel.types), f"from {writers}")
        yield SearchEntry(
            channel.flow, name_on_medium(channel), line, (f"channel:{key_of_channel(channel)}",), (channel.medium,)
        )


def make_host_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield hosts, containers, resources and links."""
    architecture = lookup.architecture
    for host in architecture.hosts.values():
        cores = inline_text.count_noun(host.cores, "core") if host.cores else None
        keys = (host.id, f"host:{host.id}", *make_owner_keys((), host.tags), *make_property_keys(host))
        text = to_plain_text(host.description)
        yield SearchEntry("host", host.title, join_entry_parts("host", cores), (f"host:{host.id}",), keys, text)
    for container in architecture.containers.values():
        line = join_entry_parts("container", f"on {container.host}" if container.host else None)
        yield SearchEntry("container", container.title, line, (f"container:{container.id}",), (container.id,))
    for resource in architecture.resources.values():
        line = join_entry_parts("resource", f"of {resource.host}" if resource.host else None)
        yield SearchEntry("resource", resource.title, line, (f"host:{resource.host}",), (resource.id,))
    for link in architecture.links.values():
        line = join_entry_parts(
            "link",
            name_medium(link.protocol) if link.protocol else None,
            ", ".join((*link.connects, *link.devices)),
        )
        yield SearchEntry("link", link.title, line, (f"link:{link.id}", "page:hosts"), (link.id,))


def make_frame_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the shown coordinate frames."""
    for frame in list_shown_frames(lookup):
        writer = f"by {name_writer(lookup.architecture, frame)}" if frame.parent is not None else None
        line = join_entry_parts("frame", f"in {frame.parent}" if frame.parent is not None else None, writer)
        text = frame.title if frame.title != frame.id else ""
        yield SearchEntry("frame", frame.id, line, (f"frame:{frame.id}", "page:frames"), text=text)


def make_type_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the conceptual types."""
    for conceptual_type in lookup.architecture.types.values():
        line = join_entry_parts(
            "type", conceptual_type.message, conceptual_type.status, *list_text_remarks(conceptual_type)
        )
        text = to_plain_text(conceptual_type.comment)
        yield SearchEntry("type", conceptual_type.name, line, (f"type:{conceptual_type.name}",), text=text)


def make_message_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the messages in use, with their fields and constants, and the messages that they contain."""
    architecture = lookup.architecture
    users = collect_messages(architecture, architecture.types.values(), architecture.topics.values())
    for message, anchors in users.items():
        # Its own page; where the part that a site shows has none, whoever uses it.
        refs = (f"message:{message}", *anchors)
        definition = architecture.interfaces.definitions.get(message)
        count = sum(map(len, definition.parts)) if definition else 0
        size = inline_text.count_noun(count, "field") if definition else "definition not at hand"
        line = join_entry_parts(message.split("/")[1].replace("srv", "service").replace("msg", "message"), size)
        yield SearchEntry(
            "message", message, line, refs, text=to_plain_text(definition.comment if definition else None)
        )
        if definition:
            yield from _make_field_entries(definition, refs)


def _make_field_entries(definition: Interface, refs: tuple[str, ...]) -> Iterator[SearchEntry]:
    short_name = definition.name.rsplit("/", 1)[1]
    line = f"of {definition.name}"
    for part, part_fields in zip(definition.part_names, definition.parts, strict=True):
        prefix = join_entry_parts(short_name, part)
        for field in part_fields:
            title = f"{prefix} · {field.name}"
            text = to_plain_text(field.comment)
            yield SearchEntry("field", title, join_entry_parts(field.type + field.array, line), refs, text=text)
    for part_constants in definition.constants:
        for constant in part_constants:
            title = f"{short_name} · {constant.name}"
            text = to_plain_text(constant.comment)
            yield SearchEntry(
                "field", title, join_entry_parts(f"{constant.type} = {constant.value}", line), refs, text=text
            )
