"""What can be wrong with a repository or a revision. The messages are written for users and say what to do."""

from __future__ import annotations


class GitError(Exception):
    """git cannot deliver what was asked for."""


class NoRepositoryError(GitError):
    """There is no repository, or git refuses to read it."""


class NoCommitsError(GitError):
    """Nothing has been committed yet."""


class UnknownRevisionError(GitError):
    """No commit has this name."""


class ShallowError(GitError):
    """The commit is not here because the clone is shallow."""
