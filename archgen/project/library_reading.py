"""Read the libraries of a project: folders of component types and types that several projects share, and what ships.

The library of component types that ships with archgen: what `libraries: {ros: builtin}` stands for.

Its files are slices like any others, in `ros_library/`; `distributions.yaml` beside them says which file is for which
distributions of ROS, and in which of them a package is released.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, lru_cache
from itertools import chain
from types import MappingProxyType

from archgen import resources
from archgen.diagnostics import Diagnostic, Severity, Span, join_words
from archgen.frozen import NamedTuple, dataclass
from archgen.language.key_paths import SLICE
from archgen.language.language_tables import KEYS, SECTION_KINDS
from archgen.model.known_interfaces import KNOWN_DISTROS, guess_distro
from archgen.project.project_search import PROJECT_FILE
from archgen.project.slice_parsing import ReadingState, parse_slice
from archgen.project.source_reading import read_library_slices
from archgen.syntax.project_files import FileRefusal, LibraryFiles, ProjectFiles
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlDocument,
    YamlNode,
    find_value,
    list_entries,
)

LIBRARY_SECTIONS = ("component_types", "types")
_MEANINGS = frozenset({"ros", "glossary"})
_TYPE_START = re.compile(r"^(?=  \w)", re.MULTILINE)
_NAMED_PACKAGE = re.compile(r"\bpackage: *(\w+)")
_SETTINGS = KEYS[SLICE].keys() - SECTION_KINDS.keys() - _MEANINGS | {"partners"}
"""Sections of a library that is checked as a project of its own. They say nothing about who uses it."""


@dataclass(frozen=True, slots=True)
class LoadedLibrary:
    """A library of which the files have been read: its documents in normal form, in the order in which they are merged.

    They hold component types and types only. `folder` starts at the project's folder, "" for a library that could not be
    read, and for the one that ships with archgen (`is_shipped`): all that it holds counts as written at `at`.
    `is_complete` is whether all of its files could be read.
    """

    id: str
    at: Span
    folder: str = ""
    documents: tuple[YamlDocument, ...] = ()
    is_complete: bool = True
    is_shipped: bool = False


def list_library_paths(root: MappingNode) -> dict[str, ScalarNode]:
    """Return where the libraries that a file names lie, by their ids; what it holds itself and what ships lies nowhere."""
    return {library_id: path for library_id, path in _list_written_paths(root).items() if path.text != SHIPPED_PATH}


def _list_written_paths(root: MappingNode) -> dict[str, ScalarNode]:
    return {
        entry.key: path
        for entry in list_entries(root, "libraries")
        if isinstance(entry.value, MappingNode)
        and isinstance(path := entry.value.get("path"), ScalarNode)
        and path.value is not None
    }


def list_inner_folders(root: MappingNode) -> frozenset[str]:
    """Return the folders of libraries that lie in the project's own: their files are none of the project's."""
    folders = (posixpath.normpath(path.text) for path in list_library_paths(root).values())
    return frozenset(folder for folder in folders if folder != "." and not folder.startswith(("../", "/")))


def read_libraries(state: ReadingState, first_file: str) -> Iterator[LoadedLibrary]:
    """Read the files of all libraries. What is wrong with them goes to the state.

    Only archgen.yaml names libraries: all partners answer for it, and what else a project consists of must be known
    before its other files are read.
    """
    for document in state.documents:
        for entry in _list_pathless_libraries(document.root):
            if not _is_reported(state, entry):
                state.diagnostics.append(_diagnose_missing_path(entry))
            state.partial = True
            yield LoadedLibrary(entry.key, entry.key_span, is_complete=False)
        for library_id, path in list_library_paths(document.root).items():
            folder_files = _open_library(state, first_file, path)
            if isinstance(folder_files, FileRefusal):
                state.diagnostics.append(_diagnose_missing_library(library_id, path, folder_files))
                state.partial = True
                yield LoadedLibrary(library_id, path.span, is_complete=False)
            else:
                yield _read_library(state, library_id, path, LibraryFiles(posixpath.normpath(path.text), folder_files))


def _list_pathless_libraries(root: MappingNode) -> Iterator[MappingEntry]:
    """Yield libraries of which neither a path nor, as in a packed file, the content is written."""
    paths = _list_written_paths(root)
    for entry in list_entries(root, "libraries"):
        keys = entry.value.entries.keys() if isinstance(entry.value, MappingNode) else set()
        if entry.key not in paths and keys.isdisjoint(LIBRARY_SECTIONS):
            yield entry


def _diagnose_missing_path(entry: MappingEntry) -> Diagnostic:
    message = f"the library `{entry.key}` has no path"
    help_line = f"write its folder, as in `{entry.key}: ../{entry.key}`, or `builtin` for what ships with archgen"
    return Diagnostic("missing-library", message, entry.key_span, help=help_line)


def _is_reported(state: ReadingState, entry: MappingEntry) -> bool:
    """Whether something in an entry was not understood, and is reported already."""
    start, end = entry.key_span, entry.value.span
    return any(
        each.span.file == start.file
        and (start.line, start.column) <= (each.span.line, each.span.column) <= (end.end_line, end.end_column)
        for each in state.diagnostics
    )


def _open_library(state: ReadingState, first_file: str, path: ScalarNode) -> ProjectFiles | FileRefusal:
    if first_file != PROJECT_FILE:
        # What `sources` of such a file name is not read either.
        return FileRefusal(
            "a project of one file holds what it uses of its libraries",
            "`archgen pack` of the whole project puts it there",
        )
    return _find_file_refusal(path, first_file) or state.files.open_folder(path.text)


def _find_file_refusal(path: ScalarNode, first_file: str) -> FileRefusal | None:
    if path.span.file == first_file:
        return None
    return FileRefusal(f"only {PROJECT_FILE} names libraries", "write it there, below `libraries`")


def read_shipped_libraries(state: ReadingState, first_file: str, distro: str | None) -> Iterator[LoadedLibrary]:
    """Read what ships with archgen for a distribution, for each library that is `builtin`."""
    for document in state.documents:
        for library_id, path in _list_written_paths(document.root).items():
            if path.text == SHIPPED_PATH:
                refusal = _find_file_refusal(path, first_file) or _find_distro_refusal(distro)
                if refusal:
                    state.diagnostics.append(_diagnose_missing_library(library_id, path, refusal))
                    state.partial = True
                documents = () if refusal else (read_shipped_document(distro, path.span),)
                yield LoadedLibrary(library_id, path.span, "", documents, not refusal, is_shipped=True)


def _find_distro_refusal(distro: str | None) -> FileRefusal | None:
    distros = list_shipping_distros()
    if choose_distro(distro) in distros:
        return None
    return FileRefusal(
        f"nothing ships for the distribution `{distro}`", f"component types ship for {join_words(distros)}"
    )


def _read_library(state: ReadingState, library_id: str, path: ScalarNode, files: LibraryFiles) -> LoadedLibrary:
    library_state = ReadingState(files, sources=state.sources, parsed_slices=state.parsed_slices)
    read_library_slices(library_state, files.folder)
    state.diagnostics += library_state.diagnostics
    state.lost_keys |= library_state.lost_keys
    state.broken_files += library_state.broken_files
    state.partial |= library_state.partial
    state.library_files += sorted(library_state.seen_files)
    documents = []
    for document in library_state.documents:
        state.diagnostics += _find_unused_sections(document, library_id)
        sections = {name: entry for name, entry in document.root.entries.items() if name in LIBRARY_SECTIONS}
        if sections:
            documents.append(YamlDocument(document.file, MappingNode(sections, document.root.span), document.ignores))
    is_complete = not library_state.broken_files and not library_state.partial
    if not documents and is_complete:
        message = f"no file in `{path.text}` holds `component_types` or `types`"
        state.diagnostics.append(Diagnostic("missing-library", message, path.span, severity=Severity.WARNING))
    return LoadedLibrary(library_id, path.span, files.folder, tuple(documents), is_complete)


def _find_unused_sections(document: YamlDocument, library_id: str) -> Iterator[Diagnostic]:
    """Report libraries of a library, and note what else it has that no project gets from it."""
    unused_entries: list[MappingEntry] = []
    for entry in document.root:
        if entry.key == "libraries":
            message = f"`{library_id}` is a library, and a library has no libraries of its own"
            help_line = "write what it takes from others into it, or name both libraries in the project"
            yield Diagnostic("missing-library", message, entry.key_span, help=help_line)
        elif entry.key not in LIBRARY_SECTIONS and entry.key not in _SETTINGS and not _names_distribution_only(entry):
            unused_entries.append(entry)
    if unused_entries:
        names = ", ".join(f"`{entry.key}`" for entry in unused_entries)
        message = f"of the library `{library_id}` only `component_types` and `types` are used, not {names}"
        yield Diagnostic("ignored-file", message, unused_entries[0].key_span)


def _names_distribution_only(entry: MappingEntry) -> bool:
    """Whether an entry is `ros` with nothing but the distribution for which a library is checked by itself."""
    return entry.key == "ros" and isinstance(entry.value, MappingNode) and entry.value.entries.keys() <= {"distro"}


def _diagnose_missing_library(library_id: str, path: ScalarNode, refusal: FileRefusal) -> Diagnostic:
    message = f"the library `{library_id}` cannot be read from `{path.text}`: {refusal.message}"
    return Diagnostic("missing-library", message, path.span, help=refusal.help)


SHIPPED_PATH = "builtin"
"""What stands in the place of a library's path. A folder of this name is `./builtin`."""
SHIPPED_ID = "ros"
"""What the documentation calls the library; a project may call it otherwise."""
_FOLDER = "ros_library"
_TABLE_FILE = "distributions.yaml"


