"""CODEOWNERS of a workspace's repositories say who owns the components of their packages."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.workspace.workspace_slices import CodeOwners

OWNERS = """\
# Who looks at what.
* @acme/robots
/drivers/ @acme/drivers  # and their tests
*.py @acme/python
nav/maps/** ann@acme.org @acme/maps
tools
[Section]
"""


@pytest.mark.parametrize(
    ("folder", "owner"),
    [
        ("base", "robots"),
        ("drivers/lidar", "drivers"),
        ("old/drivers", "robots"),
        ("nav/maps/server", ["ann", "maps"]),
        ("nav/mapsother", "robots"),
        # The last line that names it counts, and says nobody.
        ("a/tools/b", None),
    ],
)
def test_the_last_line_that_names_a_folder_counts(folder: str, owner: object, tmp_path: Path) -> None:
    (tmp_path / "src/repo/.github").mkdir(parents=True)
    (tmp_path / "src/repo/.github/CODEOWNERS").write_text(OWNERS, encoding="utf-8")
    owners = CodeOwners([tmp_path / "src"], ImportAccount())
    assert owners.name_partners(tmp_path / "src/repo" / folder) == owner


def test_nothing_above_the_workspace_is_read_and_no_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "CODEOWNERS").write_text("* @above\n", encoding="utf-8")
    (tmp_path / "src/repo/pkg").mkdir(parents=True)
    (tmp_path / "src/repo/CODEOWNERS").symlink_to(tmp_path / "CODEOWNERS")
    owners = CodeOwners([tmp_path / "src"], ImportAccount())
    assert owners.name_partners(tmp_path / "src/repo/pkg") is None
    assert owners.write_partners() == {}


def test_partners_of_one_name_are_told_apart(tmp_path: Path) -> None:
    (tmp_path / "CODEOWNERS").write_text("/a @x/nav\n/b @y/nav\n", encoding="utf-8")
    owners = CodeOwners([tmp_path], ImportAccount())
    assert [owners.name_partners(tmp_path / name) for name in "ab"] == ["nav", "nav_2"]
    assert owners.write_partners()["nav_2"] == {"title": "@y/nav", "reviewers": ["@y/nav"]}
