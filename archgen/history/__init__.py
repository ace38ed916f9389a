"""How size, progress and findings grew: a project at the commits of its repository, read from git's objects alone."""

from archgen.history.commits import By
from archgen.history.counting import history

__all__ = ["By", "history"]
