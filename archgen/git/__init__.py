"""git, read only and at arm's length: which repository, which commit, what its trees and blobs hold.

Only objects are read, never the index (but to ask whether git ignores a file), and never through a filter, hook,
textconv, pager, monitor or remote. A repository whose configuration or attributes name a program is therefore read
without running it.
"""

from archgen.git.branch_base import BaseCommit, find_branch_base, find_common_commit
from archgen.git.commit_log import find_object_ids, list_first_parents
from archgen.git.git_errors import GitError, NoCommitsError, NoRepositoryError, ShallowError, UnknownRevisionError
from archgen.git.ignored_files import ignores_file
from archgen.git.object_reader import GitObjects, TreeEntry
from archgen.git.repository_lookup import (
    GitRepository,
    find_repository,
    list_cut_commits,
    look_up_tree,
    resolve_revision,
)
from archgen.git.text_merge import LineMerge, merge_lines
from archgen.git.tree_merge import MergeFolder, PathConflict, TreeMerge, open_merge_folder

__all__ = [
    "BaseCommit",
    "GitError",
    "GitObjects",
    "GitRepository",
    "LineMerge",
    "MergeFolder",
    "NoCommitsError",
    "NoRepositoryError",
    "PathConflict",
    "ShallowError",
    "TreeEntry",
    "TreeMerge",
    "UnknownRevisionError",
    "find_branch_base",
    "find_common_commit",
    "find_object_ids",
    "find_repository",
    "ignores_file",
    "list_cut_commits",
    "list_first_parents",
    "look_up_tree",
    "merge_lines",
    "open_merge_folder",
    "resolve_revision",
]
