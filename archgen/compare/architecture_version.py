"""One version of an architecture as a comparison sees it."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.component import TypePatterns
from archgen.timing.analysis import Analysis


@dataclass(frozen=True, slots=True)
class ArchitectureVersion:
    """One version. `rule_settings` are the project's settings of rules: severities by rule, and options by `RULE.OPTION`;
    `chapters` its texts by path, in the report's
    `chapter_order`.

    `unnamed_keys` are `id` and `title` if the project does not write them: then they come from the name of a folder or
    file.
    """

    architecture: Architecture
    findings: tuple[Diagnostic, ...] = ()
    rule_settings: Mapping[str, str] = field(default_factory=dict)
    chapters: Mapping[str, str] = field(default_factory=dict)
    chapter_order: tuple[str, ...] = ()
    silenced_findings: tuple[Diagnostic, ...] = ()
    """Findings that a comment or a setting hides."""
    unnamed_keys: frozenset[str] = frozenset()
    analysis: Analysis | None = None
    """The timing analysis that its rules judged, if there is one already."""
    sound_files: frozenset[str] = frozenset()
    """The files that were read without an error."""
    unread_files: tuple[str, ...] = ()
    """The files that could not be read, or not as a whole."""
    broken_files: frozenset[str] = frozenset()
    """Those of them of which nothing could be read."""
    library_files: frozenset[str] = frozenset()
    """The files of its libraries: of these the version has what it uses."""
    waiting_rules: frozenset[str] = frozenset()
    """The rules that errors of reading and linking kept from being judged."""
    type_patterns: TypePatterns = field(default_factory=TypePatterns)
    """What component types say to their instances."""
