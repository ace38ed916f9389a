"""The view `plan`: the start-up as generators write it, computer by computer; all of it is from the one plan."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from archgen.plugin.generating import GeneratedView, GenerationContext, write_place
from archgen.plugin.model import PHASES, Architecture
from archgen.plugin.starting import StartPlan, describe_dropped, find_wanted_steps, make_start_plan
from archgen.plugins.start_scripts.start_hints import find_unread_hints, read_hint
from archgen.plugins.start_scripts.start_jobs import list_jobs, list_phase_needs, list_seen_signs
from archgen.plugins.start_scripts.start_step_record import UNPLACED, record_step


def make_view(context: GenerationContext) -> GeneratedView:
    """Make the steps of each computer, in the order of the plan, with what they wait for on other ones."""
    architecture = context.architecture
    plan = make_start_plan(architecture)
    names = {step.id: step.file_name for step in plan.steps}
    records = {
        step.id: record_step(step, number, names, architecture, context.ros_generation)
        for number, step in enumerate(plan.steps, start=1)
    }
    wanted_ids = find_wanted_steps(plan, context)
    wanted_hosts = dict.fromkeys(step.host for step in plan.steps if step.id in wanted_ids)
    steps = {step.id: step for step in plan.steps}
    folder = str(context.options.get("folder") or "") or f"/opt/{architecture.project.id}"
    hosts = [_record_host(architecture, host, plan, records, wanted_ids) for host in wanted_hosts]
    for record in hosts:
        record["file_name"] = f"{record['name']}.{context.part}" if context.part else record["name"]
    return GeneratedView(
        {
            "project": {"id": architecture.project.id, "title": architecture.project.title},
            "ros": context.ros_generation,
            "is_whole": context.is_whole,
            "prefix": f"{architecture.project.id}.{context.part}" if context.part else architecture.project.id,
            "folder": folder.rstrip("/"),
            "image": str(context.options.get("image") or ""),
            "phases": [phase for phase, _ in plan.phases],
            "hosts": hosts,
            # The file of settings is one for all parts.
            "computers": list(dict.fromkeys(step.host or UNPLACED for step in plan.steps)),
            "jobs": [job for host in hosts for job in host["jobs"]],
            "targets": [
                {"host": host["name"], "phase": phase, "phase_before": before, "needs": needs}
                for host in hosts
                for (phase, needs), before in zip(host["ends"].items(), [None, *host["ends"]], strict=False)
            ],
            "steps": [records[step.id] for step in plan.steps if step.id in wanted_ids],
            "given_up": [describe_dropped(each, steps) for each in plan.dropped if each.wait.waiting in wanted_ids],
        },
        tuple(find_unread_hints(architecture)),
    )


def _record_host(
    architecture: Architecture,
    host: str | None,
    plan: StartPlan,
    records: Mapping[str, dict[str, Any]],
    wanted_ids: Collection[str],
) -> dict[str, Any]:
    """Return a computer with its steps, and among them those of others for which they wait."""
    own_steps = [step for step in plan.steps if step.host == host and step.id in wanted_ids]
    own_ids = {step.id for step in own_steps}
    awaited_ids = {each.awaited for step in own_steps for each in step.awaited}
    last_phase = max(PHASES.index(step.phase) for step in own_steps)
    shown_steps = [
        step
        for step in plan.steps
        if step.id in own_ids or step.id in awaited_ids or PHASES.index(step.phase) < last_phase
    ]
    element = architecture.hosts.get(host or "")
    record: dict[str, Any] = {
        "name": host or UNPLACED,
        "place": write_place(element.at) if element else "",
        "title": element.title if element else "Computer of what has no host",
        "address": (read_hint(element.annotations, "address") if element else "") or host or "localhost",
        "phases": list(dict.fromkeys(step.phase for step in shown_steps)),
        "steps": [
            {
                **records[step.id],
                "is_own": step.id in own_ids,
                "is_here": step.host == host,
                "is_by_others": step.id not in wanted_ids,
            }
            for step in shown_steps
        ],
        "others": [
            {
                "name": record["host"],
                "address": "localhost" if record["host"] == (host or UNPLACED) else record["address"],
            }
            for record in {
                records[step.id]["host"]: records[step.id] for step in shown_steps if step.id not in own_ids
            }.values()
        ],
    }
    for step in record["steps"]:
        step["seen_signs"] = list_seen_signs(step)
    record["ends"] = list_phase_needs(record)
    return {**record, "jobs": list_jobs(record)}
