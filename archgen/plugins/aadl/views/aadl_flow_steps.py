"""A way through systems that stand in one another as flows: each system has one for the part of the way inside of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from archgen.plugin import dataclass
from archgen.plugins.aadl.views.aadl_system_part import SystemPart
from archgen.plugins.aadl.views.aadl_system_tree import Route
from archgen.plugins.aadl.views.aadl_words import can_be_written, make_item, make_property, write_range

TimeRange = tuple[Fraction, Fraction]
"""At least and at most, in ns."""
NO_TIME: TimeRange = (Fraction(0), Fraction(0))


@dataclass(frozen=True, slots=True)
class FlowStep:
    """A flow or connection by its `text`; or a system that is entered or left, by the feature `text`, empty at both ends."""

    text: str
    latency: TimeRange | None
    enters: SystemPart | None = None
    leaves: bool = False


def list_route_steps(route: Route, latency: TimeRange) -> Iterator[FlowStep]:
    """Yield the connections of a route, and the systems that it leaves and enters."""
    for _, feature, inner in route.outward:
        yield FlowStep(inner, NO_TIME)
        yield FlowStep(feature, NO_TIME, leaves=True)
    yield FlowStep(route.joint, latency)
    for system, feature, inner in route.inward:
        yield FlowStep(feature, NO_TIME, enters=system)
        yield FlowStep(inner, NO_TIME)


def fold_steps(
    steps: Sequence[FlowStep], flow_names: dict[tuple[SystemPart, str, str], str]
) -> tuple[SystemPart, list[str]]:
    """Return the innermost system that holds all of a way, and the way as seen there; flows of inner systems are written.

    `flow_names` has the flows that are written already.
    """
    # Systems that all of it stands in are no step of it.
    while steps[1].enters is not None and _find_exit(steps, 1) == len(steps) - 2:
        steps = steps[1:-1]
    system = steps[0].enters
    if system is None:
        msg = "a way begins where it enters the launch"
        raise ValueError(msg)
    return system, _Folding(steps, flow_names).fold(1)[0]


def _find_exit(steps: Sequence[FlowStep], start: int) -> int:
    """Return where the system is left that is entered at a step."""
    depth = 0
    for index in range(start, len(steps)):
        depth += (steps[index].enters is not None) - steps[index].leaves
        if depth == 0:
            return index
    return -1


class _Folding:
    """One way, taken together from the inside to the outside."""

    def __init__(self, steps: Sequence[FlowStep], flow_names: dict[tuple[SystemPart, str, str], str]) -> None:
        self._steps = steps
        self._flow_names = flow_names

    def fold(self, start: int) -> tuple[list[str], TimeRange | None, int]:
        """Return the steps inside of one system, how long they take, and where it is left."""
        texts: list[str] = []
        total: TimeRange | None = NO_TIME
        index = start
        while not self._steps[index].leaves:
            step = self._steps[index]
            text, latency = step.text, step.latency
            if step.enters is not None:
                inner, latency, index = self.fold(index + 1)
                flow = self._write_flow(step.enters, (step.text, self._steps[index].text), inner, latency)
                text = f"{step.enters.name}.{flow}"
            texts.append(text)
            total = (total[0] + latency[0], total[1] + latency[1]) if total and latency else None
            index += 1
        return texts, total, index

    def _write_flow(
        self, system: SystemPart, ends: tuple[str, str], inner: Sequence[str], latency: TimeRange | None
    ) -> str:
        """Return the name of a flow through a system: what it is from outside, and how it goes inside."""
        entry, leave = ends
        kind = "path" if entry and leave else "sink" if entry else "source"
        properties = [make_property("Latency", write_range(*latency))] if latency and can_be_written(latency[1]) else []
        inside = f"flow {kind} {' -> '.join(filter(None, (entry, *inner, leave)))}"
        key = (system, inside, str(properties))
        if key not in self._flow_names:
            outer_ends = [each for each in ends if each]
            wanted = "_to_".join(outer_ends) + ("_flow" if len(outer_ends) == 1 else "")
            name = self._flow_names[key] = system.names.take_name(wanted)
            system.flow_specs.append(make_item(name, f"flow {kind} {' -> '.join(outer_ends)}", properties))
            system.flows.append(make_item(name, inside))
        return self._flow_names[key]
