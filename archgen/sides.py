"""Versions of a project to compare, as users type them: revisions, folders, files, the working tree."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from archgen import git, pipeline, project
from archgen.compare import Comparison, Version, compare
from archgen.pipeline import Checked
from archgen.project import Slices
from archgen.syntax.tree import Table

_AS_PATHS = ("./", "../", "/", "~")
WORKING_TREE = "the working tree"


@dataclass(frozen=True, slots=True)
class Side:
    """A checked project, and its name as the user typed it."""

    name: str
    checked: Checked

    @property
    def commit(self) -> str:
        """Return the full hash of the commit that it was read from, empty for files on disk."""
        return self.checked.loaded.files.commit


def sides(first: str | None, second: str | None, path: Path | None = None) -> tuple[Side, Side]:
    """Read the two versions to compare. `path` is the project, as for `pipeline.check`.

    Without `second` it is the working tree; without `first` it is the commit at which the branch left its main line.
    `A..B` and `A...B` mean what they mean in git. Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    # Parsed slices are shared: most files are the same in both versions.
    known: Slices = {}
    if first is not None and second is None and ".." in first and not _is_path(first):
        # Three dots first, since they contain the two.
        left, dots, right = first.partition("..." if "..." in first else "..")
        if dots == "...":
            before = _side_at(_fork(left or "HEAD", right or "HEAD", path), path, known)
            return before, side(right or "HEAD", path, known)
        return side(left or "HEAD", path, known), side(right or "HEAD", path, known)
    if first is not None:
        return side(first, path, known), side(second, path, known)
    # The newer version first here: it names the main line that the older one is found by.
    after = side(second, path, known)
    return left_main_line(path, after.checked.architecture.review.main, known), after


def side(words: str | None, path: Path | None = None, known: Slices | None = None) -> Side:
    """Read one version: nothing or `.` is the working tree; what may be a revision or a path is taken as a revision.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    if words in {None, "", "."}:
        return Side(WORKING_TREE, pipeline.check(path, known))
    if not _is_path(words):
        try:
            return Side(words, pipeline.check_at(path, words, known))
        # The revision exists and lacks the project: falling back to a path of that name would hide this mistake.
        except project.NotAtRevisionError:
            raise
        except (git.GitError, project.ProjectNotFoundError):
            # Neither revision nor path: the message about the revision is the more useful one.
            if not os.path.lexists(words):
                raise
    return Side(words, pipeline.check(Path(words), known))


def left_main_line(path: Path | None = None, main: str | None = None, known: Slices | None = None) -> Side:
    """Read the project where the branch left its main line.

    `main_line` is the main line that the project names; None asks git.
    """
    return _side_at(git.base(project.tracked(path).objects.repository, main), path, known)


def _side_at(base: git.Base, path: Path | None, known: Slices | None) -> Side:
    """Read the project at a commit of git."""
    return Side(base.name, pipeline.check_at(path, base.commit, known))


def _fork(left: str, right: str, path: Path | None) -> git.Base:
    """Find the commit where two lines of history parted."""
    return git.fork(project.tracked(path).objects.repository, left, right)


def _is_path(words: str) -> bool:
    """Whether a text can only be a path, judged by its form."""
    return words.startswith(_AS_PATHS) or words in {".", ".."} or os.path.isabs(words)  # noqa: PTH117 - Windows' drives


def compared(before: Side, after: Side) -> Comparison:
    """Compare two versions.

    Findings are not reported as cured where the newer version has errors of reading or linking: they hide findings.
    """
    found = compare(version(before.checked), version(after.checked))
    return replace(found, cured=()) if after.checked.unsound else found


def version(checked: Checked) -> Version:
    """Return what a comparison looks at."""
    return Version(
        architecture=checked.architecture,
        findings=checked.findings,
        silenced=checked.silenced,
        rules={rule: str(severity) for rule, severity in checked.loaded.rules.items()},
        chapters={path: chapter.text for path, chapter in checked.chapters.texts.items()},
        order=checked.chapters.order,
        # Where a project does not write them, they come from the name of its folder: that is no change of the project.
        unnamed=frozenset({"id", "title"} - _written(checked)),
    )


def _written(checked: Checked) -> set[str]:
    """Return the keys that are written below `project`."""
    section = checked.merged.get("project")
    return {entry.key for entry in section} if isinstance(section, Table) else set()
