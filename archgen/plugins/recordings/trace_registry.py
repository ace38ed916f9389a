"""What a trace says about who is who: nodes, publishers, and what runs each callback.

Things are known by their addresses, which mean something inside one process only and may be used again after their thing is
gone: a later event overrides an earlier one.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from archgen.plugins.recordings.trace_events import TraceEvent

Process = tuple[str, str]
"""A host and a process."""
Address = tuple[Process, str]
CallbackKind = Literal["subscription", "service", "timer"]
MAX_ADDRESSES = 500_000
"""A trace of more things than this is not that of a robot; it bounds memory."""
_INITIALISATIONS = {
    "rcl_node_init": ("node", "node_handle", ("namespace", "node_name")),
    "rcl_publisher_init": ("publisher", "publisher_handle", ("node_handle", "topic_name")),
    "rcl_subscription_init": ("subscription", "subscription_handle", ("node_handle", "topic_name")),
    "rclcpp_subscription_init": ("subscription object", "subscription", ("subscription_handle",)),
    "rclcpp_subscription_callback_added": ("subscription callback", "callback", ("subscription",)),
    "rcl_service_init": ("service", "service_handle", ("node_handle", "service_name")),
    "rclcpp_service_callback_added": ("service callback", "callback", ("service_handle",)),
    "rcl_timer_init": ("timer", "timer_handle", ("period",)),
    "rclcpp_timer_link_node": ("timer node", "timer_handle", ("node_handle",)),
    "rclcpp_timer_callback_added": ("timer callback", "callback", ("timer_handle",)),
}
"""By event: the table that it fills, the field with the address that is the key, and the fields to keep."""
_CALLBACK_TABLES = tuple(table for table, _, _ in _INITIALISATIONS.values() if table.endswith("callback"))


class CallbackOwner(NamedTuple):
    """What runs a callback: a subscription (`name` is its topic), a service, or a timer (`name` is its period in ns)."""

    kind: CallbackKind
    node: str
    name: str


class TraceRegistry:
    """The things that the events of initialisation tell of."""

    def __init__(self) -> None:
        """Start without any."""
        self._rows: dict[tuple[str, Process, str], tuple[str, ...]] = {}
        self._names_by_process: dict[Process, set[str]] = {}
        self.node_lines: dict[str, dict[tuple[str, ...], int]] = {}
        """The processes in which each node runs, by its full name, and the lines that say so."""

    def read_event(self, event: TraceEvent) -> bool:
        """Whether an event tells of a thing; it is kept then."""
        entry = _INITIALISATIONS.get(event.name)
        if entry is None:
            return False
        table, key, value_keys = entry
        address = event.fields.get(key, "")
        self._rows[table, event.process, address] = tuple(event.fields.get(value_key, "") for value_key in value_keys)
        if table == "node":
            name = self._name_node(event.process, address)
            # Without a process in the trace, two nodes of one name are told apart by their addresses.
            process = event.process if event.process[1] else (*event.process, address)
            self.node_lines.setdefault(name, {}).setdefault(process, event.line)
            self._names_by_process.setdefault(event.process, set()).add(name)
        elif table.endswith("callback"):
            self._forget_callback(table, event.process, address)
        return True

    def is_too_large(self) -> bool:
        """Whether there are more things than any robot has."""
        return len(self._rows) + len(self.node_lines) > MAX_ADDRESSES

    def find_topic(self, process: Process, publisher: str) -> str | None:
        """Return a publisher's topic."""
        row = self._rows.get(("publisher", process, publisher))
        return row[1] if row else None

    def find_owner(self, process: Process, callback: str) -> CallbackOwner | None:
        """Return what runs a callback, None where the trace does not say."""
        if row := self._rows.get(("subscription callback", process, callback)):
            handle = self._rows.get(("subscription object", process, row[0]))
            named = self._find_named("subscription", process, handle[0]) if handle else None
            return CallbackOwner("subscription", *named) if named else None
        if row := self._rows.get(("service callback", process, callback)):
            named = self._find_named("service", process, row[0])
            return CallbackOwner("service", *named) if named else None
        row = self._rows.get(("timer callback", process, callback))
        return self._find_timer(process, row[0]) if row else None

    def _find_timer(self, process: Process, handle: str) -> CallbackOwner | None:
        period = self._rows.get(("timer", process, handle))
        node = self._rows.get(("timer node", process, handle))
        # Before ROS 2 Humble no event said whose a timer is.
        name = self._name_node(process, node[0]) if node else self._find_only_node(process)
        return CallbackOwner("timer", name, period[0]) if name and period and period[0].isdecimal() else None

    def _find_only_node(self, process: Process) -> str:
        names = self._names_by_process.get(process, set()) if process[1] else set()
        return min(names) if len(names) == 1 else ""

    def _find_named(self, table: str, process: Process, handle: str) -> tuple[str, str] | None:
        """Return the full name of the node that something belongs to, and its own name."""
        row = self._rows.get((table, process, handle))
        node = self._name_node(process, row[0]) if row else ""
        return (node, row[1]) if row and node else None

    def _name_node(self, process: Process, handle: str) -> str:
        row = self._rows.get(("node", process, handle))
        return f"{row[0].rstrip('/')}/{row[1]}" if row else ""

    def _forget_callback(self, table: str, process: Process, callback: str) -> None:
        """Forget what had a callback's address before."""
        for other_table in _CALLBACK_TABLES:
            if other_table != table:
                self._rows.pop((other_table, process, callback), None)
