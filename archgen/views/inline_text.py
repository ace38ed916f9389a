"""Runs of inline text for documents: links to elements, and values written out in words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import chain

from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.component_nesting import find_component
from archgen.model.node import Endpoint, Node, Qos, Topic
from archgen.model.port_media import ROS, key_of_channel, name_medium, name_on_medium
from archgen.model.quantity import Quantity
from archgen.model.source_repository import SourceRepository
from archgen.views.shapes import Inlines, Text

NODE_KIND_WORDS = {
    "node": "node",
    "lifecycle": "lifecycle node",
    "composable": "composable node",
    "driver": "driver",
    "nodelet": "nodelet",
    "program": "program",
}
ENDPOINT_USE_WORDS = {"publishes": "publishes", "subscribes": "subscribes to", "serves": "serves", "calls": "calls"}
UNKNOWN_INLINES: Inlines = (Text("not known yet", muted=True),)


@lru_cache(65536)
def share_text(text: str, ref: str | None = None, *, code: bool = False) -> Text:
    """Return a run of text, the same object for the same words: most runs of a site are links to the same elements."""
    return Text(text, ref=ref, code=code)


def to_inlines(*parts: str | Text | None) -> Inlines:
    """Turn strings and ready `Text` runs into one sequence of inlines, without what is empty or None."""
    if len(parts) == 1:  # most have one
        (part,) = parts
        return ((share_text(part) if isinstance(part, str) else part),) if part else ()
    return tuple([share_text(part) if isinstance(part, str) else part for part in parts if part])


def to_code(text: str | None) -> Inlines:
    """Return a text as code, nothing for an empty one."""
    return (share_text(text, code=True),) if text else ()


def message_to_inlines(message: str, *, muted: bool = False) -> Inlines:
    """Turn a finding's message into inlines; what it quotes in backticks becomes code."""
    parts = _BACKTICKED.split(message)
    # `split` with one capturing group alternates: even positions are plain text, odd ones the quoted names.
    return tuple(Text(part, code=index % 2 == 1, muted=muted) for index, part in enumerate(parts) if part)


_BACKTICKED = re.compile(r"`([^`]+)`")


def value_or_unknown(value: str | None) -> Inlines:
    """Return the value as inlines, or "not known yet"."""
    return (share_text(value),) if value else UNKNOWN_INLINES


def quantity_to_inlines(quantity: Quantity | None) -> Inlines:
    """Return a quantity as it was written, sorted by its value; "not known yet" for None."""
    return (Text(str(quantity), sort_number=str(quantity.value)),) if quantity else UNKNOWN_INLINES


def count_to_inlines(count: int | None) -> Inlines:
    """Return a count, sorted by its value; "not known yet" for None or none at all."""
    return (Text(str(count), sort_number=str(count)),) if count else UNKNOWN_INLINES


def join_inlines(items: Iterable[Inlines], separator: str = ", ") -> Inlines:
    """Join inlines with a separator, as `str.join` does."""
    runs = list(items)
    if len(runs) <= 1:  # most are one: an owner, a requirement, a reader
        return runs[0] if runs else ()
    between = share_text(separator)
    return tuple(chain.from_iterable([(between, *run) if index else run for index, run in enumerate(runs)]))


def join_first(items: Sequence[Inlines], limit: int = 3, separator: str = ", ") -> Inlines:
    """Join the first pieces of text, and count the others."""
    rest = (Text(f" and {len(items) - limit} more"),) if len(items) > limit else ()
    return (*join_inlines(items[:limit], separator), *rest)


def join_lines(items: Iterable[Inlines]) -> Inlines:
    """Put each run of inlines on a line of its own."""
    result: list[Text] = []
    # A break belongs to the run that follows it.
    for first, *other_parts in filter(None, items):
        result += [replace(first, line_break=True) if result else first, *other_parts]
    return tuple(result)


def group_link(architecture: Architecture, group_id: str) -> Text:
    """Link to a group, by its title."""
    return share_text(architecture.groups[group_id].title, f"group:{group_id}")


def component_link(component: Component) -> Text:
    """Link to a component, by its title."""
    return share_text(component.title, f"component:{component.id}")


