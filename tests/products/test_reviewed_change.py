"""The command beside a reviewed change: whoever reads the comment can repeat it in a clone of his own."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import VersionCache, check_project
from archgen.products.reviewed_change import ReviewedRequest, compare_change
from tests import repositories

REQUEST = ReviewedRequest("this pull request", "main")


@pytest.mark.parametrize(
    ("path", "request_", "is_edited", "command"),
    [
        ("archgen.yaml", None, False, "archgen diff OLD NEW"),
        ("archgen.yaml", None, True, "archgen diff OLD"),
        ("archgen.yaml", REQUEST, False, "archgen diff OLD...NEW"),
        ("robots/an arm/archgen.yaml", REQUEST, False, "archgen diff OLD...NEW -C 'robots/an arm'"),
        ("robots/arm.yaml", None, False, "archgen diff OLD NEW -C robots/arm.yaml"),
    ],
)
def test_the_command_names_commits_and_the_project(
    tmp_path: Path, path: str, request_: ReviewedRequest | None, command: str, *, is_edited: bool
) -> None:
    folder = repositories.repository(tmp_path, {path: "archgen: 1\n", "README.md": "x"})
    repositories.git(folder, "checkout", "-q", "-b", "work")
    repositories.commit(folder, {path: "archgen: 1\nrequirements: {R-1: It works}\n"})
    file = folder / path
    if is_edited:
        file.write_text("archgen: 1\nrequirements: {R-2: It works}\n", encoding="utf-8")
    project = file.parent if file.name == "archgen.yaml" else file
    cache = VersionCache()
    change = compare_change(check_project(project, cache), project, "main", request_, cache)
    old, new = (repositories.git(folder, "rev-parse", "--short=7", name) for name in ("main", "work"))
    assert change.command == command.replace("OLD", old).replace("NEW", new)
    assert [each.element_id for each in change.comparison.changes] == ["R-2" if is_edited else "R-1"]
