"""Draw the start-up: phase by phase, what starts and what it waits for; waits that follow from others are left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.bringup.plan_shapes import StartPlan, StartStep
from archgen.bringup.start_plan import make_start_plan
from archgen.model.node import PHASES
from archgen.views import start_phrases
from archgen.views.graphs.graph_folding import MAX_BOXES, add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Arrow, Box, Graph


def draw_start(lookup: Lookup) -> Graph:
    """Draw the steps of the plan; none where the project does not describe its start-up."""
    architecture = lookup.architecture
    plan = make_start_plan(architecture) if architecture.describes_start() else StartPlan()
    drawn_steps = plan.steps[:MAX_BOXES]
    phases = [phase for phase in PHASES if any(step.phase == phase for step in drawn_steps)]
    boxes: list[Box] = []
    arrows: list[Arrow] = []
    last_ids: list[str] = []
    for phase in phases:
        steps = [step for step in drawn_steps if step.phase == phase]
        waits = _reduce_waits(steps)
        boxes += [Box(f"phase {phase}", f"Phase {phase}", style="group"), *map(_make_box, steps)]
        arrows += [Arrow(f"{last} > {phase}", last, f"phase {phase}") for last in last_ids]
        arrows += _list_arrows(phase, steps, waits)
        awaited_ids = {awaited for each in waits.values() for awaited in each}
        last_ids = [_box_id(step.id) for step in steps if step.id not in awaited_ids]
    hidden = len(plan.steps) - len(drawn_steps)
    graph = Graph(
        "start_up",
        f"{architecture.project.title}: start-up",
        "flow",
        tuple(boxes),
        tuple(arrows),
        direction=architecture.layout.direction or "top-bottom",
        notes=(f"{count_noun(hidden, 'later step')} not drawn: the tables have all of them.",) if hidden else (),
        alt=f"{count_noun(len(drawn_steps), 'step')} in {count_noun(len(phases), 'phase')}: {', '.join(phases)}.",
        asked=len(arrows),
        kind="start",
    )
    return add_legend_keys(graph)


def _box_id(step_id: str) -> str:
    return f"step {step_id}"


def _make_box(step: StartStep) -> Box:
    name = step.container or step.id if step.kind == "container" else step.id
    ready = start_phrases.describe_ready(step)
    kind = start_phrases.KIND_WORDS[step.kind] if step.kind in {"program", "container"} else ""
    place = f"{kind} on {step.host}" if kind and step.host else step.host or kind
    lines = [line for line in (place, "runs to its end" if step.once else "") if line]
    lines += [start_phrases.describe_lifecycle(step)] if step.state else []
    return Box(
        _box_id(step.id),
        name,
        tuple(lines),
        style="container" if step.kind == "container" else "component" if step.kind == "program" else "node",
        ref=f"{'container' if step.kind == 'container' else 'node'}:{name}",
        tooltip="\n".join(
            [name, start_phrases.KIND_WORDS[step.kind], *lines, *([f"up when {ready}"] if ready else [])]
        ),
    )


def _list_arrows(phase: str, steps: Sequence[StartStep], waits: Mapping[str, Sequence[str]]) -> Iterator[Arrow]:
    for step in steps:
        if not waits[step.id]:
            yield Arrow(f"{phase} > {step.id}", f"phase {phase}", _box_id(step.id))
        for awaited in waits[step.id]:
            reasons = [start_phrases.describe_reason(wait) for wait in step.waits if wait.awaited == awaited]
            yield Arrow(
                f"{awaited} > {step.id}",
                _box_id(awaited),
                _box_id(step.id),
                flows=tuple(f"{step.id} waits for {awaited}: {reason}" for reason in dict.fromkeys(reasons)),
            )


def _reduce_waits(steps: Sequence[StartStep]) -> dict[str, list[str]]:
    """Return what each step waits for within a phase, without what it waits for by way of others as well."""
    inside = {step.id for step in steps}
    before: dict[str, frozenset[str]] = {}
    reduced: dict[str, list[str]] = {}
    # Each step stands behind all that it waits for.
    for step in steps:
        awaited_ids = list(dict.fromkeys(wait.awaited for wait in step.waits if wait.awaited in inside))
        implied = frozenset().union(*(before[each] for each in awaited_ids))
        before[step.id] = implied.union(awaited_ids)
        reduced[step.id] = [each for each in awaited_ids if each not in implied]
    return reduced
