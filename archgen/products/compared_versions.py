"""Versions of a project to compare, as users type them: revisions, folders, files, the working tree."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from archgen import git, pipeline, project
from archgen.compare import ArchitectureVersion, Comparison
from archgen.compare.agreements import agreement_key, hash_change
from archgen.compare.breaking_changes import stricter_policy
from archgen.compare.change_listing import find_changes
from archgen.compare.compare_versions import compare_versions
from archgen.compare.match_elements import match_elements
from archgen.compare.review_facts import Author, ReviewFacts, name_author
from archgen.diagnostics import Severity, shorten_hash
from archgen.diagnostics.rule_options import format_percentage
from archgen.frozen import dataclass, replace
from archgen.git.commit_log import find_last_commit, find_own_mail, list_author_mails
from archgen.git.project_revision import differs_from_head
from archgen.link.project_linking import link_type_patterns
from archgen.model.project_settings import agreement_file
from archgen.model.variant import BASE_NAME
from archgen.pipeline import CheckedProject, VersionCache
from archgen.project.project_search import find_project
from archgen.syntax.yaml_tree import MappingNode

_PATH_PREFIXES = ("./", "../", "/", "~")
WORKING_TREE_NAME = "the working tree"
"""Digits of a commit's hash beside a name, as git prints them."""


@dataclass(frozen=True, slots=True)
class ProjectVersion:
    """A checked project, and its name as the user typed it. `checkout_commit` is the commit that files on disk are at."""

    name: str
    checked_project: CheckedProject
    checkout_commit: str = ""

    @property
    def commit(self) -> str:
        """Return the full hash of the commit that it was read from or is at, empty for other files on disk."""
        return self.checked_project.loaded_project.files.commit or self.checkout_commit

    @property
    def title(self) -> str:
        """The name as the user typed it, with the commit where that says more."""
        # A hash that begins with what the user typed says nothing new.
        name_suffices = not self.commit or self.commit.startswith(self.name)
        return self.name if name_suffices else f"{self.name} ({shorten_hash(self.commit)})"


def find_meant_project(first: str | None, second: str | None) -> Path | None:
    """Return the project on disk that one of two versions names, where no project is around the current folder.

    The other one is a revision of the same repository then: what is named says which project is meant at it. None where
    that is not so. Raise `git.GitError`.
    """
    if first is None or second is None or _has_project_around():
        return None
    repository = git.find_repository(Path.cwd())
    paths = [Path(text) for text in (first, second) if _names_project(text, repository)]
    is_clear = len(paths) == 1 and git.find_repository(find_project(paths[0])[0]).top == repository.top
    return paths[0] if is_clear else None


def _names_project(version_text: str, repository: git.GitRepository) -> bool:
    """Whether a version is a project on disk, a folder or its archgen.yaml, and no revision."""
    path = Path(version_text)
    file = path if path.name == project.PROJECT_FILE else path / project.PROJECT_FILE
    if not os.path.lexists(file):
        return False
    if _is_path(version_text):
        return True
    try:
        git.resolve_revision(repository, version_text)
    except git.GitError:
        return True
    return False


def _has_project_around() -> bool:
    try:
        find_project(None)
    except project.ProjectNotFoundError:
        return False
    return True


