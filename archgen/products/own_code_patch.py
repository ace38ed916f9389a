"""A patch for code of the user's own: what still has an old name gets the one that most likely took its place."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable

from archgen.edit.element_edit import FileEdit
from archgen.emit.workspace.disk_files import DiskReader
from archgen.emit.workspace.own_code import CodeFinding
from archgen.products.workspace_product import WorkspaceResult

_DOTTED_WORD = re.compile(rb"(?:[A-Za-z0-9_]+\.)*(?P<last>[A-Za-z0-9_]+)")
_CODE_WORDS = re.compile(rb"//[^\n]*|/\*(?:[^*]|\*(?!/))*\*/|\"(?:[^\"\\\n]|\\.)*\"|[A-Za-z_][A-Za-z0-9_]*")
"""Comments, texts and words of C++ and its like."""


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


def rename_likely(path: str, data: bytes, findings: Iterable[CodeFinding]) -> bytes:
    """Return a file in which what findings tell of a likely new name has that name.

    In Python each of them names its place; other code is only known by its words, and each of these is renamed.
    """
    renames = [each for each in findings if each.new_name]
    if not path.endswith(".py"):
        names = {each.old_name.encode(): each.new_name.encode() for each in renames}
        return _CODE_WORDS.sub(lambda found: names.get(found[0], found[0]), data)
    starts = [0, *(found.end() for found in re.finditer(rb"\n", data))]
    # From the end, so that places before it stay what they are.
    for each in sorted(renames, key=lambda each: (-each.line, -each.column)):
        begin = starts[each.line - 1] + each.column - 1
        old_name = each.old_name.encode()
        # A parameter may have dots in its name: `arm.speed`.
        found = next((word for word in _DOTTED_WORD.finditer(data, begin) if old_name in {word[0], word["last"]}), None)
        if found and found[0] != old_name:
            data = data[: found.start("last")] + each.new_name.encode() + data[found.end() :]
        elif found:
            data = data[: found.start()] + each.new_name.encode() + data[found.end() :]
    return data
