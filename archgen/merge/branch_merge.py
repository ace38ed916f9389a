"""Merge open branches before git does: what git conflicts in, what of it the models settle, and what is wrong then."""

from __future__ import annotations

import posixpath
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from archgen import git, pipeline, project
from archgen.diagnostics.finding_identity import FindingIdentity, identify_finding
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.git import GitError
from archgen.git.object_reader import MergeFolder, PathConflict, open_merge_folder
from archgen.git.repository_lookup import look_up_tree
from archgen.merge.branch_results import BranchJudges, BranchMerge, FileConflict, FollowedVersion, JointBreaks
from archgen.merge.change_transfer import read_normal_tree
from archgen.merge.double_renames import find_double_renames
from archgen.merge.file_merge import merge_contents
from archgen.merge.tree_merge import (
    EMPTY_MAPPING,
    MergeConflictError,
    follow_renames,
    merge_values,
    read_merged_value,
)
from archgen.pipeline import CheckedProject, VersionCache
from archgen.project import TrackedProject
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.project_files import MAX_BYTES
from archgen.syntax.yaml_tree import find_value


@dataclass(frozen=True, slots=True)
class _MergeState:
    """A commit, the branches that are merged into the main line in it (none: the main line), and what is found there.

    `parts` are the states that were merged into the main line one after the other, in a state of several branches.
    """

    branches: tuple[str, ...]
    commit: str
    known_findings: frozenset[FindingIdentity]
    checked_project: CheckedProject | None
    parts: tuple[_MergeState, ...] = ()


class _FollowedStates(NamedTuple):
    """Both sides with what either of them renamed or moved, in commits that begin with one in which it is so, too."""

    ours: _MergeState
    theirs: _MergeState
    told: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MergedBranch:
    """A branch merged into what is checked out, as a commit of the merge folder; `unmerged` are the files that hold markers."""

    branch_merge: BranchMerge
    commit: str
    unmerged: tuple[PathConflict, ...]


@dataclass(frozen=True, slots=True)
class _MergedFiles:
    """The tree of what was merged file by file, with markers where people have to settle something."""

    tree: str
    conflicts: tuple[FileConflict, ...]
    unmerged: tuple[PathConflict, ...]

    @property
    def is_blocked(self) -> bool:
        return any(conflict.problem for conflict in self.conflicts)


