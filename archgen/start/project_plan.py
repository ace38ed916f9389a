"""Decide which files a new project gets, where they go, and which of them exist already."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from archgen import pipeline
from archgen.checking import code_ownership
from archgen.emit.codeowners_file import CODEOWNERS_PATHS
from archgen.pipeline import CheckedProject
from archgen.products import editor_schema_file, editor_schema_marks
from archgen.project import PROJECT_FILE
from archgen.project.project_loading import load_from_files
from archgen.start import start_templates
from archgen.start.start_answers import StartAnswers
from archgen.syntax import file_patterns
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.overlaid_files import OverlaidFiles


@dataclass(frozen=True, slots=True)
class ProjectPlan:
    """Files to write (by absolute path), files kept because they exist, and the folder that holds all of them: the
    repository's.
    """

    files: Mapping[Path, bytes]
    existing_files: tuple[Path, ...]
    repository_folder: Path
    reviewers_missing: bool


def has_other_yaml(folder: Path) -> bool:
    """Return whether there are YAML files below that are not slices of this project: it then has to name its own."""
    return bool(file_patterns.list_yaml_files(FolderFiles(folder)))


def judge_files(files: Mapping[str, bytes], name: str) -> CheckedProject:
    """Check the files of a project before they are written."""
    return pipeline.judge_project(load_from_files(OverlaidFiles(Path(name), files), PROJECT_FILE))


def plan_files(
    folder: Path, answers: StartAnswers, yaml_files: Mapping[str, bytes], checked_project: CheckedProject
) -> ProjectPlan:
    """Put the files together: the project's in its folder, what the forge reads at the top of the repository."""
    # Resolved, so that it can be relative to the repository's folder even through a symbolic link.
    target = Path(os.path.realpath(folder))
    repository_folder = _find_repository(target) or target
    prefix = "" if target == repository_folder else target.relative_to(repository_folder).as_posix()
    wanted_files = {
        target / name: data for name, data in {**yaml_files, **_project_files(answers, checked_project)}.items()
    }
    wanted_files |= {
        repository_folder / name: data for name, data in _forge_files(answers, prefix, repository_folder).items()
    }
    reviewers_missing = bool(answers.partners) and not any(partner.reviewers for partner in answers.partners)
    if any(partner.reviewers for partner in answers.partners):
        # Without a forge any of them may be meant.
        possible_paths = CODEOWNERS_PATHS.get(answers.forge) or dict.fromkeys(chain(*CODEOWNERS_PATHS.values()))
        codeowners_path = next(
            (name for name in possible_paths if os.path.lexists(repository_folder / name)), "CODEOWNERS"
        )
        wanted_files[repository_folder / codeowners_path] = code_ownership.make_codeowners(
            checked_project, prefix
        ).text.encode()
    # `lexists`: a broken symbolic link is kept as well.
    existing_files = tuple(path for path in wanted_files if os.path.lexists(path))
    return ProjectPlan(
        {path: data for path, data in wanted_files.items() if path not in existing_files},
        existing_files,
        repository_folder,
        reviewers_missing,
    )


def _project_files(answers: StartAnswers, checked_project: CheckedProject) -> dict[str, bytes]:
    return {
        editor_schema_marks.SCHEMA_FILE: editor_schema_file.render_schema(checked_project),
        ".vscode/settings.json": start_templates.read_plain_file("vscode/settings.json"),
        ".vscode/extensions.json": start_templates.read_plain_file("vscode/extensions.json"),
        ".gitignore": start_templates.read_plain_file("gitignore"),
        ".gitattributes": start_templates.read_plain_file("gitattributes"),
        "README.md": start_templates.fill_readme(answers),
    }


def _forge_files(answers: StartAnswers, project_path: str, repository_folder: Path) -> dict[str, bytes]:
    if answers.forge == "github":
        folder, name = ".github/workflows", "architecture.yml"
        # The workflow of another project, which never checks this one.
        is_taken = bool(project_path) and os.path.lexists(repository_folder / folder / name)
        if is_taken:
            name = f"architecture-{start_templates.make_project_slug(project_path) or 'project'}.yml"
        return {
            f"{folder}/{name}": start_templates.fill_workflow(project_path, publishes=not is_taken),
            f"{folder}/{name.replace('architecture', 'open-requests', 1)}": start_templates.fill_nightly_workflow(
                project_path
            ),
        }
    return {".gitlab-ci.yml": start_templates.fill_pipeline(project_path)} if answers.forge == "gitlab" else {}


def _find_repository(folder: Path) -> Path | None:
    """Return the top of the git repository around a folder, by its `.git`; git itself is not called."""
    return next((ancestor for ancestor in (folder, *folder.parents) if os.path.lexists(ancestor / ".git")), None)
