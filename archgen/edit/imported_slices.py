"""The slices that a model of another tool becomes, in a folder: new files, or those of an earlier import updated.

An update is a merge of three sides (`import_merge`): what the last import said, what this one says, and what people wrote.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from archgen import pipeline
from archgen.diagnostics import Diagnostic, Severity
from archgen.edit import earlier_import
from archgen.edit.earlier_import import ImportOrigin, KeyPath, SaidValue, read_earlier_import
from archgen.edit.edit_proof import list_new_errors
from archgen.edit.import_identity import (
    KeptIdentities,
    keep_files,
    keep_identities,
    list_known_ids,
    read_section,
    rename_ports,
)
from archgen.edit.import_merge import ImportChange, ImportSides, merge_import
from archgen.edit.said_endpoints import join_endpoints
from archgen.frozen import dataclass, field
from archgen.importers.foreign_import import ForeignImport
from archgen.merge.file_merge import ELSEWHERE_FOLDER, RECORD_FOLDER
from archgen.model import element_ids
from archgen.pipeline import CheckedProject
from archgen.project import PROJECT_FILE
from archgen.project.project_loading import load_from_files
from archgen.syntax import file_patterns
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import MAX_BYTES, OverlaidFiles, read_text_file
from archgen.syntax.yaml_writer import write_yaml

_Slices = dict[str, dict[str, Any]]


@dataclass(slots=True)
class PlannedSlice:
    """A file to write, and what changes in it. `file` is its path below the project's folder."""

    file: str
    text: str
    is_new: bool = True
    is_changed: bool = True
    changes: list[ImportChange] = field(default_factory=list)
    records: dict[str, str] = field(default_factory=dict)
    """By their paths what the next import has to know; none for a file that is none of its slices."""
    has_record: bool = True
    """Whether it is known what the last import said: without it nothing is taken away."""
    is_rewritten: bool = False
    is_left: bool = False
    """Whether nothing of it is in the model any more."""


@dataclass(slots=True)
class ImportPlan:
    """What an import would write below a project's folder, and how the project is judged then."""

    root: Path
    slices: list[PlannedSlice]
    checked_project: CheckedProject
    errors: tuple[Diagnostic, ...]
    """Errors that the project has only with what is imported."""
    renames: dict[str, str] = field(default_factory=dict)
    """The full names that nodes have by now, by their ids (`nodes.lidar`), which stay."""
    moves: dict[str, str] = field(default_factory=dict)
    """Where components stand in the project, by the place that the model has them in by now."""
    differences: tuple[str, ...] = ()
    """What other files of the project say otherwise, and did not when they were told last: path, their value, and that of the model."""

    @property
    def unread_files(self) -> list[str]:
        """Return the slices that the project does not read, by its `sources`."""
        read = frozenset(self.checked_project.loaded_project.sources.file_names())
        return [planned.file for planned in self.slices if planned.file not in read]

    @property
    def is_out_of_date(self) -> bool:
        """Whether the project does not say yet, or has not been told yet, what the source says."""
        return bool(self.differences or self.renames) or any(
            each.is_new or each.is_changed or each.changes for each in self.slices
        )


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
    mine = {f"{prefix}{name}": data for name, data in read_earlier_import(target, origin).items()} if merge else {}
    slices = {f"{prefix}{name}": data for name, data in imported.slices.items()}
    planning = _Planning(origin, files, is_merge=merge)
    if not is_new_project and files is not None:
        planning.before = pipeline.judge_project(load_from_files(files, PROJECT_FILE))
    comments = {path: text for each in imported.comments.values() for path, text in each.items()}
    now = planning.join_sides(slices, mine, comments)
    written = [name for name in {**now.slices, **mine} if now.slices.get(name) or name in mine]
    planned_slices = [planning.plan_slice(name, now.slices.get(name, {})) for name in written]
    for planned in planned_slices:
        # Told as renames.
        planned.changes = [
            each for each in planned.changes if each.path[2:] != ("name",) or ".".join(each.path[:2]) not in now.renames
        ]
    if is_new_project:
        planned_slices.insert(
            0, PlannedSlice(PROJECT_FILE, write_yaml(_make_project_data(imported, root, planned_slices)))
        )
    overlay = {planned.file: planned.text.encode() for planned in planned_slices}
    judged = pipeline.judge_project(load_from_files(OverlaidFiles(root, overlay, files), PROJECT_FILE))
    errors = [finding for finding in judged.findings if finding.severity is Severity.ERROR]
    if planning.before is not None:
        errors = list(list_new_errors(planning.before, judged))
    return ImportPlan(
        root, planned_slices, judged, tuple(errors), now.renames, now.moves, tuple(planning.list_differences())
    )