class BranchMerger:
    """Merges branches of one project. All that is read is read once."""

    def __init__(self, tracked_project: TrackedProject, merge_folder: MergeFolder, judges: BranchJudges) -> None:
        self._merge_folder = merge_folder
        self._tracked_project = tracked_project
        self._merged_project = TrackedProject(merge_folder.objects, tracked_project.locations)
        self._version_cache = VersionCache()
        self._judges = judges
        self._checked_trees: dict[str, CheckedProject | None] = {}

    def read_state(self, revision: str, branches: tuple[str, ...]) -> _MergeState:
        """Read a commit as it is; one without the project has no findings. Raise GitError for unknown revisions."""
        commit = self._tracked_project.resolve_commit(revision)
        checked_project = self._check_commit(commit, revision)
        return _MergeState(branches, commit, _identify_findings(checked_project), checked_project)

    def _check_commit(self, commit: str, name: str, *, is_kept: bool = True) -> CheckedProject | None:
        # A branch that has all of the main line is what it is merged into: one tree, checked once. What several branches
        # are together comes up once, and may be large.
        tree = look_up_tree(self._merge_folder.objects.repository, commit) or commit
        if tree in self._checked_trees:
            return self._checked_trees[tree]
        checked_project = self._check_tree(commit, name)
        if is_kept:
            self._checked_trees[tree] = checked_project
        return checked_project

    def _check_tree(self, commit: str, name: str) -> CheckedProject | None:
        try:
            loaded_project = project.load_at_commit(
                self._merged_project, commit, self._version_cache.parsed_slices, name
            )
        except project.NotAtRevisionError:
            return None
        return pipeline.check_loaded_project(loaded_project, self._version_cache)

    def merge_states(
        self, ours: _MergeState, theirs: _MergeState, *, is_checked: bool = True
    ) -> tuple[BranchMerge, _MergeState | None]:
        """Merge what `theirs` stands for into `ours`; return what came out, and the merged state if there is one.

        Unless `is_checked` only conflicts of files are asked for: checking and comparing takes most of the time.
        """
        files = self._merge_files(ours, theirs)
        told: tuple[str, ...] = ()
        our_side, their_side = ours, theirs
        if files.is_blocked and is_checked:
            followed = self._follow(ours, theirs)
            if isinstance(followed, _FollowedStates):
                followed_files = self._merge_files(followed.ours, followed.theirs)
                if not followed_files.is_blocked:
                    our_side, their_side, told = followed
                    needless = (FileConflict(each.file, is_followed=bool(each.problem)) for each in files.conflicts)
                    files = replace(followed_files, conflicts=tuple(needless))
        return self._judge_files((ours, theirs), (our_side, their_side), files, told, is_checked=is_checked)

    def _judge_files(
        self,
        states: tuple[_MergeState, _MergeState],
        followed_states: tuple[_MergeState, _MergeState],
        files: _MergedFiles,
        told: tuple[str, ...],
        *,
        is_checked: bool,
    ) -> tuple[BranchMerge, _MergeState | None]:
        ours, theirs = states
        branches, sides = (*ours.branches, *theirs.branches), (ours.branches, theirs.branches)
        if files.is_blocked:
            return BranchMerge(sides, files.conflicts), None
        checked_project = ours.checked_project
        if is_checked:
            checked_project = self._check_commit(files.tree, " + ".join(branches), is_kept=not ours.branches)
        joint_breaks, double_renames = self._judge_merge(*followed_states, checked_project)
        if double_renames:
            return BranchMerge(sides, (*files.conflicts, *double_renames)), None
        known_findings = frozenset[FindingIdentity]().union(
            *(each.known_findings for each in (*states, *followed_states))
        )
        findings = checked_project.findings if checked_project else ()
        new_findings = tuple(each for each in findings if identify_finding(each) not in known_findings)
        branch_merge = BranchMerge(sides, files.conflicts, new_findings, checked_project, joint_breaks, told)
        commit = self._merge_folder.commit_tree(files.tree, (ours.commit, theirs.commit))
        known_findings |= _identify_findings(checked_project)
        parts = (*(ours.parts or (ours,)), theirs)
        return branch_merge, _MergeState(branches, commit, known_findings, checked_project, parts)

    def _merge_files(self, ours: _MergeState, theirs: _MergeState, *, merges_all: bool = False) -> _MergedFiles:
        """Merge the files of two states; with `merges_all` also those by what they say in which git sees no conflict."""
        tree_merge = self._merge_folder.merge_commits(ours.commit, theirs.commit)
        unmerged = list(tree_merge.conflicts)
        if merges_all:
            unmerged += self._list_changed_twice(ours, theirs, {conflict.path for conflict in unmerged})
        contents: dict[str, tuple[str, bytes | None]] = {}
        conflicts, left = [], []
        for conflict in unmerged:
            content, problem = self._settle_conflict(conflict, ours, theirs)
            conflicts.append(FileConflict(conflict.path, problem))
            if problem is None or (content and all(conflict.blobs[1:])):
                contents[conflict.path] = (conflict.mode, content)
            if problem is not None:
                left.append(conflict)
        tree = self._merge_folder.replace_files(tree_merge.tree, contents)
        return _MergedFiles(tree, tuple(conflicts), tuple(left))

    def _list_changed_twice(
        self, ours: _MergeState, theirs: _MergeState, known_paths: Collection[str]
    ) -> Iterator[PathConflict]:
        """Yield the slices that both sides changed."""
        fork = self._find_fork(ours, theirs)
        if fork is None:
            return
        objects = self._merge_folder.objects
        base, our, their = (objects.list_tree(each) or {} for each in (fork.commit_id, ours.commit, theirs.commit))
        for path in base.keys() & our.keys() & their.keys() - known_paths:
            blobs = base[path].object_id, our[path].object_id, their[path].object_id
            if path.endswith(YAML_ENDINGS) and len(set(blobs)) == len(blobs):
                yield PathConflict(path, our[path].mode, blobs)

    def _follow(self, ours: _MergeState, theirs: _MergeState) -> _FollowedStates | tuple[FileConflict, ...] | None:
        """Return both sides with what either of them renamed or moved, or what contradicts; None where there is nothing."""
        fork = self._find_fork(ours, theirs)
        base_project = self._check_base(ours, theirs)
        if fork is None or base_project is None or ours.checked_project is None or theirs.checked_project is None:
            return None
        followed, conflicts = self._judges.follow(base_project, ours.checked_project, theirs.checked_project)
        if followed is None:
            return tuple(
                replace(each, file=self._path_in_repository(each.file) if each.file else "") for each in conflicts
            )
        base_commit = self._commit_followed(fork.commit_id, followed.base, ())
        our_state, their_state = (
            replace(
                state,
                commit=self._commit_followed(state.commit, version, (base_commit,)),
                checked_project=version[0],
                known_findings=_identify_findings(version[0]),
            )
            for state, version in ((ours, followed.ours), (theirs, followed.theirs))
        )
        return _FollowedStates(our_state, their_state, followed.told)

    def _commit_followed(self, commit: str, version: FollowedVersion, parents: tuple[str, ...]) -> str:
        entries = self._merge_folder.objects.list_tree(commit) or {}
        contents: dict[str, tuple[str, bytes | None]] = {}
        for file, content in version[1].items():
            path = self._path_in_repository(file)
            contents[path] = (entries[path].mode if path in entries else "100644", content)
        return self._merge_folder.commit_tree(self._merge_folder.replace_files(f"{commit}^{{tree}}", contents), parents)

    def merge_branch(self, ours: _MergeState, theirs: _MergeState) -> MergedBranch:
        """Merge `theirs` into `ours`, with what either of them renamed or moved done in the other one, too; prove that what
        comes out says what both say, and no more.
        """
        followed = self._follow(ours, theirs)
        if followed is not None and not isinstance(followed, _FollowedStates) and followed:
            files = self._merge_files(ours, theirs, merges_all=True)
            branch_merge = BranchMerge((ours.branches, theirs.branches), (*followed, *files.conflicts))
            return self._finish(branch_merge, files, ours, theirs)
        our_side, their_side, told = followed if isinstance(followed, _FollowedStates) else (ours, theirs, ())
        files = self._merge_files(our_side, their_side, merges_all=True)
        if not files.is_blocked:
            files = replace(files, conflicts=tuple(self._find_contradictions(our_side, their_side, files.tree)))
        branch_merge, _ = self._judge_files((ours, theirs), (our_side, their_side), files, told, is_checked=True)
        return self._finish(branch_merge, files, ours, theirs)

    def _finish(
        self, branch_merge: BranchMerge, files: _MergedFiles, ours: _MergeState, theirs: _MergeState
    ) -> MergedBranch:
        commit = self._merge_folder.commit_tree(files.tree, (ours.commit, theirs.commit))
        conflicts = tuple(each for each in branch_merge.conflicts if each.problem)
        return MergedBranch(replace(branch_merge, conflicts=conflicts), commit, files.unmerged)

    def _find_contradictions(self, ours: _MergeState, theirs: _MergeState, tree: str) -> Iterator[FileConflict]:
        """Yield where a merged tree says something else than both sides together, though all of its files merge."""
        base_project = self._check_base(ours, theirs)
        merged_project = self._check_commit(tree, "merged")
        projects = base_project, ours.checked_project, theirs.checked_project, merged_project
        tables = [read_merged_value(each.merged_table) if each else EMPTY_MAPPING for each in projects]
        base, our, their, merged = tables
        path: tuple[str, ...] = ()
        try:
            expected = merge_values(*follow_renames(base, our, their))
            if expected == merged:
                return
            problem = "its files merge, but together they do not say what both sides say"
        except MergeConflictError as conflict:
            path = conflict.path
            problem = conflict.reason or f"both sides changed `{'.'.join(path)}`, and git takes the lines of both"
        node = find_value(merged_project.merged_table, *path) if merged_project and path else None
        yield FileConflict(self._path_in_repository(node.span.file) if node else "", problem)

    def join_states(self, states: Sequence[_MergeState]) -> _MergeState | None:
        """Merge states and check what comes out; None where they do not merge."""
        joined: _MergeState | None = states[0]
        for state in states[1:]:
            joined = self.merge_states(joined, state, is_checked=False)[1] if joined else None
        if joined is None or joined is states[0]:
            return joined
        checked_project = self._check_commit(joined.commit, " + ".join(joined.branches), is_kept=False)
        known_findings = joined.known_findings | _identify_findings(checked_project)
        return replace(joined, checked_project=checked_project, known_findings=known_findings)

    def _judge_merge(
        self, ours: _MergeState, theirs: _MergeState, merged_project: CheckedProject | None
    ) -> tuple[JointBreaks, tuple[FileConflict, ...]]:
        """Return what both sides break only together, and what both sides call otherwise."""
        our_project, their_project = ours.checked_project, theirs.checked_project
        if our_project is None or their_project is None or merged_project is None:
            return JointBreaks(), ()
        # One side has all of the other one.
        if merged_project is our_project or merged_project is their_project:
            return JointBreaks(), ()
        base_project = self._check_base(ours, theirs)
        if base_project is None:
            return JointBreaks(), ()
        versions = base_project, our_project, their_project, merged_project
        double_renames = tuple(
            FileConflict(
                self._path_in_repository(rename.at.file),
                f"both sides renamed `{rename.old_id}`: it is `{rename.our_id}` and `{rename.their_id}` now, and there would be two",
            )
            for rename in find_double_renames(*(version.architecture for version in versions))
        )
        return JointBreaks() if double_renames else self._judges.find_breaks(*versions), double_renames

    def _check_base(self, ours: _MergeState, theirs: _MergeState) -> CheckedProject | None:
        """Check the project where both sides parted; None where it was not there, or the clone does not reach back."""
        fork = self._find_fork(ours, theirs)
        return self._check_commit(fork.commit_id, fork.description) if fork else None

    def _find_fork(self, ours: _MergeState, theirs: _MergeState) -> git.BaseCommit | None:
        try:
            return git.find_common_commit(self._merge_folder.objects.repository, ours.commit, theirs.commit)
        except GitError:
            return None

    def _path_in_repository(self, file: str) -> str:
        return posixpath.normpath(posixpath.join(self._tracked_project.locations[0][0], file))

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
            merged = merge_contents(old_content, our_content, their_content, path=conflict.path)
        except GitError as error:
            return b"", str(error)
        if merged.conflict_path:
            return merged.content, self._describe_move(conflict, ours, theirs, merged.conflict_path) or merged.problem
        return merged.content, merged.problem

    def _describe_move(
        self, conflict: PathConflict, ours: _MergeState, theirs: _MergeState, path: tuple[str, ...]
    ) -> str:
        """Return where something stands now that one side moved out of this file while the other one changed it; empty
        where it is not so: the models conflict then, too.
        """
        base_project = self._check_base(ours, theirs)
        projects = base_project, ours.checked_project, theirs.checked_project
        nodes = [
            find_value(project.merged_table, *path) if project and not project.reading_errors else None
            for project in projects
        ]
        places = [self._path_in_repository(node.span.file) if node else "" for node in nodes]
        new_place = next((place for place in places[1:] if place != conflict.path), "")
        if not all(places) or not new_place:
            return ""
        try:
            base, our, their = (read_merged_value(node, path) if node else None for node in nodes)
            merge_values(base, our, their, path)
        except MergeConflictError:
            return ""
        return (
            f"one side moved `{'.'.join(path)}` to `{new_place}`, the other one changed it: git conflicts, what both sides say"
            " does not; make the change where it stands now"
        )

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


