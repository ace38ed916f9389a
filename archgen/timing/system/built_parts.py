"""What building a system remembers of one version of a project for the next: the activities of the same nodes."""

from __future__ import annotations

import operator
from collections.abc import Sequence

from archgen.frozen import NamedTuple
from archgen.model.component import Component
from archgen.model.known_parts import KnownParts
from archgen.model.node import Endpoint, Node
from archgen.timing.figures.tick_unit import TickUnit
from archgen.timing.system.timing_system import Activity


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