class _Planning:
    """The sides of all slices of an import, while they are brought together."""

    def __init__(self, origin: ImportOrigin, files: FolderFiles | None, *, is_merge: bool) -> None:
        self._origin = origin
        self._files = files
        self._is_merge = is_merge
        self.before: CheckedProject | None = None
        """The project as it is, where there is one."""
        self._base_texts: dict[str, str] = {}
        self._comments: dict[tuple[str | int, ...], str] = {}
        self._said_elsewhere: _Slices = {}
        self._differences: dict[str, dict[KeyPath, str]] = {}

    def join_sides(
        self,
        slices: Mapping[str, Mapping[str, Any]],
        mine: Mapping[str, Mapping[str, Any]],
        comments: Mapping[tuple[str | int, ...], str],
    ) -> KeptIdentities:
        """Return what the import says with the ids, places and files that its elements have, without what other files say."""
        said = self._read_others(frozenset({*slices, *mine}))
        others: dict[str, Any] = {}
        for path, value in said.items():
            earlier_import.put_value(others, path, value.value)
        # Also of slices that people gave another name.
        texts = {name: self._read_record(record_path(name)) for name in {**slices, **mine}} if self._is_merge else {}
        base = {
            name: earlier_import.read_slice_content(name, text).data for name, text in texts.items() if text is not None
        }
        kept_base = keep_files(keep_identities(base, mine, {}, self._origin.tool).slices, mine)
        self._base_texts = {
            name: texts.get(name) or "" if base.get(name) == data else self._origin.header + write_yaml(data)
            for name, data in kept_base.items()
        }
        known = {**{f"{name} ": data for name, data in mine.items()}, **kept_base}
        now = keep_identities(slices, known, others, self._origin.tool, comments)
        if (
            self._origin.has_dated_files
            and mine
            and not set(now.node_ids.values()) & read_section(mine, "nodes").keys()
        ):
            msg = "none of its nodes is in the slices here: it is another robot; nothing was written; `-o` names another folder"
            raise ImportRefusedError(msg)
        now_slices = keep_files(now.slices, mine)
        self._comments = now.comments
        if "nodes" in others and self.before is not None:
            project = self._judge_others((*slices, *mine))
            joined = join_endpoints(now_slices, project.architecture, project.loaded_project.documents, now.node_ids)
            now_slices, self._comments = rename_ports(joined.slices, joined.ports, now.comments)
        now.slices = {name: self._leave_out_said(name, data, said) for name, data in now_slices.items()}
        return now

    def _read_others(self, own_files: frozenset[str]) -> Mapping[KeyPath, SaidValue]:
        if self.before is None:
            return {}
        return earlier_import.list_said_values(self.before.loaded_project.documents, own_files)

    def _judge_others(self, own_files: Iterable[str]) -> CheckedProject:
        """Return the project without the import's own slices."""
        assert self.before is not None  # noqa: S101 - asked for before
        own = {name: b"{}\n" for name in own_files if self._files is not None and self._files.has_path(name)}
        if not own:
            return self.before
        root = self.before.loaded_project.root
        return pipeline.judge_project(load_from_files(OverlaidFiles(root, own, self._files), PROJECT_FILE))

    def _leave_out_said(
        self, name: str, data: Mapping[str, Any], said: Mapping[KeyPath, SaidValue]
    ) -> Mapping[str, Any]:
        """Return a slice without what other files of the project say."""
        if not said:
            return data
        normal_data = earlier_import.read_slice_content(name, write_yaml(data)).data
        left_out = earlier_import.leave_out_said(data, normal_data, said)
        self._said_elsewhere[name] = left_out.left_out
        self._differences[name] = left_out.differences
        return left_out.data

    def list_differences(self) -> list[str]:
        """Return what other files say otherwise, but for what was told before."""
        new: list[str] = []
        for name, differences in self._differences.items():
            told = earlier_import.read_slice_content(name, self._read_record(_elsewhere_path(name)) or "").data
            told_values = dict(earlier_import.list_leaves(told, ()))
            now_values = dict(earlier_import.list_leaves(self._said_elsewhere[name], ()))
            new += [words for path, words in differences.items() if told_values.get(path) != now_values[path]]
        return new

    def plan_slice(self, file: str, data: Mapping[str, Any]) -> PlannedSlice:
        """Plan a slice of which an import says some data."""
        files, origin = self._files, self._origin
        comments = {path: text for path, text in self._comments.items() if _holds_path(data, path)}
        new_text = origin.header + write_yaml(data, comments)
        if len(new_text.encode()) > MAX_BYTES:
            msg = f"{file} would be larger than {MAX_BYTES // 1_048_576} MiB, more than archgen reads: import the model in parts"
            raise ImportRefusedError(msg)
        said_elsewhere = write_yaml(self._said_elsewhere.get(file, {}))
        records = {record_path(file): new_text, _elsewhere_path(file): said_elsewhere}
        if said_elsewhere == "{}\n" and self._read_record(_elsewhere_path(file)) is None:
            del records[_elsewhere_path(file)]
        if files is None or not files.has_path(file):
            return PlannedSlice(file, new_text, records=records)
        if not self._is_merge:
            if not files.has_path(record_path(file)) and read_text_file(files, file).text == new_text:
                # Left by an import that was killed: its record comes last.
                return PlannedSlice(file, new_text, records=records)
            msg = f"{file} is there already; nothing was written; `--merge` brings it up to date, `-o` names another folder"
            raise ImportRefusedError(msg)
        old_text = self._read_mine(file)
        base_text = self._base_texts.get(file)
        if base_text and base_text.partition("\n")[2] == new_text.partition("\n")[2]:
            # A recording of another day that says the same is no news.
            new_text = records[record_path(file)] = base_text
        sides = ImportSides(base_text or "", old_text, new_text, data, comments, origin.header)
        merge, updated = merge_import(file, sides)
        return PlannedSlice(
            file,
            updated.text,
            is_new=False,
            is_changed=updated.text != old_text,
            changes=merge.changes,
            records=records,
            has_record=base_text is not None,
            is_rewritten=updated.is_rewritten,
            is_left=not data and not merge.data,
        )

    def _read_mine(self, file: str) -> str:
        """Return the text of a slice that is brought up to date. Raise ImportRefusedError."""
        assert self._files is not None  # noqa: S101 - a file is in it
        old_file = read_text_file(self._files, file)
        if old_file.problem:
            raise ImportRefusedError(f"{file} cannot be brought up to date", (old_file.problem,))
        if not self._origin.is_of(old_file.text):
            raise ImportRefusedError(
                f"{file} does not come from this file: nothing was written; a comment at its top would be "
                f"`{self._origin.header.strip()}`; `-o` names another folder"
            )
        if diagnostics := earlier_import.read_slice_content(file, old_file.text).diagnostics:
            raise ImportRefusedError(f"{file} cannot be brought up to date; nothing was written", diagnostics)
        return old_file.text

    def _read_record(self, path: str) -> str | None:
        """Return the text of a record, None where there is none that can be read: then nothing is taken away."""
        files = self._files
        if files is None or not files.has_path(path) or files.is_behind_link(path):
            return None
        record = read_text_file(files, path)
        if record.problem or earlier_import.read_slice_content(path, record.text).diagnostics:
            return None
        is_slice = path.startswith(f"{RECORD_FOLDER}/")
        return record.text if not is_slice or self._origin.is_of(record.text) else None


