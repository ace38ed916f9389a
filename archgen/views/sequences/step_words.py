"""The words for the steps of use cases: who takes part, what a step runs along, how long it takes."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.architecture import UseCase
from archgen.model.path_resolver import title_from_id
from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import StepEnd
from archgen.timing.chains.use_case_times import UseCaseTimes
from archgen.views.lookup import Lookup
from archgen.views.timing import value_format

NOT_PROVEN = "not proven"
"""Words for a time that has no bound, or none that is known."""


def name_participant(lookup: Lookup, use_case: UseCase, end: StepEnd) -> str:
    """Return the title of who takes part in a step; a name that means nothing stands for itself."""
    if end.kind == "actor":
        return use_case.actors[end.id].title
    component = lookup.architecture.find_component(end.participant)
    return component.title if component else end.id


def list_carriers(lookup: Lookup, connected: ConnectedStep) -> tuple[str, ...]:
    """Return what a step runs along, each once: types, or the names of ports without one."""
    architecture = lookup.architecture
    ports = (
        architecture.outputs.get(each.output or "") or architecture.inputs.get(each.input or "")
        for each in connected.connections
    )
    return tuple(dict.fromkeys(port.type or title_from_id(port.name) for port in ports if port))


def find_times(lookup: Lookup, use_case_id: str) -> UseCaseTimes | None:
    """Return how long the steps of a use case take; None where timing is not asked, or nothing says anything of it."""
    times = lookup.timing.use_cases.get(use_case_id) if lookup.timing else None
    return times if times is not None and any(value is not None for value in times.steps) else None


def describe_step_time(lookup: Lookup, use_case_id: str, number: int) -> str:
    """Return how long a step takes at most; empty where it takes no time of the architecture's."""
    times = find_times(lookup, use_case_id)
    value = times.steps[number - 1] if times and number <= len(times.steps) else None
    if value is None:
        return ""
    text = value_format.display_duration(value)
    return NOT_PROVEN if text == value_format.UNKNOWN_FIGURE else text


def describe_total(lookup: Lookup, use_case_id: str) -> str:
    """Return how long all steps take together; empty where timing says nothing."""
    times = find_times(lookup, use_case_id)
    if times is None:
        return ""
    text = value_format.display_duration(times.total)
    if text == value_format.UNKNOWN_FIGURE:
        return NOT_PROVEN
    is_bound = times.total.complete and times.total.value is not None
    return f"at most {text}" if is_bound else f"{NOT_PROVEN} ({text})"


def list_step_lines(lookup: Lookup, use_case: UseCase) -> Iterator[str]:
    """Yield the steps as lines of text."""
    for connected in lookup.steps.by_use_case.get(use_case.id, ()):
        step = connected.step
        source, target = (name_participant(lookup, use_case, end) for end in (step.source, step.target))
        line = f"{connected.number}. {source}" + (f" -> {target}" if not step.is_inner else "")
        line += f": {' '.join(step.say.split())}" if step.say else ""
        notes = [", ".join(list_carriers(lookup, connected)), describe_step_time(lookup, use_case.id, connected.number)]
        if connected.is_broken:
            notes = ["no connection"]
        if any(notes):
            line += f" [{'; '.join(filter(None, notes))}]"
        yield line
