"""Activities: what each node does for each of its components, with the behaviour inferred where it is not written."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node
from archgen.model.timing import Behaviour, Timing
from archgen.source import Span
from archgen.timing.system import Activity
from archgen.timing.ticks import Ticks, period

Names = Mapping[tuple[str, str | None], str]
"""The activity's id, by node id and component id."""
_NOTHING = Timing()
_WRITES = frozenset({"publishes", "serves"})


def names(architecture: Architecture) -> Names:
    """Return the id of each activity: that of its node, or `node.component` where the node implements several.

    The last part of the component's id is used, or the complete id where two components of the node share that part.
    """
    found: dict[tuple[str, str | None], str] = {}
    for node in architecture.nodes.values():
        components = node.implements
        own = Counter(component.rpartition(".")[2] for component in components)
        for component in components or (None,):
            if component is None or len(components) == 1:
                found[node.id, component] = node.id
            else:
                name = component.rpartition(".")[2]
                found[node.id, component] = f"{node.id}.{name if own[name] == 1 else component}"
    return found


def key(endpoint: Endpoint) -> str:
    """Return the key under which an activity knows an endpoint: its port, or the name of an internal topic."""
    return endpoint.port or endpoint.name


def by_activity(architecture: Architecture, named: Names) -> dict[str, list[Endpoint]]:
    """Return the endpoints of each activity; those that belong to no component are the first component's."""
    found: dict[str, list[Endpoint]] = {name: [] for name in named.values()}
    for endpoint in architecture.endpoints:
        found[owner(architecture, named, endpoint)].append(endpoint)
    return found


def owner(architecture: Architecture, named: Names, endpoint: Endpoint) -> str:
    """Return the id of the activity that uses an endpoint."""
    name = named.get((endpoint.node, endpoint.component))
    if name is not None:
        return name
    components = architecture.nodes[endpoint.node].implements
    return named[endpoint.node, components[0] if components else None]


def activities(architecture: Architecture, named: Names, unit: Ticks) -> dict[str, Activity]:
    """Return all activities by id, in the order of the nodes."""
    endpoints = by_activity(architecture, named)
    outside = _outside(architecture)
    made: dict[str, Activity] = {}
    for (node_id, component), name in named.items():
        node = architecture.nodes[node_id]
        part = _Part(architecture, node, component, name, tuple(endpoints[name]), outside[component or ""])
        made[name] = _activity(part, unit)
    return made


def _outside(architecture: Architecture) -> Mapping[str, list[str]]:
    """Return the physical and external inputs of each component: nothing arrives there by ROS, but they may trigger."""
    found: dict[str, list[str]] = defaultdict(list)
    for port in architecture.inputs.values():
        if port.physical or port.external:
            found[port.component].append(port.id)
    return found


@dataclass(frozen=True, slots=True)
class _Part:
    """A node in its role for one component."""

    architecture: Architecture
    node: Node
    component: str | None
    name: str
    endpoints: Sequence[Endpoint]
    outside: Sequence[str]

    @property
    def timing(self) -> Timing:
        """Return what is written of this component's timing at the node."""
        return self.node.timing.get(self.component or "", _NOTHING)


def _activity(part: _Part, unit: Ticks) -> Activity:
    timing, node = part.timing, part.node
    behaviour = timing.behaviour or _inferred(part)
    written = period(timing)
    container = node.container
    return Activity(
        id=part.name,
        node=node.id,
        component=part.component,
        behaviour=behaviour,
        behaviour_inferred=timing.behaviour is None,
        period=None if written is None else unit.count(written),
        jitter=unit.of(timing.jitter) or 0,
        wcet=unit.of(timing.wcet),
        bcet=unit.of(timing.bcet),
        response=unit.of(timing.response),
        mode=_mode(timing),
        triggers=tuple(_triggers(part)) if behaviour == "event" else (),
        every=max(timing.every or 1, 1),
        throttle=unit.of(timing.throttle) or 0,
        conditional=frozenset(port for port, output in timing.outputs.items() if output.conditional),
        max_gaps={port: unit.count(o.max_gap.value) for port, o in timing.outputs.items() if o.max_gap},
        calls=dict(timing.calls),
        priority=timing.priority,
        host=node.host,
        container=container,
        core=timing.core,
        inputs=tuple(dict.fromkeys([*_keys(part, writes=False), *part.outside])),
        outputs=tuple(dict.fromkeys(_keys(part, writes=True))),
        at=_place(part),
        places=timing.places,
    )


def _mode(timing: Timing) -> Literal["any", "all"]:
    return timing.trigger.mode if timing.trigger else "any"


def _place(part: _Part) -> Span:
    """Return where the activity is written: its timing, else its node, else (for a planned node) its component."""
    if part.timing is not _NOTHING:
        return part.timing.at
    component = part.architecture.components.get(part.component or "")
    return part.node.at if part.node.written or component is None else component.at


def _keys(part: _Part, *, writes: bool) -> Iterator[str]:
    return (key(endpoint) for endpoint in part.endpoints if (endpoint.use in _WRITES) is writes)


def _inferred(part: _Part) -> Behaviour | None:
    """Infer the behaviour from what is written; the first rule that fits counts."""
    # The order matters. A written period beats subscriptions, since a periodic reader samples its inputs. A server that
    # also publishes is not on demand: calls alone would not say how often it publishes.
    if period(part.timing) is not None:
        return "periodic"
    uses = {endpoint.use for endpoint in part.endpoints}
    if "serves" in uses and "publishes" not in uses:
        return "on_demand"
    return "event" if "subscribes" in uses else None


def _triggers(part: _Part) -> Iterator[str]:
    """Yield the inputs that fire: those written, or all subscriptions except topics that all nodes share."""
    trigger = part.timing.trigger
    if trigger and trigger.inputs is not None:
        yield from trigger.inputs
        return
    # Shared topics such as /tf would otherwise fire every node that listens to them.
    found = dict.fromkeys(key(e) for e in part.endpoints if e.use == "subscribes" and not _common(part, e))
    yield from found


def _common(part: _Part, endpoint: Endpoint) -> bool:
    """Whether an endpoint reads a shared topic without naming a source."""
    topic = part.architecture.topics.get(endpoint.name)
    return bool(topic and topic.shared and not endpoint.sources)
