"""Render the findings of a check in the formats that programs and servers read."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import __version__

if TYPE_CHECKING:
    from archgen.pipeline import Checked
    from archgen.reported import Reported

FORMATS = ("json", "github", "sarif", "junit")


def document(form: str, found: Reported, checked: Checked, *, strict: bool = False) -> str:
    """Render findings as json, GitHub's commands, sarif or junit. With `strict`, warnings are failures too."""
    from archgen.findings import github, json, junit, sarif
    from archgen.project import MARKER
    from archgen.reported import RULES

    folder = in_repository(checked.root)
    if form == "json":
        return json.render(found.findings)
    if form == "github":
        return "".join(f"{line}\n" for line in github.render(found.findings, folder=folder))
    if form == "junit":
        lines = junit.render(found.findings, checked.sources, checked.all_files, strict=strict)
        return "".join(f"{line}\n" for line in lines)
    file = checked.files[0] if checked.files else MARKER
    scan = sarif.Scan(checked.architecture.project.id, file, folder, __version__, compared=found.compared)
    return sarif.render(found.findings, RULES, scan)


def in_repository(root: Path) -> str:
    """Return a project's folder relative to the repository's root, from which servers name files.

    On GitHub that is the workspace; elsewhere the folder that has `.git`, or else the current one. Outside of it: "".
    """
    resolved = root.resolve()
    workspace = os.environ.get("GITHUB_WORKSPACE")
    # lexists: in a worktree or submodule `.git` is a file.
    above = (folder for folder in (resolved, *resolved.parents) if os.path.lexists(folder / ".git"))
    top = Path(workspace).resolve() if workspace else next(above, Path.cwd().resolve())
    return resolved.relative_to(top).as_posix() if resolved.is_relative_to(top) else ""
