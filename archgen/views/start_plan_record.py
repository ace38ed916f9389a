"""The plan of a start-up as data for other programs: schemas/start.schema.json describes it."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from archgen.bringup.plan_shapes import DroppedWait, StartPlan, StartStep
from archgen.model.architecture import Architecture
from archgen.model.start_up import PHASES
from archgen.views.record_values import drop_unknown, record_quantity
from archgen.views.start_phrases import NamedWait, name_waits

VERSION = 1
"""The version of the format. It changes where a key goes, or means something else."""


def record_plan(
    architecture: Architecture, plan: StartPlan, shown_ids: Collection[str] | None = None
) -> dict[str, object]:
    """Return a plan as plain data: all steps, or those shown with their numbers in the whole plan. Durations are in ns."""
    steps = {step.id: step for step in plan.steps}
    return {
        "version": VERSION,
        "project": architecture.project.id,
        "phases": list(PHASES),
        "steps": [
            {"number": number, **_record_step(step, steps)}
            for number, step in enumerate(plan.steps, start=1)
            if shown_ids is None or step.id in shown_ids
        ],
        "given_up": [_record_dropped(each) for each in plan.dropped],
        "contradictions": [_record_dropped(each) for each in plan.circles],
    }


def _record_step(step: StartStep, steps: Mapping[str, StartStep]) -> dict[str, object]:
    ready = step.ready
    return drop_unknown(
        {
            "id": step.id,
            "title": step.title,
            "kind": step.kind,
            "phase": step.phase,
            "host": step.host,
            "container": step.container,
            "command": list(step.command),
            "waits": [_record_wait(wait) for wait in name_waits(step, steps)],
            "ready": drop_unknown(
                {
                    **{key: getattr(ready, key) for key in ("port", "file", "topic", "service", "log")},
                    "wait": record_quantity(ready.wait, "ns"),
                    "within": record_quantity(ready.within, "ns"),
                }
            ),
            "once": step.once or None,
            "state": step.state,
            "transitions": [list(words) for words in step.transitions],
            "managers": list(step.manager),
            "respawn": step.respawn or None,
            "respawn_delay": record_quantity(step.respawn_delay, "ns"),
            "environment": dict(step.environment),
            "directory": step.directory,
            "user": step.user,
            "needs_rights": list(step.needs_rights),
        }
    )


def _record_wait(named: NamedWait) -> dict[str, object]:
    return {
        "for": named.awaited,
        "until": named.until,
        "because": [
            drop_unknown({"reason": wait.reason, "ports": [list(pair) for pair in wait.ports]}) for wait in named.waits
        ],
    }


def _record_dropped(dropped: DroppedWait) -> dict[str, object]:
    wait = dropped.wait
    return drop_unknown(
        {
            "step": wait.waiting,
            "awaited": wait.awaited,
            "reason": wait.reason,
            "ports": [list(pair) for pair in wait.ports],
            "circle": list(dropped.circle),
        }
    )
