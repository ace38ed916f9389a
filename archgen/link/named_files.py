"""Look for the files that elements name: documents in `urls`, pictures in `image`, what verifies a requirement."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.link.report_chapters import ReportChapters
from archgen.model.architecture import Architecture
from archgen.model.known_parts import KnownParts
from archgen.model.requirement import Requirement, Verification
from archgen.syntax.project_files import ProjectFiles
from archgen.syntax.yaml_tree import MappingNode, ScalarNode

_PICTURE_ENDINGS = (".png", ".jpg", ".jpeg", ".svg", ".gif", ".webp")


class NamedFile(NamedTuple):
    """A path as it is written, with the element that names it."""

    element: str
    scalar: ScalarNode
    is_image: bool = False


def find_missing_files(
    named_files: Iterable[NamedFile], chapters: ReportChapters, *, is_folder: bool
) -> Iterator[Diagnostic]:
    """Report what is not there. A project of one file is a whole: the documents that it names lie elsewhere."""
    for named in named_files:
        if named.is_image:
            yield from _judge_image(chapters, named)
        elif is_folder and is_file_path(named.scalar.text):
            path = posixpath.normpath(named.scalar.text)
            if _is_inside(path) and chapters.files.has_path(path):
                continue
            yield _report_missing(chapters.files, named, "the file")


def is_file_path(address: str) -> bool:
    """Whether an entry of `urls` is the path of a file: it has no scheme."""
    return ":" not in address.partition("/")[0]


def _judge_image(chapters: ReportChapters, named: NamedFile) -> Iterator[Diagnostic]:
    path = posixpath.normpath(named.scalar.text)
    if not path.lower().endswith(_PICTURE_ENDINGS):
        message = f"`{named.scalar.text}` is no picture"
        help_line = "name a PNG, JPEG or SVG file of the project"
        yield Diagnostic("missing-file", message, named.scalar.span, help=help_line, element=named.element)
    elif chapters.read_picture(path) is None:
        if _is_inside(path) and chapters.files.has_path(path):
            message = f"the picture `{named.scalar.text}` cannot be shown"
            help_line = "a picture has at most 16 MiB, and an SVG is sound and names no entities"
            yield Diagnostic("missing-file", message, named.scalar.span, help=help_line, element=named.element)
        else:
            yield _report_missing(chapters.files, named, "the picture")


def _is_inside(path: str) -> bool:
    """Whether a normal path stays within the project's folder: outside nobody looks, not even whether it exists."""
    return not path.startswith(("/", "../")) and path not in (".", "..") and "\\" not in path and "\0" not in path


def _report_missing(files: ProjectFiles, named: NamedFile, noun: str) -> Diagnostic:
    text, span = named.scalar.text, named.scalar.span
    path = posixpath.normpath(text)
    if not _is_inside(path):
        message = f"{noun} `{text}` lies outside the project's folder"
        help_line = "copy it into the project, or write its address on the web"
        return Diagnostic("missing-file", message, span, help=help_line, element=named.element)
    parent, file_name = posixpath.split(path)
    _, _, neighbours = next(iter(files.walk_folders(parent)), ("", [], []))
    candidates = [posixpath.join(parent, each) for each in neighbours]
    help_line = did_you_mean(posixpath.join(parent, file_name), candidates) or (
        "write its path from the project's folder; an address on the web begins with `https://`"
    )
    return Diagnostic("missing-file", f"{noun} `{text}` is not there", span, help=help_line, element=named.element)


def list_image_paths(named_files: Iterable[NamedFile]) -> tuple[str, ...]:
    """Return the normal paths of the pictures of components and types, each once."""
    paths = (posixpath.normpath(each.scalar.text) for each in named_files if each.is_image)
    return tuple(dict.fromkeys(paths))


FilesByGroup = KnownParts[tuple[MappingNode, tuple[NamedFile, ...]]]
"""What is named below groups and component types, by their ids."""


