"""The slices that a model of another tool becomes, in a folder: new files, or those of an earlier import updated.

An update puts what the model says into what stands there. All else stays: what people added, and their comments.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.edit import earlier_import
from archgen.edit.earlier_import import (
    ImportOrigin,
    keep_places,
    leave_out_said,
    list_known_ids,
    list_said_values,
    read_earlier_import,
)
from archgen.edit.edit_proof import list_new_errors
from archgen.frozen import dataclass, field
from archgen.importers.foreign_import import ForeignImport
from archgen.model import element_ids
from archgen.pipeline import CheckedProject
from archgen.project import PROJECT_FILE
from archgen.project.project_loading import load_from_files
from archgen.syntax import file_patterns
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import MAX_BYTES, OverlaidFiles, read_text_file
from archgen.syntax.yaml_writer import write_yaml

_HOLDERS = frozenset(
    {"groups", "components", "component_types", "nodes", "types", "hosts", "inputs", "outputs", "links"}
    | {"parameters", "operations", "fields"}
)
"""Keys below which elements stand by their ids."""
RECORD_FOLDER = ".archgen/imported"
"""What the last import wrote, below the project's folder: what is not said any more is told from what people added."""
_GROWING_KEYS = frozenset({"from", "implements", "connects"})
"""Keys whose lists people make longer: what they added to what the model says stays."""


@dataclass(slots=True)
class PlannedSlice:
    """A file to write, and what changes in it. `file` is its path below the project's folder."""

    file: str
    text: str
    is_new: bool = True
    is_changed: bool = True
    kept: list[str] = field(default_factory=list)
    """Elements that stand in the file and that the model does not name (any more): they stay."""
    replaced: list[str] = field(default_factory=list)
    """What the file said otherwise than the model: path, old and new value."""
    removed: list[str] = field(default_factory=list)
    """What the model said at the last import and does not say any more, and nobody had changed since: path and value."""
    record: str = ""
    """What the model says, as the next import has to know it; empty for a file that is none of its slices."""
    is_rewritten: bool = False


@dataclass(slots=True)
class ImportPlan:
    """What an import would write below a project's folder, and how the project is judged then."""

    root: Path
    slices: list[PlannedSlice]
    checked_project: CheckedProject
    errors: tuple[Diagnostic, ...]
    """Errors that the project has only with what is imported."""
    moves: dict[str, str] = field(default_factory=dict)
    """Where components stand in the project, by the place that the model has them in by now."""
    left_files: tuple[str, ...] = ()
    """Slices of the earlier import for which nothing is in the model any more: they stay."""
    differences: tuple[str, ...] = ()
    """What other files of the project say otherwise: path, their value, and that of the model."""

    @property
    def unread_files(self) -> list[str]:
        """Return the slices that the project does not read, by its `sources`."""
        read = frozenset(self.checked_project.loaded_project.sources.file_names())
        return [planned.file for planned in self.slices if planned.file not in read]


