"""What one branch renamed or moved is done on the other one, too, so that what both say of an element meets in one place.

The renames and moves of a branch are found by comparing it with what both began with, and done there and on the other branch by
what `rename` and `move` call: each is proved to change nothing else. Then the three are merged file by file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.checking.reference_index import Element
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.kinds import ELEMENT_KINDS
from archgen.compare.match_elements import match_elements
from archgen.diagnostics import Span
from archgen.edit.element_edit import EditRefusedError, FileEdit
from archgen.edit.refactoring.element_move import plan_move
from archgen.edit.refactoring.element_rename import plan_rename
from archgen.edit.refactoring.judged_version import JudgedVersion, judge_edited, judge_version
from archgen.edit.refactoring.model_proof import RenamedIds
from archgen.edit.refactoring.moved_lines import EntryMove, MovedLines
from archgen.frozen import NamedTuple, dataclass, field
from archgen.merge.branch_results import FileConflict, FollowedBranches
from archgen.merge.tree_merge import MappingValue, MergedValue, read_merged_value
from archgen.pipeline import CheckedProject, VersionCache
from archgen.syntax.yaml_tree import MappingNode, YamlNode, find_value, list_entries

_RENAMED_KINDS = tuple(
    kind for kind in ELEMENT_KINDS if kind not in {"project", "chapter", "message", "connection", "port"}
)
_LEAST_KEPT = 0.75
"""The share of the values of an element that a side says still if it only renamed it."""


@dataclass(slots=True)
class _Version:
    """A version of the project with what is followed in it; the contents that differ, None for a file that is gone."""

    judged: JudgedVersion
    contents: dict[str, bytes | None] = field(default_factory=dict)

    @property
    def project(self) -> CheckedProject:
        return self.judged.project

    def edit(self, edits: Iterable[FileEdit]) -> _Version:
        """Return the version with some edits."""
        new_contents = {edit.file: edit.new_content for edit in edits}
        return _Version(judge_edited(self.judged, new_contents), {**self.contents, **new_contents})


@dataclass(slots=True)
class _Versions:
    """The three versions, and what was followed, in sentences."""

    base: _Version
    ours: _Version
    theirs: _Version
    told: list[str] = field(default_factory=list)

    def replace_other(self, version: _Version, *, is_ours: bool) -> None:
        """Take a version for the side that is not ours, or the one that is."""
        if is_ours:
            self.theirs = version
        else:
            self.ours = version


class _Renamed(NamedTuple):
    """A side as it is, and the elements that it renamed."""

    project: CheckedProject
    new_elements: Mapping[Element, Element]


def follow_branches(
    base: CheckedProject, ours: CheckedProject, theirs: CheckedProject
) -> tuple[FollowedBranches | None, tuple[FileConflict, ...]]:
    """Return the three versions in which elements have the names and files that either side gave them; None where neither
    side renamed or moved any. What both sides did to one of them, each in its own way, is a conflict.
    """
    renamed = _Renamed(ours, dict(_list_renames(base, ours))), _Renamed(theirs, dict(_list_renames(base, theirs)))
    conflicts = (*_find_contradictions(base, *renamed), *_find_contradictions(base, *renamed[::-1]))
    cache = VersionCache()
    old, our, their = (_Version(judge_version(each.loaded_project, cache)) for each in (base, ours, theirs))
    versions = _Versions(old, our, their)
    if not conflicts:
        conflicts = tuple(_follow_renames(versions, *renamed))
    moves = [list(_list_moves(versions.base.project, side.project)) for side in (versions.ours, versions.theirs)]
    conflicts = (*conflicts, *_find_double_moves(*moves))
    if conflicts:
        return None, tuple(dict.fromkeys(conflicts))
    _follow_moves(versions, *moves)
    if not versions.told:
        return None, ()
    old_files, our_files, their_files = (
        (each.project, each.contents) for each in (versions.base, versions.ours, versions.theirs)
    )
    return FollowedBranches(old_files, our_files, their_files, tuple(versions.told)), ()


def _follow_renames(versions: _Versions, ours: _Renamed, theirs: _Renamed) -> Iterator[FileConflict]:
    """Rename in all versions what either side renamed; yield what cannot be renamed on the other one."""
    for own, other, is_ours in ((ours, theirs, True), (theirs, ours, False)):
        new_elements = {
            element: new_element
            for element, new_element in own.new_elements.items()
            if is_ours or other.new_elements.get(element) != new_element
        }
        base, steps = _rename_surely(versions.base, new_elements, own.project)
        other_version = versions.theirs if is_ours else versions.ours
        for element, step in steps.items():
            if other.new_elements.get(element) != own.new_elements[element]:
                try:
                    other_version = _rename(other_version, *step)
                except EditRefusedError as refusal:
                    new_id = own.new_elements[element][1]
                    what = f"one side renamed {_describe(element)} to `{new_id}`, and the other one cannot follow"
                    yield FileConflict("", f"{what}: {refusal.message}")
        versions.base = base
        versions.replace_other(other_version, is_ours=is_ours)
        versions.told += [f"{_describe(element)} is `{own.new_elements[element][1]}` now" for element in steps]


def _rename_surely(
    version: _Version, new_elements: Mapping[Element, Element], side: CheckedProject
) -> tuple[_Version, Mapping[Element, tuple[Element, Element]]]:
    """Return a version with all those elements renamed that are surely the same on a side, and from what to what each was
    renamed, one after the other, by what it is called at first.
    """
    candidates = dict(new_elements)
    while True:
        renamed, steps = version, dict[Element, tuple[Element, Element]]()
        for element, new_element in candidates.items():
            name = element
            for old, new in steps.values():  # an outer one may be called otherwise by now
                name = RenamedIds({old: new}).map_element(name)
            step = name, new_element
            try:
                renamed = _rename(renamed, *step)
            except EditRefusedError:
                continue  # such as a name that nobody wrote
            steps[element] = step
        unsure = [each for each, step in steps.items() if not _is_surely_renamed(renamed.judged, side, step[1])]
        if not unsure:
            return renamed, steps
        candidates = {each: new for each, new in candidates.items() if each in steps and each not in unsure}


def _follow_moves(versions: _Versions, our_moves: Sequence[EntryMove], their_moves: Sequence[EntryMove]) -> None:
    """Put in all versions what either side moved into the file that has it there."""
    for moves, shared, is_ours in (
        (our_moves, their_moves, True),
        ([m for m in their_moves if m not in our_moves], (), False),
    ):
        side, other = (versions.ours, versions.theirs)[:: 1 if is_ours else -1]
        try:
            base = _move(versions.base, moves, side.project)
            moved = _move(other, [move for move in moves if move not in shared], side.project)
        except EditRefusedError:
            continue  # such as an entry in braces: what both sides say of it conflicts, and is told
        versions.base = base
        versions.replace_other(moved, is_ours=is_ours)
        versions.told += _tell_moves(moves)


def _tell_moves(moves: Sequence[EntryMove]) -> Iterator[str]:
    """Yield a sentence for each file that elements left."""
    for file in dict.fromkeys(move.file for move in moves):
        own = [move for move in moves if move.file == file]
        new_files = ", ".join(dict.fromkeys(move.new_file for move in own))
        if len(own) == 1:
            yield f"`{'.'.join(own[0].path)}` stands in {new_files} now"
        else:
            yield f"{len(own)} entries of {file} stand in {new_files} now"


def _find_double_moves(our_moves: Sequence[EntryMove], their_moves: Sequence[EntryMove]) -> Iterator[FileConflict]:
    for ours in our_moves:
        for theirs in their_moves:
            if (ours.path, ours.file) == (theirs.path, theirs.file) and ours.new_file != theirs.new_file:
                files = " and to ".join(sorted((ours.new_file, theirs.new_file)))
                yield FileConflict(ours.file, f"both sides moved `{'.'.join(ours.path)}`: to {files}")


def _describe(element: Element) -> str:
    return f"the {element[0].replace('_', ' ')} `{element[1]}`"


def _list_ids(project: CheckedProject, kind: str) -> Mapping[str, object]:
    list_elements = ELEMENT_KINDS[kind].elements
    return list_elements(ArchitectureVersion(project.architecture)) if list_elements else {}


def _list_renames(base: CheckedProject, side: CheckedProject) -> Iterator[tuple[Element, Element]]:
    """Yield elements with what a side calls them, from the outside in; what follows from an outer one is left out."""
    ids = {kind: (_list_ids(base, kind).keys(), _list_ids(side, kind).keys()) for kind in _RENAMED_KINDS}
    # To recognise elements takes time: most branches rename nothing.
    if base is side or not any(old - new and new - old for old, new in ids.values()):
        return
    matched_ids = match_elements(base.architecture, side.architecture)
    outer: dict[Element, Element] = {}
    for kind in _RENAMED_KINDS:
        old_ids, new_ids = ids[kind]
        own_kind = "component" if kind == "composed" else kind
        for old_id, new_id in sorted(matched_ids.new_ids.get(kind, {}).items(), key=lambda pair: pair[0].count(".")):
            is_renamed = old_id != new_id and old_id not in new_ids and new_id not in old_ids
            if is_renamed and RenamedIds(outer).map_id(own_kind, old_id) != new_id:
                outer[own_kind, old_id] = (own_kind, new_id)
                yield (own_kind, old_id), (own_kind, new_id)


def _find_contradictions(base: CheckedProject, own: _Renamed, other: _Renamed) -> Iterator[FileConflict]:
    """Yield what both sides renamed, each in its own way, and what one side renamed and the other one took away."""
    old_elements = {new: old for old, new in other.new_elements.items()}
    for element, new_element in own.new_elements.items():
        new_id = new_element[1]
        other_id, twin = other.new_elements.get(element, new_element)[1], old_elements.get(new_element, element)
        file = _file_of(base, element)
        if other_id != new_id:
            first, second = sorted((new_id, other_id))
            yield FileConflict(file, f"both sides renamed {_describe(element)}: it is `{first}` and `{second}` now")
        elif twin != element:
            first, second = sorted((element[1], twin[1]))
            yield FileConflict(file, f"`{first}` and `{second}` are `{new_id}` now, each on one side")
        elif RenamedIds(other.new_elements).map_id(*element) == element[1] and not _holds(other.project, element):
            yield FileConflict(file, f"one side renamed {_describe(element)} to `{new_id}`, the other one took it away")


def _holds(project: CheckedProject, element: Element) -> bool:
    kinds = ("component", "composed") if element[0] == "component" else (element[0],)
    return any(element[1] in _list_ids(project, kind) for kind in kinds)


def _file_of(project: CheckedProject, element: Element) -> str:
    kinds = ("component", "composed") if element[0] == "component" else (element[0],)
    elements = (_list_ids(project, kind).get(element[1]) for kind in kinds)
    at = next((getattr(each, "at", None) for each in elements if each is not None), None)
    return at.file if isinstance(at, Span) else ""


def _rename(version: _Version, element: Element, new_element: Element) -> _Version:
    """Return a version with an element renamed, and in another group if it is. Raise EditRefusedError."""
    kind, old_id = element
    if not any(each.is_declaration for each in version.judged.index.list_names(kind, old_id)) and kind != "type":
        raise EditRefusedError(f"`{old_id}` is declared nowhere that can be edited")
    old_group, _, old_name = old_id.rpartition(".")
    new_group, _, new_name = new_element[1].rpartition(".")
    if kind not in {"component", "input", "output", "group"}:
        old_group, new_group, old_name, new_name = "", "", old_id, new_element[1]
    if old_name != new_name:
        version = version.edit(plan_rename(version.judged, element, new_name).edits)
        element = (kind, f"{old_group}.{new_name}" if old_group else new_name)
    if old_group != new_group:
        version = version.edit(plan_move(version.judged, element, new_group, None).edits)
    return version


def _is_surely_renamed(replayed: JudgedVersion, side: CheckedProject, element: Element) -> bool:
    """Whether a side says of an element nearly all that was said of it before, under the old name: else it may be another one."""
    for name in replayed.index.list_names(*element):
        if name.is_declaration:
            path = _find_path(replayed.project, name.span)
            before, after = (
                find_value(table, *path) if path else None
                for table in (replayed.project.merged_table, side.merged_table)
            )
            if before is None or after is None:
                return False
            kept = list(_compare_leaves(read_merged_value(before, path), read_merged_value(after, path)))
            if sum(kept) < _LEAST_KEPT * len(kept):
                return False
    return True


def _compare_leaves(before: MergedValue, after: MergedValue | None) -> Iterator[bool]:
    """Yield of each value that was said before whether it is said still."""
    if not isinstance(before, MappingValue):
        yield after == before
        return
    values = dict(after.items) if isinstance(after, MappingValue) else {}
    for key, value in before.items:
        yield from _compare_leaves(value, values.get(key))


def _find_path(project: CheckedProject, span: Span) -> tuple[str, ...]:
    """Return the keys that lead to the entry whose key stands at a place; nothing where no key stands there."""
    document = next((each for each in project.loaded_project.documents if each.file == span.file), None)
    return next(_search_path(document.root, span, ()), ()) if document else ()


def _search_path(node: YamlNode, span: Span, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    for entry in list_entries(node):
        if entry.key_span.line == span.line and entry.key_span.column <= span.column <= entry.key_span.end_column:
            yield (*path, entry.key)
        if isinstance(entry.value, MappingNode):
            yield from _search_path(entry.value, span, (*path, entry.key))


def _list_moves(base: CheckedProject, side: CheckedProject) -> Iterator[EntryMove]:
    """Yield what stood in one file and stands in another one on a side, as whole as it is.

    A file that has only another name is left to git.
    """
    if base is side:
        return
    roots = tuple({each.file: each.root for each in project.loaded_project.documents} for project in (base, side))
    moves = list(_compare_places(roots[0], roots[1], ()))
    for file in [each for each in dict.fromkeys(move.file for move in moves) if each not in roots[1]]:
        target, *others = dict.fromkeys(move.new_file for move in moves if move.file == file)
        is_only_renamed = (
            not others
            and target not in roots[0]
            and all(move.file == file for move in moves if move.new_file == target)
        )
        if is_only_renamed:
            moves = [move for move in moves if move.file != file]
    yield from moves


def _compare_places(
    old_nodes: Mapping[str, YamlNode], new_nodes: Mapping[str, YamlNode], path: tuple[str, ...]
) -> Iterator[EntryMove]:
    old_places, new_places = _list_places(old_nodes), _list_places(new_nodes)
    for key, old in old_places.items():
        new = new_places.get(key, {})
        if not new or (len(old) == 1 and old.keys() == new.keys()):
            continue
        if len(old) == len(new) == 1:
            yield EntryMove(next(iter(old)), (*path, key), next(iter(new)), path)
        elif all(isinstance(node, MappingNode) for node in (*old.values(), *new.values())):
            yield from _compare_places(old, new, (*path, key))


def _list_places(nodes: Mapping[str, YamlNode]) -> dict[str, dict[str, YamlNode]]:
    """Return what stands at each key, by file."""
    places: dict[str, dict[str, YamlNode]] = {}
    for file, node in nodes.items():
        for entry in list_entries(node):
            places.setdefault(entry.key, {})[file] = entry.value
    return places


def _move(version: _Version, moves: Sequence[EntryMove], side: CheckedProject) -> _Version:
    """Return a version with entries where a side has them. Raise EditRefusedError."""
    roots = {each.file: each.root for each in version.project.loaded_project.documents}
    own_moves = [each for move in moves for each in _fit_move(move, roots)]
    if not own_moves:
        return version
    moved = version.edit(MovedLines(version.judged, ()).move_all(own_moves))
    before, after = (_read_meaning(each.project) for each in (version, moved))
    if before != after:
        raise EditRefusedError("more than places would change")
    kept = {each.file for each in side.loaded_project.documents}
    for file in [each for each in dict.fromkeys(move.file for move in own_moves) if each not in kept]:
        # What splits a file takes it away.
        root = next((each.root for each in moved.project.loaded_project.documents if each.file == file), None)
        text = (moved.contents[file] or b"").decode()
        if root is None or not root.entries:
            is_bare = all(not line.strip() or line.lstrip().startswith("#") for line in text.splitlines())
            moved.contents[file] = None if is_bare else moved.contents[file]
    return moved


def _read_meaning(project: CheckedProject) -> MergedValue:
    value = read_merged_value(project.merged_table)
    items = value.items if isinstance(value, MappingValue) else ()
    return MappingValue(tuple((key, each) for key, each in items if key != "sources"))


def _fit_move(move: EntryMove, roots: Mapping[str, MappingNode]) -> Iterator[EntryMove]:
    """Yield a move as a version can take it: only what is there, and piece by piece into what is there already."""
    node = find_value(roots[move.file], *move.path) if move.file in roots else None
    if node is None:
        return
    target = find_value(roots[move.new_file], *move.path) if move.new_file in roots else None
    if target is None or not isinstance(node, MappingNode):
        yield move
        return
    for entry in node:
        path = (*move.path, entry.key)
        yield from _fit_move(EntryMove(move.file, path, move.new_file, move.path), roots)
