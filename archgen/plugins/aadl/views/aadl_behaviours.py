"""The thread that does what a component does: the pattern that fits, its ports, and how it is dispatched."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from archgen.plugin.model import Architecture, Component, Timing, uses_ros
from archgen.plugins.aadl.views.aadl_ports import PortPart, list_port_parts
from archgen.plugins.aadl.views.aadl_types import TypeBook
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    can_be_written,
    make_classifier,
    make_duration_property,
    make_item,
    make_property,
    make_text_properties,
    write_aadl_duration,
    write_range,
)

_DISPATCH = {"periodic": "Periodic", "event": "Aperiodic", "on_demand": "Aperiodic", "once": "Background"}
_ROLES = {
    "ros::publisher": "source",
    "ros::callback": "sink",
    "ros::call_pub": "filter",
    "ros::service_provider": "reactive",
}
"""What the patterns say of the role."""
_INHERITED_NAMES = ("ist", "tf", "function", "pc")
"""What a thread has from the library: no port of its own is called so."""
_PROTOTYPES = {"msg": "message", "srv": "service", "msg_in": "message_in", "msg_out": "message_out"}
"""What the types of the ports of the library's threads are called."""


class Behaviour:
    """A component's thread: its classifiers, and how its ports are called there."""

    def __init__(self, architecture: Architecture, types: TypeBook, component: Component, timing: Timing) -> None:
        """Choose the pattern of a component that a node implements."""
        self.component = component
        self.timing = timing
        self.parts = list_port_parts(architecture, types, component, frozenset(self._list_triggers()))
        self.pattern, fixed_names = self._choose_pattern()
        names = NameSpace(_INHERITED_NAMES)
        self.port_names = {part.key: fixed_names.get(part.key) or names.take_name(part.name) for part in self.parts}
        """The names of its ports in the thread."""
        self.is_refined = bool(fixed_names)

    @property
    def further_role(self) -> str | None:
        """The role of the component where the pattern does not say it."""
        return self.component.role if _ROLES.get(self.pattern) != self.component.role else None

    @property
    def uses_tf(self) -> bool:
        """Whether it has access to the transformations, as all patterns of ROS have."""
        return self.pattern.startswith("ros::")

    @property
    def behaviour(self) -> str | None:
        """What activates it, as far as it is written."""
        timing = self.timing
        return timing.behaviour or ("periodic" if timing.period or timing.rate else "event" if timing.trigger else None)

    def _list_triggers(self) -> tuple[str, ...]:
        if self.behaviour == "periodic":
            return ()
        trigger = self.timing.trigger
        known = tuple(port.id for port in self.component.inputs.values())
        return known if trigger is None or trigger.inputs is None else trigger.inputs

    def _choose_pattern(self) -> tuple[str, dict[tuple[bool, str, str], str]]:
        """Return the library's thread, and the names that ports have there."""
        role, is_periodic = self.component.role, self.behaviour == "periodic"
        kinds = [part.kind for part in self.parts]
        keys = [part.key for part in self.parts]
        if all(uses_ros(part.port) for part in self.parts):
            if kinds == ["out data port"] and is_periodic and role in {None, "source"}:
                return "ros::publisher", {keys[0]: "msg"}
            if kinds == ["in event data port"] and role in {None, "sink"}:
                return "ros::callback", {keys[0]: "msg"}
            if kinds == ["provides subprogram access"] and not is_periodic and role in {None, "reactive"}:
                return "ros::service_provider", {keys[0]: "srv"}
            if kinds == ["in event data port", "out data port"] and role in {None, "filter"}:
                return "ros::call_pub", {keys[0]: "msg_in", keys[1]: "msg_out"}
        return ("ros::timer", {}) if is_periodic else ("cnc::component_behaviour", {})

    def make_classifiers(self, name: str) -> list[dict[str, Any]]:
        """Return the thread's type and its implementation, made from the pattern."""
        features = []
        for part in self.parts:
            own_name = self.port_names[part.key]
            text = f"refined to {part.text}" if self.is_refined else part.text
            features.append(make_item(own_name, text))
        bindings = self._list_bindings() if self.is_refined else []
        extends = f"{self.pattern} ({', '.join(bindings)})" if bindings else self.pattern
        return [
            make_classifier("thread", name, extends=extends, features=features),
            make_classifier("thread", f"{name}.impl", extends=f"{self.pattern}.impl"),
        ]

    def _list_bindings(self) -> list[str]:
        """Return what the prototypes of the pattern stand for."""
        return [
            f"{_PROTOTYPES[self.port_names[part.key]]} => "
            f"{'data' if part.flow == 'topic' else 'subprogram'} {part.classifier}"
            for part in self.parts
        ]

    def list_properties(self) -> list[AadlProperty]:
        """Return how the thread is dispatched, and what of its timing AADL has a word for."""
        timing, found = self.timing, list[AadlProperty]()
        if self.behaviour:
            found.append(make_property("Dispatch_Protocol", _DISPATCH[self.behaviour]))
        if timing.period:
            found += make_duration_property("Period", timing.period)
        elif timing.rate and timing.rate.value:
            period = Fraction(10**9) / timing.rate.value
            if can_be_written(period):
                found.append(make_property("Period", write_aadl_duration(period)))
            found += make_text_properties(rate=str(timing.rate))
        found += make_duration_property("Deadline", timing.deadline)
        found += make_duration_property("Dispatch_Jitter", timing.jitter)
        if timing.wcet and can_be_written(timing.wcet.value):
            lowest = timing.bcet.value if timing.bcet else Fraction(0)
            found.append(make_property("Compute_Execution_Time", write_range(lowest, timing.wcet.value)))
        if timing.priority is not None:
            found.append(make_property("Priority", str(timing.priority)))
        return found

    def find_part(self, port_id: str, *, is_output: bool, source_id: str = "") -> PortPart | None:
        """Return the part of a port; of an input that on which an output arrives."""
        return next(
            (
                part
                for part in self.parts
                if part.port.id == port_id and part.is_output is is_output and (is_output or part.reads(source_id))
            ),
            None,
        )