def preview_merges(
    path: Path | None,
    main_line: str,
    branches: Sequence[str],
    judges: BranchJudges,
    *,
    leaves_out_unmergeable: bool = False,
) -> Iterator[BranchMerge]:
    """Yield each branch merged into the main line, then what only several of them together do.

    Raise `git.GitError` and `project.ProjectNotFoundError`; with `leaves_out_unmergeable` a branch that git cannot find or
    merge is a conflict of its own, since it may be a stranger's.
    """
    tracked_project = project.find_tracked_project(path)
    with open_merge_folder(tracked_project.objects.repository) as merge_folder:
        merger = BranchMerger(tracked_project, merge_folder, judges)
        main_state = merger.read_state(main_line, ())
        merged_states = []
        for branch in dict.fromkeys(branches):
            try:
                branch_merge, merged_state = merger.merge_states(main_state, merger.read_state(branch, (branch,)))
            except GitError as error:
                if not leaves_out_unmergeable:
                    raise
                yield BranchMerge(((), (branch,)), (FileConflict("", str(error)),))
                continue
            yield branch_merge
            if merged_state is not None:
                merged_states.append(replace(merged_state, parts=()))
        yield from _merge_together(merger, main_state, merged_states)


def _merge_together(
    merger: BranchMerger, main_state: _MergeState, states: Sequence[_MergeState]
) -> Iterator[BranchMerge]:
    """Merge branches one after the other; yield where one does not go with those before it, and at last those that go
    together.

    A branch that conflicts with those before it, or brings errors that would hide what later ones do, begins a line of its
    own, and each branch is merged into each line: so every pair is seen, and pairs are merged by themselves only where a line
    says that something is wrong.
    """
    lines: list[_MergeState] = []
    # By line; None where its branches do not go together.
    whole_merges: dict[int, BranchMerge | None] = {}
    for state in states:
        home = None
        for number, line in enumerate(lines):
            branch_merge, merged_state = merger.merge_states(line, state)
            if branch_merge.has_news:
                yield from _find_partners(merger, line, state, branch_merge)
            if home is None and merged_state is not None and not _hides_more(main_state, merged_state):
                home, lines[number] = number, merged_state
                is_sound = not branch_merge.findings and whole_merges.get(number, branch_merge) is not None
                whole_merges[number] = replace(branch_merge, conflicts=()) if is_sound else None
        if home is None:
            lines.append(state)
    yield from filter(None, whole_merges.values())


