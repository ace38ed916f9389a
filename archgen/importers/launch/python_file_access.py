"""What readers of launch files in Python ask of the folders that were given: which files are there, and what YAML says."""

from __future__ import annotations

import ast
from abc import abstractmethod

from archgen.importers.launch.launch_values import LaunchValue
from archgen.importers.launch.python_methods import MethodReader


class FileAccessReader(MethodReader):
    """Looks into files beside the one that is read; how is up to the reader of the whole file."""

    @abstractmethod
    def read_yaml(self, path: LaunchValue, node: ast.AST) -> LaunchValue:
        """Return what a file says, as a mapping; an UnknownValue where it cannot be read; by the reader of the whole file."""

    @abstractmethod
    def has_file(self, path: LaunchValue) -> bool:
        """Whether a file lies in the folders that were given; by the reader of the whole file."""

    @abstractmethod
    def list_names(self, folder: LaunchValue) -> list[str]:
        """Return the names of the files in a folder; by the reader of the whole file."""
