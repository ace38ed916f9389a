"""What interfaces promise, their versions, and that they are going away, as documents, cards and lists say it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.model.architecture import Architecture
from archgen.model.component import ComponentType, Connection, Output
from archgen.model.component_nesting import find_relied_output
from archgen.model.deprecation_lookup import find_replacement
from archgen.model.message_types import ConceptualType
from archgen.model.node import Topic
from archgen.model.promise import Promise, describe_deprecation, format_range
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text
from archgen.views.type_names import type_page_link

_BADGE: Inlines = (Text(" "), Text("deprecated", status="warning"))


def describe_promise(promise: Promise | None) -> str:
    """Return what is promised on one line: `10 Hz, gaps up to 150 ms, 0 to 30 m`; empty for nothing."""
    if promise is None:
        return ""
    values = (
        str(promise.rate) if promise.rate else "",
        f"gaps up to {promise.max_gap}" if promise.max_gap else "",
        f"no older than {promise.max_age}" if promise.max_age else "",
        format_range(promise.range, promise.unit) if promise.range else f"in {promise.unit}" if promise.unit else "",
        f"in the frame {promise.frame}" if promise.frame else "",
    )
    return ", ".join(filter(None, values))


def list_card_facts(holder: Output | ConceptualType | ComponentType) -> Iterator[tuple[str, str]]:
    """Yield the facts of a card: promise, version, deprecation; what is not said is empty."""
    if isinstance(holder, Output):
        yield "promise", describe_promise(holder.promise)
    yield "version", holder.version or ""
    yield "deprecated", describe_deprecation(holder.deprecated) if holder.deprecated else ""


def list_text_remarks(holder: Output | ConceptualType | ComponentType) -> Iterator[str]:
    """Yield version and deprecation as plain text, for lists and search."""
    if holder.version:
        yield f"version {holder.version}"
    if holder.deprecated:
        yield f"deprecated ({describe_deprecation(holder.deprecated)})"


def write_badges(holder: Output | ConceptualType | ComponentType) -> Inlines:
    """Return what stands behind a name: its version, and a badge where it is going away."""
    version = (Text(f" version {holder.version}", muted=True),) if holder.version else ()
    return (*version, *write_badge(holder))


def write_badge(holder: Output | ConceptualType | ComponentType) -> Inlines:
    """Return a badge where something is going away."""
    return _BADGE if holder.deprecated else ()


def write_remarks(architecture: Architecture, port: Output) -> Iterator[Inlines]:
    """Yield what is said of an output in the column of remarks."""
    if port.promise:
        yield inline_text.to_inlines(f"promised: {describe_promise(port.promise)}")
    if port.deprecated:
        yield write_deprecation(architecture, "output", port)


def write_deprecation(
    architecture: Architecture, kind: str, holder: Output | ConceptualType | ComponentType
) -> Inlines:
    """Return until when something may be used, and a link to what replaces it in the end."""
    deprecated = holder.deprecated
    if deprecated is None:
        return ()
    until = f"until {deprecated.until}" if deprecated.until else ""
    replacement = find_replacement(architecture, kind, deprecated)
    if replacement is None:
        return inline_text.to_inlines(f"deprecated {until}".rstrip())
    link: Inlines = (Text(replacement, code=True),)
    if kind == "type":
        link = inline_text.type_link(replacement)
    elif kind == "component_type":
        component_type = architecture.component_types.get(replacement)
        link = (type_page_link(component_type),) if component_type else link
    else:
        component = architecture.find_component(replacement.rpartition(".")[0])
        output = component.outputs.get(replacement.rpartition(".")[2]) if component else None
        if output is not None and isinstance(holder, Output):
            is_near = output.component == holder.component
            link = (Text(output.name, code=True),) if is_near else inline_text.port_link(architecture, output)
    return inline_text.to_inlines(f"deprecated {until}: use ".replace(" :", ":"), *link)


def list_topic_facts(architecture: Architecture, topic: Topic) -> Iterator[tuple[str, Inlines]]:
    """Yield what the outputs on a topic promise, their versions, and until when they may be used; nothing for none."""
    outputs = [
        output
        for name in dict.fromkeys(endpoint.port for endpoint in topic.writers if endpoint.port)
        if (output := architecture.outputs.get(name)) is not None
    ]
    described: tuple[tuple[str, Callable[[Output], Inlines]], ...] = (
        ("Promised", lambda each: inline_text.to_inlines(describe_promise(each.promise)) if each.promise else ()),
        ("Version", lambda each: inline_text.to_inlines(each.version)),
        ("Deprecated", lambda each: write_deprecation(architecture, "output", each)),
    )
    for name, describe in described:
        lines = [line for output in outputs if (line := describe(output))]
        yield name, inline_text.join_lines(dict.fromkeys(lines))


def mark_source(lookup: Lookup, connection: Connection) -> Inlines:
    """Return a badge where what a connection names is going away."""
    architecture = lookup.architecture
    for output_id in connection.outputs:
        leaf = architecture.outputs.get(output_id)
        port = find_relied_output(architecture, connection, leaf) if leaf else None
        if port is not None and port.deprecated is not None:
            return _BADGE
    return ()
