"""What git knows of a change under review: who wrote its commits and the agreements in it, and what had changed by then."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from functools import cache

from archgen import git, pipeline, project
from archgen.compare.agreements import agreement_key, hash_change
from archgen.compare.breaking_changes import stricter_policy
from archgen.compare.change_listing import find_changes
from archgen.compare.match_elements import match_elements
from archgen.compare.review_facts import Author, ReviewFacts, name_author
from archgen.diagnostics.diagnostic import Severity
from archgen.frozen import replace
from archgen.git.commit_authors import find_last_commit, find_own_mail, list_author_mails
from archgen.git.project_revision import differs_from_head
from archgen.model.review_settings import agreement_file
from archgen.pipeline import CheckedProject
from archgen.products.comparison_input import make_comparison_input


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
