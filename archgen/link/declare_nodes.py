"""Declare ROS nodes: what was written about them, with the components and ports that they name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from archgen.diagnostic import Diagnostic, Label
from archgen.frozen import dataclass
from archgen.link import reading
from archgen.link.activities import Activities
from archgen.link.declare_timing import declare_timing
from archgen.link.outline import Outline
from archgen.link.references import Ports, References
from archgen.model.component import Component
from archgen.model.deployment import Container
from archgen.model.node import Node, NodeStatus, PortUse, Qos, Use
from archgen.model.qos import profile
from archgen.syntax.tree import Entry, Table, plain

USES: tuple[Use, ...] = ("publishes", "subscribes", "serves", "calls")
# What a node publishes or serves is an output of its component, what it subscribes to or calls is an input.
_SIDES: Mapping[Use, str] = {"publishes": "output", "serves": "output", "subscribes": "input", "calls": "input"}
_KINDS = frozenset({"node", "lifecycle", "composable", "driver", "nodelet"})
_DURATIONS = ("deadline", "lifespan", "lease_duration")


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What the declaration of a node needs: the elements that it may name, and where findings go."""

    outline: Outline
    references: References
    components: Mapping[str, Component]
    containers: Mapping[str, Container]
    activities: Activities


def implemented(root: Table, references: References) -> dict[str, tuple[str, ...]]:
    """Resolve what each node implements: component ids by node, without those that cannot be resolved."""
    found: dict[str, tuple[str, ...]] = {}
    for name, _, below in reading.elements(root, "nodes"):
        targets = [references.follow(w, ("component",), name) for w in reading.scalars(below, "implements")]
        found[name] = tuple(dict.fromkeys(target.id for target in targets if target))
    return found


def declare_nodes(root: Table, around: Surroundings, implements: Mapping[str, tuple[str, ...]]) -> dict[str, Node]:
    """Declare every node that is written, by id. Nodes that archgen derives are added later, by `transform`."""
    return {name: _node(name, entry, around, implements[name]) for name, entry, _ in reading.elements(root, "nodes")}


def _node(name: str, entry: Entry, around: Surroundings, implements: tuple[str, ...]) -> Node:
    below, references = reading.body(entry), around.references
    kinds = tuple(dict.fromkeys(kind for kind in reading.texts(below, "kind") if kind in _KINDS))
    container = references.plain(reading.scalar(below, "container"), "container", name)
    host = references.plain(reading.scalar(below, "host"), "host", name)
    if host and container and around.containers[container].host not in {None, host}:
        references.found.append(_elsewhere(below, name, around.containers[container]))
    # Several components may have several owners: the node then belongs to all of them, in the order of `implements`.
    inherited = (owner for component in implements for owner in around.components[component].owners)
    owners = references.owners(below, name, inherited)
    ports = _ports(name, below, around, implements)
    return Node(
        id=name,
        title=reading.title(below, name),
        implements=implements,
        description=reading.text(below, "description"),
        owner=next(iter(owners), None),
        co_owners=owners[1:],
        name=reading.text(below, "name") or name,
        namespace=_namespace(reading.text(below, "namespace")),
        kinds=kinds or ("node",),  # type: ignore[arg-type]
        package=reading.text(below, "package"),
        executable=reading.text(below, "executable"),
        plugin=reading.text(below, "plugin"),
        container=container,
        host=host or (around.containers[container].host if container else None),
        status=_status(below),
        uses=tuple(_uses(below, ports)),
        uses_known=tuple(use for use in USES if below.get(use) is not None),
        timing=around.activities.of(name, declare_timing(entry, ports, references.found), implements),
        parameters=_parameters(below),
        parameter_files=reading.texts(below, "parameter_files"),
        tags=reading.texts(below, "tags"),
        urls=reading.words(below, "urls"),
        implements_written=below.get("implements") is not None,
        at=entry.at,
        name_at=reading.place(below, "name"),
    )


def _elsewhere(below: Table, node: str, container: Container) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{node}` runs in the container `{container.id}`, which is on another host: `{container.host}`",
        reading.place(below, "host"),
        labels=(Label(container.at, "the container"),),
        help="leave `host` out: a node in a container runs on the container's host",
        element=node,
    )


def _namespace(written: str | None) -> str:
    """Return a namespace with its leading slash; a node without one is in the root namespace, `/`."""
    return "/" + (written or "").removeprefix("/")


def _status(below: Table) -> NodeStatus | None:
    written = reading.text(below, "status")
    return written if written in {"existing", "adapted", "planned"} else None  # type: ignore[return-value]


def _parameters(below: Table) -> Mapping[str, object]:
    # The only part of the language where values keep the type that YAML gives them.
    found = plain(reading.table(below, "parameters"))
    return found if isinstance(found, dict) else {}


def _ports(name: str, below: Table, around: Surroundings, implements: tuple[str, ...]) -> Ports:
    # Not `not implements`: a node whose `implements` could not be resolved has no ports, one without it has free ones.
    free = below.get("implements") is None
    return Ports(around.references, name, implements, around.outline.ports, free=free)


def _uses(below: Table, ports: Ports) -> Iterator[PortUse]:
    for use in USES:
        for key, entry, parts in reading.elements(below, use):
            port = ports.follow(key, entry.at, _SIDES[use]) if ports.components else None
            yield _use(use, port, entry, parts)
    inside = reading.table(below, "internal")
    for use in USES:
        for _, entry, parts in reading.elements(inside, use):
            yield _use(use, None, entry, parts, internal=True)


def _use(use: Use, port: str | None, entry: Entry, parts: Table, *, internal: bool = False) -> PortUse:
    named = reading.scalars(parts, "topic" if use in {"publishes", "subscribes"} else "name")
    return PortUse(
        use=use,
        key=entry.key,
        port=port,
        topics=tuple(written.text for written in named),
        message=reading.message(parts),
        qos=_qos(use, parts),
        internal=internal,
        at=entry.at,
        message_at=reading.place(parts, "message"),
        topic_places=tuple(written.at for written in named),
    )


def _qos(use: Use, parts: Table) -> Qos | None:
    """Return the values of the profile with the written ones over them; None where no `qos` is written."""
    below = reading.table(parts, "qos")
    if not below.entries:
        return None
    values: dict[str, object] = {
        key: reading.text(below, key)
        for key in ("reliability", "durability", "history", "liveliness")
        if reading.scalar(below, key)
    }
    values |= {key: reading.measure(below, key, "duration") for key in _DURATIONS if reading.scalar(below, key)}
    if reading.scalar(below, "depth"):
        values["depth"] = reading.whole(below, "depth")
    base = profile(reading.text(below, "profile") or "default", use)
    return replace(base, **values, written=True, at=reading.place(parts, "qos"))  # type: ignore[arg-type]
