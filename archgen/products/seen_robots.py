"""What a project keeps of robots that it was compared with, for those who show it: nothing is compared."""

from __future__ import annotations

from archgen.conformance.seen_record import RECORD_FILE, SeenRecordError, SeenRobot, list_seen_components, read_record
from archgen.pipeline import CheckedProject
from archgen.syntax.project_files import read_text_file


def read_seen_robots(checked_project: CheckedProject) -> tuple[tuple[SeenRobot, ...], str]:
    """Return what the project keeps of comparisons with robots, and why that cannot be read, where it cannot."""
    files = checked_project.loaded_project.files
    if not files.has_path(RECORD_FILE):
        return (), ""
    record = read_text_file(files, RECORD_FILE)
    try:
        return read_record(record.text), ""
    except SeenRecordError as error:
        reason = record.problem.message if record.problem is not None else str(error)
        return (), f"`{RECORD_FILE}` cannot be read: {reason}; move it away, and run `archgen conform --keep` again"


def find_seen_components(checked_project: CheckedProject) -> frozenset[str] | None:
    """Return the components that were seen whole on a robot that ran; None where nobody looked at one."""
    robots, _ = read_seen_robots(checked_project)
    is_told = any(each.kind != "workspace" for each in robots)
    return list_seen_components(checked_project.architecture, robots) if is_told else None
