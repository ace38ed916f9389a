"""What the programs of a workspace say to ROS: each launched node with the walk through its sources, or its type of the library."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import Span
from archgen.plugins.ros.launch.launch_actions import LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_run import LaunchRun
from archgen.plugins.ros.launch.launch_values import OPEN
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.sources.program_walk import ProgramWalk
from archgen.plugins.ros.sources.source_index import CppCode, SourceIndex
from archgen.plugins.ros.sources.walk_values import FoundNode, UnknownText, settle, show_value
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles, WorkspacePackage

CPP_EXTRA = "pip install 'archgen[sources]'"
_MAX_DEPTH = 20


@dataclass(frozen=True, slots=True)
class ReadProgram:
    """The nodes of a program. The first is the one that the launch file means."""

    nodes: tuple[FoundNode, ...]
    is_ros_1: bool
    strange_base: str = ""
    """A base of its classes that lies elsewhere, and may say more to ROS than what was read; empty where there is none."""


class ProgramReader:
    """Reads programs. What they have in common is read once."""

    def __init__(self, files: WorkspaceFiles, account: ImportAccount, run: LaunchRun) -> None:
        self._files = files
        self._run = run
        self._account = account
        self._index = SourceIndex(
            files.list_sources(), [(p.manifest.name, p.manifest.folder) for p in files.packages.values()]
        )
        self._codes: dict[tuple[str, str], CppCode] = {}

    def read_node(self, node: LaunchedNode) -> ReadProgram | None:
        """Return what a launched node says to ROS; None where its sources do not lie in the workspace, or cannot be read."""
        walk = self._walk_node(node, {})
        names = (
            {name for each in walk.nodes if isinstance(name := settle(each.name), str)} if walk is not None else set()
        )
        # What a file gives to a node by a name that only the program knows is known when that is.
        by_name = {name: self._read_files(node, name) for name in sorted(names - {node.name})}
        if any(by_name.values()):
            walk = self._walk_node(node, by_name)
        if walk is None or not walk.nodes:
            if walk is not None:
                words = f"no node was found in the sources of `{node.executable or node.plugin}`: it is not known what it says"
                self._account.add_note("program", words, node.span, fate="noted")
            return None
        main = next((each for each in walk.nodes if settle(each.name) == node.name), None)
        main = main or next((each for each in walk.nodes if each.endpoints), walk.nodes[0])
        # What is made twice at one place by one name, as by a module that runs when it is imported, is one after the other.
        made = {(each.span, show_value(each.name), show_value(each.namespace)): each for each in (*walk.nodes, main)}
        others = tuple(each for each in made.values() if each is not main and each.endpoints)
        if walk.is_cut:
            words = "it takes more steps than archgen walks: what comes later is not read"
            self._account.add_note("program", words, main.span)
        return ReadProgram((main, *others), walk.is_ros_1, next(iter(walk.strange_bases), ""))

    def _read_files(self, node: LaunchedNode, name: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for text in node.parameter_files:
            path, full_name = self._run.files.find_file(text), join_names(node.namespace, name)
            values = None if path is None else self._run.parameter_reader.read_for_node(path, full_name)
            found |= flatten_parameters(values or {})
        return found

    def _walk_node(self, node: LaunchedNode, by_name: Mapping[str, Mapping[str, Any]]) -> ProgramWalk | None:
        package = self._files.packages.get(node.package)
        if package is None:
            return None
        program = package.programs.get(node.executable)
        plugin = node.plugin or (program.plugin if program is not None else "")
        if program is None and not plugin:
            words = f"the sources of the program `{node.executable}` of `{node.package}` were not found: it is not known what it says"
            self._account.add_note("program", words, node.span, fate="noted")
            return None
        is_python = not plugin and program is not None and program.language == "python"
        if not is_python and not self._has_cpp(node):
            return None
        code = None if is_python else self._gather(package, "" if plugin else node.executable)
        given = _mark_unknown(flatten_parameters(node.parameters), node)
        walk = ProgramWalk(self._index, code, given, self._account.budget, is_ros_1=package.manifest.is_ros_1)
        names = {"name": node.name, "namespace": node.namespace}
        walk.node_names = {key: name for key, name in names.items() if name}
        walk.node_parameters = dict(by_name)
        if plugin:
            if not walk.walk_class(plugin.replace("/", "::")) and not walk.walk_class(plugin.rpartition("/")[2]):
                words = f"the class `{plugin}` was not found in the libraries of `{node.package}`: it is not known what it says"
                self._account.add_note("program", words, node.span, fate="noted")
        elif program is not None and is_python:
            file = self._index.read_file(program.sources[0])
            if file is not None:
                walk.walk_script(file, program.function)
        else:
            walk.walk_main()
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
        else:
            found[full_name] = list(value) if isinstance(value, tuple) else value
    return found


def _mark_unknown(given: Mapping[str, Any], node: LaunchedNode) -> dict[str, Any]:
    """Return the parameters of a node as its program sees them: those that only the launch knows are not what the program has by default."""
    found = {
        name: UnknownText(value, node.span) if isinstance(value, str) and OPEN in value else value
        for name, value in given.items()
    }
    unclear = {**node.unclear_parameters, **dict.fromkeys(node.parameter_commands, "what a command prints")}
    return {**{name.replace("/", "."): UnknownText(why, node.span) for name, why in unclear.items()}, **found}
