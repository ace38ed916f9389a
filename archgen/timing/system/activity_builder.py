"""Activities: what each node does for each of its components, with the behaviour inferred where it is not written.

What building a system remembers of one version of a project for the next: the activities of the same nodes.
"""

from __future__ import annotations

import operator
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.diagnostics.source_span import Span
from archgen.frozen import NamedTuple, dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.declared_timing import ActivityBehaviour, InputTiming, MeasuredTimes, Timing
from archgen.model.known_parts import KnownParts
from archgen.model.node import Endpoint, Node
from archgen.model.port_media import is_physical
from archgen.model.runtime_facts import is_isolated, keeps_each_source
from archgen.timing.figures.tick_unit import TickUnit, written_period
from archgen.timing.system.timing_system import Activity, ResourceUse, StoringCallback


class ActivitySource(NamedTuple):
    """All that an activity is built from."""

    node: Node
    component: Component | None
    endpoints: Sequence[Endpoint]
    shared_flags: tuple[bool, ...]
    """For each endpoint, whether its topic is shared by all nodes; then whether the node has one thread in any case."""


class BuiltParts:
    """Activities of the versions of one project that were built so far, by id. Linking takes over what they share."""

    def __init__(self) -> None:
        """Start empty."""
        self._by_unit: dict[TickUnit, KnownParts[tuple[ActivitySource, Activity]]] = {}
        self._activities: KnownParts[tuple[ActivitySource, Activity]] = KnownParts()

    def start_version(self, tick_unit: TickUnit) -> None:
        """Take up what is known of the versions in which durations are counted in the same unit."""
        self._activities = self._by_unit.setdefault(tick_unit, KnownParts())

    def find_activity(self, name: str, source: ActivitySource) -> Activity | None:
        """Return an activity that was built from the same."""
        for known, activity in self._activities.list_known(name):
            if (
                known.node is source.node
                and known.component is source.component
                and known.shared_flags == source.shared_flags
                and all(map(operator.is_, known.endpoints, source.endpoints))
            ):
                return activity
        return None

    def keep_activity(self, name: str, source: ActivitySource, activity: Activity) -> None:
        """Remember an activity."""
        self._activities.keep_part(name, (source, activity))


ActivityNames = Mapping[tuple[str, str | None], str]
"""The activity's id, by node id and component id."""
_NO_TIMING = Timing()
_NO_INPUT_TIMING = InputTiming()
_NO_PORTS: frozenset[str] = frozenset()
_WRITING_USES = frozenset({"publishes", "serves"})


def name_activities(architecture: Architecture) -> ActivityNames:
    """Return the id of each activity: that of its node, or `node.component` where the node implements several.

    The last part of the component's id is used, or the complete id where two components of the node share that part.
    """
    activity_names: dict[tuple[str, str | None], str] = {}
    for node in architecture.nodes.values():
        components = node.implements
        name_counts = Counter(component.rpartition(".")[2] for component in components)
        for component in components or (None,):
            if component is None or len(components) == 1:
                activity_names[node.id, component] = node.id
            else:
                own_name = component.rpartition(".")[2]
                activity_names[node.id, component] = (
                    f"{node.id}.{own_name if name_counts[own_name] == 1 else component}"
                )
    return activity_names


def endpoint_key(endpoint: Endpoint) -> str:
    """Return the key under which an activity knows an endpoint: its port, or the name of an internal topic."""
    return endpoint.port or endpoint.label


def endpoints_by_activity(architecture: Architecture, activity_names: ActivityNames) -> dict[str, list[Endpoint]]:
    """Return the endpoints of each activity; those that belong to no port are the first component's."""
    grouped_endpoints: dict[str, list[Endpoint]] = {name: [] for name in activity_names.values()}
    for endpoint in architecture.list_endpoints():
        grouped_endpoints[activity_of_endpoint(activity_names, endpoint)].append(endpoint)
    return grouped_endpoints


def activity_of_endpoint(activity_names: ActivityNames, endpoint: Endpoint) -> str:
    """Return the id of the activity that uses an endpoint."""
    return activity_names[endpoint.node, endpoint.component]


