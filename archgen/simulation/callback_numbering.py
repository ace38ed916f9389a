"""Number the callbacks that executors run: one for each clock, subscription, service and client of an activity."""

from __future__ import annotations

from archgen.simulation.simulation_plan import CLIENT, REENTRANT, SERVICE, SUBSCRIPTION, PlannedCallback
from archgen.simulation.thread_placement import ThreadPlacement
from archgen.timing.system.timing_system import Activity, Arc, StoringCallback, TimingSystem, name_queue


class CallbackNumbering:
    """Callbacks, numbered as they are asked for. `scale` is the number of units in a tick."""

    def __init__(
        self, system: TimingSystem, activity_numbers: dict[str, int], placement: ThreadPlacement, scale: int
    ) -> None:
        self.system = system
        self.activity_numbers = activity_numbers
        self.placement = placement
        self.scale = scale
        self.planned: list[PlannedCallback] = []
        self.numbers: dict[tuple[str, str], int] = {}
        self.group_numbers: dict[str, int] = {}

    def callback_of_arc(self, reader: Activity, arc: Arc, *, is_sampled: bool) -> int:
        """Return the number of the callback that a message on an arc starts; -1 where it is stored at once."""
        if not is_sampled:
            kind = SERVICE if arc.role == "request" else SUBSCRIPTION
            return self.number_callback(reader, f"{arc.role} {arc.input} {name_queue(reader, arc)}", kind)
        # A request to a periodic server waits for its next job.
        if arc.role == "request" or self.system.activities[arc.source].behaviour == "once":
            return -1
        storing = reader.storing.get(arc.input)
        if arc.role == "answer" and reader.executor in self.system.executors:
            # rclcpp hands out an answer in a callback of the client, which takes its turn like any other.
            return self.number_callback(reader, f"answer {arc.topic}", CLIENT, storing or StoringCallback())
        if storing is None:
            return -1
        return self.number_callback(
            reader, f"{arc.input} {name_queue(reader, arc)}", SUBSCRIPTION, storing, arc.depth or 0
        )

    def number_callback(
        self, activity: Activity, entity: str, kind: int, storing: StoringCallback | None = None, depth: int = 0
    ) -> int:
        """Return the number of the callback of an activity's clock, subscription, service or client."""
        key = (activity.id, entity)
        if key not in self.numbers:
            self.numbers[key] = len(self.planned)
            best, worst = (storing.bcet, storing.wcet) if storing else (activity.bcet or 0, activity.wcet or 0)
            self.planned.append(
                PlannedCallback(
                    self.activity_numbers[activity.id],
                    kind,
                    self.placement.executor_of(activity),
                    self._group_of(activity),
                    storing is not None,
                    min(best, worst) * self.scale,
                    worst * self.scale,
                    depth,
                )
            )
        return self.numbers[key]

    def _group_of(self, activity: Activity) -> int:
        """Return the number of an activity's group: where no executor is known, it excludes only itself."""
        if activity.executor not in self.system.executors:
            key = f"activity {activity.id}"
        elif activity.callback_group is None:
            return REENTRANT
        else:
            key = f"group {activity.callback_group}"
        return self.group_numbers.setdefault(key, len(self.group_numbers))