class DistributionTable(NamedTuple):
    """For which distributions the shipped types are."""

    files: Mapping[str, tuple[str, ...]]
    """The distributions that each file is for."""
    packages: Mapping[str, tuple[str, ...]]
    """The distributions in which each package is released."""


def choose_distro(distro: str | None) -> str | None:
    """Return the distribution whose types a project gets; the first one that is known for a project without any."""
    return KNOWN_DISTROS[0] if distro is None else guess_distro(distro)


@cache
def list_shipped_packages(distro: str | None) -> frozenset[str]:
    """Return the packages of a distribution of which the library knows programs."""
    packages = read_distribution_table().packages
    return frozenset(package for package, distros in packages.items() if distro in distros)


@cache
def load_shipped_component_types(distro: str | None) -> Mapping[str, MappingEntry]:
    """Return the component types that ship for a distribution, in normal form, by name; none for one that is not known.

    They are shared: nobody may change their trees.
    """
    return _gather_types(distro, list_shipped_packages(distro), parse_shipped_file)


@lru_cache(8)
def load_package_types(distro: str | None, packages: frozenset[str]) -> Mapping[str, MappingEntry]:
    """Return those of them that are of some packages. The rest of the files is not parsed: their places are others."""

    def parse_part(file: str) -> Iterable[MappingEntry]:
        head, *type_texts = _TYPE_START.split(_read_shipped_text(file))
        kept = [each for each in type_texts if not packages.isdisjoint(_NAMED_PACKAGE.findall(each))]
        # One by one: variants of a project use nearly the same packages.
        parts = [each for each in kept if ": *" not in each]
        if len(parts) < len(kept):  # what they share with other types stands at one of these
            parts.append("".join(each for each in type_texts if ": &" in each or (": *" in each and each in kept)))
        return chain.from_iterable(_parse_types(file, head + each) for each in parts)

    return _gather_types(distro, packages & list_shipped_packages(distro), parse_part)


