"""What rests on a partner, and what he has to do, for programs: version 1. Durations are in ms, elements are named by their ids."""

from __future__ import annotations

from typing import Any

from archgen.emit.data.timing_json import duration_to_json
from archgen.views.reliance.partner_impact import PartnerImpact
from archgen.views.reliance.partner_tasks import PartnerTasks, PlannedNode, Task

VERSION = 1
JsonObject = dict[str, Any]


def impact_to_json(impact: PartnerImpact) -> JsonObject:
    """Return what rests on a partner or on components as plain data."""
    late = impact.late
    return {
        "version": VERSION,
        "partner": late.partner.id if late.partner else None,
        "components": sorted(late.components),
        "chains": [
            {
                "id": each.result.id,
                "own_steps": each.own_steps,
                "steps": len(each.result.terms),
                "own_time": duration_to_json(each.own_time),
                "deadline": duration_to_json(each.result.deadline) if each.result.deadline else None,
                "verdict": each.result.verdict,
            }
            for each in impact.chains
        ],
        "untouched_chains": list(impact.free_chains),
        "use_cases": [{"id": each.id, "steps": list(each.steps), "stops_at": each.stop} for each in impact.use_cases],
        "requirements": [
            {"id": each.requirement.id, "others": [other.id for other in each.others]} for each in impact.requirements
        ],
        "interfaces": [
            {
                "id": each.terms[0].interface.key,
                "takers": list(each.takers),
                "topics": list(each.terms[0].interface.topic_names),
                "chains": list(each.chains),
                "use_case_steps": each.use_case_steps,
                "readers": list(each.readers),
                "open": list(each.open_words),
                "stand_in": each.stand_in,
            }
            for each in impact.interfaces
        ],
        "enough_stand_ins": impact.enough,
        "waiting": [
            {"partner": each.id, "flows": each.flow_count, "components_without": list(each.free_components)}
            for each in impact.waiting
        ],
        "waits_for": dict(impact.awaited),
        "readers": list(impact.readers),
        "reached": impact.reached,
        "until": impact.until,
        "milestones": [
            {"id": each.milestone.id, "date": each.milestone.date, "components": list(each.components)}
            for each in impact.milestones
        ],
    }


def tasks_to_json(tasks: PartnerTasks) -> JsonObject:
    """Return what a partner has to do as plain data; `changes` are null where the project was compared with nothing."""
    return {
        "version": VERSION,
        "partner": tasks.impact.late.owners[0],
        "tasks": [
            {
                "kind": task.kind,
                "text": task.text,
                **_waiting_to_json(task),
                "file": task.place.file or None,
                "line": task.place.line if task.place.file else None,
                "severity": str(task.finding.effective_severity) if task.finding else None,
                "rule": task.finding.rule if task.finding else None,
            }
            for task in tasks.tasks
        ],
        "waits_for": [
            {"partner": each.interface.pair[0], "interface": each.interface.key, "open": list(each.open_terms)}
            for each in tasks.awaited
        ],
        "planned_nodes": [{"id": each.node.id, **_waiting_to_json(each)} for each in tasks.planned],
        "changes": None if tasks.changes is None else list(tasks.changes),
    }


def _waiting_to_json(waiting: Task | PlannedNode) -> JsonObject:
    return {
        "chains": list(waiting.chains),
        "requirements": list(waiting.requirements),
        "partners": list(waiting.partners),
    }