def node_link(node: Node) -> Text:
    """Link to a node, by its id."""
    return share_text(node.id, f"node:{node.id}", code=True)


def host_link(architecture: Architecture, host_id: str | None) -> Inlines:
    """Link to a host, by its title; "not known yet" for None."""
    if host_id is None:
        return UNKNOWN_INLINES
    host = architecture.hosts.get(host_id)
    return (Text(host.title if host else host_id, ref=f"host:{host_id}"),)


def type_link(type_name: str | None) -> Inlines:
    """Link to a conceptual type; "not known yet" for None."""
    return (share_text(type_name, f"type:{type_name}"),) if type_name else UNKNOWN_INLINES


def topic_link(topic_name: str) -> Text:
    """Link to a topic, service or action."""
    return share_text(topic_name, f"topic:{topic_name}", code=True)


def name_carrier(carrier: Topic | Endpoint) -> Inlines:
    """Return the name of a topic, service or action as a link; of what is no ROS with its medium."""
    if carrier.medium == ROS:
        return (topic_link(name_on_medium(carrier)),)
    link = share_text(name_on_medium(carrier), f"channel:{key_of_channel(carrier)}", code=True)
    return (link, Text(f" ({name_medium(carrier.medium)})"))


def requirement_link(architecture: Architecture, requirement_id: str) -> Inlines:
    """Link to a requirement by its id, followed by its title."""
    declared_requirement = architecture.requirements.get(requirement_id)
    if declared_requirement is None:
        return (Text(requirement_id), Text(" (not declared)", muted=True))
    # Callers take `[:1]` for the link without the title, so the link must stay the first run.
    return (Text(requirement_id, ref=f"requirement:{requirement_id}"), Text(f" {declared_requirement.title}"))


def partner_link(architecture: Architecture, partner_id: str | None) -> Inlines:
    """Link to a partner, by its title."""
    if partner_id is None:
        return UNKNOWN_INLINES
    declared_partner = architecture.partners.get(partner_id)
    return (share_text(declared_partner.title if declared_partner else partner_id, f"partner:{partner_id}"),)


def owner_links(architecture: Architecture, owners: Iterable[str]) -> Inlines:
    """Link to the owners of an element; "not known yet" where it has none."""
    return join_inlines(partner_link(architecture, owner) for owner in owners) or UNKNOWN_INLINES


def port_link(architecture: Architecture, port: Input | Output) -> Inlines:
    """Link to a port's component, followed by the port's own name: ports have no page of their own."""
    component = find_component(architecture, port.component)
    return (component_link(component), share_text(" · "), share_text(port.name, code=True))


def port_id_link(architecture: Architecture, port_id: str) -> Inlines:
    """Link to the component of the port of an id, followed by the port's own name."""
    return port_link(architecture, architecture.outputs.get(port_id) or architecture.inputs[port_id])


def frame_link(name: str) -> Inlines:
    """Link to a coordinate frame."""
    return (Text(name, ref=f"frame:{name}", code=True),)


def describe_source(architecture: Architecture, connection: Connection) -> Inlines:
    """Describe what a connection reads: one output, all outputs of a component, or all of a group."""
    made_words = (Text(" (autoconnect)", muted=True),) if connection.is_made else ()
    if connection.kind == "output":
        source = port_link(architecture, architecture.outputs[connection.target])
        return (*source, *_describe_way(architecture, connection), *made_words)
    if connection.kind == "component":
        return (component_link(find_component(architecture, connection.target)), Text(" · all outputs"), *made_words)
    return (group_link(architecture, connection.target), Text(" · all of the group"))


def _describe_way(architecture: Architecture, connection: Connection) -> Inlines:
    """Return the port of a composed component that a connection is written at; nothing for any other."""
    if connection.shell_port is None:
        return ()
    is_component = connection.shell_port in architecture.shells
    shell_id, _, name = (connection.shell_port, "", "") if is_component else connection.shell_port.rpartition(".")
    port_name = (Text(" · "), Text(name, code=True)) if name else ()
    return (Text(" through ", muted=True), component_link(find_component(architecture, shell_id)), *port_name)


