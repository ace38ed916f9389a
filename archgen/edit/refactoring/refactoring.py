"""Edits of many texts that change names and places of elements and nothing else: made, lengthened where need be, proved.

What names elements outside of slices: the project's chapters, which are edited, and programs and signed texts, which are not.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

from archgen.checking.reference_index import PATH_KINDS, Element, WrittenName
from archgen.diagnostics import Span
from archgen.diagnostics.suggested_fixes import TextEdit
from archgen.edit.element_edit import EditRefusedError, FileEdit, read_editable
from archgen.edit.refactoring.judged_version import JudgedVersion, edit_files, judge_edited
from archgen.edit.refactoring.kept_names import KEEP_NONE, KeptNames, find_title, keep_names
from archgen.edit.refactoring.model_proof import RenamedIds, compare_models, find_followers, list_other_selections
from archgen.edit.refactoring.moved_lines import EntryMove, MovedLines, Place
from archgen.frozen import dataclass, replace
from archgen.grouping import group_pairs
from archgen.link.reference_resolution import list_endings
from archgen.project.source_reading import PASS_FOLDER
from archgen.syntax.yaml_writer import format_scalar

_LINKED_OR_QUOTED = re.compile(r"\(#([a-z_]{1,40}):([^)\s]{1,300})\)|`([^`\s]{1,300})`")
_PROGRAM_ENDINGS = (".py", ".j2", ".jinja")
_PROGRAM_FOLDERS = (PASS_FOLDER.rstrip("/"), "backends", "plugins")
_MOST_PROGRAM_LINES = 10


def list_chapter_edits(version: JudgedVersion, renamed: RenamedIds) -> Iterator[TextEdit]:
    """Yield the edits of links and of ids between backticks in the project's own chapters.

    What between backticks may mean several elements, of which not all are renamed, stays.
    """
    elements_by_ending: dict[str, dict[Element, None]] = {}
    for name in version.index.names:
        if name.is_declaration and not name.id.startswith("<"):
            endings = list_endings(name.id) if name.kind in PATH_KINDS else (name.id,)
            for ending in endings:
                elements_by_ending.setdefault(ending, {})[name.kind, name.id] = None
    for file in version.project.chapters.texts:
        try:
            _, text = read_editable(version.project, file)
        except EditRefusedError:  # a packed file holds it
            continue
        for number, line in enumerate(re.split(r"\r\n|\n|\r", text), start=1):
            for match in _LINKED_OR_QUOTED.finditer(line):
                group = 2 if match[2] else 3
                elements = [(match[1], match[2])] if match[2] else list(elements_by_ending.get(match[3], ()))
                texts = [_take_end(renamed.map_element(each)[1], match[group], each[0]) for each in elements]
                if len(set(texts)) == 1 and (new_text := texts[0]) != match[group]:
                    span = Span(file, number, match.start(group) + 1, number, match.end(group) + 1)
                    yield TextEdit(span, new_text)


def _take_end(new_id: str, written: str, kind: str) -> str:
    return ".".join(new_id.split(".")[-len(written.split(".")) :]) if kind in PATH_KINDS else new_id


def list_unedited(version: JudgedVersion, renamed: RenamedIds) -> Iterator[str]:
    """Yield sentences on what names what is renamed and is not edited: own passes and backends, what was signed."""
    words = {
        old_id.rpartition(".")[2]
        for (_, old_id), (_, new_id) in renamed.pairs.items()
        if old_id.rpartition(".")[2] != new_id.rpartition(".")[2]
    }
    files = version.project.loaded_project.files
    lines: list[str] = []
    for top in _PROGRAM_FOLDERS:
        for folder, _, names in files.walk_folders(top) if files.has_path(top) else ():
            for name in sorted(names):
                path = "/".join(filter(None, (top, folder, name)))
                data = files.fetch_bytes(path) if name.endswith(_PROGRAM_ENDINGS) else None
                for number, line in enumerate(data.splitlines() if isinstance(data, bytes) else (), start=1):
                    if words.intersection(re.findall(r"\w+", line.decode(errors="replace"))):
                        lines.append(f"{path}:{number}")
    if lines:
        more = f" and {len(lines) - _MOST_PROGRAM_LINES} more" if len(lines) > _MOST_PROGRAM_LINES else ""
        yield f"programs are not edited, and hold the word: {', '.join(lines[:_MOST_PROGRAM_LINES])}{more}"
    is_type = any(kind == "type" for kind, _ in renamed.pairs)
    for each in version.project.architecture.agreements.values():
        versions = each.signed.versions if each.signed else {}
        named = [("output", path) for paths in versions.values() for path in paths]
        if each.signed and (is_type or any(renamed.map_element(element) != element for element in named)):
            command = (
                f"archgen interfaces --between {' '.join(each.pair)} --signed {each.signed.tag or each.signed.revision}"
            )
            yield f"what was signed is not edited: `{command}` says what is called otherwise since"


_MAX_ROUNDS = 6
"""References are lengthened by a word in each round."""
MAX_LISTED = 5


@dataclass(frozen=True, slots=True)
class Refactoring:
    """What is to be written, and what people should know of it: `notes` are sentences."""

    edits: tuple[FileEdit, ...]
    renamed: RenamedIds
    notes: tuple[str, ...] = ()

    def with_note(self, note: str) -> Refactoring:
        """Return the same with a further sentence."""
        return replace(self, notes=(*self.notes, note))


def refuse_unsound(version: JudgedVersion) -> None:
    """Raise EditRefusedError where something of a project could not be read: what it names nobody knows."""
    errors = version.project.reading_errors
    if errors or version.project.loaded_project.partial:
        message = "something of the project cannot be read, and what it names would be lost"
        raise EditRefusedError(message, "mend it first", errors)


class NameTexts:
    """The new texts of names by their places: with the new word, and lengthened where they would mean something else."""

    def __init__(self, version: JudgedVersion, renamed: RenamedIds) -> None:
        self._version = version
        self._renamed = renamed
        self.texts: dict[Span, str] = {}
        self.lengthened: dict[Span, WrittenName] = {}
        self._short_forms = {each.span for each in version.index.names if each.is_declaration and not each.is_exact}

    def rename_word(self, name: WrittenName, number: int, word: str) -> None:
        """Write a name with another word. Raise EditRefusedError where that cannot be."""
        self._refuse_other(name)
        words = name.text.split(".") if name.kind in PATH_KINDS else [name.text]
        words[number] = word
        text = ".".join(words)
        if self.texts.setdefault(name.span, text) != text:
            message = f"{name.span}: `{name.text}` means several elements, which would need different names"
            raise EditRefusedError(message)

    def _refuse_other(self, name: WrittenName) -> None:
        """Refuse names that cannot be edited: made by a short form, written with escapes, or in a library."""
        loaded_project = self._version.project.loaded_project
        if name.span.file in loaded_project.library_files:
            message = f"{name.span} is in a library, where `{name.text}` stands for all who use it"
            raise EditRefusedError(message, "edit it in the library's files, with all projects that use it")
        if loaded_project.files.is_behind_link(name.span.file):
            message = f"{name.span.file} is behind a link: what else reads it nobody knows"
            raise EditRefusedError(message, "rename in the folder in which the file lies")
        if not name.is_exact or name.span in self._short_forms:
            message = f"{name.span}: the name of `{name.id}` follows from a short form, or is written with escapes"
            raise EditRefusedError(message, "write the long form first: `ID: {...}`")

    def lengthen(self, name: WrittenName) -> bool:
        """Write a name by one word more; return whether there is one."""
        new_id = self._renamed.map_id(name.kind, name.id)
        text = self.texts.get(name.span, name.text)
        words, all_words = text.split("."), new_id.split(".")
        if name.kind not in PATH_KINDS or name.is_declaration or len(words) >= len(all_words):
            return False
        self._refuse_other(name)
        longer = all_words[-len(words) - 1]
        if longer.startswith("<"):
            return False
        self.texts[name.span] = f"{longer}.{text}"
        self.lengthened[name.span] = name
        return True

    def list_edits(self) -> Iterator[TextEdit]:
        """Yield the edits that write the new texts."""
        for span, text in self.texts.items():
            yield TextEdit(span, self._write(span, text))

    def _write(self, span: Span, text: str) -> str:
        """Return a text as it is written at a place: in quotes if it needs them and has none."""
        line = self._version.project.sources.line_of(span.file, span.line) or ""
        before, after = line[: span.column - 1].rstrip(), line[span.end_column - 1 :].lstrip()
        is_whole = (not before or before[-1] in ":[{,-?") and (not after or after[0] in ":,]}#")
        return format_scalar(text) if is_whole else text


def prove_refactoring(
    version: JudgedVersion,
    renamed: RenamedIds,
    texts: NameTexts,
    kept: KeptNames = KEEP_NONE,
    moves: Sequence[EntryMove] = (),
) -> Refactoring:
    """Return the edits under which all references mean what they meant, and the models are the same.

    Names are edited first, then entries are moved. References that would mean something else are lengthened. Raise EditRefusedError where that is not enough.
    """
    chapter_edits = [] if kept.chapters else list(list_chapter_edits(version, renamed))
    for _ in range(_MAX_ROUNDS):
        edits = list(texts.list_edits())
        file_edits = edit_files(version, (*edits, *chapter_edits))
        place = place_after(edits)
        if moves:
            moved = MovedLines(version, file_edits)
            file_edits = _join_edits(file_edits, moved.move_all(moves))
            place = _place_moved(place, moved)
        edited = judge_edited(version, {edit.file: edit.new_content for edit in file_edits})
        if edited.project.reading_errors:
            first = edited.project.reading_errors[0]
            raise EditRefusedError(first.message, first.help or "")
        unread = [move.new_file for move in moves if move.new_file not in edited.project.yaml_files]
        if unread:
            message = f"{unread[0]} would not be taken for a part of the project"
            raise EditRefusedError(
                message, "what it would hold alone, other programs write as well: choose another file"
            )
        strayed = list(_list_strayed(version, edited, renamed, place))
        if not strayed:
            if any(kept):
                file_edits = keep_names(version, edited, file_edits, renamed, kept)
                edited = judge_edited(version, {edit.file: edit.new_content for edit in file_edits})
            _refuse_difference(version, edited, renamed, kept)
            notes = (*_list_notes(version, edited, renamed, texts, chapter_edits), *list_unedited(version, renamed))
            return Refactoring(file_edits, renamed, notes)
        # All of them in one round, each place once: inside of a type it means another element for each instance.
        places = {name.span: name for name in reversed(strayed)}
        if not [name for name in places.values() if texts.lengthen(name)]:
            break
    first_name = strayed[0]
    kind = first_name.kind.replace("_", " ")
    message = (
        f"{first_name.span}: `{first_name.text}` would no longer mean the {kind} `{first_name.id}` and nothing else"
    )
    raise EditRefusedError(message, "choose another name")


def _join_edits(first: Sequence[FileEdit], second: Sequence[FileEdit]) -> tuple[FileEdit, ...]:
    edits = {edit.file: edit for edit in (*first, *second)}
    return tuple(edits[file] for file in sorted(edits))


def _place_moved(place: Callable[[Span], Place], moved: MovedLines) -> Callable[[Span], Place]:
    return lambda span: moved.place(place(span))


def place_after(edits: Sequence[TextEdit]) -> Callable[[Span], Place]:
    """Return what says where a span begins after some edits within lines."""
    edits_by_line = group_pairs(((edit.span.file, edit.span.line), edit) for edit in edits)

    def place(span: Span) -> Place:
        before = (each for each in edits_by_line.get((span.file, span.line), ()) if each.span.column < span.column)
        moved = sum(len(each.text) - (each.span.end_column - each.span.column) for each in before)
        return span.file, span.line, span.column + moved

    return place


def _list_strayed(
    version: JudgedVersion, edited: JudgedVersion, renamed: RenamedIds, place: Callable[[Span], Place]
) -> Iterator[WrittenName]:
    """Yield the names that mean something else after some edits, or nothing, or hide something now."""
    known = {
        (name.span.file, name.span.line, column, name.kind, name.id)
        for name in edited.index.names
        # What is in quotes now begins one column later.
        for column in (name.span.column, name.span.column - 1)
    }
    hiding = {finding.span[:3] for finding in edited.project.findings if finding.rule == "hidden-reference"}
    hidden_before = {finding.span[:3] for finding in version.project.findings if finding.rule == "hidden-reference"}
    for name in version.index.names:
        new_place = place(name.span)
        if not new_place[0] and name.is_declaration:
            continue  # the key of what holds nothing here any more
        is_hiding = new_place in hiding and name.span[:3] not in hidden_before
        if is_hiding or (*new_place, *renamed.map_element((name.kind, name.id))) not in known:
            yield name


def _refuse_difference(
    version: JudgedVersion, edited: JudgedVersion, renamed: RenamedIds, kept: KeptNames = KEEP_NONE
) -> None:
    """Raise EditRefusedError where more than names would change."""
    # What is written out so that it stays is compared on the wire.
    kept_keys = frozenset({"name", "topic"} if kept.topics else ())
    difference = compare_models(version.project, edited.project, renamed, kept_keys)
    if difference.changes:
        more = f"; and {len(difference.changes) - MAX_LISTED} more" if len(difference.changes) > MAX_LISTED else ""
        message = f"more than names would change: {'; '.join(difference.changes[:MAX_LISTED])}{more}"
        is_wired = any(each.startswith("connection ") for each in difference.changes)
        help_line = (
            "`autoconnect`, or a whole group as a source, goes by names: write these connections with `from` first"
        )
        raise EditRefusedError(message, help_line if is_wired else "choose another name, or edit by hand")
    if difference.new_findings:
        message = "the project would have findings that it does not have now"
        raise EditRefusedError(message, "choose another name", difference.new_findings[:MAX_LISTED])


def _list_notes(
    version: JudgedVersion,
    edited: JudgedVersion,
    renamed: RenamedIds,
    texts: NameTexts,
    chapter_edits: Sequence[TextEdit],
) -> Iterator[str]:
    """Yield sentences on what follows from other ids, and on what names them and was not edited."""
    for name in texts.lengthened.values():
        yield f"{name.span}: `{name.text}` is `{texts.texts[name.span]}` now: the shorter path would mean something else"
    if _list_order(version, renamed) != _list_order(edited, RenamedIds({})):
        yield "elements come in another order now, which reports and lists show"
    for edit in chapter_edits:
        yield f"{edit.span}: the text of the chapter says `{edit.text}` now (--keep-chapters leaves it)"
    for (kind, old_id), element in renamed.pairs.items():
        was, is_now = find_title(version, kind, old_id), find_title(edited, *element)
        if was != is_now:
            yield f"the title `{was}` is `{is_now}` now (--keep-title keeps it)"
    architectures = version.project.architecture, edited.project.architecture
    for selection in list_other_selections(*architectures, renamed):
        yield f"{selection.text} is more or less by what moved: it goes by the group"
    followers = find_followers(*architectures, renamed)
    for what, pairs in zip(("node", "topic", "message"), followers, strict=True):
        for old_name, new_name in pairs:
            yield f"on the wire: the {what} `{old_name}` is `{new_name}` now"


def _list_order(version: JudgedVersion, renamed: RenamedIds) -> list[str]:
    """Return the ids of groups, components, and what nodes implement, as they are called afterwards, in order."""
    architecture = version.project.architecture
    implemented = (each for node in architecture.nodes.values() for each in node.implements)
    components = (renamed.map_id("component", each) for each in (*architecture.components, *implemented))
    return [*(renamed.map_id("group", each) for each in architecture.groups), *components]
