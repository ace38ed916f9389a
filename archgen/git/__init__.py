"""git, read only and at arm's length: which repository, which commit, what its trees and blobs hold.

Only objects are read: never the index, and never through a filter, hook, textconv, pager, monitor or remote. A
repository whose configuration or attributes name a program is therefore read without running it.
"""

from archgen.git.base import Base, base, fork
from archgen.git.errors import GitError, NoCommitsError, NoRepositoryError, ShallowError, UnknownRevisionError
from archgen.git.log import first_parents, ids
from archgen.git.objects import Blob, Objects
from archgen.git.repository import Repository, repository, resolve

__all__ = [
    "Base",
    "Blob",
    "GitError",
    "NoCommitsError",
    "NoRepositoryError",
    "Objects",
    "Repository",
    "ShallowError",
    "UnknownRevisionError",
    "base",
    "first_parents",
    "fork",
    "ids",
    "repository",
    "resolve",
]
