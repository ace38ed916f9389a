"""What came out of merging branches, in words: for the terminal and for comments on requests."""

from __future__ import annotations

from archgen.merge.branch_merge import BranchMerge, FileConflict


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
    outcome = conflict.problem or "git conflicts, what both sides say does not: `archgen merge-driver` merges it"
    return f"{conflict.file}: {outcome}" if conflict.file else outcome
