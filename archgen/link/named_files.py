"""Look for the files of the project that elements name: documents in `urls`, and pictures in `image`."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.link.report_chapters import ReportChapters
from archgen.model.known_parts import KnownParts
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
