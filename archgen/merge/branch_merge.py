"""Merge open branches before git does: what git conflicts in, what of it the models settle, and what is wrong then."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from archgen import pipeline, project
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.finding_identity import FindingIdentity, identify_finding
from archgen.git import GitError
from archgen.git.merged_trees import MergeFolder, PathConflict, open_merge_folder
from archgen.merge.file_merge import merge_contents
from archgen.merge.slice_reading import read_normal_tree
from archgen.merge.tree_merge import MergeConflictError, merge_values, read_merged_value
from archgen.pipeline import CheckedProject, VersionCache
from archgen.project import TrackedProject
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.project_files import MAX_BYTES


@dataclass(frozen=True, slots=True)
class FileConflict:
    """A file of the project that git conflicts in; `problem` is what people have to settle, None for nothing."""

    file: str
    problem: str | None = None


@dataclass(frozen=True, slots=True)
class BranchMerge:
    """What the main line would be with some branches merged into it.

    `new_findings` are those that neither the main line nor a branch (nor fewer of them together) has; they need not
    be wrong in any branch. `checked_project` is None where people have to settle conflicts first, or where the merged
    commit holds no project.
    """

    branches: tuple[str, ...]
    conflicts: tuple[FileConflict, ...] = ()
    new_findings: tuple[Diagnostic, ...] = ()
    checked_project: CheckedProject | None = None

    @property
    def is_blocked(self) -> bool:
        """Whether people have to settle something before there is a merged project."""
        return any(conflict.problem for conflict in self.conflicts)


@dataclass(frozen=True, slots=True)
class _MergeState:
    """A commit, the branches that are merged into the main line in it (none: the main line), and what is found there."""

    branches: tuple[str, ...]
    commit: str
    known_findings: frozenset[FindingIdentity]
    checked_project: CheckedProject | None


class BranchMerger:
    """Merges branches of one project. All that is read is read once."""

    def __init__(self, tracked_project: TrackedProject, merge_folder: MergeFolder) -> None:
        self._merge_folder = merge_folder
        self._tracked_project = tracked_project
        self._merged_project = TrackedProject(merge_folder.objects, tracked_project.locations)
        self._version_cache = VersionCache()

    def read_state(self, revision: str, branches: tuple[str, ...]) -> _MergeState:
        """Read a commit as it is; one without the project has no findings. Raise GitError for unknown revisions."""
        commit = self._tracked_project.resolve_commit(revision)
        checked_project = self._check_commit(commit, revision)
        return _MergeState(branches, commit, _identify_findings(checked_project), checked_project)

    def _check_commit(self, commit: str, name: str) -> CheckedProject | None:
        try:
            loaded_project = project.load_at_commit(
                self._merged_project, commit, self._version_cache.parsed_slices, name
            )
        except project.NotAtRevisionError:
            return None
        return pipeline.check_loaded_project(loaded_project, self._version_cache)

    def merge_states(
        self, ours: _MergeState, theirs: _MergeState, *, finds_more: bool = True
    ) -> tuple[BranchMerge, _MergeState | None]:
        """Merge what `theirs` stands for into `ours`; return what came out, and the merged state if there is one.

        Without `finds_more` only conflicts are asked for: checking what was merged takes most of the time.
        """
        branches = (*ours.branches, *theirs.branches)
        tree_merge = self._merge_folder.merge_commits(ours.commit, theirs.commit)
        settled_contents, conflicts = {}, []
        for conflict in tree_merge.conflicts:
            content, problem = self._settle_conflict(conflict, ours, theirs)
            conflicts.append(FileConflict(conflict.path, problem))
            if problem is None:
                settled_contents[conflict.path] = (conflict.mode, content)
        if any(conflict.problem for conflict in conflicts):
            return BranchMerge(branches, tuple(conflicts)), None
        tree = self._merge_folder.replace_files(tree_merge.tree, settled_contents)
        checked_project = self._check_commit(tree, " + ".join(branches)) if finds_more else ours.checked_project
        known_findings = ours.known_findings | theirs.known_findings
        new_findings = tuple(
            finding
            for finding in (checked_project.findings if checked_project else ())
            if identify_finding(finding) not in known_findings
        )
        commit = self._merge_folder.commit_tree(tree, (ours.commit, theirs.commit))
        known_findings |= _identify_findings(checked_project)
        merged_state = _MergeState(branches, commit, known_findings, checked_project)
        return BranchMerge(branches, tuple(conflicts), new_findings, checked_project), merged_state

    def _settle_conflict(
        self, conflict: PathConflict, ours: _MergeState, theirs: _MergeState
    ) -> tuple[bytes, str | None]:
        """Return the content of a file that git conflicts in, or why people have to settle it."""
        if not all(conflict.blobs[1:]):
            return b"", self._describe_absence(conflict, theirs if conflict.blobs[1] else ours)
        if not conflict.path.endswith(YAML_ENDINGS):
            return b"", "both sides changed the same lines"
        old_content, our_content, their_content = (self._read_blob(blob) if blob else b"" for blob in conflict.blobs)
        if old_content is None or our_content is None or their_content is None:
            return b"", "it cannot be read, or is too large"
        try:
            merged = merge_contents(old_content, our_content, their_content)
        except GitError as error:
            return b"", str(error)
        return merged.content, merged.problem

    def _describe_absence(self, conflict: PathConflict, other_side: _MergeState) -> str:
        """Return what happened to a file that one side changed and the other one does not have any more.

        Whoever splits a file keeps what it says: then git conflicts, and the models do not.
        """
        base_blob, *blobs = conflict.blobs
        old_table, new_table = (
            read_normal_tree((self._read_blob(blob) or b"").decode("utf-8", "replace")) if blob else None
            for blob in (base_blob, next(filter(None, blobs), ""))
        )
        if other_side.checked_project is None or old_table is None or new_table is None:
            return "one side took it away or moved it, the other one changed it"
        try:
            merge_values(
                read_merged_value(old_table),
                read_merged_value(other_side.checked_project.merged_table),
                read_merged_value(new_table),
            )
        except MergeConflictError as merge_conflict:
            what = ".".join(merge_conflict.path)
            return f"one side took it away or moved it, the other one changed it; both sides changed `{what}`"
        return (
            "one side moved what is in it to other files, the other one changed it: git conflicts, what both sides say does "
            "not; make the change where it stands now"
        )

    def _read_blob(self, blob: str) -> bytes | None:
        size = self._merge_folder.objects.blob_size(blob)
        return self._merge_folder.objects.read_blob(blob) if size is not None and size <= MAX_BYTES else None


def _identify_findings(checked_project: CheckedProject | None) -> frozenset[FindingIdentity]:
    return frozenset(identify_finding(finding) for finding in (checked_project.findings if checked_project else ()))


def preview_merges(path: Path | None, main_line: str, branches: Sequence[str]) -> Iterator[BranchMerge]:
    """Yield each branch merged into the main line, then what only several of them together do.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    tracked_project = project.find_tracked_project(path)
    with open_merge_folder(tracked_project.objects.repository) as merge_folder:
        merger = BranchMerger(tracked_project, merge_folder)
        main_state = merger.read_state(main_line, ())
        merged_states = []
        for branch in dict.fromkeys(branches):
            branch_merge, merged_state = merger.merge_states(main_state, merger.read_state(branch, (branch,)))
            yield branch_merge
            if merged_state is not None:
                merged_states.append(merged_state)
        yield from _merge_together(merger, merged_states)


