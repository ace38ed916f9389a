"""From the table of a project to its architecture, both levels of it.

The day up to which a project's repository has gone: on it rests whether what is deprecated may still be used.

The interface definitions that a project brings itself: files, those in its YAML, those of its types.

A loaded project becomes one table first, of its slices and libraries.
"""

from __future__ import annotations

from archgen import compose, derivation, link, project
from archgen.checking.all_rules import list_structural_errors
from archgen.compose.expanded_project import ExpandedProject
from archgen.derivation.derived_parts import DerivedParts
from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass, replace
from archgen.link import element_outline, interface_sources, named_files, node_parameter_files, slice_merging
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.interface_sources import TypeMessages
from archgen.link.link_memory import LinkMemory
from archgen.link.node_parameter_files import ReadParameters
from archgen.link.project_types import declare_project_types
from archgen.link.reference_resolution import HeardReferences
from archgen.link.variants import variant_order
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import Interfaces, guess_distro
from archgen.model.known_parts import KnownParts
from archgen.project import LoadedProject
from archgen.syntax import project_files
from archgen.syntax.project_files import ProjectFiles
from archgen.syntax.yaml_tree import MappingNode, ScalarNode


@dataclass(frozen=True, slots=True)
class MergedProject:
    """A loaded project whose slices and libraries are one table, and what was found on the way."""

    loaded_project: LoadedProject
    table: MappingNode
    diagnostics: tuple[Diagnostic, ...]
    reading_errors: tuple[Diagnostic, ...]
    damaged_elements: frozenset[str]

    @property
    def is_folder(self) -> bool:
        """Whether it is a folder: a project of one file is a whole, and what it names, like its `sources`, lies elsewhere."""
        return self.loaded_project.first_file == project.PROJECT_FILE


def merge_project(loaded_project: LoadedProject) -> MergedProject:
    """Return a loaded project as one table, with what was found in merging it."""
    # These errors mean that something is missing in the architecture: the findings that they explain wait, so that one
    # mistake is reported once.
    reading_errors = tuple(list_structural_errors(loaded_project.diagnostics))
    damaged_elements = frozenset(error.element for error in reading_errors if error.element)
    merged_table, merge_findings = slice_merging.merge_documents(
        loaded_project.documents, loaded_project.lost_keys, damaged_elements
    )
    merged_table, library_findings = slice_merging.merge_libraries(merged_table, loaded_project.libraries)
    variant_findings = (
        tuple(variant_order.check_variant_order(merged_table, loaded_project.lost_keys))
        if "variants" in merged_table.entries
        else ()
    )
    pass_findings = _find_wrong_passes(loaded_project)
    all_findings = (*merge_findings, *library_findings, *variant_findings, *pass_findings)
    return MergedProject(loaded_project, merged_table, all_findings, reading_errors, damaged_elements)


def _find_wrong_passes(loaded_project: LoadedProject) -> tuple[Diagnostic, ...]:
    is_folder = loaded_project.first_file == project.PROJECT_FILE
    if not is_folder or not loaded_project.files.has_path(project.PASS_FOLDER.rstrip("/")):
        return ()
    # Imported here: hardly any project has passes of its own.
    from archgen.passes.patterns.pattern_registry import find_wrong_passes

    return tuple(find_wrong_passes(loaded_project.files, loaded_project.sources))


