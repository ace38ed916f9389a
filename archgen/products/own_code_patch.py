"""A patch for code of the user's own: what still has an old name gets the one that most likely took its place."""

from __future__ import annotations

import contextlib

from archgen.edit.element_edit import FileEdit
from archgen.emit.workspace.disk_files import DiskReader
from archgen.emit.workspace.own_code import CodeFinding, rename_likely
from archgen.products.workspace_product import WorkspaceResult


def plan_renames(result: WorkspaceResult) -> tuple[FileEdit, ...]:
    """Return the edits that give own code the names that most likely took the place of those that it still uses."""
    findings: dict[str, list[CodeFinding]] = {}
    for step in result.plan.steps if result.plan else ():
        for finding in step.findings:
            if finding.new_name:
                findings.setdefault(finding.path or step.path, []).append(finding)
    edits: list[FileEdit] = []
    for path, its_findings in sorted(findings.items()):
        old = DiskReader(result.folder).read_data(path)
        new = rename_likely(path, old, its_findings)
        with contextlib.suppress(UnicodeDecodeError):  # a patch is text
            new.decode()
            if new != old:
                edits.append(FileEdit(path, old, new, its_findings[0].line))
    return tuple(edits)
