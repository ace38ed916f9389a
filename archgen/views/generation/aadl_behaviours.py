"""The thread that does what a component does: the pattern that fits, its ports, and how it is dispatched."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.declared_timing import Timing
from archgen.model.port_media import uses_ros
from archgen.views.generation.aadl_types import TypeBook
from archgen.views.generation.aadl_words import (
    AadlProperty,
    NameSpace,
    can_be_written,
    make_classifier,
    make_duration_property,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    write_range,
)

_DISPATCH = {"periodic": "Periodic", "event": "Aperiodic", "on_demand": "Aperiodic", "once": "Background"}
_INHERITED_NAMES = ("ist", "tf", "function", "pc")
"""What a thread has from the library: no port of its own is called so."""


class Behaviour:
    """A component's thread: its classifiers, and how its ports are called there."""

    def __init__(self, architecture: Architecture, types: TypeBook, component: Component, timing: Timing) -> None:
        """Choose the pattern of a component that a node implements."""
        self._architecture = architecture
        self._types = types
        self.component = component
        self.timing = timing
        self.pattern, fixed_names = self._choose_pattern()
        names = NameSpace((*_INHERITED_NAMES, *fixed_names.values()))
        self.port_names = {
            port.id: fixed_names.get(port.id) or names.take_name(port.name) for port in component.ports
        }
        """The names of its ports, by their complete ids."""
        self.is_refined = bool(fixed_names)

    @property
    def uses_tf(self) -> bool:
        """Whether it has access to the transformations, as all patterns of ROS have."""
        return self.pattern.startswith("ros::")

    def _choose_pattern(self) -> tuple[str, dict[str, str]]:
        """Return the library's thread, and the names that ports have there."""
        component, role = self.component, self.component.role
        inputs, outputs = tuple(component.inputs.values()), tuple(component.outputs.values())
        flows = tuple(self._architecture.flow_of(port) for port in component.outputs.values())
        is_periodic = self.behaviour == "periodic"
        calls = any(self.flow_of_input(port) != "topic" for port in inputs)
        if len(component.ports) == 1 and all(map(uses_ros, component.ports)):
            if flows == ("topic",) and is_periodic and role in {None, "source"}:
                return "ros::publisher", {outputs[0].id: "msg"}
            if inputs and not calls and not is_periodic and role in {None, "sink"}:
                return "ros::callback", {inputs[0].id: "msg"}
            if flows in {("service",), ("action",)} and not is_periodic and role in {None, "reactive"}:
                return "ros::service_provider", {outputs[0].id: "srv"}
        if len(inputs) == 1 and flows == ("topic",) and not calls and not is_periodic and role in {None, "filter"}:
            return "ros::call_pub", {inputs[0].id: "msg_in", outputs[0].id: "msg_out"}
        if is_periodic:
            return "ros::timer", {}
        return "cnc::component_behaviour", {}

    @property
    def behaviour(self) -> str | None:
        """What activates it, as far as it is written."""
        timing = self.timing
        return timing.behaviour or ("periodic" if timing.period or timing.rate else None)

    def flow_of_input(self, port: Input) -> str:
        """Return whether an input reads what is sent, or calls a service or an action."""
        sources = (each for connection in port.connections for each in connection.outputs)
        first = self._architecture.outputs.get(next(sources, ""))
        return self._architecture.flow_of(first if first is not None and port.type is None else port)

    def describe_port(self, port: Input | Output) -> str:
        """Return a port as a feature: its kind, and the classifier of what passes."""
        if isinstance(port, Output):
            flow = self._architecture.flow_of(port)
            classifier = self._types.name_type(port.type, flow)
            own_kind = _find_port_kind(port)
            return (
                f"out {own_kind or 'data'} port {classifier}"
                if flow == "topic"
                else f"provides subprogram access {classifier}"
            )
        flow = self.flow_of_input(port)
        classifier = self._types.name_type(self._find_input_type(port), flow)
        if flow != "topic":
            return f"requires subprogram access {classifier}"
        return f"in {_find_port_kind(port) or ('event data' if self._triggers(port) else 'data')} port {classifier}"

    def _find_input_type(self, port: Input) -> str | None:
        sources = (each for connection in port.connections for each in connection.outputs)
        return port.type or next(
            (self._architecture.outputs[each].type for each in sources if each in self._architecture.outputs), None
        )

    def _triggers(self, port: Input) -> bool:
        if self.behaviour == "periodic":
            return False
        trigger = self.timing.trigger
        return trigger is None or trigger.inputs is None or port.id in trigger.inputs

    def make_classifiers(self, name: str) -> list[dict[str, Any]]:
        """Return the thread's type and its implementation, made from the pattern."""
        refined = "refined to " if self.is_refined else ""
        features = [
            make_item(
                self.port_names[port.id],
                refined + self.describe_port(port),
                make_named_properties(port.name if refined else self.port_names[port.id], port.name),
            )
            for port in self.component.ports
        ]
        bindings = self._list_bindings()
        extends = f"{self.pattern} ({', '.join(bindings)})" if bindings else self.pattern
        return [
            make_classifier("thread", name, extends=extends, features=features),
            make_classifier("thread", f"{name}.impl", extends=f"{self.pattern}.impl"),
        ]

    def _list_bindings(self) -> list[str]:
        """Return what the prototypes of the pattern stand for."""
        words = {"msg": "message", "srv": "service", "msg_in": "message_in", "msg_out": "message_out"}
        bindings = []
        for port in self.component.ports:
            if self.is_refined:
                name = self.port_names[port.id]
                category = "subprogram" if name == "srv" else "data"
                bindings.append(f"{words[name]} => {category} {self.describe_port(port).rpartition(' ')[2]}")
        return bindings

    def list_properties(self) -> list[AadlProperty]:
        """Return how the thread is dispatched, and what of its timing AADL has a word for."""
        timing, found = self.timing, list[AadlProperty]()
        behaviour = self.behaviour
        if behaviour:
            found.append(make_property("Dispatch_Protocol", _DISPATCH[behaviour]))
        if timing.period:
            found += make_duration_property("Period", timing.period)
        elif timing.rate and timing.rate.value:
            period = Fraction(10**9) / timing.rate.value
            if can_be_written(period):
                found.append(make_property("Period", write_range(period, period).partition(" .. ")[0]))
            found += make_text_properties(rate=str(timing.rate))
        found += make_duration_property("Deadline", timing.deadline)
        found += make_duration_property("Dispatch_Jitter", timing.jitter)
        if timing.wcet and can_be_written(timing.wcet.value):
            lowest = timing.bcet.value if timing.bcet else Fraction(0)
            found.append(make_property("Compute_Execution_Time", write_range(lowest, timing.wcet.value)))
        if timing.priority is not None:
            found.append(make_property("Priority", str(timing.priority)))
        return found


def _find_port_kind(port: Input | Output) -> str | None:
    """Return what AADL called the port that this one was read from."""
    hints = port.annotations.hints.get("aadl")
    kind = hints.get("port") if isinstance(hints, dict) else None
    return kind if kind in {"data", "event data"} else None
