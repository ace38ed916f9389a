"""Look for the parameter files that nodes name, as far as the project can hold them."""

from __future__ import annotations

import posixpath
import re
from collections import defaultdict
from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.link import mapping_values
from archgen.syntax.project_files import ProjectFiles, read_binary_file
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

MISSING_PARAMETER_FILE = Rule(
    "missing-parameter-file",
    Severity.OFF,
    "A parameter file that a node names is not there.",
)
_ELSEWHERE = re.compile(r"[/~$\\]|\.\.(/|\Z)|\w+:")
"""How the path of a file begins that does not lie in the project, or whose place only the robot knows."""
_MAX_DEPTH = 4
"""How deep the folder of a package is looked for: `src/perception/camera_driver`."""
_SKIPPED_FOLDERS = frozenset({"build", "install", "log", "node_modules", "archgen-out"})


def find_missing_parameter_files(root: MappingNode, files: ProjectFiles) -> Iterator[Diagnostic]:
    """Report the parameter files of the merged project that should be in it, and are not."""
    search = ParameterFileSearch(files)
    for node_id, _, body in mapping_values.iterate_elements(root, "nodes"):
        for scalar in mapping_values.get_scalars(body, "parameter_files"):
            if search.is_missing(scalar, mapping_values.get_text(body, "package")):
                yield Diagnostic(
                    "missing-parameter-file",
                    f"there is no file `{scalar.text}`",
                    scalar.span,
                    help="write its path from the project's folder, or from that of its package; a file that lies elsewhere "
                    "begins with `/` or `package://`",
                    element=node_id,
                )


def _list_tops(scalar: ScalarNode) -> list[str]:
    """Return the folders from which a path is meant: the project's, and that of the file that names it."""
    return list(dict.fromkeys(["", posixpath.dirname(scalar.span.file)]))


class ParameterFileSearch:
    """Looks for files in a project; its folders are listed once, and only if a file is not where it should be."""

    def __init__(self, files: ProjectFiles) -> None:
        self._files = files
        self._parents_by_name: dict[str, list[str]] | None = None
        self._present_paths: dict[str, bool] = {}

    def is_missing(self, scalar: ScalarNode, package: str | None) -> bool:
        """Whether a file that a node of a package names should be in the project, and is not."""
        if _ELSEWHERE.match(scalar.text) or self.find_file(scalar, package) is not None:
            return False
        tops = _list_tops(scalar)
        package_folders = self._find_folders(package) if package else []
        first_part = posixpath.normpath(scalar.text).partition("/")[0]
        return not package or bool(package_folders) or not set(tops).isdisjoint(self._find_parents(first_part))

    def find_file(self, scalar: ScalarNode, package: str | None) -> str | None:
        """Return the path in the project of a file that a node of a package names; None where it lies elsewhere."""
        if _ELSEWHERE.match(scalar.text):
            return None
        path = self._find_below(_list_tops(scalar), scalar.text)
        return path or (self._find_below(self._find_folders(package), scalar.text) if package else None)

    def _find_below(self, folders: list[str], path: str) -> str | None:
        paths = [posixpath.normpath(posixpath.join(folder, path)) for folder in folders]
        # Nothing outside is looked at, not even whether it exists: `a/../../x` leads there, too.
        return next((path for path in paths if not path.startswith("../") and self._is_present(path)), None)

    def _is_present(self, path: str) -> bool:
        # A thousand nodes may name one file.
        if path not in self._present_paths:
            self._present_paths[path] = read_binary_file(self._files, path) is not None
        return self._present_paths[path]

    def _find_folders(self, name: str) -> list[str]:
        return [posixpath.join(parent, name) for parent in self._find_parents(name)]

    def _find_parents(self, name: str) -> list[str]:
        """Return the folders that hold a folder of this name."""
        if self._parents_by_name is None:
            self._parents_by_name = defaultdict(list)
            for folder in self._list_folders():
                self._parents_by_name[posixpath.basename(folder)].append(posixpath.dirname(folder))
        return self._parents_by_name.get(name, [])

    def _list_folders(self) -> Iterator[str]:
        for folder, folders, _ in self._files.walk_folders(""):
            folders[:] = [name for name in folders if not name.startswith(".") and name not in _SKIPPED_FOLDERS]
            if folder.count("/") >= _MAX_DEPTH - 1:
                folders.clear()
            if folder:
                yield folder
