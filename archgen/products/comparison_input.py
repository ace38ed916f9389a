"""What a comparison looks at of a checked project."""

from __future__ import annotations

from archgen.compare import ArchitectureVersion
from archgen.diagnostics.rule_options import format_percentage
from archgen.link.project_linking import link_type_patterns
from archgen.pipeline import CheckedProject
from archgen.syntax.yaml_tree import MappingNode


def make_comparison_input(checked_project: CheckedProject) -> ArchitectureVersion:
    """Return what a comparison looks at."""
    unread_files = dict.fromkeys(error.span.file for error in checked_project.reading_errors)
    project_section = checked_project.merged_table.get("project")
    return ArchitectureVersion(
        architecture=checked_project.architecture,
        findings=checked_project.findings,
        silenced_findings=checked_project.silenced_findings,
        rule_settings={
            **{rule: str(severity) for rule, severity in checked_project.loaded_project.rule_settings.items()},
            **{
                f"{rule}.{name}": format_percentage(share)
                for rule, options in checked_project.rule_options.items()
                for name, share in options.items()
            },
        },
        chapters={path: chapter.text for path, chapter in checked_project.chapters.texts.items()},
        chapter_order=checked_project.chapters.order,
        # Where a project does not write them, they come from the name of its folder: that is no change of the project.
        unnamed_keys=frozenset(
            {"id", "title"}
            - ({entry.key for entry in project_section} if isinstance(project_section, MappingNode) else set())
        ),
        analysis=checked_project.analysis,
        sound_files=frozenset(checked_project.yaml_files).difference(unread_files),
        unread_files=tuple(sorted(unread_files)),
        broken_files=checked_project.loaded_project.broken_files,
        library_files=frozenset(checked_project.loaded_project.library_files),
        waiting_rules=checked_project.waiting_rules,
        type_patterns=link_type_patterns(checked_project.merged_table, checked_project.architecture),
    )
