"""What came out of merging branches: in words for the terminal and for comments, and for programs (`schemas/merges.schema.json`)."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.diagnostics import format_json
from archgen.emit.data.findings_data import finding_to_json
from archgen.merge.branch_results import BranchMerge, FileConflict


def describe_merge(branch_merge: BranchMerge, main_line: str) -> str:
    """Return in one line what came out, and in which order the branches can be merged."""
    parts = []
    if branch_merge.joint_breaks.findings:
        parts.append(describe_order(branch_merge, main_line))
    if branch_merge.is_blocked:
        parts.append("conflicts")
    elif branch_merge.new_findings:
        parts.append("merges, and then there are new findings")
    elif branch_merge.checked_project is None:
        parts.append("merges, but holds no project any more")
    elif branch_merge.conflicts and not parts:
        parts.append("git conflicts needlessly")
    elif not parts:
        parts.append("merges")
        if branch_merge.unread_files:
            parts.append(f"what it breaks cannot be judged: `{branch_merge.unread_files[0]}` cannot be read")
    return "; ".join(parts)


def describe_order(branch_merge: BranchMerge, main_line: str) -> str:
    """Return in which order branches that break somebody only together can be merged."""
    first, second = (" + ".join(names) for names in branch_merge.order or branch_merge.sides)
    # One side is the main line, where it stands already.
    if not (first and second):
        return f"breaks a partner together with what came to {main_line} since it left"
    if branch_merge.goes_in_no_order:
        return "neither order; together"
    return f"first {first}, then {second}, whose author has to look"


def describe_conflict(conflict: FileConflict) -> str:
    """Return what is to be done about a file that git conflicts in."""
    verb = "merge" if conflict.is_followed else "merge-driver"
    outcome = conflict.problem or f"git conflicts, what both sides say does not: `archgen {verb}` merges it"
    return f"{conflict.file}: {outcome}" if conflict.file else outcome


_VERSION = 1


def format_merges_json(main_line: str, branch_merges: Iterable[BranchMerge], *, is_written: bool | None = None) -> str:
    """Return all merges as one JSON document, in their order, with a line end behind it.

    `is_written` says of a merge that was asked for whether it stands in the work tree.
    """
    return format_json(
        {
            "version": _VERSION,
            "main": main_line,
            **({} if is_written is None else {"written": is_written}),
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
                    "followed": list(branch_merge.followed),
                }
                for branch_merge in branch_merges
            ],
        }
    )


def _order_to_json(branch_merge: BranchMerge) -> str | dict[str, list[str]]:
    if branch_merge.order is None:
        return "neither" if branch_merge.goes_in_no_order else "any"
    return {name: list(branches) for name, branches in zip(("first", "then"), branch_merge.order, strict=True)}
