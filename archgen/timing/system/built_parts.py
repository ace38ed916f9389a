"""What building a system remembers of one version of a project for the next: the activities of the same nodes."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import NamedTuple

from archgen.model.component import Component
from archgen.model.node import Endpoint, Node
from archgen.timing.figures.tick_unit import TickUnit
from archgen.timing.system.timing_system import Activity


class ActivitySource(NamedTuple):
    """All that an activity is built from."""

    node: Node
    component: Component | None
    endpoints: Sequence[Endpoint]
    shared_flags: tuple[bool, ...]
    """For each endpoint, whether its topic is shared by all nodes."""


class BuiltParts:
    """Activities of the versions of one project that were built so far, by id. Linking takes over what they share."""

    def __init__(self) -> None:
        """Start empty."""
        self._tick_unit: TickUnit | None = None
        self._activities: dict[str, tuple[ActivitySource, Activity]] = {}

    def start_version(self, tick_unit: TickUnit) -> None:
        """Forget everything where durations are counted in another unit."""
        if self._tick_unit != tick_unit:
            self._tick_unit, self._activities = tick_unit, {}

    def find_activity(self, name: str, source: ActivitySource) -> Activity | None:
        """Return an activity that was built from the same."""
        known_source, activity = self._activities.get(name, (None, None))
        is_same = (
            known_source is not None
            and known_source.node is source.node
            and known_source.component is source.component
            and known_source.shared_flags == source.shared_flags
            and all(map(operator.is_, known_source.endpoints, source.endpoints))
        )
        return activity if is_same else None

    def keep_activity(self, name: str, source: ActivitySource, activity: Activity) -> None:
        """Remember an activity."""
        self._activities[name] = (source, activity)
