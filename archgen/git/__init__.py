"""git, read only and at arm's length: which repository, which commit, what its trees and blobs hold.

Only objects are read, never the index (but to ask whether git ignores a file), and never through a filter, hook,
textconv, pager, monitor or remote. A repository whose configuration or attributes name a program is therefore read
without running it.

What only a merge or an editor needs is imported from its module, so that `archgen check` does not load it.
"""

from archgen.git.branch_base import BaseCommit, find_branch_base, find_common_commit, find_unpushed_base
from archgen.git.commit_log import find_object_ids, list_first_parents
from archgen.git.git_call import GitError, NoCommitsError, NoRepositoryError, ShallowError, UnknownRevisionError
from archgen.git.object_reader import GitObjects, TreeEntry
from archgen.git.repository_lookup import (
    GitRepository,
    find_repository,
    list_cut_commits,
    look_up_tree,
    resolve_revision,
)

__all__ = ["BaseCommit", "GitError", "GitObjects", "GitRepository", "NoCommitsError", "NoRepositoryError"]
__all__ += ["ShallowError", "TreeEntry", "UnknownRevisionError", "find_branch_base", "find_common_commit"]
__all__ += ["find_object_ids", "find_repository", "find_unpushed_base", "list_cut_commits", "list_first_parents"]
__all__ += ["look_up_tree", "resolve_revision"]
