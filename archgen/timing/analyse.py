"""The whole analysis: of an architecture, or of a system in which some figures were changed."""

from __future__ import annotations

from operator import attrgetter

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, Reason
from archgen.timing.bounds import all_responses, host_loads
from archgen.timing.build import system as build
from archgen.timing.edges import Known, edge_paces
from archgen.timing.paces import paces
from archgen.timing.placement import resources
from archgen.timing.queueing import settled
from archgen.timing.services import service_loads
from archgen.timing.system import System
from archgen.timing.traffic import link_loads, topic_loads


def analyse(architecture: Architecture, *, judging: bool = False) -> Analysis:
    """Analyse an architecture, chains aside.

    With `judging`, what no rule looks at is left out: the topics, and the edges that cannot be at fault.
    """
    system, notes = build(architecture)
    if not judging:
        return analyse_system(system, notes)
    # Rules are run again and again for versions of one project that mostly leave timing as it was. Only the last
    # analysis is kept, and it is used again only where every figure and every place is the same.
    global _judged  # noqa: PLW0603 - what was found last, for who judges many versions of one project
    if _judged is None or not _same(_judged, system, notes):
        _judged = analyse_system(system, notes, judging=True)
    return _judged


def for_chains(architecture: Architecture) -> Analysis:
    """Analyse what chains rest on and no more, for callers that ask the same of many versions of one project."""
    system, notes = build(architecture)
    return analyse_system(system, notes, judging=True)


_judged: Analysis | None = None


def _same(found: Analysis, system: System, notes: tuple[Reason, ...]) -> bool:
    """Whether an analysis is that of this system: every figure is equal, and written at the same place."""
    # Spans take no part in the equality of systems (`compare=False`), but findings point to them.
    return (
        found.system == system
        and list(map(_activity_places, found.system.activities.values()))
        == list(map(_activity_places, system.activities.values()))
        and list(map(_arc_places, found.system.arcs)) == list(map(_arc_places, system.arcs))
        and [(note, note.at) for note in found.notes] == [(note, note.at) for note in notes]
    )


_activity_places = attrgetter("at", "places")
_arc_places = attrgetter("at", "queue_at")


def analyse_system(system: System, notes: tuple[Reason, ...] = (), *, judging: bool = False) -> Analysis:
    """Analyse a system, chains aside."""
    # The order of the stages: links and event models in ticks, responses in ns, rates, and then what rests on all of
    # them.
    system, firing, state = settled(system)
    places = resources(system)
    responses = all_responses(state, places)
    found = paces(state, responses)
    known = Known(state, found.of, found.outputs, responses)
    return Analysis(
        system=system,
        paces={name: found.of[name] for name in system.activities},
        outputs={(a.id, key): found.outputs[a.id, key] for a in system.activities.values() for key in a.outputs},
        responses=responses,
        hosts=host_loads(system, places, found.of, responses),
        links=link_loads(state, found),
        topics={} if judging else topic_loads(system, found.outputs),
        edges=edge_paces(known, judging=judging),
        endless=firing.endless,
        deadlocked=firing.deadlocked,
        diverged=tuple(
            name
            for name in system.activities
            if name in state.diverged or "diverged" in responses[name].worst.assumptions
        ),
        derived=found.derived,
        services=service_loads(state, found.of, responses),
        notes=notes,
    )
