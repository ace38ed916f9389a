"""Move an element into another group, or into another file; split a file into several."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from typing import Literal

from archgen.checking.reference_index import Element
from archgen.edit.element_edit import CannotInsertError, EditRefusedError, parse_text, read_editable
from archgen.edit.element_place import place_for_component
from archgen.edit.refactoring.element_rename import refuse_taken
from archgen.edit.refactoring.judged_version import JudgedVersion
from archgen.edit.refactoring.kept_names import KeptNames
from archgen.edit.refactoring.model_proof import RenamedIds
from archgen.edit.refactoring.moved_lines import EntryMove
from archgen.edit.refactoring.refactoring import NameTexts, Refactoring, prove_refactoring, refuse_unsound
from archgen.language.language_tables import COMMON_SECTIONS, SECTION_KINDS
from archgen.project import PROJECT_FILE
from archgen.syntax.yaml_tree import MappingNode, list_entries

SplitUnit = Literal["group", "component", "section"]
_SECTIONS = {kind: section for section, kind in SECTION_KINDS.items()}
_BLAME = "`git blame -C` finds who wrote the lines that moved; commit this by itself"


def plan_move(version: JudgedVersion, element: Element, group: str | None, file: str | None) -> Refactoring:
    """Return what moves an element into a group, a file, or both. Raise EditRefusedError."""
    refuse_unsound(version)
    if file is not None:
        refuse_strange_file(version, file)
    kind, element_id = element
    old_group, _, name = element_id.rpartition(".")
    if group is None or group == old_group:
        if file is None:
            message = f"`{element_id}` stands in that group already"
            raise EditRefusedError(message, "name another group, or a file with --file")
        return _move_to_file(version, element, file)
    if kind != "component" or "." in old_group or old_group.startswith("<"):
        message = f"`{element_id}` does not stand directly in a group"
        raise EditRefusedError(message, "components of groups are moved; what is inside of others goes with them")
    if group not in version.project.architecture.groups:
        raise EditRefusedError(f"there is no group `{group}`", "`archgen new group` makes one")
    renamed = RenamedIds({element: ("component", f"{group}.{name}")})
    refuse_taken(version, renamed)
    texts = NameTexts(version, renamed)
    for written, number in version.index.list_names_through(*element):
        if number > 0:
            texts.rename_word(written, number - 1, group)
    target = file or place_for_component(version.project, group).file
    moves = list(_list_group_moves(version, element_id, group, target))
    if not moves:
        message = f"`{element_id}` is not written in a block below `components` of its group"
        raise EditRefusedError(message, "write it there as `ID:` with its keys below first")
    refactoring = prove_refactoring(version, renamed, texts, KeptNames(owner=True), moves)
    return refactoring.with_note(_BLAME)


def refuse_strange_file(version: JudgedVersion, file: str) -> None:
    """Raise EditRefusedError for a file that no slice of the project can be."""
    if posixpath.isabs(file) or "\\" in file or posixpath.normpath(file) != file or file.startswith(".."):
        message = f"`{file}` lies outside of the project, or is not written plainly"
        raise EditRefusedError(message, "name a path from the project's folder, such as `groups/arm.yaml`")
    if not file.endswith((".yaml", ".yml")):
        raise EditRefusedError(f"`{file}` is no name of a slice", "end it in .yaml")
    if version.project.loaded_project.first_file != PROJECT_FILE:
        raise EditRefusedError("a project of one file has no others", f"call it {PROJECT_FILE}, in a folder")
    files = version.project.loaded_project.files
    if files.has_path(file) and file not in version.project.yaml_files:
        raise EditRefusedError(f"{file} is there, and no slice of the project", "choose another file")


def _move_to_file(version: JudgedVersion, element: Element, file: str) -> Refactoring:
    kind, element_id = element
    group, _, name = element_id.rpartition(".")
    if kind == "component" and "." not in group and not group.startswith("<"):
        path: tuple[str, ...] = ("groups", group, "components", name)
    elif kind in _SECTIONS:
        path = (_SECTIONS[kind], element_id)
    else:
        raise EditRefusedError(f"`{element_id}` stands inside of another element, and goes with it", "move that one")
    declared = dict.fromkeys(
        written.span.file for written in version.index.list_names(*element) if written.is_declaration
    )
    if any(each in version.project.loaded_project.library_files for each in declared):
        message = f"`{element_id}` is in a library, and is moved there"
        raise EditRefusedError(message, "edit it in the library's files, with all projects that use it")
    sources = [each for each in declared if each != file and _writes(version, each, path)]
    if not sources:
        raise EditRefusedError(f"{file} writes all of `{element_id}` already")
    # What other files say of it stays there: the first one declares it.
    moves = [EntryMove(sources[0], path, file, path[:-1])]
    renamed = RenamedIds({})
    return prove_refactoring(version, renamed, NameTexts(version, renamed), moves=moves).with_note(_BLAME)


def _writes(version: JudgedVersion, file: str, path: tuple[str, ...]) -> bool:
    return any(entry.key == path[-1] for entry in list_entries(_read_tree(version, file), *path[:-1]))


def _read_tree(version: JudgedVersion, file: str) -> MappingNode:
    _, text = read_editable(version.project, file)
    try:
        return parse_text(file, text.removeprefix("\ufeff")).root
    except CannotInsertError as error:
        raise EditRefusedError(str(error)) from None


def _list_group_moves(version: JudgedVersion, component_id: str, group: str, target: str) -> Iterator[EntryMove]:
    """Yield the entries that say something of a component: in all files, below variants' changes, with dotted ids."""
    old_group, _, name = component_id.partition(".")
    for file in version.project.yaml_files:
        root = _read_tree(version, file)
        variants = [entry.key for entry in list_entries(root, "variants")]
        for outer in ((), *(("variants", each, "changes") for each in variants)):
            for entry in list_entries(root, *outer, "groups", old_group, "components"):
                if entry.key == name or entry.key.startswith(f"{name}."):
                    holder = (*outer, "groups", old_group, "components")
                    is_main = not outer and file == _main_file(version, component_id)
                    yield EntryMove(
                        file, (*holder, entry.key), target if is_main else file, (*outer, "groups", group, "components")
                    )


