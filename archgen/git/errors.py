"""What can be wrong with a repository or a revision. The texts are written for users and say what to do."""

from __future__ import annotations


class GitError(Exception):
    """git cannot give what was asked for."""


class NoRepositoryError(GitError):
    """There is no repository, or git refuses to read it."""


class NoCommitsError(GitError):
    """Nothing was committed yet."""


class UnknownRevisionError(GitError):
    """No commit is called so."""


class ShallowError(GitError):
    """The commit is not here because the clone is shallow."""
