"""Recordings of a small robot as text: each test writes the lines that it is about."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.importers.foreign_import import ReadRecordings
from archgen.plugins.recordings.recorded_names import RecordedNames
from archgen.plugins.recordings.recording_import import read_recordings
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.measured_project import PROJECT

_NAMES = {"1": "/front scan", "2": "/ plan", "3": "/ drive", "4": "/ maps"}


def event(time: float, name: str, process: str, fields: str, thread: str = "") -> str:
    """Write an event at so many ms after noon."""
    clock = f"12:00:{time // 1000:02.0f}.{time % 1000 * 10**6:09.0f}"
    context = f'{{ vpid = {process}, vtid = {thread or process}, procname = "p{process}" }}'
    return f"[{clock}] (+0.000000001) robot ros2:{name}: {{ cpu_id = 0 }}, {context}, {{ {fields} }}\n"


def node(process: str) -> str:
    """Write that a node begins: 1 is `/front/scan`, 2 `/plan`, 3 `/drive`, 4 `/maps`."""
    namespace, name = _NAMES[process].split()
    fields = f'node_handle = 0xA, rmw_handle = 0xB, node_name = "{name}", namespace = "{namespace}"'
    return event(0, "rcl_node_init", process, fields)


def timer(process: str, callback: str, period: float) -> str:
    """Write that a node has a timer of so many ms."""
    handle = f"timer_handle = 0xF{callback}"
    return (
        event(0, "rcl_timer_init", process, f"{handle}, period = {round(period * 10**6)}")
        + event(0, "rclcpp_timer_callback_added", process, f"{handle}, callback = {callback}")
        + event(0, "rclcpp_timer_link_node", process, f"{handle}, node_handle = 0xA")
    )


def subscription(process: str, callback: str, topic: str) -> str:
    """Write that a node subscribes to a topic."""
    handle, reader = f"subscription_handle = 0xC{callback}", f"subscription = 0xD{callback}"
    fields = f'{handle}, node_handle = 0xA, rmw_subscription_handle = 0x9, topic_name = "{topic}", queue_depth = 1'
    return (
        event(0, "rcl_subscription_init", process, fields)
        + event(0, "rclcpp_subscription_init", process, f"{handle}, {reader}")
        + event(0, "rclcpp_subscription_callback_added", process, f"{reader}, callback = {callback}")
    )


def run(process: str, callback: str, start: float, end: float) -> str:
    """Write a run of a callback, from and to so many ms."""
    return begin(process, callback, start) + finish(process, callback, end)


def begin(process: str, callback: str, time: float, thread: str = "") -> str:
    """Write that a callback begins."""
    return event(time, "callback_start", process, f"callback = {callback}, is_intra_process = 0", thread)


def finish(process: str, callback: str, time: float, thread: str = "") -> str:
    """Write that a callback ends."""
    return event(time, "callback_end", process, f"callback = {callback}", thread)


def make_names(folder: Path) -> RecordedNames:
    """Return what names mean in the small robot."""
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    checked_project = pipeline.check_project(folder)
    assert not checked_project.has_errors, checked_project.findings
    analysis = analyse_architecture(checked_project.architecture)
    chains = bound_all_chains(analysis, checked_project.architecture)
    return RecordedNames(checked_project.architecture, analysis.system, chains)


def read(folder: Path, *texts: str, name: str = "recording") -> ReadRecordings:
    """Read recordings of the small robot."""
    paths = []
    for number, text in enumerate(texts):
        paths.append(folder / f"{name}{number}")
        paths[-1].write_text(text, encoding="utf-8")
    return read_recordings(paths, make_names(folder))


def list_figures(recordings: ReadRecordings) -> list[str]:
    """Return what was measured, one line for each element."""
    return [
        f"{o.id}: {', '.join(f'{key} {quantity}' for key, quantity in o.figures.items())}"
        for o in recordings.observations
    ]


def list_problems(recordings: ReadRecordings) -> list[str]:
    """Return what is odd, with its line and severity."""
    return [f"{d.span.line} {d.severity}: {d.message}" for d in recordings.diagnostics]


def list_unmapped(recordings: ReadRecordings) -> list[str]:
    """Return what has no place in the design."""
    return [f"{samples.name} ({samples.count}): {samples.why}" for samples in recordings.unmapped]
