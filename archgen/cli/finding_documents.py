"""Render the findings of a check in the formats that programs and servers read."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import __version__
from archgen.cli import command_support

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.products.check_findings import ReportedFindings

DOCUMENT_FORMATS = ("json", "github", "sarif", "junit")


def render_findings(
    format_name: str, reported_findings: ReportedFindings, checked_project: CheckedProject, *, strict: bool = False
) -> str:
    """Render findings as json, GitHub's commands, sarif or junit. With `strict`, warnings are failures too."""
    from archgen.emit.data import findings_data, junit_results, sarif_document
    from archgen.findings.rule_table import COMPARISON_RULES, index_rules
    from archgen.pipeline import index_all_rules
    from archgen.project import PROJECT_FILE

    folder = folder_in_repository(checked_project.root)
    if format_name == "json":
        return findings_data.format_findings_json(reported_findings.findings, checked_project.sources)
    if format_name == "github":
        return "".join(
            f"{line}\n" for line in findings_data.format_github_commands(reported_findings.findings, folder=folder)
        )
    if format_name == "junit":
        lines = junit_results.format_junit(
            reported_findings.findings,
            checked_project.sources,
            checked_project.input_files,
            folder=folder,
            strict=strict,
        )
        return "".join(f"{line}\n" for line in lines)
    file = checked_project.yaml_files[0] if checked_project.yaml_files else PROJECT_FILE
    sarif_scan = sarif_document.SarifScan(
        checked_project.architecture.project.id,
        file,
        folder,
        __version__,
        is_compared=reported_findings.was_compared,
        sources=checked_project.sources,
    )
    rules = {**index_all_rules(), **index_rules(COMPARISON_RULES)}
    return sarif_document.format_sarif(reported_findings.findings, rules, sarif_scan)


def folder_in_repository(root: Path) -> str:
    """Return a project's folder relative to the repository's root, from which servers name files.

    On GitHub that is the workspace; elsewhere the folder that has `.git`, or else the current one. Outside of it: "".
    """
    resolved = root.resolve()
    workspace = os.environ.get("GITHUB_WORKSPACE")
    found = command_support.find_repository_folder(resolved, Path.cwd().resolve())
    repository_root = Path(workspace).resolve() if workspace else found
    return resolved.relative_to(repository_root).as_posix() if resolved.is_relative_to(repository_root) else ""
