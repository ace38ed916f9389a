"""Which arcs carry something only for some of the activations of their source."""

from __future__ import annotations

from archgen.timing.system.timing_system import Arc, TimingSystem


def is_selective_arc(system: TimingSystem, arc: Arc) -> bool:
    """Whether an activation of the source may send nothing on an arc, with no promise of when one does.

    That is so for a conditional output without `max_gap`, for fewer than one call per activation, and for the answers
    of a server that something other than this caller activates too.
    """
    source = system.activities[arc.source]
    if arc.role == "request":
        return source.calls.get(arc.output, 1) < 1
    if arc.role == "data":
        return arc.output in source.conditional and arc.output not in source.max_gaps
    other_arcs = (
        other_arc
        for other_arc in system.arcs_into.get(arc.source, ())
        if other_arc.role != "request" or other_arc.source != arc.target
    )
    return source.period is not None or any(
        other_arc.role == "request" or other_arc.input in source.triggers for other_arc in other_arcs
    )
