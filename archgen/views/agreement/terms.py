"""The terms of an interface: for readers, and as plain text that two revisions are compared by.

No term names a line of a file: text that moves changes nothing between the partners.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from archgen.diagnostic import Diagnostic
from archgen.model.component import Component
from archgen.model.distro import is_ros_1
from archgen.model.node import Endpoint
from archgen.timing import activities
from archgen.timing.analysis import ChainResult
from archgen.views import figures, words
from archgen.views.agreement import messages, timing
from archgen.views.agreement.interfaces import Interface, components, guests
from archgen.views.index import Index
from archgen.views.shapes import Inlines, Text

_FLOWS = {"topic": "Topic", "service": "Service", "action": "Action", "physical": ""}
_OPEN = ("Type", "Message", "Rate", "Size", "Answers within", "QoS offered")
"""Facts without which an interface is not settled, by the beginning of their name."""


@dataclass(frozen=True, slots=True)
class End:
    """One row of who gives and who takes: partners, component with port, and node with its QoS."""

    role: str
    owners: tuple[str, ...]
    component: Component | None
    port: str
    node: str | None
    qos: str
    taker: bool


@dataclass(frozen=True, slots=True)
class Terms:
    """An interface with all that is said of it. `field_rows` is None if the message has no definition."""

    interface: Interface
    title: str
    facts: tuple[timing.Fact, ...]
    ends: tuple[End, ...]
    rows: tuple[messages.Row, ...] | None
    chains: tuple[ChainResult, ...]
    requirements: tuple[Inlines, ...]
    points: tuple[Diagnostic, ...]
    shared: tuple[str, ...]
    """Sentences on what both partners, or a partner and a third one, are responsible for together."""

    @property
    def missing(self) -> tuple[str, ...]:
        """Return the names of the facts that are still to be settled."""
        unheld = ["definition of the message"] if self.interface.message and self.rows is None else []
        unknown = (name for name, value in self.facts if name.startswith(_OPEN) and _unknown(value))
        return (*(name if name.startswith("QoS") else name.lower() for name in unknown), *unheld)


def terms(view: Index, named: activities.Names, interface: Interface) -> Terms:
    """Gather all terms of an interface."""
    return Terms(
        interface,
        title(view, interface),
        tuple(_facts(view, named, interface)),
        tuple(_ends(view, interface)),
        messages.rows(view.architecture.interfaces, interface.message) if interface.message else None,
        tuple(timing.chains(view, named, interface)),
        tuple(_requirements(view, interface)),
        tuple(_points(view, named, interface)),
        tuple(_shared(view, interface)),
    )


def title(view: Index, interface: Interface) -> str:
    """Return the name of an interface for people: component and port, or its topic."""
    if interface.output is None:
        return interface.key
    return f"{view.architecture.components[interface.output.component].title} · {interface.output.name}"


def _facts(view: Index, named: activities.Names, interface: Interface) -> Iterator[timing.Fact]:
    kind = _FLOWS[interface.flow]
    if interface.flow == "physical":
        yield "Kind", words.text("physical: neither message nor topic")
    else:
        yield kind, words.joined((Text(name, code=True),) for name in interface.names) or words.UNKNOWN
    yield "Type", words.maybe(interface.type)
    if interface.output and interface.output.description:
        yield "Meaning", words.text(interface.output.description)
    if interface.flow != "physical":
        yield "Message", _message(view, interface)
    yield from timing.facts(view, named, interface)
    if interface.flow == "topic" and not is_ros_1(view.architecture.distro):
        yield "QoS offered", _qos(interface.givers)
    others = dict.fromkeys(port.component for port in interface.others)
    if others:
        yield "Also read by", words.lines(_other(view, component) for component in others)


def _message(view: Index, interface: Interface) -> Inlines:
    if interface.message is None:
        return words.UNKNOWN
    mapped = view.architecture.types.get(interface.type or "")
    planned = [" (planned)"] if mapped and mapped.status == "planned" else []
    return words.text(Text(interface.message, code=True), *planned)


def _qos(ends: Iterable[Endpoint]) -> Inlines:
    said = dict.fromkeys(quality(end) for end in ends)
    if not any(end.qos.written for end in ends):
        return (Text("not written: ROS's default counts", muted=True),)
    return words.lines(words.text(one) for one in said)


def quality(end: Endpoint) -> str:
    """Return a QoS in words; one that nobody wrote is the default."""
    return words.qos_words(end.qos) if end.qos.written else "default (not written)"


def _other(view: Index, component: str) -> Inlines:
    found = view.architecture.components[component]
    owners = partners(view, found.owners)
    return words.text(found.title, Text(f" ({owners})" if owners else ""))


def partners(view: Index, owners: Iterable[str]) -> str:
    """Return partners' titles, comma separated."""
    known = view.architecture.partners
    return ", ".join(known[owner].title if owner in known else owner for owner in owners)