def link_urls(named_urls: Iterable[tuple[str, str]], repository: SourceRepository | None = None) -> Inlines:
    """Write (name, address) pairs as links; files of the project lead into its repository, if that is known."""
    return join_inlines((_link_address(name, address, repository),) for name, address in named_urls)


def _link_address(name: str, address: str, repository: SourceRepository | None) -> Text:
    if address.startswith(("https://", "http://")):
        return Text(name, url=address)
    # Any other scheme (`javascript:`, `file:`) stays text that nobody can click.
    is_file = ":" not in address and not address.startswith("/")
    file_address = repository.file_address(address) if repository and is_file else None
    return Text(name, url=file_address) if file_address else Text(f"{name}: {address}")


def format_qos(qos: Qos) -> str:
    """Describe a quality of service: the profile's name, then its settings."""
    return f"{qos.profile.replace('_', ' ')}: {', '.join(list_qos_settings(qos))}"


def list_qos_settings(qos: Qos) -> list[str]:
    """Return the settings of a quality of service in words, those that are as always left out."""
    parts = [qos.reliability.replace("_", " ")]
    if qos.durability == "transient_local":
        parts.append("transient local (latched)")
    parts.append("keep all" if qos.history == "keep_all" else f"depth {qos.depth}" if qos.depth is not None else "")
    parts += [f"deadline {qos.deadline}" if qos.deadline else "", f"lifespan {qos.lifespan}" if qos.lifespan else ""]
    if qos.liveliness != "automatic":
        parts.append("manual liveliness")
    parts.append(f"lease {qos.lease_duration}" if qos.lease_duration else "")
    return [part for part in parts if part]


def format_qos_cell(endpoint: Endpoint) -> Inlines:
    """Describe the quality of service of a topic's end for a table cell; a default that nobody wrote is muted."""
    has_qos = endpoint.flow == "topic" and endpoint.medium == ROS
    return (Text(format_qos(endpoint.qos), muted=not endpoint.qos.written),) if has_qos else ()


def join_runs(runs: Inlines) -> str:
    """Return the text of runs on one line, with a semicolon where another line begins."""
    return "".join(f"; {run.text}" if run.line_break else run.text for run in runs)


def cut_text(text: str, characters: int) -> str:
    """Return a text of at most so many characters; one that is cut ends in an ellipsis."""
    return text if len(text) <= characters else f"{text[: max(1, characters - 1)].rstrip()}…"


def count_noun(count: int, noun: str) -> str:
    """Count a noun with a regular plural: `1 node`, `2 nodes`, `3 activities`."""
    if count == 1:
        return f"1 {noun}"
    return f"{count} {noun[:-1]}ies" if noun.endswith("y") and noun[-2] not in "aeiou" else f"{count} {noun}s"


# Marks stand around words, never inside of one: `2*3*4` and `*` alone are no emphasis.
_MARK = re.compile(r"(?<![\w*`])(?:\*\*(?=\S)([^*`]+?)(?<=\S)\*\*|\*(?=\S)([^*`]+?)(?<=\S)\*|`([^`]+)`)(?![\w*`])")


def render_marks(inlines: Inlines) -> Inlines:
    """Return runs of text with marked words set in bold, in italics or as code."""
    return tuple(run for part in inlines for run in _split_marks(part))


def read_marks(markdown: str) -> Inlines:
    """Return a line of Markdown as runs of text."""
    return render_marks(to_inlines(markdown))


def strip_marks(markdown: str) -> str:
    """Return a line of Markdown as text alone, for where nothing can be set in italics."""
    return "".join([run.text for run in read_marks(markdown)])


def _split_marks(part: Text) -> list[Text]:
    if part.code or not ("*" in part.text or "`" in part.text):
        return [part]
    runs, end = [], 0
    for found in _MARK.finditer(part.text):
        strong, emphasis, code = found.groups()
        runs.append(replace(part, text=part.text[end : found.start()]))
        runs.append(
            replace(
                part,
                text=strong or emphasis or code,
                strong=part.strong or strong is not None,
                emphasis=part.emphasis or emphasis is not None,
                code=code is not None,
                line_break=False,
            )
        )
        end = found.end()
    runs.append(replace(part, text=part.text[end:], line_break=part.line_break and not runs))
    return [run for run in runs if run.text or run.line_break]