def _merge_together(merger: BranchMerger, states: Iterable[_MergeState]) -> Iterator[BranchMerge]:
    """Merge branches one after the other; yield where one does not go with those before it, and at last all of them if
    they do.
    """
    merged_states: list[_MergeState] = []
    together: _MergeState | None = None
    whole_merge: BranchMerge | None = None
    has_new_findings = False
    for state in states:
        branch_merge, merged_state = merger.merge_states(together, state) if together else (None, state)
        if branch_merge is not None and (branch_merge.conflicts or branch_merge.new_findings):
            yield from _find_partners(merger, merged_states, state, branch_merge)
        if branch_merge is not None and not branch_merge.is_blocked:
            whole_merge = replace(branch_merge, conflicts=(), new_findings=())
            has_new_findings |= bool(branch_merge.new_findings)
        # A branch that conflicts with those before it is left out of what follows.
        if merged_state is not None:
            together = merged_state
            merged_states.append(state)
    if whole_merge is not None and not has_new_findings:
        yield whole_merge


def _find_partners(
    merger: BranchMerger, earlier_states: Sequence[_MergeState], state: _MergeState, branch_merge: BranchMerge
) -> Iterator[BranchMerge]:
    """Yield the pairs that do what a branch does with all earlier ones; where no pair does, all of them."""
    finds_more = bool(branch_merge.new_findings)
    pairs = [merger.merge_states(earlier, state, finds_more=finds_more)[0] for earlier in earlier_states]
    guilty_pairs = [pair for pair in pairs if pair.conflicts or pair.new_findings]
    shown_conflicts = {conflict for pair in guilty_pairs for conflict in pair.conflicts}
    shown_findings = {identify_finding(finding) for pair in guilty_pairs for finding in pair.new_findings}
    yield from guilty_pairs
    if not shown_conflicts.issuperset(branch_merge.conflicts) or not shown_findings.issuperset(
        map(identify_finding, branch_merge.new_findings)
    ):
        yield branch_merge