def _main_file(version: JudgedVersion, component_id: str) -> str:
    architecture = version.project.architecture
    component = architecture.components.get(component_id) or architecture.shells[component_id]
    return component.at.file


def plan_split(version: JudgedVersion, file: str, unit: SplitUnit | None) -> Refactoring:
    """Return what puts each group, component or section of a file into a file of its own. Raise EditRefusedError."""
    refuse_unsound(version)
    if file not in version.project.yaml_files:
        message = f"{file} is no slice of the project"
        raise EditRefusedError(message, f"there are {', '.join(version.project.yaml_files[:5])}")
    refuse_strange_file(version, file)
    root = _read_tree(version, file)
    groups = [entry.key for entry in list_entries(root, "groups")]
    unit = unit or ("group" if len(groups) > 1 else "component" if groups else "section")
    paths = list(_list_units(root, unit))
    # A file of which nothing would be left keeps what comes first.
    others = [entry.key for entry in root if entry.key != "groups"] if unit == "group" else root.entries
    if file != PROJECT_FILE and (not others or (unit == "section" and len(paths) == len(root.entries))):
        paths = paths[1:]
    if not paths:
        message = f"there is nothing in {file} to be split by {unit}"
        raise EditRefusedError(message, "`--by group`, `component` or `section`")
    folder = posixpath.dirname(file) or ("" if unit == "section" else "groups")
    moves: list[EntryMove] = []
    for path in paths:
        new_file = posixpath.join(folder, f"{path[-1]}.yaml")
        if version.project.loaded_project.files.has_path(new_file) or any(move.new_file == new_file for move in moves):
            message = f"{new_file} is there already, or would hold two things"
            raise EditRefusedError(message, "`archgen move ELEMENT --file FILE` takes a name of your own")
        moves.append(EntryMove(file, path, new_file, path[:-1]))
    renamed = RenamedIds({})
    return prove_refactoring(version, renamed, NameTexts(version, renamed), moves=moves).with_note(_BLAME)


def _list_units(root: MappingNode, unit: SplitUnit) -> Iterator[tuple[str, ...]]:
    """Yield the paths of what gets a file of its own."""
    if unit == "section":
        yield from ((entry.key,) for entry in root if entry.key in SECTION_KINDS.keys() - COMMON_SECTIONS)
        return
    for group in list_entries(root, "groups"):
        if unit == "group":
            yield "groups", group.key
        else:
            parts = list_entries(group.value, "components")
            yield from (("groups", group.key, "components", part.key) for part in parts)