class ImportRefusedError(Exception):
    """The import cannot be written as it was asked for. The message says why and what to do."""

    def __init__(self, message: str, diagnostics: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.message, self.diagnostics = message, diagnostics


def plan_import(imported: ForeignImport, origin: ImportOrigin, folder: Path, *, merge: bool) -> ImportPlan:
    """Plan the slices of an import in a folder, which may be new. Raise ImportRefusedError."""
    target = folder.resolve()
    root = find_root(target)
    is_new_project = root is None
    root = root or target
    prefix = "" if target == root else f"{target.relative_to(root).as_posix()}/"
    files = FolderFiles(root) if root.is_dir() else None
    earlier = read_earlier_import(target, origin) if merge else {}
    new_slices, moves = keep_places(earlier, imported.slices, origin.tool)
    differences: list[str] = []
    if not is_new_project and files is not None:
        new_slices = _leave_out_said(new_slices, prefix, files, differences)
    slices = [
        _plan_slice(f"{prefix}{name}", data, imported.comments.get(name, {}), origin, files, merge=merge)
        for name, data in new_slices.items()
    ]
    if is_new_project:
        slices.insert(0, PlannedSlice(PROJECT_FILE, write_yaml(_make_project_data(imported, root, slices))))
    overlay = {planned.file: planned.text.encode() for planned in slices}
    judged = pipeline.judge_project(load_from_files(OverlaidFiles(root, overlay, files), PROJECT_FILE))
    errors = [finding for finding in judged.findings if finding.severity is Severity.ERROR]
    if not is_new_project and files is not None:
        before = pipeline.judge_project(load_from_files(files, PROJECT_FILE))
        errors = list(list_new_errors(before, judged))
    left_files = tuple(f"{prefix}{name}" for name in earlier if name not in new_slices)
    return ImportPlan(root, slices, judged, tuple(errors), moves, left_files, tuple(differences))


def _leave_out_said(
    new_slices: Mapping[str, Mapping[str, Any]], prefix: str, files: FolderFiles, differences: list[str]
) -> dict[str, Mapping[str, Any]]:
    """Return the slices without what other files of the project say; what they say otherwise is added to `differences`."""
    own_files = frozenset(f"{prefix}{name}" for name in new_slices)
    said = list_said_values(load_from_files(files, PROJECT_FILE).documents, own_files)
    kept_slices: dict[str, Mapping[str, Any]] = {}
    for name, data in new_slices.items():
        normal_data = earlier_import.read_slice_content(name, write_yaml(data)).data
        left_out = leave_out_said(data, normal_data, said)
        differences += left_out.differences
        if left_out.data:
            kept_slices[name] = left_out.data
    return kept_slices


def find_known_ids(origin: ImportOrigin, folder: Path) -> dict[str, str]:
    """Return the ids that elements have since an earlier import, by those of the other tool."""
    return list_known_ids(read_earlier_import(folder.resolve(), origin), origin.tool)


def find_root(folder: Path) -> Path | None:
    """Return the folder of the project that a folder is, or lies in; None where there is none."""
    return next((each for each in (folder, *folder.parents) if (each / PROJECT_FILE).is_file()), None)


def _make_project_data(imported: ForeignImport, root: Path, slices: list[PlannedSlice]) -> dict[str, Any]:
    title = " ".join(imported.title.split()) or root.name
    data: dict[str, Any] = {"project": {"id": element_ids.make_id(title, "project"), "title": title}}
    if imported.distro:
        data["ros"] = {"distro": imported.distro}
    # Without `sources` a project is all YAML below it: what else lies there is none of its files.
    has_others = root.is_dir() and bool(file_patterns.list_yaml_files(FolderFiles(root)))
    return {**data, "sources": [planned.file for planned in slices]} if has_others else data


def _plan_slice(  # noqa: PLR0913 - what, where and how
    file: str,
    data: Mapping[str, Any],
    comments: Mapping[tuple[str | int, ...], str],
    origin: ImportOrigin,
    files: FolderFiles | None,
    *,
    merge: bool,
) -> PlannedSlice:
    new_text = origin.header + write_yaml(data, comments)
    if len(new_text.encode()) > MAX_BYTES:
        msg = f"{file} would be larger than {MAX_BYTES // 1_048_576} MiB, more than archgen reads: import the model in parts"
        raise ImportRefusedError(msg)
    if files is None or not files.has_path(file):
        return PlannedSlice(file, new_text, record=new_text)
    if not merge and not files.has_path(record_path(file)) and read_text_file(files, file).text == new_text:
        return PlannedSlice(file, new_text, record=new_text)  # left by an import that was killed: its record comes last
    if not merge:
        msg = f"{file} is there already; nothing was written; `--merge` brings it up to date, `-o` names another folder"
        raise ImportRefusedError(msg)
    old_file = read_text_file(files, file)
    if old_file.problem:
        msg = f"{file} cannot be brought up to date"
        raise ImportRefusedError(msg, (old_file.problem,))
    if not origin.is_of(old_file.text):
        msg = (
            f"{file} does not come from this file: nothing was written; a comment at its top would be "
            f"`{origin.header.strip()}`; `-o` names another folder"
        )
        raise ImportRefusedError(msg)
    return _update_slice(file, old_file.text, new_text, _read_record(files, file, origin))


def record_path(file: str) -> str:
    """Return where it stands, from the project's folder, what the last import wrote into a slice."""
    return f"{RECORD_FOLDER}/{file}"


def _read_record(files: FolderFiles, file: str, origin: ImportOrigin) -> Mapping[str, Any]:
    """Return what the last import wrote into a slice, nothing where that is not known: then nothing is taken away."""
    path = record_path(file)
    if not files.has_path(path) or files.is_behind_link(path):
        return {}
    record = read_text_file(files, path)
    if record.problem or not origin.is_of(record.text):
        return {}
    return earlier_import.read_slice_content(path, record.text).data


def _update_slice(file: str, old_text: str, new_text: str, base: Mapping[str, Any]) -> PlannedSlice:
    old_content = earlier_import.read_slice_content(file, old_text)
    if old_content.diagnostics:
        msg = f"{file} cannot be brought up to date; nothing was written"
        raise ImportRefusedError(msg, old_content.diagnostics)
    # Read back, so that both sides are in the same normal form.
    new_content = earlier_import.read_slice_content(file, new_text)
    removed: list[str] = []
    old_data = _take_away_unsaid(old_content.data, base, new_content.data, removed)
    merged = _lay_over(old_data, new_content.data)
    updated = earlier_import.update_slice_text(old_text, write_yaml(old_content.data), write_yaml(merged))
    return PlannedSlice(
        file,
        updated.text,
        is_new=False,
        is_changed=updated.text != old_text,
        kept=list(_list_kept(old_content.data, new_content.data)),
        replaced=list(_list_replaced(old_data, merged)),
        removed=removed,
        record=new_text,
        is_rewritten=updated.is_rewritten,
    )


def _take_away_unsaid(  # noqa: PLR0913 - three versions of a mapping, and where it stands
    old: Mapping[str, Any],
    base: Mapping[str, Any],
    new: Mapping[str, Any],
    removed: list[str],
    path: str = "",
    *,
    holds: bool = False,
) -> dict[str, Any]:
    """Return the old mapping without what the model said last time, does not say now, and nobody has changed since.

    Elements stay: what other files say of them would be lost. `removed` gets what went, with its path.
    """
    kept: dict[str, Any] = {}
    for key, value in old.items():
        inner_path = f"{path}.{key}" if path else key
        base_value, new_value = base.get(key), new.get(key)
        is_element = holds or key in _HOLDERS or not path
        if isinstance(value, Mapping) and isinstance(base_value, Mapping) and (key in new or not is_element):
            inner_new = new_value if isinstance(new_value, Mapping) else {}
            inner_holds = not holds and key in _HOLDERS
            inner = _take_away_unsaid(value, base_value, inner_new, removed, inner_path, holds=inner_holds)
            if inner or key in new:
                kept[key] = inner
        elif not is_element and key in base and key not in new and value == base_value:
            removed.append(f"{inner_path}: {_quote(value)}")
        else:
            kept[key] = value
    return kept


def _lay_over(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """Return the old values with the new ones over them, mapping by mapping; other values are replaced."""
    merged = dict(old)
    for key, value in new.items():
        old_value = old.get(key)
        if isinstance(value, Mapping) and isinstance(old_value, Mapping):
            merged[key] = _lay_over(old_value, value)
        elif key not in _GROWING_KEYS or not _has_all(old_value, value):
            merged[key] = value
    return merged


def _has_all(old: object, new: object) -> bool:
    """Whether a list has all that the model says, and more."""
    wanted = new if isinstance(new, list) else [new]
    return isinstance(old, list) and all(each in old for each in wanted)


def _list_replaced(old: Mapping[str, Any], merged: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """Yield where the old values gave way, with both."""
    for key, value in old.items():
        inner_path, new_value = f"{path}.{key}" if path else key, merged[key]
        if isinstance(value, Mapping) and isinstance(new_value, Mapping):
            yield from _list_replaced(value, new_value, inner_path)
        elif value != new_value:
            yield f"{inner_path}: {_quote(value)} by {_quote(new_value)}"


def _quote(value: object) -> str:
    words = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    return f"`{words[:80]}`" if not isinstance(value, Mapping) and value is not None else "what stands there"


def _list_kept(old: Mapping[str, Any], new: Mapping[str, Any], path: str = "", *, holds: bool = False) -> Iterator[str]:
    """Yield the elements of the old mapping that the new one does not have, by their paths without section names."""
    for key, value in old.items():
        inner_path = f"{path}.{key}" if path and holds else key if holds else path
        if holds and key not in new:
            yield inner_path
        elif key in _GROWING_KEYS and key in new and isinstance(value, list):
            wanted = new[key] if isinstance(new[key], list) else [new[key]]
            extra = [str(each) for each in value if each not in wanted]
            if extra and _has_all(value, wanted):
                yield f"{inner_path} {key} {', '.join(extra)}"
        elif isinstance(value, Mapping):
            inner = new.get(key)
            inner = inner if isinstance(inner, Mapping) else {}
            yield from _list_kept(value, inner, inner_path, holds=not holds and key in _HOLDERS)
