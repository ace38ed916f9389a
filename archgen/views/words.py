"""Runs of inline text for documents: links to elements, and values written out in words."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from itertools import chain

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Connection, Input, Output
from archgen.model.node import Node, Qos
from archgen.model.timing import Timing
from archgen.views.shapes import Inlines, Text

BEHAVIOURS = {"periodic": "periodic", "event": "event-driven", "on_demand": "on demand", "once": "once, at the start"}
KINDS = {
    "node": "node",
    "lifecycle": "lifecycle node",
    "composable": "composable node",
    "driver": "driver",
    "nodelet": "nodelet",
}
USES = {"publishes": "publishes", "subscribes": "subscribes to", "serves": "serves", "calls": "calls"}
UNKNOWN: Inlines = (Text("not known yet", muted=True),)


def text(*parts: str | Text) -> Inlines:
    """Turn strings and ready `Text` runs into one sequence of inlines."""
    return tuple(Text(part) if isinstance(part, str) else part for part in parts)


def spoken(message: str, *, muted: bool = False) -> Inlines:
    """Turn a finding's message into inlines; what it quotes in backticks becomes code."""
    parts = _NAMED.split(message)
    # `split` with one capturing group alternates: even positions are plain text, odd ones the quoted names.
    return tuple(Text(part, code=place % 2 == 1, muted=muted) for place, part in enumerate(parts) if part)


_NAMED = re.compile(r"`([^`]+)`")


def maybe(value: str | None) -> Inlines:
    """Return the value as inlines, or "not known yet"."""
    return (Text(value),) if value else UNKNOWN


def joined(items: Iterable[Inlines], separator: str = ", ") -> Inlines:
    """Join inlines with a separator, as `str.join` does."""
    runs = list(items)
    return tuple(chain.from_iterable((Text(separator), *run) if place else run for place, run in enumerate(runs)))


def lines(items: Iterable[Inlines]) -> Inlines:
    """Put each run of inlines on a line of its own."""
    result: list[Text] = []
    for place, run in enumerate(items):
        # A break belongs to the run that follows it, so each item needs at least one run of text.
        first, *rest = run
        result += [_broken(first) if place else first, *rest]
    return tuple(result)


def _broken(part: Text) -> Text:
    """Return the run with a line break before it."""
    return replace(part, line_break=True)


def group_link(architecture: Architecture, group: str) -> Text:
    """Link to a group, by its title."""
    return Text(architecture.groups[group].title, ref=f"group:{group}")


def component_link(component: Component) -> Text:
    """Link to a component, by its title."""
    return Text(component.title, ref=f"component:{component.id}")


def node_link(node: Node) -> Text:
    """Link to a node, by its id."""
    return Text(node.id, ref=f"node:{node.id}", code=True)


def type_link(name: str | None) -> Inlines:
    """Link to a conceptual type; "not known yet" for None."""
    return (Text(name, ref=f"type:{name}"),) if name else UNKNOWN


def topic_link(name: str) -> Text:
    """Link to a topic, service or action."""
    return Text(name, ref=f"topic:{name}", code=True)


def requirement_link(architecture: Architecture, requirement: str) -> Inlines:
    """Link to a requirement by its id, followed by its title."""
    found = architecture.requirements.get(requirement)
    if found is None:
        return (Text(requirement), Text(" (not declared)", muted=True))
    # Callers take `[:1]` for the link without the title, so the link must stay the first run.
    return (Text(requirement, ref=f"requirement:{requirement}"), Text(f" {found.title}"))


def partner_link(architecture: Architecture, partner: str | None) -> Inlines:
    """Link to a partner, by its title."""
    if partner is None:
        return UNKNOWN
    found = architecture.partners.get(partner)
    return (Text(found.title if found else partner, ref=f"partner:{partner}"),)


def owner_links(architecture: Architecture, owners: Iterable[str]) -> Inlines:
    """Link to the owners of an element; "not known yet" where it has none."""
    return joined(partner_link(architecture, owner) for owner in owners) or UNKNOWN


def port_link(architecture: Architecture, port: Input | Output) -> Inlines:
    """Link to a port's component, followed by the port's own name: ports have no page of their own."""
    component = architecture.components[port.component]
    return (component_link(component), Text(" · "), Text(port.name, code=True))


def source_words(architecture: Architecture, connection: Connection) -> Inlines:
    """Describe what a connection reads: one output, all outputs of a component, or all of a group."""
    if connection.kind == "output":
        return port_link(architecture, architecture.outputs[connection.target])
    if connection.kind == "component":
        return (component_link(architecture.components[connection.target]), Text(" · all outputs"))
    return (group_link(architecture, connection.target), Text(" · all of the group"))


