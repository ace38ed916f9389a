"""Read the parameter files that nodes name, as far as they lie in the project, and give each node what they say to it.

Look for the parameter files that nodes name, as far as the project can hold them.
"""

from __future__ import annotations

import posixpath
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.diagnostics import Diagnostic, Severity, Span
from archgen.frozen import dataclass, field, replace
from archgen.link import mapping_values
from archgen.link.parameter_texts import ParameterText, find_node_values, read_parameter_text
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.parameter import FileRemark, ParameterValue
from archgen.model.ros_distro import is_ros_1
from archgen.syntax.project_files import ProjectFiles, read_binary_file, read_text_file
from archgen.syntax.yaml_tree import IgnoreComment, MappingNode, ScalarNode

MAX_CHARACTERS = 64 * 1024 * 1024
"""How much is read of all parameter files together."""
MAX_VALUES = 200_000
"""How many values files may give to all nodes together: `/**` gives each of its values to every node."""


@dataclass(frozen=True, slots=True)
class ReadParameters:
    """An architecture whose nodes know what their parameter files say.

    `texts` are the texts of the files by path. `packed_texts` are the same by the name under which a packed file holds
    them: as nodes write it, with the node's id behind it where that name means another file for it.
    """

    architecture: Architecture
    texts: Mapping[str, str] = field(default_factory=dict)
    packed_texts: Mapping[str, str] = field(default_factory=dict)
    ignores: tuple[IgnoreComment, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def read_node_parameters(root: MappingNode, architecture: Architecture, files: ProjectFiles | None) -> ReadParameters:
    """Read what the nodes of the merged project name. `files` is None where nothing beside the project's file is read."""
    naming_nodes = [node for node in architecture.nodes.values() if node.parameter_files]
    if not naming_nodes:
        return ReadParameters(architecture)
    reader = _ParameterReader(root, architecture, files)
    nodes = {**architecture.nodes, **{node.id: reader.read_files(node) for node in naming_nodes}}
    return ReadParameters(
        replace(architecture, nodes=nodes),
        reader.texts,
        reader.list_packed_texts(),
        tuple(ignore for text in reader.parsed_texts.values() for ignore in text.ignores),
        tuple(reader.diagnostics),
    )


class _ParameterReader:
    """Reads each file once; counts what is read, and says where it stops."""

    def __init__(self, root: MappingNode, architecture: Architecture, files: ProjectFiles | None) -> None:
        self._bodies = mapping_values.get_mapping(root, "nodes")
        self._packed = mapping_values.get_mapping(mapping_values.get_mapping(root, "ros"), "parameter_texts")
        self._files = files
        self._search = ParameterFileSearch(files) if files is not None else None
        self._ros_1 = is_ros_1(architecture.distro)
        self._node_names = frozenset(
            part
            for node in architecture.nodes.values()
            for part in (node.name, node.namespace.strip("/").partition("/")[0])
            if part
        )
        self._characters = self._values = self._looked_at = 0
        self.texts: dict[str, str] = {}
        self._texts_by_node: dict[str, dict[str, str | None]] = {}
        """The texts by the path as nodes write it, and by node; None where it leads nowhere."""
        self.parsed_texts: dict[str, ParameterText] = {}
        self.diagnostics: list[Diagnostic] = []

    def read_files(self, node: Node) -> Node:
        """Return a node with what its files say, in their order."""
        values: list[ParameterValue] = []
        unread_files: list[str] = []
        remarks: list[FileRemark] = []
        body = self._bodies.get(node.id)
        for scalar in mapping_values.get_scalars(body, "parameter_files") if isinstance(body, MappingNode) else ():
            parameter_text = None if self.diagnostics else self._read_file(scalar, node)
            if parameter_text is None or self._is_too_much(parameter_text, scalar):
                unread_files.append(scalar.text)
                continue
            file_values, remark = find_node_values(parameter_text, scalar, node, self._node_names, ros_1=self._ros_1)
            inner_values = tuple(self._read_inner_nodes(parameter_text, scalar, node))
            if remark is not None and not inner_values:
                unread_files.append(scalar.text)
                remarks.append(remark)
            self._values += len(file_values) + len(inner_values)
            values += (*file_values, *inner_values)
        return replace(node, file_values=tuple(values), unread_files=tuple(unread_files), file_remarks=tuple(remarks))

    def _read_inner_nodes(
        self, parameter_text: ParameterText, scalar: ScalarNode, node: Node
    ) -> Iterator[ParameterValue]:
        for prefix, inner_name in node.inner_nodes.items():
            namespace, _, name = f"{node.namespace.rstrip('/')}/{inner_name.strip('/')}".rpartition("/")
            inner_node = replace(node, name=name, namespace=namespace or "/")
            values, _ = find_node_values(parameter_text, scalar, inner_node, self._node_names, ros_1=self._ros_1)
            yield from (replace(value, name=f"{prefix}.{value.name}") for value in values)

    def _is_too_much(self, parameter_text: ParameterText, scalar: ScalarNode) -> bool:
        """Whether what a file may say to one more node is more than is read."""
        # A file of ROS 1 is searched through for each node; of one of ROS 2 its patterns with wildcards are tried.
        is_ros_2 = bool(parameter_text.sections)
        self._looked_at += len(parameter_text.positions.get("", ())) if is_ros_2 else parameter_text.value_count
        if self._values + parameter_text.value_count > MAX_VALUES or self._looked_at > MAX_VALUES:
            self._report_excess(scalar, f"parameter files give more than {MAX_VALUES:,} values to nodes")
            return True
        return False

    def _read_file(self, scalar: ScalarNode, node: Node) -> ParameterText | None:
        packed_names = (f"{scalar.text} of {node.id}", scalar.text)
        for name, packed in zip(packed_names, map(self._packed.get, packed_names), strict=True):
            if isinstance(packed, ScalarNode) and packed.value is not None:
                return self._parse(f"{packed.span.file}:{name}", packed.text, scalar, packed.span)
        path = self._find_file(scalar, node)
        text = None if path is None else self.texts[path]
        self._texts_by_node.setdefault(scalar.text, {})[node.id] = text
        return None if path is None or text is None else self._parse(path, text, scalar)

    def _find_file(self, scalar: ScalarNode, node: Node) -> str | None:
        """Return the path of a file that can be read, and keep its text."""
        path = self._search.find_file(scalar, node.package) if self._search else None
        # A link leads to what another checkout may not have: none is followed.
        if path is None or self._files is None or self._files.is_behind_link(path):
            return None
        if path not in self.texts:
            # What cannot be decoded is as good as absent: the robot's own tools say what is wrong with it.
            file_text = read_text_file(self._files, path)
            if file_text.problem is not None:
                return None
            self.texts[path] = file_text.text
        return path

    def list_packed_texts(self) -> dict[str, str]:
        """Return the texts as a packed file holds them: by the path that nodes write, where it is one file for all of them."""
        packed_texts = {e.key: e.value.text for e in self._packed if isinstance(e.value, ScalarNode)}
        for written_path, texts in self._texts_by_node.items():
            is_shared = len(set(texts.values())) == 1
            for node, text in texts.items():
                if text is not None:
                    packed_texts[written_path if is_shared else f"{written_path} of {node}"] = text
        return packed_texts

    def _parse(self, path: str, text: str, scalar: ScalarNode, packed_span: Span | None = None) -> ParameterText | None:
        if path not in self.parsed_texts:
            self._characters += len(text)
            if self._characters > MAX_CHARACTERS:
                self._report_excess(scalar, f"the parameter files hold more than {MAX_CHARACTERS:,} characters")
                return None
            self.parsed_texts[path] = read_parameter_text(path, text, packed_span)
        return self.parsed_texts[path]

    def _report_excess(self, scalar: ScalarNode, message: str) -> None:
        help_line = "from this file on none is read"
        self.diagnostics.append(Diagnostic("too-large", message, scalar.span, Severity.WARNING, help=help_line))


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