def _ends(view: Index, interface: Interface) -> Iterator[End]:
    giving, taking = components(view, interface)
    verbs = ("serves", "calls") if interface.flow in {"service", "action"} else ("publishes", "reads")
    if interface.flow == "physical":
        verbs = ("gives", "takes")
    for component in giving or (None,):
        mine = [end for end in interface.givers if component is None or end.component == component.id]
        port = interface.output.name if interface.output else ""
        yield from _side(view, verbs[0], component, port, mine, taker=False)
    if not interface.inputs:
        for component in taking or (None,):
            mine = [end for end in interface.takers if component is None or end.component == component.id]
            yield from _side(view, verbs[1], component, "", mine, taker=True)
    for entry in interface.inputs:
        mine = [end for end in interface.takers if end.port == entry.id]
        role = f"{verbs[1]} (optional)" if entry.optional else verbs[1]
        yield from _side(view, role, view.architecture.components[entry.component], entry.name, mine, taker=True)


def _side(  # noqa: PLR0913 - the columns of a row
    view: Index, role: str, component: Component | None, port: str, ends: list[Endpoint], *, taker: bool
) -> Iterator[End]:
    found = view.architecture
    own = component.owners if component else ()
    with_qos = not is_ros_1(found.distro)
    rows: dict[tuple[str, str], None] = {}
    for end in (end for end in ends if found.nodes[end.node].written):
        # A dict as an ordered set: several endpoints of a node with one QoS are one row.
        rows[end.node, quality(end) if end.flow == "topic" and with_qos else ""] = None
    for node, qos in rows:
        owners = dict.fromkeys((*own, *guests(found, found.nodes[node]))) or found.nodes[node].owners
        yield End(role, tuple(owners), component, port, node, qos, taker)
    if not rows:
        yield End(role, own, component, port, None, "", taker)


def _both(view: Index, interface: Interface) -> Iterable[Component]:
    """Return the components at both ends, each once."""
    return {each.id: each for side in components(view, interface) for each in side}.values()


def _requirements(view: Index, interface: Interface) -> Iterator[Inlines]:
    """Yield the requirements that the components at the ends serve, each once, with the components."""
    found: dict[str, dict[str, None]] = {}
    for component in _both(view, interface):
        for use in component.requirements:
            found.setdefault(use.text, {})[component.title] = None
    for text, titles in found.items():
        declared = view.architecture.requirements.get(text)
        said = [Text(text, strong=True), Text(f" {declared.title}")] if declared else [Text(text)]
        yield (*said, Text(f" ({', '.join(titles)})", muted=True))


def _points(view: Index, named: activities.Names, interface: Interface) -> Iterator[Diagnostic]:
    """Yield the findings about the interface itself: its ports, topics, type and chains, or that name them."""
    ports = {interface.key, *(port.id for port in interface.inputs)}
    exact = {*ports, *interface.names, *([interface.type] if interface.type else [])}
    exact |= {result.id for result in timing.chains(view, named, interface)}
    near = {each.id for each in _both(view, interface)}
    near |= {end.node for end in (*interface.givers, *interface.takers)}
    own = {port.rpartition(".")[2] for port in ports}
    quoted = [f"`{name}`" for name in sorted(exact | own)]
    for finding in view.findings:
        if finding.element in exact or (finding.element in near and any(word in finding.message for word in quoted)):
            yield finding


def _shared(view: Index, interface: Interface) -> Iterator[str]:
    found = view.architecture
    for component in _both(view, interface):
        if len(component.owners) > 1:
            yield f"{component.title} belongs to {partners(view, component.owners)} together: each answers for this interface."
    for node in dict.fromkeys(end.node for end in (*interface.givers, *interface.takers)):
        implements = [found.components[name].title for name in found.nodes[node].implements]
        if (owners := guests(found, found.nodes[node])) and implements:
            yield f"{partners(view, owners)} implements {', '.join(implements)} with the node {node}, and answers for this interface too."


def plain(view: Index, of: Terms) -> Mapping[str, tuple[str, str]]:
    """Return the terms as plain text by a key that survives new titles: (name, text) each."""
    found = {"": ("Title", of.title)} | {name: (name, text(value)) for name, value in of.facts}
    for end in of.ends:
        name = f"{end.component.title} · {end.port}" if end.component else ""
        # The key holds ids: a renamed component or node is one end removed and one added, see
        # `term_changes.compare_revisions`.
        key = f"end {end.component.id if end.component else ''} {end.port} {end.taker} {end.node}"
        # What is offered is a term of its own ("QoS offered").
        qos = end.qos if end.taker else ""  # what is offered is a term of its own
        said = "; ".join(part for part in (end.role, partners(view, end.owners), qos) if part)
        found[key] = (f"{name} (node {end.node})" if name and end.node else name or f"Node {end.node}", said)
    found |= {f"field {row.path}": (f"Field {row.path}", row.type) for row in of.rows or ()}
    titles = view.architecture.chains
    found |= {f"chain {chain.id}": (f"Chain {titles[chain.id].title}", figure(chain)) for chain in of.chains}
    found |= {
        f"requirement {item[0].text}": (f"Requirement {item[0].text}", text(item[1:]).strip())
        for item in of.requirements
    }
    return found


def figure(chain: ChainResult) -> str:
    """Return a chain's bound, deadline and verdict in one line."""
    deadline = f"; deadline {figures.duration(chain.deadline)}" if chain.deadline else ""
    return f"{figures.duration(chain.bound)}{deadline}; {chain.verdict}"


def text(value: Inlines) -> str:
    """Return the text of runs, lines separated by semicolons."""
    return "".join(f"; {run.text}" if run.line_break else run.text for run in value)


def _unknown(value: Inlines) -> bool:
    return all(run.muted for run in value)
