"""Decide which files a new project gets, where they go, and which of them exist already."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from archgen import ownership, pipeline
from archgen.pipeline import Checked
from archgen.project import MARKER
from archgen.project.loaded import load_from
from archgen.start import templates
from archgen.start.answers import Answers
from archgen.syntax import globs
from archgen.syntax.folder import Folder
from archgen.syntax.overlay import Overlay

_OWNERS = ("CODEOWNERS", ".github/CODEOWNERS", "docs/CODEOWNERS", ".gitlab/CODEOWNERS")
"""Where GitHub and GitLab look for the file; the first that exists counts."""


@dataclass(frozen=True, slots=True)
class Plan:
    """Files to write (by absolute path), files kept because they exist, and the folder that holds all of them: the
    repository's.
    """

    files: Mapping[Path, bytes]
    kept: tuple[Path, ...]
    top: Path
    reviewers_missing: bool


def other_yaml(folder: Path) -> bool:
    """Return whether there are YAML files below that are not slices of this project: it then has to name its own."""
    return bool(globs.expand(Folder(folder), "**/*.yaml"))


def judge(files: Mapping[str, bytes], name: str) -> Checked:
    """Check the files of a project before they are written."""
    return pipeline.judge(load_from(Overlay(Path(name), files), MARKER))


def plan(folder: Path, answers: Answers, yaml_files: Mapping[str, bytes], checked: Checked) -> Plan:
    """Put the files together: the project's in its folder, what the forge reads at the top of the repository."""
    # Resolved, so that it can be relative to the repository's folder even through a symbolic link.
    target = Path(os.path.realpath(folder))
    top = _repository(target) or target
    prefix = "" if target == top else target.relative_to(top).as_posix()
    wanted = {target / name: data for name, data in {**yaml_files, **_beside(answers)}.items()}
    wanted |= {top / name: data for name, data in _forge(answers, prefix).items()}
    reviewers_missing = bool(answers.partners) and not any(partner.reviewers for partner in answers.partners)
    if any(partner.reviewers for partner in answers.partners):
        there = next((name for name in _OWNERS if os.path.lexists(top / name)), "CODEOWNERS")
        wanted[top / there] = ownership.codeowners(checked, prefix).text.encode()
    # `lexists`: a broken symbolic link is kept as well.
    kept = tuple(path for path in wanted if os.path.lexists(path))
    return Plan({path: data for path, data in wanted.items() if path not in kept}, kept, top, reviewers_missing)


def _beside(answers: Answers) -> dict[str, bytes]:
    return {
        templates.SCHEMA: templates.schema(),
        ".vscode/settings.json": templates.plain("vscode/settings.json"),
        ".vscode/extensions.json": templates.plain("vscode/extensions.json"),
        ".gitignore": templates.plain("gitignore"),
        ".gitattributes": templates.plain("gitattributes"),
        "README.md": templates.readme(answers),
    }


def _forge(answers: Answers, inner: str) -> dict[str, bytes]:
    if answers.forge == "github":
        return {".github/workflows/architecture.yml": templates.workflow(inner)}
    return {".gitlab-ci.yml": templates.pipeline(inner)} if answers.forge == "gitlab" else {}


def _repository(folder: Path) -> Path | None:
    """Return the top of the git repository around a folder, by its `.git`; git itself is not called."""
    return next((above for above in (folder, *folder.parents) if os.path.lexists(above / ".git")), None)
