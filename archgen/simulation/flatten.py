"""From a system to a plan. Unknown figures are taken as nothing, and named."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from archgen.simulation.places import Places
from archgen.simulation.plan import (
    ANY,
    FINEST,
    IDLE,
    KEPT,
    PERIODIC,
    SAMPLED,
    TRIGGERED,
    Output,
    Plan,
    Step,
    Wire,
)
from archgen.timing.selective import selective
from archgen.timing.system import Activity, Arc, System

_SECOND = 10**9
Pauses = Mapping[tuple[str, str], Fraction]
"""The largest time between two chances to publish an output, in ns, by activity and output key."""


def flatten(system: System, pauses: Pauses | None = None) -> Plan:
    """Make a plan. `pauses` say when a conditional output must be published to keep its promised largest gap."""
    made = _Flat(system, pauses or {})
    wires = tuple(made.wire(arc) for arc in system.arcs)
    steps = tuple(made.step(activity) for activity in system.activities.values())
    back = {(arc.target, arc.source, arc.topic): e for e, arc in enumerate(system.arcs) if arc.role == "answer"}
    asked = ((e, (arc.source, arc.target, arc.topic)) for e, arc in enumerate(system.arcs) if arc.role == "request")
    answers = {e: back[key] for e, key in asked if key in back}
    return Plan(
        system.tick / made.scale,
        steps,
        wires,
        system.arcs,
        tuple(made.places.processor_of_thread),
        tuple(map(tuple, made.places.members)),
        tuple(made.places.affinity),
        tuple(made.places.pool_of_thread),
        tuple(made.places.pools),
        tuple(made.places.processors),
        tuple(made.links),
        tuple(made.queues),
        made.places.cores(),
        answers,
        tuple(made.unknown),
    )


class _Flat:
    """Numbers for everything, given in order of appearance."""

    def __init__(self, system: System, pauses: Pauses) -> None:
        self.system = system
        self.pauses = pauses
        self.scale = max(1, -(-system.tick.numerator // (system.tick.denominator * FINEST)))
        self.number = {key: at for at, key in enumerate(system.activities)}
        self.places = Places(system, self.number)
        self.links: dict[str, int] = {}
        self.queues: dict[tuple[str, str, str], int] = {}
        self.unknown: dict[str, None] = {}
        self.into: dict[str, list[tuple[int, Arc]]] = {}
        self.out_of: dict[str, list[tuple[int, Arc]]] = {}
        for e, arc in enumerate(system.arcs):
            self.into.setdefault(arc.target, []).append((e, arc))
            self.out_of.setdefault(arc.source, []).append((e, arc))

    def units(self, ticks: int) -> int:
        return ticks * self.scale

    def known(self, ticks: int | None, what: str) -> int:
        if ticks is None:
            self.unknown[what] = None
            return 0
        return self.units(ticks)

    def wire(self, arc: Arc) -> Wire:
        reader = self.system.activities[arc.target]
        worst = self.units(arc.worst or 0)
        if arc.worst is None:
            self.unknown[f"latency from {arc.source} to {arc.target}"] = None
        link, transmission = -1, 0
        bandwidth = self.system.bandwidths.get(arc.link or "")
        if arc.role == "data" and arc.link is not None and arc.size is not None and bandwidth:
            link = self.links.setdefault(arc.link, len(self.links))
            transmission = int(arc.size * _SECOND * self.scale / (bandwidth * self.system.tick))
        queue = -1
        if arc.role == "data":
            queue = self.queues.setdefault((arc.target, arc.input, arc.topic), len(self.queues))
        best = min(self.units(arc.best or 0), worst)
        request = arc.role == "request"
        return Wire(
            target=self.number[arc.target],
            slot=_slot(reader, arc),
            best=best,
            worst=worst,
            queue=queue,
            depth=arc.depth or 0,
            link=link,
            transmission=transmission,
            limit=None if arc.worst is None else worst,
            request=request,
            selective=selective(self.system, arc),
        )

    def step(self, activity: Activity) -> Step:
        kind = self.kind(activity)
        wcet = self.known(activity.wcet, f"execution time of {activity.id}")
        if activity.wcet is None and (activity.response is not None or kind == KEPT):
            self.unknown.pop(f"execution time of {activity.id}", None)
        fixed = activity.mode == "all"
        into = self.into.get(activity.id, [])
        return Step(
            activity.id,
            kind,
            self.units(activity.period or 0) if kind == PERIODIC else 0,
            self.units(activity.jitter),
            min(self.units(activity.bcet or 0), wcet),
            wcet,
            None if activity.response is None else self.units(activity.response),
            1 if kind == PERIODIC else activity.every,
            0 if kind == PERIODIC else self.units(activity.throttle),
            len(activity.triggers),
            self.kept(activity) if fixed else (),
            tuple(e for e, arc in into if fixed and _slot(activity, arc) >= 0),
            tuple(e for e, _ in into),
            tuple(self.output(activity, key) for key in self.outputs(activity)),
            tuple(self.calls(activity)),
            self.places.thread(activity),
            activity.priority,
            activity.behaviour == "periodic",
        )

    def kind(self, activity: Activity) -> int:
        if activity.behaviour == "once":
            return KEPT
        if activity.behaviour == "periodic":
            if activity.period:
                return PERIODIC
            self.unknown[f"period of {activity.id}"] = None
            return IDLE
        if activity.period and not self.fired(activity):
            return PERIODIC
        if activity.behaviour is None:
            self.unknown[f"behaviour of {activity.id}"] = None
        for outside in self.system.external.get(activity.id, ()):
            if outside in activity.triggers:
                self.unknown[f"events from outside at {outside}"] = None
        return TRIGGERED

    def fired(self, activity: Activity) -> bool:
        """Tell whether something within the architecture fires an activity; else it keeps the period that it states."""
        return any(
            arc.role == "request" or (arc.role == "data" and arc.input in activity.triggers)
            for arc in self.system.into.get(activity.id, ())
        )

    def kept(self, activity: Activity) -> tuple[int, ...]:
        into = self.into.get(activity.id, [])
        once = {arc.input for _, arc in into if self.system.activities[arc.source].behaviour == "once"}
        return tuple(slot for slot, key in enumerate(activity.triggers) if key in once)

    def outputs(self, activity: Activity) -> tuple[str, ...]:
        carried = [arc.output for _, arc in self.out_of.get(activity.id, []) if arc.role == "data"]
        return tuple(dict.fromkeys((*carried, *(key for key in activity.outputs if key in activity.conditional))))

    def output(self, activity: Activity, key: str) -> Output:
        sent = self.out_of.get(activity.id, [])
        wires = tuple(e for e, arc in sent if arc.output == key and arc.role == "data")
        largest = activity.max_gaps.get(key)
        pause = self.pauses.get((activity.id, key))
        patience = None
        if largest is not None:
            patience = self.units(largest) - int(pause / self.system.tick * self.scale) - 1 if pause is not None else -1
        return Output(key, wires, key in activity.conditional, patience)

    def calls(self, activity: Activity) -> list[tuple[Fraction, tuple[int, ...]]]:
        found: dict[str, list[int]] = {}
        for e, arc in self.out_of.get(activity.id, []):
            if arc.role == "request":
                found.setdefault(arc.output, []).append(e)
        return [(activity.calls.get(key, Fraction(1)), tuple(wires)) for key, wires in found.items()]


def _slot(reader: Activity, arc: Arc) -> int:
    if arc.role == "request":
        return SAMPLED if reader.behaviour == "periodic" else ANY
    if arc.role == "answer" or arc.input not in reader.triggers:
        return SAMPLED
    return reader.triggers.index(arc.input) if reader.mode == "all" else ANY
