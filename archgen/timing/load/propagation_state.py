"""What is known so far of a system's activities, while event models and responses are found in turns."""

from __future__ import annotations

from fractions import Fraction

from archgen.frozen import dataclass, field
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_streams import EventStreams
from archgen.timing.load.level_cascades import EntryWay
from archgen.timing.load.thread_work import ThreadWork, WorstResponse
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.timing.system.trigger_graph import TriggerGraph


@dataclass(slots=True)
class PropagationState:
    """What is known so far of each activity: its event model, and its worst response."""

    system: TimingSystem
    triggers: TriggerGraph
    event_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    responses: dict[str, WorstResponse] = field(default_factory=dict)
    diverged: set[str] = field(default_factory=set)
    storing_waits: dict[str, WorstResponse] = field(default_factory=dict)
    """How long a message that an activity only stores may wait for that while the activity is activated."""
    ways_to: dict[str, tuple[EntryWay, ...]] = field(default_factory=dict)
    """The ways on which events reach each activity of a core with triggers inside."""
    host_ways_to: dict[str, tuple[EntryWay, ...]] = field(default_factory=dict)
    """The same from where events enter a host of several cores, where that is bounded as a whole."""
    transaction_ways: dict[str, tuple[EntryWay, ...]] = field(default_factory=dict)
    """The same from where events enter a group of hosts that fire one another in turn."""
    transaction_arcs: dict[str, tuple[Arc, ...]] = field(default_factory=dict)
    """The arcs by which such ways go on to an activity."""
    place_ways: dict[str, tuple[EntryWay, ...]] = field(default_factory=dict)
    """How long events stay on the cores of activities of such a group, as far as these alone bound it."""
    settled_ids: set[str] = field(default_factory=set)
    """Activities of such groups of which these ways say what leaves them, once each place has been looked at by itself."""
    run_arcs: dict[str, tuple[Arc, ...]] = field(default_factory=dict)
    """The arcs by which ways go on to an activity from another of its core."""
    work_ends: dict[str, WorstResponse] = field(default_factory=dict)
    """When the work is done of those with a declared response whose threads wait for resources."""
    single_ends: dict[str, int] = field(default_factory=dict)
    """When the work is done of those whose cores are looked at one by one."""
    load_state: PropagationState | None = None
    """The same of all that loads processors, where callbacks that store inputs take time: they are activities there."""
    entering_models: dict[int, EventStreams | UnknownCause] = field(default_factory=dict)
    """Event models of what comes by the arcs that enter such a core (by identity), as its responses rest on them."""
    leaving_models: dict[str, EventStreams | UnknownCause] = field(default_factory=dict)
    """Event models of what leaves each activity; filled on demand by sent_models, once everything else is found."""
    turn_times: dict[tuple[str, tuple[str, ...]], dict[str, int | None]] = field(default_factory=dict)
    """How long each use of a resource takes that serves its users in the order in which they come."""
    resource_users: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """The activities that use each resource."""
    resource_loads: dict[str, tuple[tuple[object, ...], Fraction]] = field(default_factory=dict)
    """The share of each resource that is used, for the event models for which it was found last."""
    late_threads: dict[tuple[str, ...], tuple[tuple[object, ...], ThreadWork]] = field(default_factory=dict)
    """What threads do on a core as others see it, for what it was found from last."""
    searched_terms: int = 0
    """How many terms the searches looked at: what finding all this has cost."""
