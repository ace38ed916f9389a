"""How size, progress and findings grew: a project at the commits of its repository, read from git's objects alone."""

from archgen.history.history_counting import count_history
from archgen.history.project_commits import HistoryInterval

__all__ = ["HistoryInterval", "count_history"]