def _gather_types(
    distro: str | None, packages: frozenset[str], parse: Callable[[str], Iterable[MappingEntry]]
) -> Mapping[str, MappingEntry]:
    files = [file for file, distros in read_distribution_table().files.items() if distro in distros]
    entries = {
        entry.key: _say_that_it_exists(entry.change_keys({"node": _say_that_it_exists}))
        for file in files
        for entry in parse(file)
        if _get_node_text(entry.value, "package") in packages
    }
    return MappingProxyType(dict(sorted(entries.items())))


def _say_that_it_exists(entry: MappingEntry) -> MappingEntry:
    """Return a type, or its node, with the status of what others have made: no program is generated for it."""
    status = MappingEntry("status", entry.key_span, ScalarNode("existing", "existing", entry.key_span))
    known_entries = entry.value.entries if isinstance(entry.value, MappingNode) else {}
    return entry.with_entries({**known_entries, "status": status})


@cache
def index_shipped_programs(distro: str | None) -> Mapping[tuple[str, str], tuple[str, ...]]:
    """Return the names of the types that ship for a distribution, as `index_programs` has them."""
    return index_programs(load_shipped_component_types(distro))


def index_programs(types: Mapping[str, MappingEntry]) -> Mapping[tuple[str, str], tuple[str, ...]]:
    """Return the names of types by package and executable or plug-in.

    Without generic ones: which messages theirs are only the running program tells.
    """
    index: dict[tuple[str, str], tuple[str, ...]] = {}
    for name, entry in types.items():
        for key in ("executable", "plugin") if find_value(entry.value, "generic") is None else ():
            program = _get_node_text(entry.value, "package"), _get_node_text(entry.value, key)
            if program[1]:
                index[program] = (*index.get(program, ()), name)
    return MappingProxyType(index)


