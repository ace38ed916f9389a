"""Comments of a transformed file that say what each element was made from: written, and read again.

`# archgen: made[flatten] from arms.yaml:12:3`, and `# archgen: from arms.yaml:12:3` at what is as it was.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label, SourceTexts, Span, make_visible
from archgen.diagnostics.element_origins import Origin, TreePath
from archgen.frozen import replace
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import ElementPlace, MadeElement
from archgen.passes.project_tree import list_paths, walk_tree
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    list_entries,
)

_COMMENT = re.compile(r"# archgen: (?:made\[([a-z0-9_., ]{1,2000})\] )?from ([^#\r\n]{1,300})")
_UNMADE_SECTIONS = frozenset({"libraries", "properties", "variants"})
"""Sections of which no pass makes anything."""
_SECTIONS_OF_ELEMENTS = SECTION_KINDS.keys() - _UNMADE_SECTIONS
_MAX_OUTER_LINES = 100_000
MadePlace = tuple[Span, str]
"""The place that a made value carries, and its key where something else has this place, too; else nothing."""


def list_origin_comments(
    root: MappingNode, provenance: Mapping[TreePath, Origin], earlier: Mapping[ElementPlace, MadeElement]
) -> dict[TreePath, str]:
    """Return the comments of a transformed project by the path of what each is about: what was made, and all elements.

    `earlier` are those of passes that made the project's own files: what they say is further back.
    """
    made = {path: MadeElement(each.passes, str(each.at)) for path, each in provenance.items()}
    places = {path: each.at for path, each in provenance.items()}
    for path, key_span in _list_elements(root):
        if path not in made:
            around = _find_around(provenance, path)
            made[path] = MadeElement(around.passes if around else (), str(key_span))
            places[path] = key_span
    comments = keep_origin_comments(root, earlier)
    for path, each in made.items():
        before = earlier.get((places[path].file, places[path].line, 0))
        comments[path] = write_comment(
            MadeElement((*before.passes, *(n for n in each.passes if n not in before.passes)), before.place)
            if before
            else each
        )
    return comments


def keep_origin_comments(root: MappingNode, made_elements: Mapping[ElementPlace, MadeElement]) -> dict[TreePath, str]:
    """Return the comments of a file that is packed again, by the path of what each is about."""
    comments: dict[TreePath, str] = {}
    lines: set[tuple[str, int]] = set()
    for path, entry, node in walk_tree(root):
        span = entry.key_span if entry else node.span
        made = made_elements.get((span.file, span.line, 0))
        if made is not None and (span.file, span.line) not in lines:
            lines.add((span.file, span.line))
            comments[path] = write_comment(made)
    return comments


def write_comment(made_element: MadeElement) -> str:
    """Return a comment, without its mark: what a text that is no place could hold is taken out of it."""
    place = make_visible(made_element.place).replace("#", "?")
    names = ", ".join(made_element.passes)
    return f"archgen: made[{names}] from {place}" if names else f"archgen: from {place}"


def _find_around(provenance: Mapping[TreePath, Origin], path: TreePath) -> Origin | None:
    around = (provenance.get(path[:length]) for length in range(len(path), 0, -1))
    return next((each for each in around if each is not None), None)


def _list_elements(root: MappingNode) -> Iterator[tuple[TreePath, Span]]:
    """Yield the elements of a project with their keys' places: those of sections, and components in components."""
    for section in root:
        if section.key in _SECTIONS_OF_ELEMENTS and isinstance(section.value, MappingNode):
            for entry in section.value:
                yield (section.key, entry.key), entry.key_span
                yield from _list_components(entry, (section.key, entry.key))


def _list_components(holder: MappingEntry, path: TreePath) -> Iterator[tuple[TreePath, Span]]:
    for part in list_entries(holder.value, "components"):
        inner_path = (*path, "components", part.key)
        yield inner_path, part.key_span
        yield from _list_components(part, inner_path)


def index_origins(root: MappingNode, provenance: Mapping[TreePath, Origin]) -> dict[ElementPlace, MadeElement]:
    """Return what elements of a transformed project were made from, by the places that they carry."""
    made: dict[ElementPlace, MadeElement] = {}
    for path, span in _list_elements(root):
        origin = _find_around(provenance, path)
        if origin is not None and origin.passes:
            made.setdefault((span.file, span.line, span.column), MadeElement(origin.passes, str(span)))
    return made