def list_named_files(root: MappingNode, known_files: FilesByGroup | None = None) -> Iterator[NamedFile]:
    """Yield the documents and pictures that the elements of a project name, where they are written.

    `known_files` are those of other versions of the project: what is the same is not searched again.
    """
    for section in ("groups", "component_types"):
        for name, _, body in mapping_values.iterate_elements(root, section):
            yield from _list_below(name, body) if known_files is None else _recall_files(name, body, known_files)
    for section in ("nodes", "requirements"):
        for name, _, body in mapping_values.iterate_elements(root, section):
            yield from _list_own(name, body)


def _recall_files(name: str, body: MappingNode, known_files: FilesByGroup) -> tuple[NamedFile, ...]:
    files = next((files for known_body, files in known_files.list_known(name) if known_body is body), None)
    if files is None:
        files = tuple(_list_below(name, body))
        known_files.keep_part(name, (body, files))
    return files


def _list_below(element: str, body: MappingNode) -> Iterator[NamedFile]:
    """Yield what a group, a component or a type names, with its ports, its node, and the components inside."""
    yield from _list_own(element, body)
    yield from _list_own(element, mapping_values.get_mapping(body, "node"))
    for side in ("inputs", "outputs"):
        for _, _, port in mapping_values.iterate_elements(body, side):
            yield from _list_own(element, port)
    for name, _, inner_body in mapping_values.iterate_elements(body, "components"):
        yield from _list_below(f"{element}.{name}", inner_body)


def _list_own(element: str, body: MappingNode) -> Iterator[NamedFile]:
    if "urls" not in body.entries and "image" not in body.entries:  # nearly everything
        return
    urls = mapping_values.get_mapping(body, "urls")
    for entry in urls:
        scalar = mapping_values.get_scalar(urls, entry.key)
        if scalar is not None:
            yield NamedFile(element, scalar)
    image = mapping_values.get_scalar(body, "image")
    if image is not None:
        yield NamedFile(element, image, is_image=True)


_MAX_GUESSES = 50
"""So many get a guess; it is looked for among all use cases and chains."""


def find_missing_verifications(architecture: Architecture, files: ProjectFiles | None) -> Iterator[Diagnostic]:
    """Report what requirements name in `verified_by` and is neither a use case, nor a chain, nor a file of the project.

    `files` are those of the project's folder, None for a project of one file.
    """
    search = _FileSearch(files)
    guess_count = 0
    for requirement in architecture.requirements.values():
        for verification in requirement.verified_by:
            if verification.kind != "file" or _may_be_unread(architecture, verification):
                continue
            if search.is_missing(verification):
                guess_count += 1
                names = (*architecture.use_cases, *architecture.chains) if guess_count <= _MAX_GUESSES else ()
                yield _diagnose_missing(requirement, verification, did_you_mean(verification.text, names))


def _may_be_unread(architecture: Architecture, verification: Verification) -> bool:
    """Whether what could not be read may declare it."""
    sections = {verification.text, "use_cases", "chains"}
    return architecture.partial or not sections.isdisjoint(architecture.unread_keys)


def _diagnose_missing(requirement: Requirement, verification: Verification, guess: str | None) -> Diagnostic:
    return Diagnostic(
        "missing-verification",
        f"`{verification.text}` is neither a use case, nor a chain, nor a file of the project",
        verification.at,
        help=guess or "write the path of a file from the project's folder, or a sentence with a blank",
        element=requirement.id,
    )


class _FileSearch:
    """Looks for each file once: a thousand requirements may name one."""

    def __init__(self, files: ProjectFiles | None) -> None:
        self._files = files
        self._present_paths: dict[str, bool] = {}

    def is_missing(self, verification: Verification) -> bool:
        """Whether a file is not where it should be."""
        if not verification.file:
            return True
        if self._files is None:
            return "/" not in verification.file and "." not in verification.file
        folders = dict.fromkeys(["", posixpath.dirname(verification.at.file)])
        return not any(self._is_present(posixpath.join(folder, verification.file)) for folder in folders)

    def _is_present(self, path: str) -> bool:
        path = posixpath.normpath(path)
        # Nothing outside is looked at, not even whether it exists.
        if self._files is None or path.startswith(("../", "/")) or path == "..":
            return False
        if path not in self._present_paths:
            self._present_paths[path] = self._files.has_path(path) and not self._files.is_behind_link(path)
        return self._present_paths[path]