# The trees of documents are never changed, and the history of a project reads hundreds of commits with the same line.
@lru_cache(8)
def read_shipped_document(distro: str | None, span: Span) -> YamlDocument:
    """Return the types that ship for a project's distribution as if all of them were written at a span.

    So no finding names a file that its reader does not have.
    """
    types = {
        name: MappingEntry(name, span, _move_node(entry.value, span))
        for name, entry in load_shipped_component_types(choose_distro(distro)).items()
    }
    section = MappingEntry("component_types", span, MappingNode(types, span))
    return YamlDocument(span.file, MappingNode({section.key: section}, span))


def is_shipped_type(name: str, distro: str | None) -> bool:
    """Whether a type ships for a project's distribution."""
    return name in load_shipped_component_types(choose_distro(distro))


def describe_missing_type(name: str, distro: str | None) -> str | None:
    """Return for which distributions a type ships that does not for a project's; None where it ships for none."""
    distros = [each for each in KNOWN_DISTROS if name in load_shipped_component_types(each)]
    if not distros:
        return None
    meant_distro = f"the project's distribution, {choose_distro(distro)}"
    if distro is None:
        meant_distro = f"{choose_distro(distro)}, which counts where `ros.distro` is not written"
    return f"it ships for {join_words(distros)}, not for {meant_distro}"


def list_shipping_distros() -> tuple[str, ...]:
    """Return the distributions for which types ship."""
    distros = {distro for file_distros in read_distribution_table().files.values() for distro in file_distros}
    return tuple(distro for distro in KNOWN_DISTROS if distro in distros)


@cache
def read_distribution_table() -> DistributionTable:
    """Return for which distributions files and packages are; read once."""
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    data = yaml.load(resources.resource_path(_FOLDER, _TABLE_FILE).read_text("utf-8"), loader)  # noqa: S506 - safe ones
    return DistributionTable(
        {name: tuple(distros) for name, distros in data["files"].items()},
        {name: tuple(distros) for name, distros in data["packages"].items()},
    )


@cache
def parse_shipped_file(file: str) -> MappingNode:
    """Return the component types of a shipped file. Raises `ValueError` where it is wrong, which a test rules out."""
    return _parse_types(file, _read_shipped_text(file))


def _read_shipped_text(file: str) -> str:
    return resources.resource_path(_FOLDER, file).read_text("utf-8")


@lru_cache(128)
def _parse_types(file: str, text: str) -> MappingNode:
    parsed_slice = parse_slice(file, text)
    diagnostics = parsed_slice.validate_once().diagnostics
    types = parsed_slice.document.root.get("component_types") if parsed_slice.document else None
    if diagnostics or not isinstance(types, MappingNode):
        raise ValueError(f"{file}: {'; '.join(f'{each.span.line}: {each.message}' for each in diagnostics)}")
    return types


def find_program_name(package: str, program: str) -> str | None:
    """Return what a program of ROS 2 calls its node where nobody names it, by its executable or plug-in.

    None where no type that ships knows it, or distributions differ.
    """
    names = _index_program_names().get((package, program), set())
    return next(iter(names)) if len(names) == 1 else None


@cache
def _index_program_names() -> Mapping[tuple[str, str], set[str]]:
    index: dict[tuple[str, str], set[str]] = {}
    for file, distros in read_distribution_table().files.items():
        for entry in () if "noetic" in distros else parse_shipped_file(file):
            package, own_name = (_get_node_text(entry.value, key) for key in ("package", "own_name"))
            for program in filter(None, (_get_node_text(entry.value, key) for key in ("executable", "plugin"))):
                index.setdefault((package, program), set()).add(own_name)
    return index


def _get_node_text(body: YamlNode, key: str) -> str:
    node = find_value(body, "node")
    value = find_value(node, key)
    return value.text if isinstance(value, ScalarNode) else ""


def _move_node(node: YamlNode, span: Span) -> YamlNode:
    if isinstance(node, ScalarNode):
        return ScalarNode(node.value, node.text, span, node.is_plain)
    if isinstance(node, SequenceNode):
        return SequenceNode([_move_node(item, span) for item in node.items], span)
    entries = {e.key: MappingEntry(e.key, span, _move_node(e.value, span)) for e in node}
    return MappingNode(entries, span, node.declares)
