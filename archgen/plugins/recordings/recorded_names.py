"""Which activity of the design a recorded callback belongs to: by the node's full name and what fires the callback."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.plugin import dataclass
from archgen.plugin.model import Architecture, UseKind
from archgen.plugin.timing import (
    Activity,
    ChainResult,
    TimingSystem,
    activity_of_endpoint,
    endpoint_key,
    name_activities,
)

_PERIOD_TOLERANCE = Fraction(1, 100)
"""A timer is that of an activity if their periods differ by no more: 33 ms are 30 Hz."""


class UnmappedError(ValueError):
    """A recorded name is nothing in the design, or may be several things; the text says which."""


@dataclass(frozen=True, slots=True)
class CallbackPlace:
    """What a callback is in the design: it fires an activity, or stores one of its inputs.

    `is_partial`: some of its calls return before the activity's work is done, as they wait for another input or drop the
    message.
    """

    activity: str
    stored_input: str | None = None
    is_partial: bool = False


class RecordedNames:
    """Finds what recorded names mean in a design."""

    def __init__(
        self, architecture: Architecture, system: TimingSystem, chain_results: Mapping[str, ChainResult]
    ) -> None:
        """Index nodes, endpoints and chains."""
        self._architecture = architecture
        self._system = system
        self.chain_results = chain_results
        self._node_ids: dict[str, list[str]] = defaultdict(list)
        for node in architecture.nodes.values():
            self._node_ids[node.full_name].append(node.id)
        self._activities: dict[str, list[Activity]] = defaultdict(list)
        for activity in system.activities.values():
            self._activities[activity.node].append(activity)
        activity_names = name_activities(architecture)
        self._endpoints: dict[tuple[str, UseKind, str], dict[tuple[str, str], None]] = defaultdict(dict)
        for endpoint in architecture.endpoints:
            place = (activity_of_endpoint(activity_names, endpoint), endpoint_key(endpoint))
            if endpoint.name is not None:
                self._endpoints[endpoint.node, endpoint.use, endpoint.name][place] = None

    def find_node(self, full_name: str) -> str:
        """Return the id of the node with a full name. Raise UnmappedError."""
        node_ids = self._node_ids.get(full_name, ())
        if len(node_ids) != 1:
            msg = "several nodes of the design have this name" if node_ids else "no node of the design has this name"
            raise UnmappedError(msg)
        return node_ids[0]

    def name_node(self, activity: str) -> str:
        """Return the full name of an activity's node."""
        return self._architecture.nodes[self._system.activities[activity].node].full_name

    def has_topic(self, name: str) -> bool:
        """Whether the design has a topic of this name."""
        return name in self._architecture.topics

    def find_subscription(self, node_name: str, topic: str) -> CallbackPlace:
        """Return what a node's subscription is. Raise UnmappedError."""
        activity_id, key = self._find_endpoint(node_name, "subscribes", topic)
        activity = self._system.activities[activity_id]
        if key not in activity.triggers:
            return CallbackPlace(activity_id, key)
        waits_for_others = activity.mode != "any" and len(activity.triggers) > 1
        return CallbackPlace(activity_id, is_partial=waits_for_others or activity.every > 1 or activity.throttle > 0)

    def find_service(self, node_name: str, service: str) -> CallbackPlace:
        """Return what the callback of a node's service is. Raise UnmappedError."""
        return CallbackPlace(self._find_endpoint(node_name, "serves", service)[0])

    def _find_endpoint(self, node_name: str, use: UseKind, name: str) -> tuple[str, str]:
        places = list(self._endpoints.get((self.find_node(node_name), use, name), ()))
        if len(places) == 1:
            return places[0]
        if places:
            msg = f"several activities of this node use it: {', '.join(activity for activity, _ in places)}"
        else:
            msg = f"this node of the design {'does not read' if use == 'subscribes' else 'does not serve'} it"
        raise UnmappedError(msg)

    def match_timers(self, node_name: str, periods: Sequence[int]) -> list[str | None]:
        """Return the activity of each of a node's timers (periods in ns): by its period, or since there is one of each."""
        activities = [a for a in self._activities.get(self.find_node(node_name), ()) if a.behaviour == "periodic"]
        fitting_activities = [[a for a in activities if self._has_period(a, period)] for period in periods]
        fit_counts = defaultdict[str, int](int)
        for fitting in fitting_activities:
            for activity in fitting:
                fit_counts[activity.id] += 1
        if len(periods) == len(activities) == 1:
            return [activities[0].id]
        return [
            fitting[0].id if len(fitting) == 1 and fit_counts[fitting[0].id] == 1 else None
            for fitting in fitting_activities
        ]

    def _has_period(self, activity: Activity, period_ns: int) -> bool:
        if activity.period is None:
            return False
        written_ns = activity.period * self._system.tick
        return abs(period_ns - written_ns) <= _PERIOD_TOLERANCE * written_ns

    def split_callback_name(self, name: str) -> tuple[str, str]:
        """Split CARET's name of a callback, `/name/space/node/callback_0`, into node and callback. Raise UnmappedError."""
        node_name, _, callback = name.rpartition("/")
        self.find_node(node_name)
        return node_name, callback

    def find_only_work(self, node_name: str, callback: str) -> CallbackPlace:
        """Return what a callback is that has a number for a name: only where it cannot be anything else.

        Raise UnmappedError.
        """
        activities = self._activities.get(self.find_node(node_name), [])
        if len(activities) != 1:
            raise UnmappedError("this node has several activities, and the name does not say which of them")
        activity = activities[0]
        read_inputs = [
            key
            for (node, use, _), places in self._endpoints.items()
            if (node, use) == (activity.node, "subscribes")
            for _, key in places
        ]
        stored_inputs = [key for key in read_inputs if key not in activity.triggers]
        if callback.startswith("timer_callback") and activity.behaviour == "periodic":
            return CallbackPlace(activity.id)
        if callback.startswith("subscription_callback") and len(read_inputs) == len(stored_inputs) == 1:
            return CallbackPlace(activity.id, stored_inputs[0])
        if stored_inputs:
            msg = "this node has callbacks that only store an input, and the name does not say which one it is"
            raise UnmappedError(msg)
        return CallbackPlace(activity.id, is_partial=len(read_inputs) > 1 and activity.mode != "any")

    def name_step(self, recorded_step: str) -> str:
        """Return the topic or the node's full name that a step of a path means: a topic, a node or one of its callbacks."""
        if self.has_topic(recorded_step) or recorded_step in self._node_ids:
            return recorded_step
        return recorded_step.rpartition("/")[0]

    def find_chain(self, recorded_steps: Sequence[str]) -> str:
        """Return the chain that leads through exactly these nodes (full names) and topics. Raise UnmappedError."""
        node_ids = self._trace_nodes(recorded_steps)
        matches = [
            chain_id
            for chain_id, result in self.chain_results.items()
            if node_ids in (self._list_nodes(result.through), self._list_nodes([t.activity for t in result.terms]))
        ]
        if len(matches) != 1:
            way = " - ".join(node_ids)
            raise UnmappedError(f"{'several chains lead' if matches else 'no chain of the design leads'} through {way}")
        return matches[0]

    def _trace_nodes(self, recorded_steps: Sequence[str]) -> list[str]:
        """Return the nodes of a path without repetition: those of its callbacks, and the only writer of each topic."""
        node_ids: list[str] = []
        for step in recorded_steps:
            topic = self._architecture.topics.get(step)
            # A name may be a node's and a topic's: a step that is no topic must be a node.
            writers = {writer.node for writer in topic.writers} if topic else {self.find_node(step)}
            if len(writers) == 1 and not (node_ids and node_ids[-1] in writers):
                node_ids += writers
        return node_ids

    def _list_nodes(self, activity_ids: Sequence[str]) -> list[str]:
        activities = self._system.activities
        nodes = [activities[name].node if name in activities else name for name in activity_ids]
        return [node for at, node in enumerate(nodes) if not at or nodes[at - 1] != node]
