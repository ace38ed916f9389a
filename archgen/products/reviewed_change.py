"""The change that a review judges: from where the branch left what it is merged into, to the files as they are now.

Comment, findings and outputs are all of these files: a comment about HEAD beside findings of an edited work tree would
contradict them.

What a change of code makes differ from the model is asked of the workspace that the project names, before the change and after
it. That of before is read from git's objects: its files are written into a temporary folder, and nothing is checked out.
"""

from __future__ import annotations

import posixpath
import shlex
import tempfile
from pathlib import Path, PurePosixPath

from archgen import git, project
from archgen.compare import Comparison
from archgen.compare.review_facts import ReviewFacts
from archgen.conformance.robot_comparison import ComparedPart
from archgen.diagnostics import Diagnostic, Span, shorten_hash
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.git.object_reader import GitObjects
from archgen.git.project_revision import differs_from_head
from archgen.git.repository_lookup import look_up_commit
from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.robot_observation import ObservationOptions, list_designed_starts, observe_robot
from archgen.pipeline import CheckedProject, VersionCache
from archgen.products.check_findings import compare_findings
from archgen.products.compared_versions import (
    WORKING_TREE_NAME,
    ProjectVersion,
    compare_named_versions,
    read_at_base,
)
from archgen.products.merge_breaks import find_breaks
from archgen.products.robot_conformance import hold_against_robots
from archgen.project import PROJECT_FILE
from archgen.project.project_tracking import TrackedProject, load_at_commit

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
    options = replace(options, starts=tuple(list_designed_starts(checked_project.architecture)))
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


class ReviewedRequest(NamedTuple):
    """A pull or merge request, or what waits in a merge queue: its name in titles, the branch it is merged into, and its
    last commit (both empty if unknown).

    `merge_commit` is the merge that the forge made of both for the job: empty if it made one whose hash is unknown, None
    if it made none.
    """

    name: str
    target_branch: str = ""
    head_commit: str = ""
    merge_commit: str | None = None


@dataclass(frozen=True, slots=True)
class ReviewedChange:
    """A compared change: both versions, what changed, which breaks count, and the command that shows it to a reader."""

    old_version: ProjectVersion
    new_version: ProjectVersion
    comparison: Comparison
    breaks: tuple[Diagnostic, ...]
    command: str
    code: WorkspaceChanges = field(default_factory=WorkspaceChanges)
    """What the code does otherwise than the model says since the change."""


def find_merge_target(path: Path | None, base: str, request: ReviewedRequest | None) -> str:
    """Return the revision that the change is merged into: `base`, or the first parent of the merge that a forge made.

    What a forge names as base may be older than what it merged into. Raise what `project.find_tracked_project` raises.
    """
    if request is None or request.merge_commit is None:
        return base
    repository = project.find_tracked_project(path).objects.repository
    # A job may have checked out the branch instead. A merge train that fast-forwards has no merge either; a shallow
    # clone cannot say, and is told so where the parent is asked for.
    is_checked_out = request.merge_commit in {"", look_up_commit(repository, "HEAD")}
    is_merge = repository.is_shallow or bool(look_up_commit(repository, "HEAD^2"))
    return "HEAD^1" if is_checked_out and is_merge else base


def compare_change(  # noqa: PLR0913, PLR0917 - what is compared, and all that is known of it
    checked_project: CheckedProject,
    path: Path | None,
    target: str,
    request: ReviewedRequest | None,
    version_cache: VersionCache,
    forge_facts: ReviewFacts | None = None,
) -> ReviewedChange:
    """Compare a project with where it left `target`. Raise `git.GitError`, or `project.NotAtRevisionError` where it did
    not exist there.
    """
    tracked_project = project.find_tracked_project(path)
    repository = tracked_project.objects.repository
    # HEAD has all of its own parent; any other target may have moved on.
    fork = git.find_common_commit(repository, target, "HEAD")
    if fork.commit_id == git.resolve_revision(repository, target):
        fork = fork._replace(description=target)
    old_name = request.target_branch if request and request.target_branch else fork.description
    new_version = _name_version(checked_project, tracked_project, request, version_cache)
    old_version = read_at_base(git.BaseCommit(fork.commit_id, old_name), path, version_cache, new_version)
    comparison = compare_named_versions(old_version, new_version, forge_facts=forge_facts)
    return ReviewedChange(
        old_version,
        new_version,
        comparison,
        find_breaks(comparison, checked_project),
        _repeat_command(old_version, new_version, tracked_project, request),
        find_new_differences(
            old_version.checked_project,
            checked_project,
            tracked_project.objects,
            fork.commit_id,
            tracked_project.locations[0][0],
        ),
    )


def _name_version(
    checked_project: CheckedProject,
    tracked_project: TrackedProject,
    request: ReviewedRequest | None,
    version_cache: VersionCache,
) -> ProjectVersion:
    """Name the files as they are: by the request or HEAD if they are what was committed, else as the work tree."""
    head = git.resolve_revision(tracked_project.objects.repository, "HEAD")
    is_committed = _is_as_committed(checked_project, tracked_project, head, version_cache)
    if request is None:
        name = "HEAD" if is_committed else f"{WORKING_TREE_NAME}, with changes that are not committed"
        return ProjectVersion(name, checked_project, head if is_committed else "")
    addition = "" if is_committed else ", with changes that are not committed"
    return ProjectVersion(f"{request.name}{addition}", checked_project, request.head_commit or head)


def _is_as_committed(
    checked_project: CheckedProject, tracked_project: TrackedProject, head: str, version_cache: VersionCache
) -> bool:
    """Whether the files of a project are those of HEAD: none changed, came or went."""
    try:
        committed_project = load_at_commit(tracked_project, head, version_cache.parsed_slices)
    except project.NotAtRevisionError:
        return False
    files = {*checked_project.loaded_project.sources.file_names(), *checked_project.input_files}
    committed_files = {*committed_project.sources.file_names(), *committed_project.interface_files}
    return committed_files <= files and not differs_from_head(checked_project.root, sorted(files))


def _repeat_command(
    old_version: ProjectVersion,
    new_version: ProjectVersion,
    tracked_project: TrackedProject,
    request: ReviewedRequest | None,
) -> str:
    """Return the command that shows the same in a clone, by hashes: names mean other commits tomorrow."""
    folder, first_file = tracked_project.locations[0]
    place = folder if first_file == PROJECT_FILE else str(PurePosixPath(folder, first_file))
    old_hash, new_hash = shorten_hash(old_version.commit), shorten_hash(new_version.commit)
    # A forge's merge commit is in nobody's clone: what the branch did since it left the other commit is the same change.
    versions = [f"{old_hash}...{new_hash}"] if request else [old_hash, *([new_hash] if new_hash else [])]
    return " ".join(["archgen diff", *versions, *(["-C", shlex.quote(place)] if place else [])])