def read_versions(
    first: str | None, second: str | None, path: Path | None = None
) -> tuple[ProjectVersion, ProjectVersion]:
    """Read the two versions to compare. `path` is the project, as for `pipeline.check`.

    Without `second` it is the working tree; without `first` it is the commit at which the branch left its main line.
    `A..B` and `A...B` mean what they mean in git. Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    # Shared: most files are the same in both versions, and so is timing where nothing of it changed.
    version_cache = VersionCache()
    left, dots, right = split_range(first) if first is not None and second is None else ("", "", "")
    if dots:
        after = read_version(right, path, version_cache)
        if dots == "...":
            base = git.find_common_commit(project.find_tracked_project(path).objects.repository, left, right)
            return read_at_base(base, path, version_cache, after), after
        return read_earlier_version(left, path, version_cache, after), after
    if first is not None:
        after = read_version(second, path, version_cache)
        return read_earlier_version(first, path, version_cache, after), after
    # The newer version first here: it names the main line that the older one is found by.
    after = read_version(second, path, version_cache)
    main_line = after.checked_project.architecture.review.main
    base = git.find_branch_base(project.find_tracked_project(path).objects.repository, main_line)
    return read_at_base(base, path, version_cache, after), after


def split_range(version_text: str) -> tuple[str, str, str]:
    """Return the parts of `A..B` or `A...B`, with HEAD for one that is left out; any other version is A alone."""
    # Three dots first, since they contain the two.
    dots = next((dots for dots in ("...", "..") if dots in version_text), "")
    if not dots or _is_path(version_text):
        return version_text, "", ""
    left, _, right = version_text.partition(dots)
    return left or "HEAD", dots, right or "HEAD"


def read_version(
    version_text: str | None, path: Path | None = None, version_cache: VersionCache | None = None
) -> ProjectVersion:
    """Read one version: nothing or `.` is the working tree; what may be a revision or a path is taken as a revision.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    if version_text in {None, "", "."}:
        return ProjectVersion(WORKING_TREE_NAME, pipeline.check_project(path, version_cache))
    if not _is_path(version_text):
        try:
            return ProjectVersion(version_text, pipeline.check_at_revision(path, version_text, version_cache))
        # The revision exists and lacks the project: falling back to a path of that name would hide this mistake.
        except project.NotAtRevisionError:
            raise
        except (git.GitError, project.ProjectNotFoundError):
            # Neither revision nor path: the message about the revision is the more useful one.
            if not os.path.lexists(version_text):
                raise
    return ProjectVersion(version_text, pipeline.check_project(Path(version_text), version_cache))


def read_at_base(
    base: git.BaseCommit, path: Path | None, version_cache: VersionCache | None, later: ProjectVersion | None = None
) -> ProjectVersion:
    """Read the project at a commit of git, also where it lay in another folder than in a later version.

    Raise `git.GitError`, and `project.NotAtRevisionError` where it did not exist there.
    """
    try:
        return ProjectVersion(base.description, pipeline.check_at_revision(path, base.commit_id, version_cache))
    except project.NotAtRevisionError:
        if later is None:
            raise
        return ProjectVersion(base.description, _check_moved(base.commit_id, path, version_cache, later))


def read_earlier_version(
    version_text: str, path: Path | None, version_cache: VersionCache, later: ProjectVersion
) -> ProjectVersion:
    """Read a version as `read_version` does, also where the project lay in another folder than in a later version."""
    try:
        return read_version(version_text, path, version_cache)
    except project.NotAtRevisionError:
        return ProjectVersion(version_text, _check_moved(version_text, path, version_cache, later))


def _check_moved(
    revision: str, path: Path | None, version_cache: VersionCache | None, later: ProjectVersion
) -> CheckedProject:
    """Check the project at a revision at which it lay in another folder."""
    moved_project = project.find_moved_project(
        project.find_tracked_project(path), revision, later.checked_project.architecture.project.id, later.commit
    )
    return pipeline.check_tracked_project(moved_project, revision, version_cache)


def _is_path(version_text: str) -> bool:
    """Whether a text can only be a path, judged by its form."""
    return version_text.startswith(_PATH_PREFIXES) or version_text in {".", ".."} or os.path.isabs(version_text)  # noqa: PTH117 - Windows' drives


def read_variant(version: ProjectVersion, standing_project: CheckedProject, names: Sequence[str]) -> ProjectVersion:
    """Return a version as it stands in variants, under a name that says so."""
    suffix = f"variant {', '.join(names)}" if tuple(names) != (BASE_NAME,) else "without variants"
    return replace(version, name=f"{version.name}, {suffix}", checked_project=standing_project)


