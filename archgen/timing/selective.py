"""Which arcs carry something only for some of the activations of their source."""

from __future__ import annotations

from archgen.timing.system import Arc, System


def selective(system: System, arc: Arc) -> bool:
    """Whether an activation of the source may send nothing on an arc, with no promise of when one does.

    That is so for a conditional output without `max_gap`, for fewer than one call per activation, and for the answers
    of a server that something other than this caller activates too.
    """
    source = system.activities[arc.source]
    if arc.role == "request":
        return source.calls.get(arc.output, 1) < 1
    if arc.role == "data":
        return arc.output in source.conditional and arc.output not in source.max_gaps
    others = (one for one in system.into.get(arc.source, ()) if one.role != "request" or one.source != arc.target)
    return source.period is not None or any(one.role == "request" or one.input in source.triggers for one in others)
