"""Merge a branch into what is checked out: judged in a folder of its own first, then put into the work tree as a whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from archgen import project
from archgen.frozen import NamedTuple
from archgen.git import GitError
from archgen.git.branch_base import list_common_commits
from archgen.git.object_reader import open_merge_folder
from archgen.git.work_tree import lay_merge, name_head, refuse_unready
from archgen.merge.branch_merge import BranchMerger
from archgen.merge.branch_results import BranchJudges, BranchMerge


class HeadMerge(NamedTuple):
    """What came out of merging a branch into `head`. `is_needless`: it holds all of the branch already."""

    head: str
    branch_merge: BranchMerge
    is_written: bool
    is_needless: bool = False


def merge_into_head(
    path: Path | None, branch: str, judges: BranchJudges, accepts: Callable[[BranchMerge], bool]
) -> HeadMerge:
    """Merge a branch into what is checked out; write it if it is accepted. Raise GitError and ProjectNotFoundError."""
    tracked_project = project.find_tracked_project(path)
    repository = tracked_project.objects.repository
    refuse_unready(repository)
    head = name_head(repository)
    with open_merge_folder(repository) as merge_folder:
        merger = BranchMerger(tracked_project, merge_folder, judges)
        ours, theirs = merger.read_state("HEAD", ()), merger.read_state(branch, (branch,))
        common_commits = list_common_commits(repository, ours.commit, theirs.commit)
        if theirs.commit in common_commits:
            empty = BranchMerge((ours.branches, theirs.branches), checked_project=ours.checked_project)
            return HeadMerge(head, empty, is_written=False, is_needless=True)
        if len(common_commits) > 1:
            msg = f"`{branch}` and `{head}` were merged into each other crosswise: `git merge {branch}` with the merge driver"
            raise GitError(msg)
        merged = merger.merge_branch(ours, theirs)
        is_written = accepts(merged.branch_merge)
        if is_written:
            lay_merge(repository, merge_folder, merged.commit, branch, merged.unmerged)
    return HeadMerge(head, merged.branch_merge, is_written)
