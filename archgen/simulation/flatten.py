"""Build a simulation plan from a system. Unknown figures are taken as nothing, and listed."""

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
"""The longest time between two chances to publish an output, in ns, by activity and output key."""


def flatten(system: System, pauses: Pauses | None = None) -> Plan:
    """Build a plan.

    `pauses` say when a conditional output must be published so that its promised largest gap is kept.
    """
    made = _Flat(system, pauses or {})
    # Wires come first: unknown latencies are listed before unknown execution times.
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
    """Numbers activities, wires, queues, links and threads in order of appearance."""

    def __init__(self, system: System, pauses: Pauses) -> None:
        self.system = system
        self.pauses = pauses
        # Rounded up: a unit is at most MAX_UNIT_NS ns long.
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
        """Convert ticks to units."""
        return ticks * self.scale

    def known(self, ticks: int | None, what: str) -> int:
        """Convert ticks to units; an unknown figure is noted and counts as 0."""
        if ticks is None:
            self.unknown[what] = None
            return 0
        return self.units(ticks)

    def wire(self, arc: Arc) -> Wire:
        """Plan the wire for an arc."""
        reader = self.system.activities[arc.target]
        best = self.units(arc.best or 0)
        # A latency that the analysis computed for a queued link is not a declared one: the simulation must be free to
        # exceed it, or it would prove nothing.
        promised = None if arc.worst is None or arc.link in self.system.queued else self.units(arc.worst)
        if arc.worst is None:
            self.unknown[f"latency from {arc.source} to {arc.target}"] = None
        link, transmission = -1, 0
        bandwidth = self.system.bandwidths.get(arc.link or "")
        if arc.link is not None and arc.size is not None and bandwidth:
            link = self.links.setdefault(arc.link, len(self.links))
            transmission = int(arc.size * _SECOND * self.scale / (bandwidth * self.system.tick))
        queue = -1
        if arc.role == "data":
            queue = self.queues.setdefault((arc.target, arc.input, arc.topic), len(self.queues))
        return Wire(
            target=self.number[arc.target],
            slot=_slot(reader, arc),
            best=best if promised is None else min(best, promised),
            worst=best if promised is None else promised,
            queue=queue,
            depth=arc.depth or 0,
            link=link,
            transmission=transmission,
            limit=promised,
            request=arc.role == "request",
            selective=selective(self.system, arc),
        )

    def step(self, activity: Activity) -> Step:
        """Plan an activity."""
        kind = self.kind(activity)
        wcet = self.known(activity.wcet, f"execution time of {activity.id}")
        # Here no execution time is needed, so it is not listed as unknown.
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
        """Return what starts an activity, and note what is missing where nothing does."""
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
        """Return whether something within the architecture fires an activity; else it keeps its stated period."""
        return any(
            arc.role == "request" or (arc.role == "data" and arc.input in activity.triggers)
            for arc in self.system.into.get(activity.id, ())
        )

    def kept(self, activity: Activity) -> tuple[int, ...]:
        """Return the slots of an all-of trigger that outputs published once fill for good."""
        into = self.into.get(activity.id, [])
        once = {arc.input for _, arc in into if self.system.activities[arc.source].behaviour == "once"}
        return tuple(slot for slot, key in enumerate(activity.triggers) if key in once)

    def outputs(self, activity: Activity) -> tuple[str, ...]:
        """Return the keys of the outputs that have readers or are conditional, in order and without duplicates."""
        carried = [arc.output for _, arc in self.out_of.get(activity.id, []) if arc.role == "data"]
        return tuple(dict.fromkeys((*carried, *(key for key in activity.outputs if key in activity.conditional))))

    def output(self, activity: Activity, key: str) -> Output:
        """Plan an output."""
        sent = self.out_of.get(activity.id, [])
        wires = tuple(e for e, arc in sent if arc.output == key and arc.role == "data")
        largest = activity.max_gaps.get(key)
        pause = self.pauses.get((activity.id, key))
        patience = None
        if largest is not None:
            # Publish unless waiting for one more chance would still keep the promise. The 1 makes up for rounding; -1
            # (no bound on the pause) publishes at each chance.
            patience = self.units(largest) - int(pause / self.system.tick * self.scale) - 1 if pause is not None else -1
        return Output(key, wires, key in activity.conditional, patience)

    def calls(self, activity: Activity) -> list[tuple[Fraction, tuple[int, ...]]]:
        """Return calls for each activation and the wires that they use, by output."""
        found: dict[str, list[int]] = {}
        for e, arc in self.out_of.get(activity.id, []):
            if arc.role == "request":
                found.setdefault(arc.output, []).append(e)
        return [(activity.calls.get(key, Fraction(1)), tuple(wires)) for key, wires in found.items()]


def _slot(reader: Activity, arc: Arc) -> int:
    """Return the slot of an arc at its reader: a place of an all-of trigger, SLOT_ANY or SLOT_SAMPLED."""
    if arc.role == "request":
        return SAMPLED if reader.behaviour == "periodic" else ANY
    if arc.role == "answer" or arc.input not in reader.triggers:
        return SAMPLED
    return reader.triggers.index(arc.input) if reader.mode == "all" else ANY
