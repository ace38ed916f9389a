"""What git knows of a change: its authors, those of each agreement, and what had changed when that was written."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.compare.review_facts import ReviewFacts, name_author
from archgen.pipeline import check_at_revision, check_project
from archgen.products.compared_versions import find_review_facts
from tests import repositories

ROBOT = """\
archgen: 1
partners: {p: {title: P}, q: {title: Q}}
review: {breaking: {foreign: error}}
groups: {g: {owner: p, components: {a: {outputs: {x: T}}}}}
types: {T: {message: std_msgs/msg/Int8}}
"""
AGREED = "review: {accepted: {g.a: {key: title, reason: ok}}}\n"
ELEMENT = ("g.a", "title")


def commit(top: Path, files: dict[str, str], mail: str) -> None:
    """Commit files as somebody."""
    repositories.commit(top, files, author=f"Somebody <{mail}>")


@pytest.mark.parametrize("folder", ["", "robot"])
def test_authors_and_what_had_changed(tmp_path: Path, folder: str) -> None:
    lead = f"{folder}/" if folder else ""
    top = repositories.repository(tmp_path, {f"{lead}archgen.yaml": ROBOT})
    base = repositories.git(top, "rev-parse", "HEAD")
    before = check_project(top / folder)
    commit(top, {f"{lead}archgen.yaml": ROBOT.replace("a: {", "a: {title: One, ")}, "one@x.example")
    commit(top, {f"{lead}review/p.yaml": AGREED}, "two@x.example")

    def find(*, committed: bool = True) -> ReviewFacts:
        after = check_at_revision(top / folder, "HEAD") if committed else check_project(top / folder)
        return find_review_facts(before, after, base, ReviewFacts(trusts_mails=False))

    one, two, own = (name_author(mail=f"{name}@x.example") for name in ("one", "two", "own"))
    facts = find()
    assert (facts.authors, facts.agreement_authors, facts.trusts_mails) == (
        (one, two),
        {"review/p.yaml": (two,)},
        False,
    )
    # Written last: what has changed is what had changed.
    assert facts.agreed_hashes("review/p.yaml") is None
    commit(top, {f"{lead}archgen.yaml": ROBOT.replace("a: {", "a: {title: Two, ")}, "one@x.example")
    hashes = find().agreed_hashes("review/p.yaml")
    commit(top, {f"{lead}review/p.yaml": AGREED.replace("ok", "fine")}, "two@x.example")
    commit(top, {"unrelated": "1"}, "one@x.example")
    later_hashes = find().agreed_hashes("review/p.yaml")
    assert hashes and later_hashes and hashes[ELEMENT] != later_hashes[ELEMENT]  # noqa: PT018 - None has no items
    # What is not committed is one's own.
    repositories.git(top, "config", "user.email", "own@x.example")
    (top / lead / "review/p.yaml").write_text(AGREED)
    facts = find(committed=False)
    assert (facts.authors, facts.agreement_authors) == ((one, own, two), {"review/p.yaml": (own, two)})
    assert facts.agreed_hashes("review/p.yaml") is None


def test_nobody_asks_git_where_the_project_does_not(tmp_path: Path) -> None:
    top = repositories.repository(tmp_path, {"archgen.yaml": ROBOT.replace("foreign: error", "wire: error")})
    project = check_project(top)
    assert find_review_facts(project, project, "0" * 40, ReviewFacts()) == ReviewFacts()
    asking = repositories.repository(tmp_path / "asking", {"archgen.yaml": ROBOT})
    (tmp_path / "plain").mkdir()
    (tmp_path / "plain/archgen.yaml").write_text(ROBOT)
    assert find_review_facts(check_project(asking), check_project(asking), "", ReviewFacts()) == ReviewFacts()
