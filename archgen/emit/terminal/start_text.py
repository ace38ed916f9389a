"""The plan of a start-up for people: steps by phase, what each waits for and why, and what was given up."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterator

from archgen.bringup.plan_shapes import StartPlan, StartStep
from archgen.diagnostics import make_visible
from archgen.model.node import PHASES
from archgen.views import start_phrases

_INDENT = " " * 6


def format_plan(title: str, plan: StartPlan, shown_ids: Collection[str] | None = None) -> list[str]:
    """Return the lines of a plan. With `shown_ids` only these steps, under their numbers in the whole plan."""
    numbered = [
        (number, step) for number, step in enumerate(plan.steps, start=1) if shown_ids is None or step.id in shown_ids
    ]
    steps = {step.id: step for step in plan.steps}
    rest = "" if shown_ids is None else f" of {len(plan.steps)}"
    lines = [f"Start-up of {make_visible(title)}: {len(numbered)}{rest} step{'s' if len(numbered) != 1 else ''}"]
    for phase in PHASES:
        in_phase = [each for each in numbered if each[1].phase == phase]
        lines += ["", f"Phase {phase}"] if in_phase else []
        for number, step in in_phase:
            lines += map(make_visible, _describe_step(number, step))
    dropped = [
        start_phrases.describe_dropped(each, steps)
        for each in plan.dropped
        if shown_ids is None or each.wait.waiting in shown_ids
    ]
    lines += ["", "Given up, so that nothing waits for itself:"] if dropped else []
    lines += [make_visible(f"  {line}") for line in dropped]
    lines += ["", "Contradictions, which no plan can keep:"] if plan.circles else []
    lines += [make_visible(f"  {start_phrases.describe_circle(each, steps)}") for each in plan.circles]
    return lines


def _describe_step(number: int, step: StartStep) -> Iterator[str]:
    place = f" on {step.host}" if step.host else ""
    loaded = f" in {step.container}" if step.kind == "composable" and step.container else ""
    yield f"{number:4}  {step.id}, {start_phrases.KIND_WORDS[step.kind]}{loaded}{place}"
    for words in step.preparations:
        yield f"{_INDENT}run first: {shlex.join(words)}"
    # As one line, to be copied: quoted for a POSIX shell, so that nothing in it is expanded.
    yield _INDENT + (f"run: {shlex.join(step.command)}" if step.command else start_phrases.describe_unknown(step))
    for words in step.transitions:
        yield f"{_INDENT}run: {shlex.join(words)}"
    for name, words in step.ros.value_commands.items() if step.ros else ():
        yield f"{_INDENT}parameter {name}: the output of {shlex.join(words)}"
    for phrase in start_phrases.describe_process(step):
        yield f"{_INDENT}{phrase}"
    for right in step.needs_rights:
        yield f"{_INDENT}needs rights {right}"
    for wait in start_phrases.name_waits(step):
        until = {"ended": " until it has ended", "started": " until it is started"}.get(wait.until, "")
        yield f"{_INDENT}waits for {wait.awaited}{until} ({'; '.join(wait.reasons)})"
    state = start_phrases.describe_lifecycle(step)
    if state:
        yield f"{_INDENT}state: {state}"
    ready = start_phrases.describe_ready(step)
    if ready:
        yield f"{_INDENT}up when {ready}"