def _hides_more(main_state: _MergeState, merged_state: _MergeState) -> bool:
    """Whether there are errors of reading or linking that the main line has not: what they are about is judged no more."""
    old_errors, new_errors = (
        {identify_finding(error) for error in (each.checked_project.structural_errors if each.checked_project else ())}
        for each in (main_state, merged_state)
    )
    return not new_errors <= old_errors


def _find_partners(
    merger: BranchMerger, line: _MergeState, state: _MergeState, branch_merge: BranchMerge
) -> Iterator[BranchMerge]:
    """Yield the pairs that do what a branch does with a line of merged branches; where no pair does, the whole line."""
    if not line.parts:
        yield branch_merge
        return
    # Where files conflict a look at the files suffices.
    is_checked = bool(branch_merge.findings)
    pairs = [merger.merge_states(earlier, state, is_checked=is_checked)[0] for earlier in line.parts]
    rest = [earlier for earlier, pair in zip(line.parts, pairs, strict=True) if not pair.is_blocked]
    if branch_merge.is_blocked and len(rest) < len(pairs):
        yield from (pair for pair in pairs if pair.is_blocked)
        # The branch was not judged with those with which it does not conflict.
        rest_line = merger.join_states(rest) if rest else None
        rest_merge = merger.merge_states(rest_line, state)[0] if rest_line else None
        if rest_line and rest_merge and rest_merge.has_news:
            yield from _find_partners(merger, rest_line, state, rest_merge)
        return
    if branch_merge.is_blocked:
        # Elements have two names, which no file says.
        pairs = [merger.merge_states(earlier, state)[0] for earlier in line.parts]
    guilty_pairs = [pair for pair in pairs if pair.has_news]
    yield from guilty_pairs
    shown_conflicts = {conflict for pair in guilty_pairs for conflict in pair.conflicts}
    shown_findings = {identity for pair in guilty_pairs for identity in _identify_news(pair)}
    if not shown_conflicts.issuperset(branch_merge.conflicts) or not shown_findings.issuperset(
        _identify_news(branch_merge)
    ):
        yield branch_merge


def _identify_news(branch_merge: BranchMerge) -> Iterator[FindingIdentity]:
    yield from map(identify_finding, branch_merge.findings)
