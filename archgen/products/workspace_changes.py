"""What a change of code makes differ from the model: the workspace that the project names, before the change and after it.

The workspace of before is read from git's objects: its files are written into a temporary folder, and nothing is checked out.
"""

from __future__ import annotations

import posixpath
import tempfile
from pathlib import Path, PurePosixPath

from archgen.conformance.robot_comparison import ComparedPart
from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import dataclass, replace
from archgen.git.object_reader import GitObjects
from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.pipeline import CheckedProject
from archgen.products.check_findings import compare_findings
from archgen.products.robot_conformance import hold_against_robots

_READ_ENDINGS = frozenset(
    {
        *(".py", ".cfg", ".txt", ".cmake", ".xml", ".yaml", ".yml", ".launch", ".msg", ".srv", ".action", ".toml"),
        *(".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".hxx", ".ipp"),
    }
)
_OTHER_NAMES = frozenset({"COLCON_IGNORE", "CATKIN_IGNORE", "AMENT_IGNORE"})
_MAX_FILE_BYTES = 1_000_000
_MAX_FILES = 20_000
_MAX_BYTES = 200_000_000
_REGULAR_MODES = frozenset({"100644", "100755"})


@dataclass(frozen=True, slots=True)
class WorkspaceChanges:
    """The differences between workspace and model that are there since a change, and why some could not be looked for."""

    differences: tuple[Diagnostic, ...] = ()
    obstacles: tuple[str, ...] = ()


def find_new_differences(
    old_project: CheckedProject, new_project: CheckedProject, objects: GitObjects, base_commit: str, folder: str
) -> WorkspaceChanges:
    """Hold both versions of a project against both versions of the workspaces that the old one names in `conform.against`.

    `folder` is the project's in the repository. What the branch itself says of its comparison does not count.
    """
    settings = old_project.architecture.conform
    differences: list[Diagnostic] = []
    obstacles: list[str] = []
    for text in settings.against:
        path = posixpath.normpath(posixpath.join(folder, text))
        workspace = new_project.root / text
        # A link of the branch may lead to anywhere on the machine that judges it.
        is_inside = workspace.resolve().is_relative_to(objects.repository.top.resolve())
        if path.startswith(("..", "/")) or not is_inside or not workspace.is_dir():
            obstacles.append(f"{text} is not held against the model: it is no folder of this repository")
            continue
        options = ObservationOptions(launch_files=settings.launch, distro=old_project.architecture.distro or "")
        try:
            with tempfile.TemporaryDirectory(prefix="archgen-") as temporary:
                old_workspace = Path(temporary).resolve() / "workspace"
                _write_out(objects, base_commit, "" if path == "." else path, old_workspace)
                old_findings = _find_differences(old_project, old_workspace, text, options)
            new_findings = _find_differences(new_project, workspace, text, options)
        except ForeignFileError as error:
            obstacles.append(
                f"{text} is not held against the model: {error.span.file}: {error.message}; {error.help_line}"
            )
            continue
        differences += compare_findings(
            replace(new_project, findings=new_findings), replace(old_project, findings=old_findings)
        )[0]
    return WorkspaceChanges(tuple(differences), tuple(obstacles))


def _find_differences(
    checked_project: CheckedProject, workspace: Path, text: str, options: ObservationOptions
) -> tuple[Diagnostic, ...]:
    # Both versions are called the same, so that their findings can be.
    # A branch may put anything in the place of a workspace, such as a recording that unpacks to fill the memory.
    robot = replace(observe_robot(workspace, checked_project.root, options, ("workspace",)), origin=text)
    return hold_against_robots(checked_project, [robot], ComparedPart()).reported.findings


def _write_out(objects: GitObjects, commit: str, prefix: str, folder: Path) -> None:
    """Write the files of a commit below a folder that readers of workspaces look at. Raise ForeignFileError for too many."""
    folder.mkdir()
    count = total = 0
    for name, entry in (objects.list_tree(commit, prefix) or {}).items():
        path = PurePosixPath(name)
        is_read = path.suffix in _READ_ENDINGS or path.name in _OTHER_NAMES
        # A tree that somebody made by hand may hold any name.
        is_plain = (
            not path.is_absolute() and not {"..", ".git"} & set(path.parts) and "\\" not in name and ":" not in name
        )
        size = objects.blob_size(entry.object_id) if is_read and is_plain and entry.mode in _REGULAR_MODES else None
        if size is None or size > _MAX_FILE_BYTES:
            continue
        count, total = count + 1, total + size
        if count > _MAX_FILES or total > _MAX_BYTES:
            words = f"it holds more than {_MAX_FILES:,} files, or {_MAX_BYTES // 1_000_000} MB"
            raise ForeignFileError(
                words, Span.of_file(prefix or "."), "name a folder that holds less in `conform.against`"
            )
        target = folder / path
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(objects.read_blob(entry.object_id) or b"")
        except OSError as error:  # a file that is called as a folder, in a tree that somebody made by hand
            words = f"`{name}` of {commit[:10]} cannot be written: {error.strerror or error}"
            raise ForeignFileError(words, Span.of_file(prefix or "."), "look at it with `git fsck`") from None
