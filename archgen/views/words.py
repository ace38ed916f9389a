"""The words of documents: links to elements, and how values are written out."""

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
    """Make a run of text of strings and ready parts."""
    return tuple(Text(part) if isinstance(part, str) else part for part in parts)


def spoken(message: str, *, muted: bool = False) -> Inlines:
    """Write what a finding says: what it names in backticks is code."""
    parts = _NAMED.split(message)
    return tuple(Text(part, code=place % 2 == 1, muted=muted) for place, part in enumerate(parts) if part)


_NAMED = re.compile(r"`([^`]+)`")


def maybe(value: str | None) -> Inlines:
    """Write a value, or that it is not known yet."""
    return (Text(value),) if value else UNKNOWN


def joined(items: Iterable[Inlines], separator: str = ", ") -> Inlines:
    """Put a separator between runs of text."""
    runs = list(items)
    return tuple(chain.from_iterable((Text(separator), *run) if place else run for place, run in enumerate(runs)))


def lines(items: Iterable[Inlines]) -> Inlines:
    """Put each run of text on a line of its own."""
    result: list[Text] = []
    for place, run in enumerate(items):
        first, *rest = run
        result += [_broken(first) if place else first, *rest]
    return tuple(result)


def _broken(part: Text) -> Text:
    return replace(part, line_break=True)


def group_link(architecture: Architecture, group: str) -> Text:
    """Name a group by its title, as a link."""
    return Text(architecture.groups[group].title, ref=f"group:{group}")


def component_link(component: Component) -> Text:
    """Name a component by its title, as a link."""
    return Text(component.title, ref=f"component:{component.id}")


def node_link(node: Node) -> Text:
    """Name a node by its id, as a link."""
    return Text(node.id, ref=f"node:{node.id}", code=True)


def type_link(name: str | None) -> Inlines:
    """Name a conceptual type, as a link."""
    return (Text(name, ref=f"type:{name}"),) if name else UNKNOWN


def topic_link(name: str) -> Text:
    """Name a topic, service or action, as a link."""
    return Text(name, ref=f"topic:{name}", code=True)


def requirement_link(architecture: Architecture, requirement: str) -> Inlines:
    """Name a requirement by its id, as a link, with its title."""
    found = architecture.requirements.get(requirement)
    if found is None:
        return (Text(requirement), Text(" (not declared)", muted=True))
    return (Text(requirement, ref=f"requirement:{requirement}"), Text(f" {found.title}"))


def partner_link(architecture: Architecture, partner: str | None) -> Inlines:
    """Name a partner by its title, as a link."""
    if partner is None:
        return UNKNOWN
    found = architecture.partners.get(partner)
    return (Text(found.title if found else partner, ref=f"partner:{partner}"),)


def owner_links(architecture: Architecture, owners: Iterable[str]) -> Inlines:
    """Name who answers for an element, as links; that nobody is known to do is said."""
    return joined(partner_link(architecture, owner) for owner in owners) or UNKNOWN


def port_link(architecture: Architecture, port: Input | Output) -> Inlines:
    """Name a port by its component's title and its own name."""
    component = architecture.components[port.component]
    return (component_link(component), Text(" · "), Text(port.name, code=True))


def source_words(architecture: Architecture, connection: Connection) -> Inlines:
    """Name where a connection comes from: an output, all of a component, or all of a group."""
    if connection.kind == "output":
        return port_link(architecture, architecture.outputs[connection.target])
    if connection.kind == "component":
        return (component_link(architecture.components[connection.target]), Text(" · all outputs"))
    return (group_link(architecture, connection.target), Text(" · all of the group"))


def urls(items: Iterable[tuple[str, str]]) -> Inlines:
    """Write addresses as links under their names; what is no web address stays text."""
    return joined(
        (Text(name, url=address) if address.startswith(("https://", "http://")) else Text(f"{name}: {address}"),)
        for name, address in items
    )


def qos_words(qos: Qos) -> str:
    """Say a quality of service in words: the profile's name, then what was changed, or `default`."""
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
    """Say a quality of service for a table; the default that nobody wrote is muted."""
    return (Text(qos_words(qos)),) if qos.written else (Text("default", muted=True),)


def timing_sentence(timing: Timing | None) -> str:
    """Write out what a timing says in one line; empty where nobody wrote anything."""
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
    return [f"{name.rsplit('.', 1)[-1]} {count}" for name, count in timing.calls.items()]


def _trigger(timing: Timing) -> str:
    if timing.trigger is None:
        return ""
    if timing.trigger.inputs is None:
        return f"{timing.trigger.mode} of the inputs"
    names = ", ".join(name.rsplit(".", 1)[-1] for name in timing.trigger.inputs)
    return f"{timing.trigger.mode} of {names}"


def _outputs(timing: Timing) -> list[str]:
    return [
        f"{name.rsplit('.', 1)[-1]}" + (f" (at least each {output.max_gap})" if output.max_gap else "")
        for name, output in timing.outputs.items()
    ]


def short_timing(timing: Timing | None) -> str:
    """Say a timing in a few words for a table: `10 Hz, 80 ms`."""
    if timing is None:
        return ""
    rate = timing.rate or timing.period
    words = [str(rate) if rate else BEHAVIOURS.get(timing.behaviour, "") if timing.behaviour else ""]
    words.append(f"up to {timing.wcet}" if timing.wcet else "")
    return ", ".join(word for word in words if word)


def plural(count: int, noun: str) -> str:
    """Count something: `1 node`, `2 nodes`."""
    if count == 1:
        return f"1 {noun}"
    return f"{count} {noun[:-1]}ies" if noun.endswith("y") and noun[-2] not in "aeiou" else f"{count} {noun}s"