def _holds_path(data: Any, path: tuple[str | int, ...]) -> bool:  # noqa: ANN401 - plain data
    for key in path:
        is_there = key in data if isinstance(data, Mapping) else isinstance(data, list) and key in range(len(data))
        if not is_there:
            return False
        data = data[key]
    return True


def find_known_ids(origin: ImportOrigin, folder: Path) -> dict[str, str]:
    """Return the ids that elements have since an earlier import, by those of the other tool."""
    return list_known_ids(read_earlier_import(folder.resolve(), origin), origin.tool)


def find_root(folder: Path) -> Path | None:
    """Return the folder of the project that a folder is, or lies in; None where there is none."""
    return next((each for each in (folder, *folder.parents) if (each / PROJECT_FILE).is_file()), None)


def record_path(file: str) -> str:
    """Return where it stands, from the project's folder, what the last import said of a slice."""
    return f"{RECORD_FOLDER}/{file}"


def _elsewhere_path(file: str) -> str:
    return f"{ELSEWHERE_FOLDER}/{file}"


def _make_project_data(imported: ForeignImport, root: Path, slices: list[PlannedSlice]) -> dict[str, Any]:
    title = " ".join(imported.title.split()) or root.name
    data: dict[str, Any] = {"project": {"id": element_ids.make_id(title, "project"), "title": title}}
    if imported.distro:
        data["ros"] = {"distro": imported.distro}
    if imported.uses_shipped_library:
        data["libraries"] = {"ros": "builtin"}
    # Without `sources` a project is all YAML below it: what else lies there is none of its files.
    has_others = root.is_dir() and bool(file_patterns.list_yaml_files(FolderFiles(root)))
    return {**data, "sources": [planned.file for planned in slices]} if has_others else data
