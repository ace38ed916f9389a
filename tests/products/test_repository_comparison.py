"""`archgen diff` at the top of a repository: which projects a change touches, and through which library."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import git
from archgen.products.repository_comparison import compare_projects_below, list_compared_projects, list_projects_below
from tests.repositories import commit, repository
from tests.repositories import git as git_command
from tests.repositories import git as run_git
from tests.running import archgen_here

LIBRARY = "component_types: {laser: {parameters: {range: 5.0}, outputs: {scan: sensor_msgs/msg/LaserScan}}}\n"
USER = """archgen: 1
libraries: {common: ../../common}
partners: {lab: {title: Lab}, plant: {title: Plant}}
groups:
  sensing: {owner: lab, components: {front: {is: common.laser}}}
  driving: {owner: plant, components: {drive: {inputs: {scan: front.scan}}}}
"""
PLAIN = "archgen: 1\ngroups: {g: {title: G}}\n"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    files = {"robots/one/archgen.yaml": USER, "robots/two/archgen.yaml": PLAIN, "common/a.yaml": LIBRARY}
    return repository(tmp_path, dict(files))


def compare(top: Path, first: str | None = "HEAD", second: str | None = None) -> list[tuple[str, str]]:
    projects = list_compared_projects(top, first, second)
    return [(each.folder, each.summary) for each in compare_projects_below(top, projects, first, second)]


def test_a_change_of_a_library_names_the_projects_that_use_it(top: Path) -> None:
    (top / "common" / "a.yaml").write_text(LIBRARY.replace("5.0", "6.0"))
    assert compare(top) == [
        ("robots/one", "1 change (1 changed); the library `common` changed"),
        ("robots/two", "nothing changed"),
    ]


def test_a_change_that_breaks_a_partner_says_so(top: Path) -> None:
    (top / "common" / "a.yaml").write_text(LIBRARY.replace("LaserScan", "Image"))
    ((_, summary), _) = compare(top)
    assert summary.endswith("the library `common` changed; breaks Plant")


def test_between_commits(top: Path) -> None:
    commit(top, {"robots/three/archgen.yaml": PLAIN, "robots/two/archgen.yaml": PLAIN.replace("G}", "H}")})
    assert compare(top, "HEAD~1", "HEAD") == [
        ("robots/one", "nothing changed"),
        ("robots/three", "not there before"),
        ("robots/two", "1 change (1 changed)"),
    ]


def test_a_project_that_is_gone_or_new_on_the_disk(top: Path) -> None:
    (top / "robots" / "two" / "archgen.yaml").unlink()
    (top / "robots" / "new").mkdir()
    # Where one went and another came, nobody says that it moved.
    (top / "robots" / "new" / "archgen.yaml").write_text(PLAIN)
    assert compare(top) == [
        ("robots/new", "not there before"),
        ("robots/one", "nothing changed"),
        ("robots/two", "not there any more"),
    ]


@pytest.mark.parametrize("first", ["main..feat", "main...feat"])
def test_a_range_lists_the_projects_of_both_ends(top: Path, first: str) -> None:
    run_git(top, "checkout", "-q", "-b", "feat")
    (top / "robots" / "two" / "archgen.yaml").unlink()
    commit(top, {"robots/three/archgen.yaml": PLAIN})
    run_git(top, "checkout", "-q", "main")
    expected = [
        ("robots/one", "nothing changed"),
        ("robots/three", "not there before"),
        ("robots/two", "not there any more"),
    ]
    assert compare(top, first) == compare(top, "main", "feat") == expected


def test_without_versions_the_working_tree_is_compared_with_the_last_commit_of_the_main_line(top: Path) -> None:
    (top / "common" / "a.yaml").write_text(LIBRARY.replace("5.0", "6.0"))
    assert compare(top, None) == compare(top, "main")
    archgen_here("diff", "robots/one", cwd=top, status=2)


def test_in_a_project_or_outside_of_a_repository_there_is_no_list(
    top: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    assert list_projects_below(top / "robots" / "one", None) == ()
    with pytest.raises(git.GitError):
        list_projects_below(tmp_path_factory.mktemp("empty"), None)


def test_the_verb_ends_as_it_does_for_one_project(top: Path) -> None:
    archgen_here("diff", "HEAD", "--exit-code", cwd=top)
    (top / "common" / "a.yaml").write_text(LIBRARY.replace("LaserScan", "Image"))
    done = archgen_here("diff", "HEAD", "--exit-code", cwd=top, status=1)
    assert done.stdout.decode().splitlines()[-1] == "`archgen diff -C FOLDER` says what changed in a project."
    archgen_here("diff", "HEAD", "--breaking", cwd=top)
    (top / "robots" / "one" / "archgen.yaml").write_text(USER + "review: {breaking: error}\n")
    archgen_here("diff", "HEAD", "--breaking", cwd=top, status=1)
    refused = archgen_here("diff", "HEAD", "--format", "json", cwd=top, status=2)
    assert "this folder only holds projects: name one with -C, such as `-C robots/one`" in refused.stderr.decode()


def test_what_ships_with_archgen_is_no_library_that_changed(tmp_path: Path) -> None:
    text = "archgen: 1\nros: {distro: jazzy}\nlibraries: {ros: builtin}\ngroups: {g: {components: {a: {is: ros.rplidar}}}}\n"
    top = repository(tmp_path, {"robot/archgen.yaml": text})
    (top / "robot" / "archgen.yaml").write_text(text + "hosts: {pc: {}}\n")
    assert compare(top) == [("robot", "1 change (1 added)")]


def test_what_cannot_be_read_is_not_removed(top: Path) -> None:
    fields = LIBRARY + "types: {Spot: {fields: {x: float64}}}\n"
    commit(top, {"common/a.yaml": fields.replace("outputs: {", "outputs: {spot: Spot, ")})
    (top / "common" / "a.yaml").write_text(fields + "  x: [\n")
    unreadable = "cannot be judged: `../../common/a.yaml` cannot be read"
    assert compare(top)[0] == ("robots/one", f"0 changes; the library `common` changed; {unreadable}")
    # What another file removes is removed all the same.
    (top / "robots" / "one" / "archgen.yaml").write_text(USER.replace("drive: {inputs: {scan: front.scan}}", ""))
    assert compare(top)[0][1].startswith("1 change (1 removed); ")


@pytest.mark.parametrize("named", ["robots/two", "./robots/two", "robots/two/archgen.yaml"])
def test_the_folder_that_is_named_says_which_project_is_meant_at_the_revision(top: Path, named: str) -> None:
    (top / "robots" / "two" / "archgen.yaml").write_text(PLAIN.replace("G}", "H}"))
    assert "title `G` → `H`" in archgen_here("diff", "HEAD", named, cwd=top).stdout.decode()
    assert "title `H` → `G`" in archgen_here("diff", named, "HEAD", cwd=top).stdout.decode()


def test_a_folder_of_another_repository_says_nothing_of_the_one_here(
    top: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    other = repository(tmp_path_factory.mktemp("other"), {"archgen.yaml": PLAIN})
    archgen_here("diff", "HEAD", str(other), cwd=top, status=2)


def test_a_branch_that_is_called_as_a_folder_is_the_branch(top: Path) -> None:
    (top / "two").mkdir()
    (top / "two" / "archgen.yaml").write_text(PLAIN)
    git_command(top, "branch", "two")
    lines = archgen_here("diff", "HEAD", "two", cwd=top).stdout.decode().splitlines()
    assert lines == ["robots/one  nothing changed", "robots/two  nothing changed"]
