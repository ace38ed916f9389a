"""The settings of a loaded project as a variant has them: rules, distribution, and files of interfaces."""

from __future__ import annotations

from dataclasses import replace

from archgen.diagnostics.diagnostic import Severity
from archgen.project.project_loading import LoadedProject, find_severity_setting, list_rule_entries, read_rule_options
from archgen.project.reading_state import ReadingState
from archgen.project.source_patterns import expand_source_pattern
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode


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
    rules, ros = root.get("rules"), root.get("ros")
    rule_entries = list(list_rule_entries(rules))
    distro = ros.get("distro") if isinstance(ros, MappingNode) else None
    patterns = ros.get("interfaces") if isinstance(ros, MappingNode) else None
    # What is wrong with a pattern is told where the project itself is read, or as a message that is not known.
    state = ReadingState(loaded_project.files, sources=loaded_project.sources)
    interface_files = [
        file
        for pattern in (patterns.items if isinstance(patterns, SequenceNode) else ())
        for file in expand_source_pattern(state, pattern)
    ]
    severities = {entry.key: find_severity_setting(entry.value) for entry in rule_entries}
    return replace(
        loaded_project,
        rule_settings={name: Severity(scalar.text) for name, scalar in severities.items() if scalar},
        rule_options=read_rule_options(rule_entries),
        rule_spans={entry.key: entry.key_span for entry in rule_entries},
        distro=distro.text if isinstance(distro, ScalarNode) else None,
        interface_files=tuple(dict.fromkeys(interface_files)),
        diagnostics=(*loaded_project.diagnostics, *state.diagnostics),
    )
