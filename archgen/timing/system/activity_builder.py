"""Activities: what each node does for each of its components, with the behaviour inferred where it is not written."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from archgen.diagnostics.source_span import Span
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import ActivityBehaviour, Timing
from archgen.model.node import Endpoint, Node
from archgen.timing.figures.tick_unit import TickUnit, written_period
from archgen.timing.system.timing_system import Activity

ActivityNames = Mapping[tuple[str, str | None], str]
"""The activity's id, by node id and component id."""
_NO_TIMING = Timing()
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
    return endpoint.port or endpoint.name


def endpoints_by_activity(architecture: Architecture, activity_names: ActivityNames) -> dict[str, list[Endpoint]]:
    """Return the endpoints of each activity; those that belong to no port are the first component's."""
    grouped_endpoints: dict[str, list[Endpoint]] = {name: [] for name in activity_names.values()}
    for endpoint in architecture.endpoints:
        grouped_endpoints[activity_of_endpoint(activity_names, endpoint)].append(endpoint)
    return grouped_endpoints


def activity_of_endpoint(activity_names: ActivityNames, endpoint: Endpoint) -> str:
    """Return the id of the activity that uses an endpoint."""
    return activity_names[endpoint.node, endpoint.component]


def build_activities(
    architecture: Architecture, activity_names: ActivityNames, tick_unit: TickUnit
) -> dict[str, Activity]:
    """Return all activities by id, in the order of the nodes."""
    endpoints = endpoints_by_activity(architecture, activity_names)
    outside_inputs = _outside_inputs(architecture)
    activities_by_id: dict[str, Activity] = {}
    for (node_id, component), name in activity_names.items():
        node = architecture.nodes[node_id]
        part = _NodePart(architecture, node, component, name, tuple(endpoints[name]), outside_inputs[component or ""])
        activities_by_id[name] = _build_activity(part, tick_unit)
    return activities_by_id


def _outside_inputs(architecture: Architecture) -> Mapping[str, list[str]]:
    """Return the physical and external inputs of each component: nothing arrives there by ROS, but they may trigger."""
    inputs_by_component: dict[str, list[str]] = defaultdict(list)
    for port in architecture.inputs.values():
        if port.physical or port.external:
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
    container = node.container
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
        mode=_trigger_mode(timing),
        triggers=tuple(_trigger_inputs(part)) if behaviour == "event" else (),
        every=max(timing.every or 1, 1),
        throttle=tick_unit.quantity_to_ticks(timing.throttle) or 0,
        conditional=frozenset(port for port, output in timing.outputs.items() if output.conditional),
        max_gaps={port: tick_unit.ns_to_ticks(o.max_gap.value) for port, o in timing.outputs.items() if o.max_gap},
        calls=dict(timing.calls),
        priority=timing.priority,
        host=node.host,
        container=container,
        cores=() if timing.core is None else (timing.core,),
        inputs=tuple(dict.fromkeys([*_endpoint_keys(part, writes=False), *part.outside_inputs])),
        outputs=tuple(dict.fromkeys(_endpoint_keys(part, writes=True))),
        at=_span_of_part(part),
        places=timing.places,
    )


def _trigger_mode(timing: Timing) -> Literal["any", "all"]:
    return timing.trigger.mode if timing.trigger else "any"


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
    uses = {endpoint.use for endpoint in part.endpoints}
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
    topic = part.architecture.topics.get(endpoint.name)
    return bool(topic and topic.shared and not endpoint.sources)
