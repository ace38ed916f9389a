"""The plan of a start-up as tables, one for each phase, and the waits that were given up."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterator, Mapping

from archgen.bringup.plan_shapes import StartPlan, StartStep
from archgen.bringup.start_plan import make_start_plan
from archgen.model.node import PHASES
from archgen.views import inline_text, start_phrases
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Bullets, Inlines, Paragraph, Table, Text, make_columns

_LEAD = (
    "The steps of the start-up in an order in which they can be started one by one. A phase begins when all of the one before is "
    "up; within a phase, steps that do not wait for one another may start side by side."
)
_MAX_WAITS = 8
"""So many steps are named for which one step waits, those that are needed most first; the rest is counted."""
_COLUMNS = make_columns(("Step", 0.4, "right"), ("What starts", 1.4), ("How", 2.2), ("Waits for", 2), ("Up when", 1.4))


def make_start_blocks(lookup: Lookup) -> list[Block]:
    """Make the tables of the phases and what is said below them; nothing where the project does not describe its start-up."""
    if not lookup.architecture.describes_start():
        return []
    plan = make_start_plan(lookup.architecture)
    steps = {step.id: step for step in plan.steps}
    shown_steps = list_shown_steps(lookup, plan)
    if not shown_steps:
        return []
    blocks: list[Block] = [Paragraph(inline_text.to_inlines(_LEAD))]
    for phase in PHASES:
        numbered = [(number, step) for number, step in shown_steps if step.phase == phase]
        rows = tuple(_make_row(lookup, number, step, steps) for number, step in numbered)
        if rows:
            blocks.append(Table(f"table:start/{phase}", f"Start-up: phase {phase}", _COLUMNS, rows, wide=True))
    return [*blocks, *_list_left_out(plan, steps, {step.id for _, step in shown_steps})]


def list_shown_steps(lookup: Lookup, plan: StartPlan) -> list[tuple[int, StartStep]]:
    """Return the steps of the nodes that are shown, and of their containers, with their numbers in the whole plan."""
    nodes = lookup.architecture.nodes
    containers = {node.container for node in nodes.values() if lookup.scope.shows_node(node.id)}
    return [
        (number, step)
        for number, step in enumerate(plan.steps, start=1)
        if (
            (lookup.scope.nodes is None or step.container in containers)
            if step.kind == "container"
            else lookup.scope.shows_node(step.id)
        )
    ]


def _list_left_out(plan: StartPlan, steps: Mapping[str, StartStep], shown_ids: Collection[str]) -> Iterator[Block]:
    for lead, lines in (
        (
            "These waits were given up, so that nothing waits for itself:",
            [start_phrases.describe_dropped(each, steps) for each in plan.dropped if each.wait.waiting in shown_ids],
        ),
        (
            "These contradict one another, and no plan can keep them:",
            [start_phrases.describe_circle(each, steps) for each in plan.circles if each.wait.waiting in shown_ids],
        ),
    ):
        if lines:
            yield Paragraph(inline_text.to_inlines(lead))
            yield Bullets(tuple(inline_text.to_inlines(line) for line in lines))


def _make_row(lookup: Lookup, number: int, step: StartStep, steps: Mapping[str, StartStep]) -> tuple[Inlines, ...]:
    return (
        (Text(str(number), sort_number=str(number)),),
        inline_text.join_lines(_name_step(lookup, step)),
        inline_text.join_lines(_list_ways(step)),
        inline_text.join_lines(_list_waits(step, steps)) or _mute_words("nothing"),
        inline_text.join_lines(_list_signs(step)) or _mute_words("at once"),
    )


def _name_step(lookup: Lookup, step: StartStep) -> Iterator[Inlines]:
    yield (link_step(step),)
    kind = start_phrases.KIND_WORDS[step.kind]
    host = inline_text.host_link(lookup.architecture, step.host) if step.host else ()
    yield (Text(f"{kind} on " if host else kind, muted=True), *host)


def link_step(step: StartStep) -> Text:
    """Link to the node or container that a step starts."""
    if step.kind == "container":
        return Text(step.container or step.id, ref=f"container:{step.container}", code=True)
    return Text(step.id, ref=f"node:{step.id}", code=True)


def _list_ways(step: StartStep) -> Iterator[Inlines]:
    for words in step.preparations:
        yield (Text(shlex.join(words), code=True),)
    yield (
        (Text(shlex.join(step.command), code=True),)
        if step.command
        else _mute_words(start_phrases.describe_unknown(step))
    )
    for words in step.transitions:
        yield (Text(shlex.join(words), code=True),)
    for name, words in step.ros.value_commands.items() if step.ros else ():
        yield (Text(f"parameter {name}: the output of ", muted=True), Text(shlex.join(words), code=True))
    for phrase in start_phrases.describe_process(step):
        yield _mute_words(phrase)
    for right in step.needs_rights:
        yield (Text(f"needs rights {right}", strong=True),)


def _list_waits(step: StartStep, steps: Mapping[str, StartStep]) -> Iterator[Inlines]:
    waits = start_phrases.name_waits(step)
    for wait in waits[:_MAX_WAITS]:
        end = {"ended": "its end; ", "started": "its start; "}.get(wait.until, "")
        yield (link_step(steps[wait.awaited]), Text(f" ({end}{'; '.join(wait.reasons)})", muted=True))
    rest = waits[_MAX_WAITS:]
    if rest:
        yield _mute_words(f"and for {len(rest)} others that are needed no more than these: archgen start names them")


def _list_signs(step: StartStep) -> Iterator[Inlines]:
    ready = start_phrases.describe_ready(step)
    if ready:
        yield (Text(ready),)
    state = start_phrases.describe_lifecycle(step)
    if state:
        yield (Text(f"state {state}"),)


def _mute_words(words: str) -> Inlines:
    return (Text(words, muted=True),)


START_COLUMNS = ("number", "id", "kind", "phase", "host", "command", "waits_for", "up_when", "state", "place")


def list_start_rows(lookup: Lookup) -> Iterator[tuple[object, ...]]:
    """Yield the shown steps of the start-up, with their numbers in the whole plan."""
    architecture = lookup.architecture
    for number, step in list_shown_steps(lookup, make_start_plan(architecture)):
        node = None if step.kind == "container" else architecture.nodes[step.id]
        place = architecture.containers[step.container or ""].at if node is None else node.at
        yield (
            str(number),
            step.id,
            step.kind,
            step.phase,
            step.host or "",
            shlex.join(step.command),
            ", ".join(dict.fromkeys(wait.awaited for wait in step.waits)),
            start_phrases.describe_ready(step),
            start_phrases.describe_lifecycle(step),
            str(place) if place.file else "",
        )
