"""Load a project: everything that later stages need to know about its files.

The settings of a loaded project as a variant has them: rules, distribution, and files of interfaces.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from archgen.diagnostics import Diagnostic, Severity, SourceTexts, Span, name_rule
from archgen.diagnostics.rule_options import WrittenOption
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.project.library_reading import (
    SHIPPED_ID,
    SHIPPED_PATH,
    LoadedLibrary,
    describe_missing_type,
    is_shipped_type,
    list_inner_folders,
    read_libraries,
    read_shipped_libraries,
)
from archgen.project.project_search import PROJECT_FILE, find_project
from archgen.project.slice_parsing import ParsedSlices, ReadingState
from archgen.project.source_patterns import expand_source_pattern
from archgen.project.source_reading import read_slice, read_sources
from archgen.syntax.folder_files import FolderFiles
from archgen.syntax.project_files import ProjectFiles
from archgen.syntax.yaml_tree import (
    IgnoreComment,
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlDocument,
    YamlNode,
    find_value,
    list_entries,
)


@dataclass(frozen=True, slots=True)
class LoadedProject:
    """A project whose files have been read. `documents` are in normal form, in the order in which they are merged.

    `first_file` was read first. `id` and `title` are the defaults for a project that states neither. `rule_settings`
    are the severities in `rules:` by name, `rule_options` the options (neither is judged yet), `rule_spans` where the rules are named. `interface_files`
    are relative to the project's folder. `chapter_entries` are those of `report.chapters`, None if it is not written.

    Nothing is used of the files in `broken_files`. `lost_keys` are the keys in them, and in whatever else was not
    understood: what they may declare is never reported as missing. `partial` is whether that was a whole file or
    section. `unread_names` is what slices declare that are not read, by their files. `library_files` are the files of libraries, read or not, by their paths from the project's folder.
    """

    files: ProjectFiles
    first_file: str
    id: str
    title: str
    documents: tuple[YamlDocument, ...]
    sources: SourceTexts
    diagnostics: tuple[Diagnostic, ...]
    ignores: Mapping[str, tuple[IgnoreComment, ...]] = field(default_factory=dict)
    rule_settings: Mapping[str, Severity] = field(default_factory=dict)
    rule_options: Mapping[str, Mapping[str, WrittenOption]] = field(default_factory=dict)
    rule_spans: Mapping[str, Span] = field(default_factory=dict)
    distro: str | None = None
    interface_files: tuple[str, ...] = ()
    broken_files: frozenset[str] = frozenset()
    lost_keys: frozenset[str] = frozenset()
    partial: bool = False
    libraries: tuple[LoadedLibrary, ...] = ()
    library_files: tuple[str, ...] = ()
    unread_names: Mapping[str, frozenset[str]] = field(default_factory=dict)

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self.files.root

    @property
    def library_ignores(self) -> tuple[IgnoreComment, ...]:
        """The comments that silence findings in libraries: nobody says that this project needs them."""
        return tuple(
            ignore for library in self.libraries for document in library.documents for ignore in document.ignores
        )

    @property
    def incomplete_libraries(self) -> frozenset[str]:
        """The libraries of which something could not be read."""
        return frozenset(library.id for library in self.libraries if not library.is_complete)

    def describe_missing_type(self, name: str) -> str | None:
        """Return what is to be known of a type that a library lacks, by its name with the library's id; None for nothing."""
        library_id, _, type_id = name.partition(".")
        library = next((library for library in self.libraries if library.id == library_id), None)
        if library is None and library_id == SHIPPED_ID and is_shipped_type(type_id, self.distro):
            return f"it ships with archgen: write `libraries: {{{SHIPPED_ID}: {SHIPPED_PATH}}}` in {PROJECT_FILE}"
        return describe_missing_type(type_id, self.distro) if library is not None and library.is_shipped else None


def load_project(path: Path | None = None, parsed_slices: ParsedSlices | None = None) -> LoadedProject:
    """Read the project in a folder, in a file, or (None) around the current folder."""
    root, first_file = find_project(path)
    return load_from_files(FolderFiles(root), first_file, parsed_slices)


def load_from_files(files: ProjectFiles, first_file: str, parsed_slices: ParsedSlices | None = None) -> LoadedProject:
    """Read a project, wherever its files are, beginning with `first_file`.

    Slices in `parsed_slices` are not parsed again, and new ones are added to it.
    """
    state = ReadingState(files, parsed_slices=parsed_slices)
    read_slice(state, first_file)
    if first_file == PROJECT_FILE:  # a file of any other name is the whole project: its `sources` are not followed
        state.skipped_folders = list_inner_folders(state.documents[0].root) if state.documents else frozenset()
        read_sources(state)
    return _finish_loading(state, first_file, tuple(read_libraries(state, first_file)))


