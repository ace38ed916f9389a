"""What the programs of a workspace say to ROS: each launched node with the walk through its sources, or its type of the library."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_actions import LaunchedNode
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.sources.program_walk import ProgramWalk
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import FoundNode, settle
from archgen.plugins.ros.workspace.program_sources import ProgramSources, WorkspaceFiles, WorkspacePackage

CPP_EXTRA = "pip install 'archgen[sources]'"
_MAX_DEPTH = 20


@dataclass(frozen=True, slots=True)
class ReadProgram:
    """The nodes of a program. The first is the one that the launch file means."""

    nodes: tuple[FoundNode, ...]
    is_ros_1: bool
    is_cut: bool = False


class ProgramReader:
    """Reads programs. What they have in common is read once."""

    def __init__(self, files: WorkspaceFiles, account: ImportAccount) -> None:
        self._files = files
        self._account = account
        self._index = SourceIndex(
            files.list_sources(), [(p.manifest.name, p.manifest.folder) for p in files.packages.values()]
        )
        self._codes: dict[tuple[str, str], CppCode] = {}

    def read_node(self, node: LaunchedNode) -> ReadProgram | None:
        """Return what a launched node says to ROS; None where its sources do not lie in the workspace, or cannot be read."""
        package = self._files.packages.get(node.package)
        if package is None:
            return None
        program = package.programs.get(node.executable)
        is_ros_1 = package.manifest.is_ros_1
        walk: ProgramWalk | None = None
        given = flatten_parameters(node.parameters)
        if node.plugin or (program is not None and program.plugin):
            walk = self._walk_plugin(package, node.plugin or (program.plugin if program else ""), given, node)
        elif program is None:
            words = f"the sources of the program `{node.executable}` of `{node.package}` were not found: it is not known what it says"
            self._account.add_note("program", words, node.span, fate="noted")
        elif program.language == "python":
            walk = self._walk_python(program, given, node, is_ros_1=is_ros_1)
        elif self._has_cpp(node):
            code = self._gather(package, node.executable)
            walk = self._start_walk(node, code, given, is_ros_1=is_ros_1)
            walk.walk_main()
        if walk is None or not walk.nodes:
            return None
        main = next((each for each in walk.nodes if settle(each.name) == node.name), None)
        main = main or next((each for each in walk.nodes if each.endpoints), walk.nodes[0])
        others = tuple(each for each in walk.nodes if each is not main and each.endpoints)
        if walk.is_cut:
            words = "it takes more steps than archgen walks: what comes later is not read"
            self._account.add_note("program", words, main.span)
        return ReadProgram((main, *others), is_ros_1, walk.is_cut)

    def _start_walk(
        self, node: LaunchedNode, code: CppCode | None, given: Mapping[str, Any], *, is_ros_1: bool
    ) -> ProgramWalk:
        walk = ProgramWalk(self._index, code, given, is_ros_1=is_ros_1)
        names = {"name": node.name, "namespace": node.namespace}
        walk.node_names = {key: name for key, name in names.items() if name}
        return walk

    def _walk_python(
        self, program: ProgramSources, given: Mapping[str, Any], node: LaunchedNode, *, is_ros_1: bool
    ) -> ProgramWalk | None:
        file = self._index.read_file(program.sources[0]) if program.sources else None
        if file is None:
            return None
        walk = self._start_walk(node, None, given, is_ros_1=is_ros_1)
        walk.walk_script(file, program.function)
        return walk

    def _has_cpp(self, node: LaunchedNode) -> bool:
        if not self._index.has_cpp_reader:
            words = f"sources in C++ are not read, those of `{node.executable or node.plugin}` for one"
            place = Span.of_file(node.package)
            if not any(note.kind == "C++" for note in self._account.notes):
                self._account.add_note("C++", words, place, f"`{CPP_EXTRA}` installs what reads them")
        return self._index.has_cpp_reader

    def _gather(self, package: WorkspacePackage, target: str) -> CppCode:
        key = (package.manifest.name, target)
        if key not in self._codes:
            if target:
                sources = self._files.list_linked_sources(package, target)
            else:
                sources = [
                    path for library in package.libraries for path in self._files.list_linked_sources(package, library)
                ]
            self._codes[key] = self._index.gather_cpp(sources)
        return self._codes[key]

    def _walk_plugin(
        self, package: WorkspacePackage, plugin: str, given: Mapping[str, Any], node: LaunchedNode
    ) -> ProgramWalk | None:
        if not self._has_cpp(node):
            return None
        code = self._gather(package, "")
        walk = self._start_walk(node, code, given, is_ros_1=package.manifest.is_ros_1)
        if walk.walk_class(plugin.replace("/", "::")) or walk.walk_class(plugin.rpartition("/")[2]):
            return walk
        words = f"the class `{plugin}` was not found in the libraries of `{package.manifest.name}`: it is not known what it says"
        self._account.add_note("program", words, node.span, fate="noted")
        return None

    def tell_unread(self) -> None:
        """Note each file that was looked into and could not be read."""
        for file in self._index.list_read_files():
            for line, column, reason in file.unread:
                self._account.add_note("sources", reason, Span(file.shown, line, column, line, column + 1))


def flatten_parameters(parameters: Mapping[str, Any], outer: str = "", depth: int = 0) -> dict[str, Any]:
    """Return parameters by their dotted names."""
    found: dict[str, Any] = {}
    for name, value in parameters.items():
        full_name = f"{outer}{name}".replace("/", ".")
        if isinstance(value, Mapping) and depth < _MAX_DEPTH:
            found |= flatten_parameters(value, f"{full_name}.", depth + 1)
        elif not isinstance(value, str) or "$(" not in value:
            found[full_name] = list(value) if isinstance(value, tuple) else value
    return found