def read_origin_comments(sources: SourceTexts) -> dict[ElementPlace, MadeElement]:
    """Return what the comments of a project's files say of where its elements come from, by file and line."""
    made: dict[ElementPlace, MadeElement] = {}
    for file in sources.file_names():
        text = sources.text_of(file) or ""
        # Hardly any file has such comments.
        if "# archgen: made[" not in text and "# archgen: from " not in text:
            continue
        for number, line in enumerate(text.split("\n"), 1):
            if (match := _COMMENT.search(line)) is not None:
                names = tuple(name.strip() for name in (match[1] or "").split(",") if name.strip())
                made[file, number, 0] = MadeElement(names, match[2].strip())
    return made


def label_findings(
    findings: Iterable[Diagnostic],
    sources: SourceTexts,
    made_elements: Mapping[ElementPlace, MadeElement],
    made_places: Mapping[MadePlace, Origin],
) -> tuple[Diagnostic, ...]:
    """Return findings that say of what a pass made which one it was, and from what."""
    return tuple(_label_finding(each, sources, made_elements, made_places) for each in findings)


def _label_finding(
    finding: Diagnostic,
    sources: SourceTexts,
    made_elements: Mapping[ElementPlace, MadeElement],
    made_places: Mapping[MadePlace, Origin],
) -> Diagnostic:
    name = (finding.element or "").rpartition(".")[2]
    origin = made_places.get((finding.span, "")) or made_places.get((finding.span, name))
    if origin is not None:
        text = f"{MadeElement(origin.passes, '').sentence} this"
        return replace(finding, labels=(*finding.labels, Label(origin.at, text)))
    line = _find_commented_line(finding.span, sources, made_elements)
    if line is None:
        return finding
    made = made_elements[finding.span.file, line, 0]
    width = len(sources.line_of(finding.span.file, line) or "") + 1
    place = Span(finding.span.file, line, 1, line, width)
    return replace(finding, labels=(*finding.labels, Label(place, str(made))))


def _find_commented_line(
    place: Span, sources: SourceTexts, made_elements: Mapping[ElementPlace, MadeElement]
) -> int | None:
    """Return the line of the innermost element around a place that says where it comes from."""
    if not any(file == place.file and column == 0 for file, _, column in made_elements):
        return None
    indent: int | None = None
    for number in range(place.line, max(0, place.line - _MAX_OUTER_LINES), -1):
        line = sources.line_of(place.file, number) or ""
        own_indent = len(line) - len(line.lstrip(" "))
        if not line.strip() or (indent is not None and own_indent >= indent):
            continue
        indent = own_indent
        if (place.file, number, 0) in made_elements:
            return number
    return None


def list_made_places(root: MappingNode, provenance: Mapping[TreePath, Origin]) -> dict[MadePlace, Origin]:
    """Return the places that made values carry, each with its origin; what only moved is where it was written."""
    places: dict[Span, Origin] = {}
    kept_places: set[Span] = set()
    origins: dict[TreePath, Origin | None] = {(): None}
    for path, node in list_paths(root):
        origin = provenance.get(path, origins.get(path[:-1]))
        origins[path] = origin
        is_made = origin is not None and bool(origin.passes) and not origin.is_moved
        for span in _list_spans(node):
            if is_made and origin is not None:
                places.setdefault(span, origin)
            else:
                kept_places.add(span)
    named_places: dict[MadePlace, Origin] = {
        (origin.at, str(path[-1])): origin for path, origin in provenance.items() if not origin.is_moved
    }
    return named_places | {(span, ""): origin for span, origin in places.items() if span not in kept_places}


def _list_spans(node: YamlNode) -> Iterator[Span]:
    if isinstance(node, MappingNode):
        yield from (entry.key_span for entry in node)
    elif isinstance(node, ScalarNode):
        yield node.span
    elif isinstance(node, SequenceNode):
        yield from (item.span for item in node.items if isinstance(item, ScalarNode))
