"""Put a merge into the work tree as git does before it commits one: all of it or nothing, and only where nothing is lost.

The one place that writes into somebody's repository, and only when he asks for it. What git's settings name as filters of
files runs, as in each checkout; hooks do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from archgen.git.git_call import GitError, GitResult, run_git
from archgen.git.object_reader import MergeFolder, PathConflict
from archgen.git.repository_lookup import GitRepository, resolve_revision

_UNDER_WAY = {
    "MERGE_HEAD": ("merge", "`git merge --abort` or `git commit` ends it"),
    "CHERRY_PICK_HEAD": ("cherry-pick", "`git cherry-pick --abort` or `--continue` ends it"),
    "REVERT_HEAD": ("revert", "`git revert --abort` or `--continue` ends it"),
    "rebase-merge": ("rebase", "`git rebase --abort` or `--continue` ends it"),
    "rebase-apply": ("rebase", "`git rebase --abort` or `--continue` ends it"),
}


def refuse_unready(repository: GitRepository) -> None:
    """Raise GitError where a merge would meet what is not committed, or another one that is under way."""
    if repository.is_bare:
        raise GitError("there is no work tree here: merge in a clone")
    for name, (what, way_out) in _UNDER_WAY.items():
        if _git_path(repository, name).exists():
            raise GitError(f"a {what} is under way: {way_out}")
    status = _run(repository, "status", "--porcelain", "-z", "--untracked-files=no", "--ignore-submodules=dirty")
    changed = [entry[3:] for entry in status.text.split("\0") if entry]
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        msg = f"`{changed[0]}`{more} has changes that are not committed: `git commit` or `git stash` them first"
        raise GitError(msg)


def name_head(repository: GitRepository) -> str:
    """Return the branch that is checked out, HEAD where none is."""
    name = run_git(repository.top, "symbolic-ref", "--quiet", "--short", "HEAD").text.strip()
    return name or "HEAD"


def lay_merge(
    repository: GitRepository, merge_folder: MergeFolder, commit: str, branch: str, unmerged: Sequence[PathConflict]
) -> None:
    """Put a commit of a merge folder into index and work tree, as a merge of `branch` that is to be committed.

    Files in `unmerged` hold git's markers, and git knows that they do. Raise GitError, with nothing written, where files that
    git does not know are in the way.
    """
    head, other = (resolve_revision(repository, name) for name in ("HEAD", branch))
    pack = merge_folder.pack_commit(commit, (head, other))
    _run(repository, "unpack-objects", "-q", stdin=pack)
    _run(repository, "read-tree", "-m", "-u", head, commit)
    entries = b"".join(_list_stages(conflict) for conflict in unmerged)
    if entries:
        _run(repository, "update-index", "-z", "--index-info", stdin=entries)
    _git_path(repository, "MERGE_MSG").write_bytes(f"Merge {branch}\n".encode("utf-8", "surrogateescape"))
    _git_path(repository, "MERGE_MODE").write_bytes(b"no-ff")
    _git_path(repository, "MERGE_HEAD").write_bytes(f"{other}\n".encode())


def _list_stages(conflict: PathConflict) -> bytes:
    """Return the entries of the index that say what the sides have of a file."""
    no_blob = "0" * max(map(len, conflict.blobs))
    fields = [f"0 {no_blob} 0"]
    fields += [f"{conflict.mode} {blob} {stage}" for stage, blob in enumerate(conflict.blobs, start=1) if blob]
    return "".join(f"{each}\t{conflict.path}\0" for each in fields).encode("utf-8", "surrogateescape")


def _git_path(repository: GitRepository, name: str) -> Path:
    path = run_git(repository.top, "rev-parse", "--git-path", name).text.removesuffix("\n")
    return repository.top / path


def _run(repository: GitRepository, *words: str, stdin: bytes = b"") -> GitResult:
    result = run_git(repository.top, *words, stdin=stdin)
    if result.status:
        lines = (line.strip().removeprefix("error: ") for line in result.error_text.splitlines())
        reasons = [line for line in lines if line and not line.startswith("hint:")]
        raise GitError(f"git does not merge here: {' '.join(reasons[:2]) or f'`git {words[0]}` fails'}")
    return result


def ignores_file(folder: Path, name: str) -> bool:
    """Whether git ignores a file that is in a folder. It does not where it keeps the file, and outside of a repository."""
    # Not `check-ignore`, which refuses to take names literally.
    return bool(run_git(folder, "ls-files", "--others", "--ignored", "--exclude-standard", "--", name).output)
