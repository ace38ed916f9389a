"""Use cases as plain data, for other programs: actors, and steps with what they run along."""

from __future__ import annotations

from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import StepEnd
from archgen.views.lookup import Lookup
from archgen.views.records.record_values import drop_unknown, pick_fields, record_annotations


def record_use_cases(lookup: Lookup) -> dict[str, object]:
    """Return the use cases by id. Steps with an end that names nothing are left out."""
    return {
        use_case.id: pick_fields(use_case, "title", "description")
        | drop_unknown(
            {
                "actors": {actor.id: actor.title for actor in use_case.actors.values()},
                "steps": [
                    _record_step(each)
                    for each in lookup.steps.by_use_case.get(use_case.id, ())
                    if each.step.is_resolved
                ],
            }
        )
        | record_annotations(use_case)
        for use_case in lookup.architecture.use_cases.values()
    }


def _record_step(connected: ConnectedStep) -> dict[str, object]:
    step, connections = connected.step, connected.connections
    outputs = dict.fromkeys(each.output for each in connections if each.output)
    inputs = dict.fromkeys(each.input for each in connections if each.input and not each.output)
    return {"from": _record_end(step.source), "to": _record_end(step.target)} | drop_unknown(
        {"say": step.say, "outputs": list(outputs), "inputs": list(inputs)}
    )


def _record_end(end: StepEnd) -> dict[str, object]:
    return {"kind": end.kind, "id": end.id}
