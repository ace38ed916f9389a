"""Places lead to the repository where one is configured, in the form of its forge; else they are plain text to copy."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.model.source_repository import Forge, SourceRepository
from archgen.pipeline import check_project
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.pages import page_parts, site_pages
from tests.repositories import git

ROBOT = """\
site: {repository: "https://github.com/lab/robot.git", branch: develop}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}}}}
"""


@pytest.mark.parametrize(
    ("address", "forge", "expected"),
    [
        ("https://github.com/lab/robot", None, "https://github.com/lab/robot/blob/main/arch/a%20b.yaml#L3"),
        ("https://github.lab.org/lab/robot.git", None, "https://github.lab.org/lab/robot/blob/main/arch/a%20b.yaml#L3"),
        ("https://gitlab.com/lab/robot/", None, "https://gitlab.com/lab/robot/-/blob/main/arch/a%20b.yaml#L3"),
        ("https://git.lab.org:8443/robot", None, "https://git.lab.org:8443/robot/-/blob/main/arch/a%20b.yaml#L3"),
        ("https://codeberg.org/lab/robot", None, "https://codeberg.org/lab/robot/src/branch/main/arch/a%20b.yaml#L3"),
        ("https://git.lab.org/robot", "gitea", "https://git.lab.org/robot/src/branch/main/arch/a%20b.yaml#L3"),
        ("https://git.lab.org/robot", "github", "https://git.lab.org/robot/blob/main/arch/a%20b.yaml#L3"),
    ],
)
def test_each_forge_has_its_form(address: str, forge: Forge | None, expected: str) -> None:
    repository = SourceRepository(address, folder="arch", forge=forge)
    assert repository.file_address("a b.yaml", 3) == expected


@pytest.mark.parametrize(
    ("forge", "path"), [("github", "blob/1a2b"), ("gitlab", "-/blob/1a2b"), ("gitea", "src/commit/1a2b")]
)
def test_a_commit_has_an_address_of_its_own(forge: Forge, path: str) -> None:
    repository = SourceRepository("https://git.lab.org/robot", forge=forge, commit="1a2b")
    assert repository.file_address("a.yaml", 3) == f"https://git.lab.org/robot/{path}/a.yaml#L3"


@pytest.mark.parametrize("file", ["", "../../outside.yaml", "/etc/passwd"])
def test_a_file_outside_of_the_repository_has_no_address(file: str) -> None:
    assert SourceRepository("https://github.com/lab/robot", folder="arch").file_address(file, 1) is None


def make_pages(folder: Path, text: str) -> dict[str, str | None]:
    """Return the address of each page's place, by the page's anchor."""
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    views = project_views.make_views(
        check_project(folder / "robot.yaml"), OutputOptions(revision="", show_history=False)
    )
    pages = page_parts.place_pages(views.lookup, site_pages.make_pages(views.lookup, views.edition))
    assert all(page.place.is_place for page in pages if page.place)
    return {page.anchor: page.place.url for page in pages if page.place}


def test_the_folder_of_the_project_is_what_git_says(tmp_path: Path) -> None:
    git(tmp_path, "init")
    (tmp_path / "arch").mkdir()
    places = make_pages(tmp_path / "arch", ROBOT)
    assert places["component:g.a"] == "https://github.com/lab/robot/blob/develop/arch/robot.yaml#L2"


def test_a_written_folder_counts_more_than_git(tmp_path: Path) -> None:
    places = make_pages(tmp_path, ROBOT.replace("branch: develop", "folder: docs/arch"))
    assert places["group:g"] == "https://github.com/lab/robot/blob/main/docs/arch/robot.yaml#L2"


def test_the_main_line_of_reviews_is_the_branch(tmp_path: Path) -> None:
    places = make_pages(tmp_path, ROBOT.replace(", branch: develop", "") + "review: {main: trunk}\n")
    assert places["group:g"] == "https://github.com/lab/robot/blob/trunk/robot.yaml#L2"


def test_without_a_repository_places_have_no_address(tmp_path: Path) -> None:
    places = make_pages(tmp_path, ROBOT.partition("\n")[2])
    assert places["component:g.a"] is None


@pytest.mark.parametrize(
    "address",
    [
        "http://github.com/lab/robot",
        "javascript:alert(1)",
        "https://me:secret@github.com/lab/robot",
        "https://github.com",
        '"https://x.org/a b"',
    ],
)
def test_only_an_address_with_https_and_without_a_password_is_taken(tmp_path: Path, address: str) -> None:
    (tmp_path / "robot.yaml").write_text(f"site: {{repository: {address}}}\ngroups: {{}}\n", encoding="utf-8")
    (finding,) = (f for f in check_project(tmp_path / "robot.yaml").findings if f.severity == "error")
    assert "a repository is the address of its page" in f"{finding.message} {finding.help}"


def test_an_unknown_forge_is_told_which_there_are(tmp_path: Path) -> None:
    text = "site: {repository: https://x.org/lab/robot, forge: bitbucket}\ngroups: {}\n"
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    (finding,) = (f for f in check_project(tmp_path / "robot.yaml").findings if f.severity == "error")
    assert "gitea" in f"{finding.message} {finding.help}"