def load_project_interfaces(
    loaded_project: LoadedProject, merged_table: MappingNode, declared_types: DeclaredTypes
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Read the project's own interface definitions, which override the shipped ones: files, `ros.definitions`, types."""
    texts, diagnostics = read_interface_files(loaded_project)
    ros_section = merged_table.get("ros")
    inline_table = ros_section.get("definitions") if isinstance(ros_section, MappingNode) else None
    entries = inline_table if isinstance(inline_table, MappingNode) else ()
    inline_definitions = {e.key: (e.value.text, e.value.span) for e in entries if isinstance(e.value, ScalarNode)}
    known_interfaces, load_diagnostics = interface_sources.load_interfaces(
        guess_distro(loaded_project.distro),
        tuple(texts.items()),
        inline_definitions,
        TypeMessages(declared_types.definitions, declared_types.message_mentions),
    )
    return known_interfaces, (*diagnostics, *load_diagnostics)


def read_interface_files(loaded_project: LoadedProject) -> tuple[dict[str, str], tuple[Diagnostic, ...]]:
    """Read the interface files that the project names; return their texts by path, and what could not be read."""
    texts, diagnostics = {}, []
    for file in loaded_project.interface_files:
        read_file = project_files.read_text_file(loaded_project.files, file)
        if read_file.problem:
            diagnostics.append(read_file.problem)
        else:
            texts[file] = read_file.text
            loaded_project.sources.add_text(file, read_file.text)
    return texts, tuple(diagnostics)


class PartMemory:
    """The parts that the versions and the variants of a project have in common."""

    def __init__(self) -> None:
        """Start empty."""
        self.linked = LinkMemory()
        self.derived = DerivedParts()
        self.named_files: named_files.FilesByGroup = KnownParts()
        self.heard: HeardReferences | None = None
        """What references mean is added here, in each variant; None where nobody asks. To be renewed for each version."""


@dataclass(frozen=True, slots=True)
class LinkedProject:
    """A project as its architecture, and what was found on the way from its table."""

    expansion: ExpandedProject
    linked_architecture: Architecture
    """The architecture as it is written: without values of parameters, and without what is derived."""
    architecture: Architecture
    parameters: ReadParameters
    interface_findings: tuple[Diagnostic, ...]
    link_findings: tuple[Diagnostic, ...]


def link_merged_project(merged_project: MergedProject, part_memory: PartMemory | None = None) -> LinkedProject:
    """Return the architecture of a merged project; what `part_memory` knows from another variant is not made anew."""
    linked_parts = part_memory.linked if part_memory else None
    loaded_project, merged_table = merged_project.loaded_project, merged_project.table
    damaged_elements = merged_project.damaged_elements
    expansion = compose.expand_project(
        merged_table, loaded_project.incomplete_libraries, loaded_project.describe_missing_type
    )
    outline = element_outline.build_outline(expansion, linked_parts)
    declared_types = declare_project_types(loaded_project, merged_table, expansion, outline, damaged_elements)
    known_interfaces, interface_findings = load_project_interfaces(loaded_project, merged_table, declared_types)
    linked_architecture, link_findings = link.link_project(
        expansion,
        outline,
        default_id=loaded_project.id,
        default_title=loaded_project.title,
        declared_types=declared_types,
        interfaces=known_interfaces,
        lost_keys=loaded_project.lost_keys,
        damaged_elements=damaged_elements,
        is_partial=loaded_project.partial,
        memory=linked_parts,
        heard=part_memory.heard if part_memory else None,
    )
    read_parameters = node_parameter_files.read_node_parameters(
        merged_table, linked_architecture, loaded_project.files if merged_project.is_folder else None
    )
    for path, text in read_parameters.texts.items():
        loaded_project.sources.add_text(path, text)
    architecture = derivation.derive_low_level(
        read_parameters.architecture, part_memory.derived if part_memory else None
    )
    commit_day = find_newest_day(loaded_project.files, architecture)
    if commit_day is not None:
        architecture = replace(architecture, commit_day=commit_day)
    return LinkedProject(
        expansion, linked_architecture, architecture, read_parameters, interface_findings, link_findings
    )


def find_newest_day(files: ProjectFiles, architecture: Architecture) -> str | None:
    """Return the day of the newest commit, as YYYY-MM-DD: of the commit that the files are of, else of HEAD.

    None where nothing in the project ends on a day (then git is not asked), and where git knows none.
    """
    if not _has_last_day(architecture):
        return None
    # Imported here: few projects have a last day.
    from archgen.git import project_revision

    commit = getattr(files, "commit", None)
    day = project_revision.find_commit_day(files.root, commit) if isinstance(commit, str) else None
    # What two branches make together is a tree, and no commit: the day of HEAD has to do.
    return day or project_revision.find_commit_day(files.root)


def _has_last_day(architecture: Architecture) -> bool:
    words = (
        *(output.deprecated for output in architecture.outputs.values()),
        *(output.deprecated for shell in architecture.shells.values() for output in shell.outputs.values()),
        *(each.deprecated for each in architecture.types.values()),
        *(each.deprecated for each in architecture.component_types.values()),
    )
    return any(each.date for each in architecture.milestones.values()) or any(
        deprecated is not None and deprecated.until is not None for deprecated in words
    )