def build_activities(
    architecture: Architecture,
    activity_names: ActivityNames,
    tick_unit: TickUnit,
    memory: BuiltParts | None = None,
) -> dict[str, Activity]:
    """Return all activities by id, in the order of the nodes; those that `memory` knows are not built anew."""
    endpoints = endpoints_by_activity(architecture, activity_names)
    outside_inputs = _outside_inputs(architecture)
    activities_by_id: dict[str, Activity] = {}
    if memory is not None:
        memory.start_version(tick_unit)
    for (node_id, component), name in activity_names.items():
        node = architecture.nodes[node_id]
        if memory is None:
            activity = None
        else:
            source = _list_sources(architecture, node, component, endpoints[name])
            activity = memory.find_activity(name, source)
        if activity is None:
            outside = outside_inputs[component or ""]
            part = _NodePart(architecture, node, component, name, tuple(endpoints[name]), outside)
            activity = _build_activity(part, tick_unit)
            if memory is not None:
                memory.keep_activity(name, source, activity)
        activities_by_id[name] = activity
    return activities_by_id


def _list_sources(
    architecture: Architecture, node: Node, component_id: str | None, endpoints: Sequence[Endpoint]
) -> ActivitySource:
    topics = architecture.topics
    flags = [topic.shared if (topic := topics.get(each.label)) else False for each in endpoints]
    component = architecture.components.get(component_id or "")
    return ActivitySource(node, component, endpoints, (*flags, is_isolated(architecture, node)))


def _outside_inputs(architecture: Architecture) -> Mapping[str, list[str]]:
    """Return the physical and external inputs of each component: nothing arrives there by ROS, but they may trigger."""
    inputs_by_component: dict[str, list[str]] = defaultdict(list)
    for port in architecture.inputs.values():
        if is_physical(port) or port.external:
            inputs_by_component[port.component].append(port.id)
    return inputs_by_component


@dataclass(frozen=True, slots=True)
class _NodePart:
    """A node in its role for one component."""

    architecture: Architecture
    node: Node
    component: str | None
    name: str
    endpoints: Sequence[Endpoint]
    outside_inputs: Sequence[str]

    @property
    def timing(self) -> Timing:
        """Return what is written of this component's timing at the node."""
        return self.node.timing.get(self.component or "", _NO_TIMING)


def _build_activity(part: _NodePart, tick_unit: TickUnit) -> Activity:
    timing, node = part.timing, part.node
    behaviour = timing.behaviour or _infer_behaviour(part)
    period_ns = written_period(timing)
    input_keys = tuple(dict.fromkeys([*_endpoint_keys(part, writes=False), *part.outside_inputs]))
    triggers = tuple(_trigger_inputs(part)) if behaviour == "event" else ()
    measured_times = timing.measured_times or MeasuredTimes()
    return Activity(
        id=part.name,
        node=node.id,
        component=part.component,
        behaviour=behaviour,
        behaviour_inferred=timing.behaviour is None,
        period=None if period_ns is None else tick_unit.ns_to_ticks(period_ns),
        jitter=tick_unit.quantity_to_ticks(timing.jitter) or 0,
        wcet=tick_unit.quantity_to_ticks(timing.wcet),
        bcet=tick_unit.quantity_to_ticks(timing.bcet),
        response=tick_unit.quantity_to_ticks(timing.response),
        mode=timing.trigger.mode if timing.trigger else "any",
        triggers=triggers,
        within=tick_unit.quantity_to_ticks(timing.trigger.within) if timing.trigger else None,
        every=max(timing.every or 1, 1),
        throttle=tick_unit.quantity_to_ticks(timing.throttle) or 0,
        keeps_dropped=timing.dropped != "forgotten",
        conditional=frozenset(port for port, output in timing.outputs.items() if output.conditional) or _NO_PORTS,
        max_gaps={port: tick_unit.ns_to_ticks(o.max_gap.value) for port, o in timing.outputs.items() if o.max_gap},
        calls=dict(timing.calls),
        priority=timing.priority,
        deadline=tick_unit.quantity_to_ticks(timing.deadline),
        host=node.host,
        container=node.container,
        cores=(timing.cores or ()) if timing.core is None else (timing.core,),
        executor=executor_key(node),
        callback_group=_find_callback_group(part),
        storing=dict(_storing_callbacks(part, triggers, tick_unit)),
        separate_memories=frozenset(
            key
            for each in part.endpoints
            if each.use == "subscribes"
            and keeps_each_source(each, timing.inputs.get(key := endpoint_key(each), _NO_INPUT_TIMING))
        )
        or _NO_PORTS,
        uses={
            resource: ResourceUse(tick_unit.ns_to_ticks(use.max.value), tick_unit.quantity_to_ticks(use.min) or 0)
            for resource, use in timing.uses.items()
        },
        freshness=dict(_demanded_freshness(part.architecture, input_keys, tick_unit)),
        percentiles={name: tick_unit.ns_to_ticks(time.value) for name, time in measured_times.percentiles.items()},
        wcet_measured=measured_times.is_measured,
        inputs=input_keys,
        outputs=tuple(dict.fromkeys(_endpoint_keys(part, writes=True))),
        at=_span_of_part(part),
        places=timing.places,
    )