def compare_named_versions(
    before: ProjectVersion, after: ProjectVersion, *, forge_facts: ReviewFacts | None = None
) -> Comparison:
    """Compare two versions. `forge_facts` are what the forge says of who changed the one into the other.

    Findings are not reported as cured where the newer version has errors of reading or linking: they hide findings.
    """
    facts = find_review_facts(
        before.checked_project, after.checked_project, before.commit, forge_facts or ReviewFacts()
    )
    comparison = compare_versions(
        make_comparison_input(before.checked_project), make_comparison_input(after.checked_project), facts=facts
    )
    comparison = replace(comparison, left_out_files=_find_left_out_files(before.checked_project, after.checked_project))
    if comparison.changes and before.checked_project.variants and after.checked_project.variants:
        from archgen.products.variant_breaks import add_variant_breaks

        comparison = add_variant_breaks(
            comparison, _compare_variants(comparison, before.checked_project, after.checked_project)
        )
    versions = before.checked_project, after.checked_project
    agreements = [each.architecture.agreements for each in versions]
    if any(agreements) and (comparison.changes or agreements[0] != agreements[1]):
        from archgen.products.agreement_gate import add_agreement_breaks

        comparison = add_agreement_breaks(comparison, *versions)
    return replace(comparison, cured_findings=()) if after.checked_project.structural_errors else comparison


def _compare_variants(comparison: Comparison, before: CheckedProject, after: CheckedProject) -> dict[str, Comparison]:
    """Return what changed in each variant that both versions have, by its new id; nothing where there are no partners."""
    if not (before.architecture.partners or after.architecture.partners):
        return {}
    return {
        new_name: compare_versions(
            make_comparison_input(variant), make_comparison_input(after.variants[new_name]), facts=comparison.facts
        )
        for name, variant in before.variants.items()
        if (new_name := comparison.matched_ids.find_new_id("variant", name) or "") in after.variants
    }


def _find_left_out_files(before: CheckedProject, after: CheckedProject) -> tuple[str, ...]:
    """Return the files that an earlier project read, and that a later one has and does not read."""
    if before.loaded_project.first_file != after.loaded_project.first_file:
        return ()  # two projects of one file each beside each other
    # A file that could not be parsed, or says nothing any more, was read.
    read_files = {*after.sources.file_names(), *after.loaded_project.interface_files}
    later_files = after.loaded_project.files
    old_files = (*before.yaml_files, *before.loaded_project.interface_files)
    return tuple(file for file in old_files if file not in read_files and later_files.has_path(file))


def find_review_facts(
    before: CheckedProject, after: CheckedProject, base_commit: str, forge_facts: ReviewFacts
) -> ReviewFacts:
    """Return what is known of who changed a project: what the forge tells, and git of the commits since `base_commit`."""
    reviews = before.architecture.review, after.architecture.review
    is_asked = stricter_policy(*reviews).foreign is not Severity.OFF
    if not base_commit or not (is_asked or reviews[1].accepted):
        return forge_facts
    try:
        repository = git.find_repository(after.root)
        head = git.resolve_revision(repository, after.loaded_project.files.commit or "HEAD")
    except git.GitError:
        return forge_facts
    on_disk = not after.loaded_project.files.commit

    def list_authors(path: str, files: tuple[str, ...]) -> tuple[Author, ...]:
        mails = list_author_mails(repository, base_commit, head, path)
        if on_disk and differs_from_head(after.root, files):
            mails |= {find_own_mail(repository)}
        return tuple(name_author(mail=mail) for mail in sorted(mails) if mail)

    own_files = map(agreement_file, before.architecture.partners)
    files = {file: posixpath.join(repository.prefix, file) for file in own_files}
    present_files = tuple(file for file in after.yaml_files if file in files)

    @cache
    def hash_agreed_changes(file: str) -> Mapping[tuple[str, str], str] | None:
        commit = find_last_commit(repository, base_commit, head, files.get(file, file))
        if not commit or commit == head or (on_disk and differs_from_head(after.root, (file,))):
            return None
        return _hash_changes(before, after, commit)

    return replace(
        forge_facts,
        authors=list_authors("", after.input_files),
        agreement_authors={file: list_authors(files[file], (file,)) for file in present_files},
        agreed_hashes=hash_agreed_changes,
    )


def _hash_changes(before: CheckedProject, after: CheckedProject, commit: str) -> Mapping[tuple[str, str], str]:
    """Return the hashes of what had changed at a commit, by element and key; nothing where the project was not there."""
    try:
        agreed_project = pipeline.check_at_revision(after.root, commit)
    except (git.GitError, project.ProjectNotFoundError):
        return {}
    old, new = make_comparison_input(before), make_comparison_input(agreed_project)
    versions, changes = find_changes(old, new, match_elements(old.architecture, new.architecture))
    return {(change.element_id, agreement_key(change)): hash_change(change, versions) for change in changes}


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
