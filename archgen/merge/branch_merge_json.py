"""Merged branches for programs, as `schemas/merges.schema.json` describes it."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.diagnostics.safe_text import format_json
from archgen.emit.data.findings_json import finding_to_json
from archgen.merge.branch_merge import BranchMerge

VERSION = 1


def format_merges_json(main_line: str, branch_merges: Iterable[BranchMerge]) -> str:
    """Return all merges as one JSON document, in their order, with a line end behind it."""
    return format_json(
        {
            "version": VERSION,
            "main": main_line,
            "merges": [
                {
                    "branches": list(branch_merge.branches),
                    "merged": branch_merge.checked_project is not None,
                    "conflicts": [
                        {"file": conflict.file, "problem": conflict.problem} for conflict in branch_merge.conflicts
                    ],
                    "new_findings": [finding_to_json(finding) for finding in branch_merge.new_findings],
                    "breaks": [finding_to_json(finding) for finding in branch_merge.joint_breaks.findings],
                    "order": _order_to_json(branch_merge),
                }
                for branch_merge in branch_merges
            ],
        }
    )


def _order_to_json(branch_merge: BranchMerge) -> str | dict[str, list[str]]:
    if branch_merge.order is None:
        return "neither" if branch_merge.goes_in_no_order else "any"
    return {name: list(branches) for name, branches in zip(("first", "then"), branch_merge.order, strict=True)}
