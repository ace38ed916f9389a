"""Libraries: folders of component types and types in the same repository, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from archgen.pipeline import CheckedProject, check_at_revision, check_project
from tests.repositories import commit, git, repository

DRIVERS = "component_types:\n  laser: {outputs: {scan: sensor_msgs/msg/LaserScan}}\n"
ROBOT = """archgen: 1
libraries: {common: PATH}
groups:
  sensing:
    components:
      front: {is: common.laser}
"""


def robot(path: str = "../common") -> str:
    return ROBOT.replace("PATH", path)


def write(folder: Path, files: Mapping[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def list_errors(checked: CheckedProject) -> list[str]:
    return [
        f"{d.span} {d.rule}: {d.message} | {d.help}" for d in checked.findings if d.severity in {"error", "warning"}
    ]


def list_library_findings(checked: CheckedProject) -> list[str]:
    return [line for line in list_errors(checked) if "library" in line]


def test_types_come_from_a_folder_beside_the_project(tmp_path: Path) -> None:
    repository(tmp_path, {"robot/archgen.yaml": robot(), "common/a/drivers.yaml": DRIVERS})
    checked = check_project(tmp_path / "robot")
    assert list(checked.architecture.components["sensing.front"].outputs) == ["scan"]
    assert checked.architecture.component_types["common.laser"].at.file == "../common/a/drivers.yaml"
    assert checked.architecture.component_types["common.laser"].library == "common"
    assert checked.input_files == ("archgen.yaml", "../common/a/drivers.yaml")
    assert checked.yaml_files == ("archgen.yaml",)


def test_a_commit_has_the_library_of_that_commit(tmp_path: Path) -> None:
    repository(tmp_path, {"robot/archgen.yaml": robot(), "common/drivers.yaml": DRIVERS})
    commit(tmp_path, {"common/drivers.yaml": DRIVERS.replace("scan", "cloud")})
    old, new = (check_at_revision(tmp_path / "robot", revision) for revision in ("HEAD~1", "HEAD"))
    assert [list(each.architecture.components["sensing.front"].outputs) for each in (old, new)] == [["scan"], ["cloud"]]
    assert list_errors(new) == list_errors(check_project(tmp_path / "robot"))


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("../../elsewhere", "this leads out of the repository"),
        ("../common/../../x", "this leads out of the repository"),
        ("..", "this folder holds the project itself"),
        (".", "this folder holds the project itself"),
        ("../linked", "this folder is reached through a symbolic link"),
        ("../linked/deep", "this folder is reached through a symbolic link"),
        ("../robot/lib", "this leads out of the project's folder and back into it"),
        ("../nowhere", "there is no such folder"),
        ("../common/drivers.yaml", "there is no such folder"),
        ("/etc", "this is no path"),
        ('"..\\\\common"', "this is no path"),
        ('" "', "this is no path"),
    ],
)
@pytest.mark.parametrize("is_committed", [False, True])
def test_no_other_folder_is_read(tmp_path: Path, path: str, reason: str, *, is_committed: bool) -> None:
    top = tmp_path / "top"
    write(tmp_path, {"elsewhere/x.yaml": DRIVERS})
    repository(top, {"robot/archgen.yaml": robot(path), "common/drivers.yaml": DRIVERS, "common/deep/x.yaml": DRIVERS})
    (top / "linked").symlink_to("common")
    commit(top, {})
    checked = check_at_revision(top / "robot", "HEAD") if is_committed else check_project(top / "robot")
    # git lists nothing below a link.
    expected = "there is no such folder" if is_committed and "link" in path else reason
    written = path.strip('"').replace("\\\\", "\\")
    (error,) = list_library_findings(checked)
    assert error.startswith(
        f"archgen.yaml:2:21 missing-library: the library `common` cannot be read from `{written}`: {expected} | "
    )
    # That its types are unknown follows from it.
    assert not [line for line in list_errors(checked) if "unknown-reference" in line]
    assert "common.laser" not in checked.architecture.component_types


def test_a_project_in_a_hidden_folder_finds_its_library_in_a_commit(tmp_path: Path) -> None:
    repository(tmp_path, {".robots/one/archgen.yaml": robot("../lib"), ".robots/lib/a.yaml": DRIVERS})
    for checked in (
        check_project(tmp_path / ".robots" / "one"),
        check_at_revision(tmp_path / ".robots" / "one", "HEAD"),
    ):
        assert list(checked.architecture.component_types) == ["common.laser"]


def test_a_project_of_one_file_in_a_library_is_none_of_it(tmp_path: Path) -> None:
    packed = "archgen: 1\ncomponent_types: {laser: {title: Another}, lamp: {}}\n"
    write(tmp_path, {"archgen.yaml": robot("lib"), "lib/drivers.yaml": DRIVERS, "lib/packed.yaml": packed})
    checked = check_project(tmp_path)
    assert checked.architecture.component_types["common.laser"].title == "Laser"
    assert list_library_findings(checked) == []


def test_without_a_repository_a_library_lies_below_the_project(tmp_path: Path) -> None:
    write(tmp_path, {"robot/archgen.yaml": robot(), "common/drivers.yaml": DRIVERS})
    (error,) = list_library_findings(check_project(tmp_path / "robot"))
    assert "this leads out of the project's folder, which is in no repository" in error
    write(tmp_path, {"robot/archgen.yaml": robot("lib/common"), "robot/lib/common/drivers.yaml": DRIVERS})
    assert list_library_findings(check_project(tmp_path / "robot")) == []


@pytest.mark.parametrize("sources", ["", 'sources: ["**/*.yaml"]\n', "sources: [lib/drivers.yaml]\n"])
def test_a_library_in_the_projects_folder_is_no_source(tmp_path: Path, sources: str) -> None:
    write(tmp_path, {"archgen.yaml": robot("./lib/") + sources, "lib/drivers.yaml": DRIVERS})
    checked = check_project(tmp_path)
    assert list(checked.architecture.component_types) == ["common.laser"]
    assert checked.yaml_files == ("archgen.yaml",)
    assert list_library_findings(checked) == []


def test_only_archgen_yaml_names_libraries(tmp_path: Path) -> None:
    text = robot("lib").replace("libraries: {common: lib}\n", "")
    write(tmp_path, {"archgen.yaml": text, "b.yaml": "libraries: {common: lib}\nhosts: {pc: {}}\n"})
    write(tmp_path, {"lib/drivers.yaml": "x: 1\n"})
    (error,) = list_library_findings(check_project(tmp_path))
    assert error == (
        "b.yaml:1:21 missing-library: the library `common` cannot be read from `lib`: only archgen.yaml names libraries"
        " | write it there, below `libraries`"
    )


def test_a_file_with_nothing_but_libraries_says_where_they_are_named(tmp_path: Path) -> None:
    own = {"b.yaml": "libraries: {common: lib}\n", "c.yaml": "libraries: {common: {path: ../lib}}\n"}
    others = {"d.yaml": "libraries: {zlib: 1.2}\n", "e.yaml": "libraries: {a: x}\nversion: 2\n"}
    write(tmp_path, {"archgen.yaml": "archgen: 1\n", **own, **others})
    notes = [f"{d.span}: {d.message}" for d in check_project(tmp_path).findings if d.rule == "ignored-file"]
    assert sorted(notes) == [
        "archgen.yaml:1:1: `d.yaml`, `e.yaml` hold no element of the language and are not read",
        "b.yaml:1:1: only archgen.yaml names libraries: this file is not read",
        "c.yaml:1:1: only archgen.yaml names libraries: this file is not read",
    ]


@pytest.mark.parametrize("written", ["e: ", "e: {}", "e: {path: }"])
def test_a_library_without_a_path_is_reported(tmp_path: Path, written: str) -> None:
    text = ROBOT.replace("common: PATH", written).replace("common.laser", "e.laser")
    write(tmp_path, {"archgen.yaml": text})
    (error,) = list_errors(check_project(tmp_path))
    assert error == (
        "archgen.yaml:2:13 missing-library: the library `e` has no path"
        " | write its folder, as in `e: ../e`, or `builtin` for what ships with archgen"
    )


@pytest.mark.parametrize("written", ["e: {pth: lib}", "e: 5", "e: [lib]", "e: {path: [lib]}"])
def test_a_library_that_was_not_understood_is_reported_once(tmp_path: Path, written: str) -> None:
    write(tmp_path, {"archgen.yaml": ROBOT.replace("common: PATH", written).replace("common.laser", "e.laser")})
    (error,) = list_errors(check_project(tmp_path))
    assert "missing-library" not in error


def test_a_project_of_one_file_reads_no_library(tmp_path: Path) -> None:
    write(tmp_path, {"one.yaml": robot("lib"), "lib/drivers.yaml": DRIVERS})
    (error,) = list_library_findings(check_project(tmp_path / "one.yaml"))
    assert "a project of one file holds what it uses of its libraries | `archgen pack`" in error


def test_of_ros_only_the_distribution_is_for_a_library_that_is_checked_by_itself(tmp_path: Path) -> None:
    library = {"archgen.yaml": "archgen: 1\nros: {distro: jazzy, interfaces: [a.msg]}\n", "drivers.yaml": DRIVERS}
    write(tmp_path, {"archgen.yaml": robot("lib"), **{f"lib/{name}": text for name, text in library.items()}})
    notes = [d.message for d in check_project(tmp_path).findings if d.rule == "ignored-file"]
    assert notes == ["of the library `common` only `component_types` and `types` are used, not `ros`"]


def test_what_a_library_holds_besides_types_is_not_used(tmp_path: Path) -> None:
    library = {
        "archgen.yaml": "archgen: 1\nproject: {title: Common}\nrules: {unmapped-component: error}\nros: {distro: jazzy}\n",
        "drivers.yaml": DRIVERS + "groups: {a: {title: A}}\nhosts: {pc: {}}\n",
        "values.yaml": "image: {tag: 1}\n",
        "template.yaml": "{{ x }}\n",
        "below/archgen.yaml": "archgen: 1\ncomponent_types: {no: {}}\n",
    }
    write(tmp_path, {"archgen.yaml": robot("lib"), **{f"lib/{name}": text for name, text in library.items()}})
    checked = check_project(tmp_path)
    notes = [f"{d.span} {d.severity} {d.message}" for d in checked.findings if d.rule == "ignored-file"]
    assert notes == [
        "lib/drivers.yaml:3:1 note of the library `common` only `component_types` and `types` are used, not `groups`, `hosts`"
    ]
    assert list(checked.architecture.groups) == ["sensing"]
    assert [d.severity for d in checked.findings if d.rule == "unmapped-component"] == ["warning"]


def test_a_library_has_no_libraries_of_its_own(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": robot("lib"), "lib/drivers.yaml": DRIVERS + "libraries: {more: ../more}\n"})
    (error,) = list_library_findings(check_project(tmp_path))
    assert error.startswith(
        "lib/drivers.yaml:3:1 missing-library: `common` is a library, and a library has no libraries"
    )


def test_an_empty_library_is_a_warning(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": "archgen: 1\nlibraries: {common: lib}\n", "lib/readme.txt": "x"})
    (warning,) = [d for d in check_project(tmp_path).findings if d.rule == "missing-library"]
    assert (warning.severity, warning.message) == ("warning", "no file in `lib` holds `component_types` or `types`")


def test_a_broken_file_of_a_library_is_one_error(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": robot("lib"), "lib/drivers.yaml": DRIVERS + "  laser: [\n"})
    errors = [d for d in check_project(tmp_path).findings if d.severity == "error"]
    assert [(d.rule, d.span.file) for d in errors] == [("syntax-error", "lib/drivers.yaml")]


def test_a_slip_in_archgen_yaml_does_not_lose_its_libraries(tmp_path: Path) -> None:
    write(tmp_path, {"archgen.yaml": "archgen: 1\nlibraries: {common: lib}\nproject: [\n", "lib/drivers.yaml": DRIVERS})
    write(tmp_path, {"a.yaml": "groups: {g: {title: G, components: {a: {is: common.laser}}}}\n"})
    errors = [d for d in check_project(tmp_path).findings if d.severity == "error"]
    assert [(d.rule, d.span.file) for d in errors] == [("syntax-error", "archgen.yaml")]


def test_a_comment_in_a_library_silences_and_is_never_called_unused(tmp_path: Path) -> None:
    comment = DRIVERS.rstrip() + "  # archgen: ignore[unread-output, missing-rate] read by nobody yet\n"
    write(tmp_path, {"archgen.yaml": robot("lib"), "lib/drivers.yaml": comment})
    rules = {d.rule for d in check_project(tmp_path).findings}
    assert rules.isdisjoint({"unread-output", "unused-ignore"})


def test_history_counts_anew_when_a_library_changes(tmp_path: Path) -> None:
    from archgen.history.project_commits import list_commits
    from archgen.project import find_tracked_project

    repository(tmp_path, {"robot/archgen.yaml": robot(), "common/drivers.yaml": DRIVERS})
    commit(tmp_path, {"other.txt": "x"})
    commit(tmp_path, {"common/drivers.yaml": DRIVERS + "# x\n"})
    commits = list_commits(find_tracked_project(tmp_path / "robot"), "revision")
    hashes = git(tmp_path, "log", "--reverse", "--format=%H").split()
    assert [each.id for each in commits] == [hashes[0], hashes[2]]
    assert len({each.tree_id for each in commits}) == 2
