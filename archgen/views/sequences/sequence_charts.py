"""Use cases as sequences: the whole for a page that scrolls, and cut into pieces that fit on paper."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from archgen.diagnostics import join_first
from archgen.frozen import replace
from archgen.model.architecture import UseCase
from archgen.model.path_resolver import title_from_id
from archgen.model.port_media import is_physical
from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import StepEnd
from archgen.timing.chains.use_case_times import UseCaseTimes
from archgen.timing.figures.timing_values import sum_fractions
from archgen.views import short_figures
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Lifeline, MessageStyle, SequenceChart, SequenceMessage
from archgen.views.timing import value_format

CHART_PREFIX = "sequences/"
"""How the id of each sequence begins; the id of its use case follows."""
_PRINTED_LIFELINES = 6
"""So many stand side by side on a page of the report."""
_PRINTED_STEPS = 12
"""So many steps of a sequence stand on a page of the report."""
_LEGEND_KEYS: dict[MessageStyle, str] = {
    "data": "step:data",
    "service": "step:service",
    "action": "step:action",
    "physical": "physical",
    "inner": "step:inner",
    "broken": "step:broken",
}
"""How the legend calls the styles of messages, in its order."""
_MAX_TEXT = 160
"""Characters of what is said that stand beside an arrow; the table has all of it."""


def make_sequence_charts(lookup: Lookup, components: Collection[str] | None = None) -> Iterator[SequenceChart]:
    """Yield the sequence of each use case with steps; of some components, by complete ids, those that one takes part in."""
    for use_case_id, steps in lookup.steps.by_use_case.items():
        ends = {end.participant for each in steps for end in (each.step.source, each.step.target)}
        parts = (leaf for end in sorted(ends) for leaf in lookup.architecture.leaves_of(end))
        if components is None or any(part in components for part in parts):
            yield make_sequence_chart(lookup, use_case_id)


def make_sequence_chart(lookup: Lookup, use_case_id: str) -> SequenceChart:
    """Return the whole sequence of a use case."""
    use_case = lookup.architecture.use_cases[use_case_id]
    return _draw_steps(lookup, use_case, f"{CHART_PREFIX}{use_case_id}", lookup.steps.by_use_case[use_case_id])


def make_printed_charts(lookup: Lookup, use_case_id: str) -> tuple[SequenceChart, ...]:
    """Return the sequence of a use case in pieces that fit on paper; a short one is the whole sequence itself.

    Three pieces stand on a page if only the last one has the legend, and what the steps run along is left to the table below.
    """
    pieces = list(_cut_steps(lookup.steps.by_use_case[use_case_id]))
    if len(pieces) == 1:
        return (make_sequence_chart(lookup, use_case_id),)
    use_case = lookup.architecture.use_cases[use_case_id]
    charts = [
        _draw_steps(lookup, use_case, f"{CHART_PREFIX}{use_case_id}/{number}", piece, is_printed=True)
        for number, piece in enumerate(pieces, 1)
    ]
    used_keys = {key for chart in charts for key in chart.legend}
    legend = tuple(key for key in (*_LEGEND_KEYS.values(), "external") if key in used_keys)
    return (*(replace(chart, legend=()) for chart in charts[:-1]), replace(charts[-1], legend=legend))


def _cut_steps(steps: Sequence[ConnectedStep]) -> Iterator[tuple[ConnectedStep, ...]]:
    """Yield runs of steps with few participants each: as few runs as can be, and of those the most even ones."""
    # For each number of steps the best way to cut them: how many runs, the sum of the squares of their lengths, and where
    # the last run begins.
    best: list[tuple[int, int, int]] = [(0, 0, 0)]
    for end in range(1, len(steps) + 1):
        participants = set[str]()
        choices: list[tuple[int, int, int]] = []
        for start in range(end - 1, max(end - _PRINTED_STEPS, 0) - 1, -1):
            participants |= {steps[start].step.source.participant, steps[start].step.target.participant}
            if choices and len(participants) > _PRINTED_LIFELINES:
                break
            runs, squares, _ = best[start]
            choices.append((runs + 1, squares + (end - start) ** 2, start))
        best.append(min(choices))
    ends = [len(steps)]
    while ends[-1] > 0:
        ends.append(best[ends[-1]][2])
    for start, end in pairwise(reversed(ends)):
        yield tuple(steps[start:end])


def _draw_steps(
    lookup: Lookup, use_case: UseCase, chart_id: str, steps: Sequence[ConnectedStep], *, is_printed: bool = False
) -> SequenceChart:
    positions: dict[str, int] = {}
    lifelines: list[Lifeline] = []
    for each in steps:
        for end in (each.step.source, each.step.target):
            if end.participant not in positions:
                positions[end.participant] = len(lifelines)
                lifelines.append(_make_lifeline(lookup, use_case, end))
    messages = tuple(_make_message(lookup, use_case, each, positions, is_printed=is_printed) for each in steps)
    styles = {message.style for message in messages}
    numbers = f"steps {steps[0].number} to {steps[-1].number}" if len(steps) > 1 else f"step {steps[0].number}"
    is_whole = len(steps) == len(use_case.steps)
    title = use_case.title if is_whole else f"{use_case.title}: {numbers}"
    legend = tuple(key for style, key in _LEGEND_KEYS.items() if style in styles)
    has_outside = any(lifeline.kind == "actor" for lifeline in lifelines)
    total = short_figures.shorten_text(describe_total(lookup, use_case.id)) if is_whole else ""
    return SequenceChart(
        chart_id,
        title,
        tuple(lifelines),
        messages,
        legend=(*legend, *(("external",) if has_outside else ())),
        notes=(f"All steps together: {total}. What stands outside takes its own time.",) if total else (),
        alt=_describe_chart(use_case, lifelines, messages),
    )


def _make_lifeline(lookup: Lookup, use_case: UseCase, end: StepEnd) -> Lifeline:
    title = name_participant(lookup, use_case, end)
    if end.kind in {"actor", "unknown"}:
        return Lifeline(title, "actor" if end.kind == "actor" else "unknown", tooltip=title)
    component = lookup.architecture.find_component(end.participant)
    if component is None:
        return Lifeline(title, "unknown", tooltip=title)
    kind = "composed" if component.id in lookup.architecture.shells else "component"
    return Lifeline(title, kind, lookup.group_hues.get(component.group), f"component:{component.id}", component.id)  # type: ignore[arg-type]


def _make_message(
    lookup: Lookup, use_case: UseCase, connected: ConnectedStep, positions: dict[str, int], *, is_printed: bool
) -> SequenceMessage:
    step = connected.step
    text = " ".join((step.say or "").split())
    text = text if len(text) <= _MAX_TEXT else f"{text[: _MAX_TEXT - 1]}…"
    carriers = list(_list_carriers(lookup, connected))
    shown = join_first(carriers, 2)
    time = describe_step_time(lookup, use_case.id, connected.number)
    lines = ("" if is_printed and text else shown, short_figures.shorten_text(time))
    detail = "no connection" if connected.is_broken else "\n".join(filter(None, lines))
    tooltip = "\n".join(filter(None, (text, ", ".join(carriers), time)))
    return SequenceMessage(
        connected.number,
        positions[step.source.participant],
        positions[step.target.participant],
        text,
        detail,
        _choose_style(lookup, connected),
        find_carrier_ref(lookup, connected),
        tooltip,
    )


def _choose_style(lookup: Lookup, connected: ConnectedStep) -> MessageStyle:
    if connected.is_broken or not connected.step.is_resolved:
        return "broken"
    if connected.step.is_inner:
        return "inner"
    if connected.way == "outside":
        port_id = connected.connections[0].output or connected.connections[0].input or ""
        port = lookup.architecture.outputs.get(port_id) or lookup.architecture.inputs.get(port_id)
        return "physical" if port is not None and is_physical(port) else "data"
    return connected.way if connected.way in {"service", "action", "physical"} else "data"


def find_carrier_ref(lookup: Lookup, connected: ConnectedStep) -> str | None:
    """Return the page of the type that a step carries, if all that it runs along has one type."""
    architecture = lookup.architecture
    ports = (
        architecture.outputs.get(each.output or "") or architecture.inputs.get(each.input or "")
        for each in connected.connections
    )
    types = tuple(dict.fromkeys(port.type for port in ports if port is not None))
    return f"type:{types[0]}" if len(types) == 1 and types[0] is not None else None


def _describe_chart(use_case: UseCase, lifelines: Sequence[Lifeline], messages: Sequence[SequenceMessage]) -> str:
    """Tell the sequence in words."""
    sentences = [f"A sequence of {count_noun(len(messages), 'step')} of {use_case.id}."]
    for message in messages:
        tail, head = lifelines[message.tail].title, lifelines[message.head].title
        way = tail if message.tail == message.head else f"{tail} to {head}"
        sentences.append(f"{message.number}: {way}{f': {message.text}' if message.text else ''}.")
    return " ".join(sentences)


NOT_PROVEN = "not proven"
"""Words for a time that has no bound, or none that is known."""


def name_participant(lookup: Lookup, use_case: UseCase, end: StepEnd) -> str:
    """Return the title of who takes part in a step; a name that means nothing stands for itself."""
    if end.kind == "actor":
        return use_case.actors[end.id].title
    component = lookup.architecture.find_component(end.participant)
    return component.title if component else end.id


def _list_carriers(lookup: Lookup, connected: ConnectedStep) -> tuple[str, ...]:
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
    return NOT_PROVEN if value.value is None or text == value_format.UNKNOWN_FIGURE else text


def describe_total(lookup: Lookup, use_case_id: str) -> str:
    """Return how long all steps take together; empty where timing says nothing."""
    times = find_times(lookup, use_case_id)
    if times is None:
        return ""
    text = value_format.display_duration(times.total)
    if times.total.value is None:
        return NOT_PROVEN
    return f"at most {text}" if times.total.complete else f"{NOT_PROVEN} ({text})"


def explain_total(lookup: Lookup, use_case_id: str) -> str:
    """Return how long all steps take together and, where that is less than their sum, why."""
    times, total = find_times(lookup, use_case_id), describe_total(lookup, use_case_id)
    if times is None or not times.total.complete or times.total.value is None:
        return total
    known = [each.value for each in times.steps if each and each.value]
    is_less = len(known) > 1 and times.total.value < sum_fractions(known)
    return f"{total}; the steps add up to more, but what several of them wait for counts once" if is_less else total


def list_step_lines(lookup: Lookup, use_case: UseCase) -> Iterator[str]:
    """Yield the steps as lines of text."""
    for connected in lookup.steps.by_use_case.get(use_case.id, ()):
        step = connected.step
        source, target = (name_participant(lookup, use_case, end) for end in (step.source, step.target))
        line = f"{connected.number}. {source}" + (f" -> {target}" if not step.is_inner else "")
        line += f": {' '.join(step.say.split())}" if step.say else ""
        notes = [
            ", ".join(_list_carriers(lookup, connected)),
            describe_step_time(lookup, use_case.id, connected.number),
        ]
        if connected.is_broken:
            notes = ["no connection"]
        if any(notes):
            line += f" [{'; '.join(filter(None, notes))}]"
        yield line