def _finish_loading(state: ReadingState, first_file: str, libraries: tuple[LoadedLibrary, ...]) -> LoadedProject:
    # The default id and title come from the folder's name, or from the file's. A bare clone is called `robot.git`.
    stem = state.files.root.name.removesuffix(".git") if first_file == PROJECT_FILE else Path(first_file).stem
    name_words = re.findall(r"[a-z0-9]+", stem.lower())
    slug = "_".join(name_words) if name_words and name_words[0][0].isalpha() else "_".join(["project", *name_words])
    # Read off the documents before they are merged, because shipped types and interfaces depend on the distribution.
    settings = _read_settings(state, [document.root for document in state.documents])
    libraries = (*libraries, *read_shipped_libraries(state, first_file, settings.distro))
    return LoadedProject(
        files=state.files,
        first_file=first_file,
        id=slug,
        title=" ".join(name_words).capitalize() or "Project",
        documents=tuple(state.documents),
        sources=state.sources,
        diagnostics=tuple(state.diagnostics),
        ignores={document.file: document.ignores for document in state.documents if document.ignores},
        **settings._asdict(),
        broken_files=frozenset(state.broken_files),
        lost_keys=frozenset(state.lost_keys),
        partial=state.partial,
        libraries=libraries,
        library_files=tuple(state.library_files),
        unread_names=state.unread_names,
    )


class _Settings(NamedTuple):
    """What is read off a project before its elements are."""

    rule_settings: Mapping[str, Severity]
    rule_options: Mapping[str, Mapping[str, WrittenOption]]
    rule_spans: Mapping[str, Span]
    distro: str | None
    interface_files: tuple[str, ...]


def _read_settings(state: ReadingState, roots: Sequence[MappingNode]) -> _Settings:
    """Read the settings in mappings that are merged. In a conflict the first distribution wins, as it does in merging."""
    rule_entries = [
        MappingEntry(name_rule(entry.key), entry.key_span, entry.value)
        for root in roots
        for entry in list_entries(root, "rules")
    ]
    listings = (find_value(root, "ros", "interfaces") for root in roots)
    interface_files = [
        file
        for listing in listings
        if isinstance(listing, SequenceNode)
        for pattern in listing.items
        for file in expand_source_pattern(state, pattern)
    ]
    distros = (find_value(root, "ros", "distro") for root in roots)
    return _Settings(
        rule_settings={
            entry.key: Severity(severity.text)
            for entry in rule_entries
            if (severity := find_severity_setting(entry.value))
        },
        rule_options=read_rule_options(rule_entries),
        rule_spans={entry.key: entry.key_span for entry in rule_entries},
        distro=next((value.text for value in distros if isinstance(value, ScalarNode)), None),
        interface_files=tuple(dict.fromkeys(interface_files)),
    )


def find_severity_setting(setting: YamlNode) -> ScalarNode | None:
    """Return where a rule's severity is written: as its setting, or below `severity`; None where it is not."""
    node = setting.get("severity") if isinstance(setting, MappingNode) else setting
    return node if isinstance(node, ScalarNode) and node.value is not None else None


def read_rule_options(rule_entries: Iterable[MappingEntry]) -> dict[str, dict[str, WrittenOption]]:
    """Return the options by rule and name. Two files may set different options of one rule."""
    rule_options: dict[str, dict[str, WrittenOption]] = {}
    for rule_entry in rule_entries:
        for entry in list_entries(rule_entry.value):
            if entry.key != "severity":
                text = entry.value.text if isinstance(entry.value, ScalarNode) else ""
                written_option = WrittenOption(text, entry.key_span, entry.value.span)
                rule_options.setdefault(rule_entry.key, {})[entry.key] = written_option
    return rule_options


def changes_settings(variant: MappingEntry) -> bool:
    """Whether a variant writes or drops what is read off a project before its elements are."""
    body = variant.value
    if not isinstance(body, MappingNode):
        return False
    changes, drop = body.get("changes"), body.get("drop")
    sections = set(changes.entries) if isinstance(changes, MappingNode) else set()
    if isinstance(drop, SequenceNode):
        sections |= {item.text.partition(".")[0] for item in drop.items if isinstance(item, ScalarNode)}
    return not sections.isdisjoint({"rules", "ros"})


def adopt_settings(loaded_project: LoadedProject, root: MappingNode) -> LoadedProject:
    """Return a loaded project with the settings that its merged slices have in a variant."""
    # What is wrong with a pattern is told where the project itself is read, or as a message that is not known.
    state = ReadingState(loaded_project.files, sources=loaded_project.sources)
    settings = _read_settings(state, [root])
    return replace(
        loaded_project,
        **settings._asdict(),
        diagnostics=(*loaded_project.diagnostics, *state.diagnostics),
    )
