"""The interface definitions that a project brings itself: files, those in its YAML, those of its types."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link import interface_sources
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.interface_sources import TypeMessages
from archgen.model.known_interfaces import Interfaces, guess_distro
from archgen.project import LoadedProject
from archgen.syntax import project_files
from archgen.syntax.yaml_tree import MappingNode, ScalarNode


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