def urls(items: Iterable[tuple[str, str]]) -> Inlines:
    """Write (name, address) pairs as links."""
    return joined(
        # Any other scheme (`javascript:`, `file:`) stays text that nobody can click.
        (Text(name, url=address) if address.startswith(("https://", "http://")) else Text(f"{name}: {address}"),)
        for name, address in items
    )


def qos_words(qos: Qos) -> str:
    """Describe a quality of service: the profile's name, then its settings."""
    parts = [qos.reliability.replace("_", " ")]
    if qos.durability == "transient_local":
        parts.append("transient local (latched)")
    parts.append("keep all" if qos.history == "keep_all" else f"depth {qos.depth}" if qos.depth is not None else "")
    parts += [f"deadline {qos.deadline}" if qos.deadline else "", f"lifespan {qos.lifespan}" if qos.lifespan else ""]
    if qos.liveliness != "automatic":
        parts.append("manual liveliness")
    parts.append(f"lease {qos.lease_duration}" if qos.lease_duration else "")
    words = ", ".join(part for part in parts if part)
    return f"{qos.profile.replace('_', ' ')}: {words}"


def qos_cell(qos: Qos) -> Inlines:
    """Describe a quality of service for a table cell; a default that nobody wrote is muted."""
    return (Text(qos_words(qos)),) if qos.written else (Text("default", muted=True),)


def timing_sentence(timing: Timing | None) -> str:
    """Write everything a `timing` section says on one line; empty for None."""
    if timing is None:
        return ""
    span = f"{timing.bcet} to {timing.wcet}" if timing.bcet and timing.wcet else ""
    parts = (
        BEHAVIOURS[timing.behaviour] if timing.behaviour else "",
        f"period {timing.period}" if timing.period else "",
        f"{timing.rate}" if timing.rate else "",
        f"jitter {timing.jitter}" if timing.jitter else "",
        f"triggered by {_trigger(timing)}" if timing.trigger else "",
        f"fires at each {timing.every}th" if timing.every else "",
        f"at least {timing.throttle} apart" if timing.throttle else "",
        f"execution {span}" if span else "",
        f"execution up to {timing.wcet}" if timing.wcet and not span else "",
        f"execution at least {timing.bcet}" if timing.bcet and not span else "",
        f"declared response {timing.response}" if timing.response else "",
        f"publishes only at times: {', '.join(_outputs(timing))}" if timing.outputs else "",
        f"calls for each activation: {', '.join(_calls(timing))}" if timing.calls else "",
        f"priority {timing.priority}" if timing.priority is not None else "",
        f"core {timing.core}" if timing.core is not None else "",
    )
    return "; ".join(part for part in parts if part)


def _calls(timing: Timing) -> list[str]:
    """Format `calls` as "port count"; ports by the last part of their id."""
    return [f"{name.rsplit('.', 1)[-1]} {count}" for name, count in timing.calls.items()]


def _trigger(timing: Timing) -> str:
    """Describe which inputs trigger an activation."""
    if timing.trigger is None:
        return ""
    if timing.trigger.inputs is None:
        return f"{timing.trigger.mode} of the inputs"
    names = ", ".join(name.rsplit(".", 1)[-1] for name in timing.trigger.inputs)
    return f"{timing.trigger.mode} of {names}"


def _outputs(timing: Timing) -> list[str]:
    """Format the outputs that are not published at every activation."""
    return [
        f"{name.rsplit('.', 1)[-1]}" + (f" (at least each {output.max_gap})" if output.max_gap else "")
        for name, output in timing.outputs.items()
    ]


def short_timing(timing: Timing | None) -> str:
    """Write rate or period and worst-case execution time for a table cell: `10 Hz, up to 80 ms`."""
    if timing is None:
        return ""
    rate = timing.rate or timing.period
    words = [str(rate) if rate else BEHAVIOURS.get(timing.behaviour, "") if timing.behaviour else ""]
    words.append(f"up to {timing.wcet}" if timing.wcet else "")
    return ", ".join(word for word in words if word)


def plural(count: int, noun: str) -> str:
    """Count a noun with a regular plural: `1 node`, `2 nodes`, `3 activities`."""
    if count == 1:
        return f"1 {noun}"
    return f"{count} {noun[:-1]}ies" if noun.endswith("y") and noun[-2] not in "aeiou" else f"{count} {noun}s"