def executor_key(node: Node) -> str:
    """Return the key of the process that runs a node: its container, or itself."""
    return f"container {node.container}" if node.container else f"node {node.id}"


def _find_callback_group(part: _NodePart) -> str | None:
    """Return the mutually exclusive group of an activity, None where its callbacks run at once."""
    if is_isolated(part.architecture, part.node):
        return part.node.id
    if part.node.reentrant:
        return None
    groups = part.node.callback_groups
    own_group = next((name for name, members in groups.items() if part.component in members), None)
    return f"{part.node.id}.{own_group}" if own_group else part.node.id


def _storing_callbacks(
    part: _NodePart, triggers: Collection[str], tick_unit: TickUnit
) -> Iterator[tuple[str, StoringCallback]]:
    """Yield the inputs that fire nobody, each with the callback that stores its messages, if one does, or takes its answers."""
    for endpoint in part.endpoints:
        key = endpoint_key(endpoint)
        times = part.timing.inputs.get(key, _NO_INPUT_TIMING)
        is_stored = endpoint.use == "subscribes" and key not in triggers and not times.stored_at_once
        if is_stored or (endpoint.use == "calls" and times.wcet is not None):
            wcet, bcet = map(tick_unit.quantity_to_ticks, (times.wcet, times.bcet))
            yield key, StoringCallback(wcet or 0, bcet or 0)


def _demanded_freshness(
    architecture: Architecture, input_keys: Iterable[str], tick_unit: TickUnit
) -> Iterator[tuple[str, int]]:
    """Yield the inputs at which the reader limits the age of what it reads."""
    for key in input_keys:
        port = architecture.inputs.get(key)
        if port is not None and port.freshness is not None:
            yield key, tick_unit.ns_to_ticks(port.freshness.value)


def _span_of_part(part: _NodePart) -> Span:
    """Return where the activity is written: its timing, else its node, else (for a planned node) its component."""
    if part.timing is not _NO_TIMING:
        return part.timing.at
    component = part.architecture.components.get(part.component or "")
    return part.node.at if part.node.written or component is None else component.at


def _endpoint_keys(part: _NodePart, *, writes: bool) -> Iterator[str]:
    return (endpoint_key(endpoint) for endpoint in part.endpoints if (endpoint.use in _WRITING_USES) is writes)


def _infer_behaviour(part: _NodePart) -> ActivityBehaviour | None:
    """Infer the behaviour from what is written; the first rule that fits counts."""
    # The order matters. A written period beats subscriptions, since a periodic reader samples its inputs. A server that
    # also publishes is not on demand: calls alone would not say how often it publishes.
    if written_period(part.timing) is not None:
        return "periodic"
    # What follows from frames (internal, and not written) says nothing of when a server works.
    uses = {endpoint.use for endpoint in part.endpoints if endpoint.written or not endpoint.internal}
    if "serves" in uses and "publishes" not in uses:
        return "on_demand"
    return "event" if "subscribes" in uses else None


def _trigger_inputs(part: _NodePart) -> Iterator[str]:
    """Yield the inputs that fire: those written, or all subscriptions except topics that all nodes share."""
    trigger = part.timing.trigger
    if trigger and trigger.inputs is not None:
        yield from trigger.inputs
        return
    # Shared topics such as /tf would otherwise fire every node that listens to them.
    input_keys = dict.fromkeys(
        endpoint_key(e) for e in part.endpoints if e.use == "subscribes" and not _is_shared_by_all(part, e)
    )
    yield from input_keys


def _is_shared_by_all(part: _NodePart, endpoint: Endpoint) -> bool:
    """Whether an endpoint reads a shared topic without naming a source."""
    topic = part.architecture.topics.get(endpoint.label)
    return bool(topic and topic.shared and not endpoint.sources)
