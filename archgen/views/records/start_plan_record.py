"""The plan of a start-up as data for other programs: schemas/start.schema.json describes it."""

from __future__ import annotations

from collections.abc import Collection

from archgen.bringup.plan_shapes import DroppedWait, RosLaunch, StartPlan, StartStep
from archgen.model.architecture import Architecture
from archgen.model.node import PHASES
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.records.record_sources import drop_unknown, record_quantity, to_plain
from archgen.views.records.resolved_record import write_record
from archgen.views.start_phrases import NamedWait, name_waits

VERSION = 1
"""The version of the format. It changes where a key goes, or means something else."""


def record_plan(
    architecture: Architecture, plan: StartPlan, shown_ids: Collection[str] | None = None
) -> dict[str, object]:
    """Return a plan as plain data: all steps, or those shown with their numbers in the whole plan. Durations are in ns."""
    lookup = make_lookup(architecture)
    return {
        "version": VERSION,
        "project": architecture.project.id,
        "phases": list(PHASES),
        "steps": [
            {"number": number, **_record_step(step, lookup)}
            for number, step in enumerate(plan.steps, start=1)
            if shown_ids is None or step.id in shown_ids
        ],
        "given_up": [_record_dropped(each) for each in plan.dropped],
        "contradictions": [_record_dropped(each) for each in plan.circles],
    }


def _record_step(step: StartStep, lookup: Lookup) -> dict[str, object]:
    return drop_unknown(
        {
            "id": step.id,
            "title": step.title,
            "kind": step.kind,
            "phase": step.phase,
            "host": step.host,
            "container": step.container,
            "status": step.status,
            "preparations": [list(words) for words in step.preparations],
            "command": list(step.command),
            "ros": _record_launch(step.ros) if step.ros else None,
            "log_file": step.log_file,
            "waits": [_record_wait(wait) for wait in name_waits(step)],
            "ready": write_record("start_ready", step.ready, lookup),
            "seconds_at_most": step.seconds_at_most,
            "once": step.once or None,
            "state": step.state,
            "transitions": [list(words) for words in step.transitions],
            "managers": list(step.manager),
            "respawn": step.respawn or None,
            "respawn_delay": record_quantity(step.respawn_delay, "ns"),
            "environment": dict(step.environment),
            "directory": step.directory,
            "user": step.user,
            "priority": step.scheduling.priority,
            "cores": list(step.scheduling.cores),
            "needs_rights": list(step.needs_rights),
        }
    )


def _record_launch(launch: RosLaunch) -> dict[str, object]:
    return drop_unknown(
        {
            "name": launch.name,
            "namespace": launch.namespace,
            "package": launch.package,
            "executable": launch.executable,
            "plugin": launch.plugin,
            "container": launch.container,
            "earlier_values": to_plain(launch.earlier_values),
            "parameter_files": list(launch.parameter_files),
            "own_values": to_plain(launch.own_values),
            "value_commands": {name: list(words) for name, words in launch.value_commands.items()},
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
