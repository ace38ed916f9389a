"""Who wrote the commits between two, as they say themselves."""

from __future__ import annotations

from pathlib import Path

from archgen.git.commit_log import find_last_commit, find_own_mail, list_author_mails
from archgen.git.repository_lookup import find_repository
from tests import repositories


def test_authors_are_those_that_the_commits_name(tmp_path: Path) -> None:
    top = repositories.repository(tmp_path, {"a.yaml": "1"})
    base = repositories.git(top, "rev-parse", "HEAD")
    commits = []
    for file, mail in (("a.yaml", "ann@a.example"), ("re[v]iew/*.yaml", "bob@b.example"), (".mailmap", "x@x.example")):
        mails = {file: f"Eve <eve@e.example> <{mail}>\n"}
        commits.append(repositories.commit(top, mails, author=f"Somebody <{mail}>"))
    found = find_repository(top)
    assert list_author_mails(found, base, "HEAD") == {"ann@a.example", "bob@b.example", "x@x.example"}
    assert list_author_mails(found, base, "HEAD", "re[v]iew/*.yaml") == {"bob@b.example"}
    assert list_author_mails(found, base, "HEAD", ":(glob)**") == frozenset()
    assert find_last_commit(found, base, "HEAD", "re[v]iew/*.yaml") == commits[1]
    assert find_last_commit(found, commits[1], "HEAD", "re[v]iew/*.yaml") == ""
    assert list_author_mails(found, base, "--output=x") == frozenset()
    repositories.git(top, "config", "user.email", "own@o.example")
    assert find_own_mail(found) == "own@o.example"
