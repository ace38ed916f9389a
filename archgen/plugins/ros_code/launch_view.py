"""The views `ros1_launch` and `ros2_launch`: launch files for each computer, in the order of the one plan of the start-up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from archgen.plugin.findings import NO_SPAN, Diagnostic
from archgen.plugin.generating import (
    GeneratedView,
    GenerationContext,
    ProgramNames,
    make_ros_name,
    tell_left_out,
    write_place,
)
from archgen.plugin.ros import is_ros_1
from archgen.plugin.starting import (
    SCHEDULING_SCRIPT,
    StartStep,
    find_network_variables,
    find_wanted_steps,
    make_start_plan,
    record_dds_profile,
)
from archgen.plugins.ros_code.launch_entries import record_container_entry, record_node_entry
from archgen.plugins.ros_code.package_facts import RosdepKeys, record_package_facts

_UNPLACED = "no-host"
"""What the computer of steps without a host is called: no id has a hyphen."""


def make_ros1_view(context: GenerationContext) -> GeneratedView:
    """Make the launch files for ROS 1."""
    return make_view(context, ros=1)


def make_ros2_view(context: GenerationContext) -> GeneratedView:
    """Make the launch files for ROS 2."""
    return make_view(context, ros=2)


def make_view(context: GenerationContext, ros: int) -> GeneratedView:
    """Make the launch files of each computer, for ROS 1 or ROS 2."""
    architecture = context.architecture
    package = make_ros_name(f"{architecture.project.id}_bringup")
    facts = {**record_package_facts(context), "name": package}
    data: dict[str, Any] = {
        "project": {"id": architecture.project.id, "title": architecture.project.title},
        "is_whole": context.is_whole,
    }
    if is_ros_1(architecture.distro) != (ros == 1):
        other = f"ros{3 - ros}_launch"
        finding = tell_left_out(
            f"the project is made for ROS {3 - ros}: there is nothing to launch in ROS {ros}",
            NO_SPAN,
            help_line=f"`archgen generate {other}`, or another `distro` below `ros`",
        )
        return GeneratedView({**data, "hosts": [], "packages": [], "parameter_files": []}, (finding,))
    plan = make_start_plan(architecture)
    program_names = ProgramNames(architecture, ros)
    wanted_ids = find_wanted_steps(plan, context)
    findings: list[Diagnostic] = []
    entries: dict[str, dict[str, Any]] = {}
    for step in plan.steps:
        if step.kind == "container":
            entry, entry_findings = record_container_entry(architecture, step, ros)
        else:
            managed = [each for each in plan.steps if step.id in each.manager]
            entry, entry_findings = record_node_entry(architecture, step, program_names, managed, ros)
        entries[step.id] = entry
        findings += entry_findings if step.id in wanted_ids else ()
    hosts: list[dict[str, Any]] = []
    for host in dict.fromkeys(step.host for step in plan.steps if step.id in wanted_ids):
        steps = [step for step in plan.steps if step.host == host and step.id in wanted_ids]
        hosts.append(_record_host(context, host, steps, [entries[step.id] for step in steps], ros))
    written = [
        {**each, "package": package, "place": entry["place"]}
        for host in hosts
        for entry in host["entries"]
        for each in entry["written"]
    ]
    # The package is that of all parts: each of them may be generated into it alone.
    has_states = any(step.transitions and step.ros for step in plan.steps)
    keys = RosdepKeys(architecture)
    findings += keys.findings
    all_entries = list(entries.values())
    package_record = {**facts, **_list_dependencies(all_entries, package, keys, ros, has_states=has_states)}
    packages = [package_record] if hosts else []
    return GeneratedView({**data, "hosts": hosts, "packages": packages, "parameter_files": written}, tuple(findings))


_OWN_ARGUMENTS = frozenset({"prefix", "scheduling"})
"""Arguments of launch files that no host may take."""


def _record_host(
    context: GenerationContext, host: str | None, steps: list[StartStep], entries: list[dict[str, Any]], ros: int
) -> dict[str, Any]:
    element = context.architecture.hosts.get(host or "")
    name = host or _UNPLACED
    network = find_network_variables(steps) if ros != 1 else {}
    if network:
        # The file sets them for all that it starts.
        entries = [
            {**each, "environment": [own for own in each["environment"] if network.get(own["name"]) != own["value"]]}
            for each in entries
        ]
    times = [each["simulated_time"] for each in entries if each["simulated_time"] is not None]
    return {
        "name": name,
        "file_name": f"{name}.{context.part}" if context.part else name,
        "argument": f"host_{name}" if name in _OWN_ARGUMENTS else make_ros_name(name),
        "title": element.title if element else "what has no host",
        "place": write_place(element.at) if element else "",
        "package": make_ros_name(f"{context.architecture.project.id}_bringup"),
        "network": [{"name": name, "value": value} for name, value in network.items()],
        "dds_profile": record_dds_profile(context.architecture, host),
        "entries": entries,
        "phases": _group_by_phase(entries, ros),
        "simulated_time": times[0] if times else None,
        "schedulings": _list_schedulings(entries),
        "scheduling_script": SCHEDULING_SCRIPT,
        "states": [
            {"node": step.ros.full_name, "transitions": [words[-1] for words in step.transitions]}
            for step in steps
            if step.transitions and step.ros
        ],
    }


def _list_schedulings(entries: list[dict[str, Any]]) -> list[dict[str, str]]:
    """Return the priorities and choices of cores that processes are started with, each once."""
    started = [each["scheduling"] for each in entries if each["form"] not in {"nobody", "loaded"}]
    named = {each["name"]: each for each in started if each["words"]}
    return [named[name] for name in sorted(named)]


def _group_by_phase(entries: list[dict[str, Any]], ros: int) -> list[dict[str, Any]]:
    """Return the blocks of each phase: an entry, or what stands together in one tag, since a container loads it."""
    phases: list[dict[str, Any]] = []
    for entry in entries:
        if not phases or phases[-1]["name"] != entry["phase"]:
            phases.append({"name": entry["phase"], "blocks": []})
        blocks = phases[-1]["blocks"]
        last = blocks[-1] if blocks else None
        if entry["form"] == "loaded" and last is not None and last["target"] == entry["container"]:
            last["loaded"].append(entry)
        elif entry["form"] == "loaded":
            blocks.append({"kind": "load", "target": entry["container"], "entry": None, "loaded": [entry]})
        else:
            # In ROS 1 each nodelet is a node that asks the manager by itself.
            target = entry["full_name"] if entry["form"] == "container" and ros != 1 else None
            blocks.append({"kind": entry["form"], "target": target, "entry": entry, "loaded": []})
    return phases


def _list_dependencies(
    all_entries: list[dict[str, Any]], own_package: str, keys: RosdepKeys, ros: int, *, has_states: bool
) -> dict[str, Any]:
    """Return what the package of the launch files needs, and what else stands in it."""
    entries = [entry for entry in all_entries if entry["form"] != "nobody"]
    used = {entry["package"] for entry in entries if entry["package"]}
    used |= {file["package"] for entry in entries for file in entry["files"] if file["package"]}
    used |= {
        part["package"] for entry in entries for each in entry["filled"] for part in each["parts"] if part["package"]
    }
    has_programs = any(entry["form"] == "program" for entry in entries)
    return {
        "rosdep_keys": keys.list_keys(used - {own_package}, (entry["element"] for entry in entries)),
        "has_parameters": any(entry["written"] for entry in entries),
        "has_programs": has_programs,
        "has_states": has_states,
        "scripts": [
            name
            for name, is_needed in (
                ("run_program", ros == 1 and has_programs),
                (SCHEDULING_SCRIPT, _list_schedulings(all_entries)),
                ("set_states", ros != 1 and has_states),
            )
            if is_needed
        ],
        "scheduling_script": SCHEDULING_SCRIPT,
        "scheduling_script_text": Path(__file__).with_name("scheduling_script.sh").read_text(encoding="utf-8"),
        "not_started": [entry["step"] for entry in all_entries if entry["form"] == "nobody"],
    }
