"""`archgen list --of component_types`, and TYPE of `archgen new instance` completed."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from archgen.cli import component_type_listing
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.library_reading import load_shipped_component_types
from tests.cli.conftest import Run

HEAD = "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: jazzy}\n"
OWN = "component_types: {arm: {title: Arm, functionality: Moves., inputs: {goal: Pose}, node: {package: arm}}, hand: {is: arm}}\n"


def write_project(folder: Path, text: str) -> Path:
    (folder / "archgen.yaml").write_text(HEAD + text, encoding="utf-8")
    return folder


def read_rows(run: Run, folder: Path, *options: str) -> list[list[str]]:
    result = run("list", "-C", folder, "--of", "component_types", "--format", "csv", *options)
    return list(csv.reader(io.StringIO(result.out)))


def test_own_types_have_what_they_are_made_from(run: Run, tmp_path: Path) -> None:
    assert read_rows(run, write_project(tmp_path, OWN)) == [
        ["type", "title", "functionality", "inputs", "outputs", "package"],
        ["arm", "Arm", "Moves.", "goal", "", "arm"],
        ["hand", "Hand", "Moves.", "goal", "", "arm"],
    ]


def test_a_library_offers_also_what_nobody_uses(run: Run, tmp_path: Path) -> None:
    project = write_project(tmp_path, f"libraries: {{parts: builtin}}\n{OWN}")
    names = [row[0] for row in read_rows(run, project)[1:]]
    assert names == ["arm", "hand", *(f"parts.{name}" for name in load_shipped_component_types("jazzy"))]
    assert [row[0] for row in read_rows(run, project, "--library", "parts")[1:]] == names[2:]


def test_what_ships_is_found_by_who_has_none_of_it(run: Run, tmp_path: Path) -> None:
    project = write_project(tmp_path, OWN)
    result = run("list", "-C", project, "--of", "component_types")
    assert "archgen list --of component_types --library builtin" in result.err
    shipped = run("list", "-C", project, "--of", "component_types", "--library", "builtin")
    assert "ros.slam_toolbox" in shipped.out
    assert shipped.err == "With `libraries: {ros: builtin}` in archgen.yaml the project may name these.\n"
    assert [row[0] for row in read_rows(run, project, "--library", "builtin")[1:]] == [
        f"ros.{name}" for name in load_shipped_component_types("jazzy")
    ]


def test_what_ships_is_listed_by_what_the_project_calls_it(run: Run, tmp_path: Path) -> None:
    project = write_project(tmp_path, f"libraries: {{parts: builtin}}\n{OWN}")
    by_word, by_id = (read_rows(run, project, "--library", name) for name in ("builtin", "parts"))
    assert by_word == by_id
    assert by_word[1][0].startswith("parts.")


def test_a_library_that_there_is_not(run: Run, tmp_path: Path) -> None:
    project = write_project(tmp_path, "libraries: {parts: builtin}\n")
    result = run("list", "-C", project, "--of", "component_types", "--library", "part")
    assert (result.status, "the project has no library `part`; did you mean `parts`?" in result.err) == (2, True)
    assert "`--library` goes with `--of component_types`" in run("list", "-C", project, "--library", "parts").err
    assert "`--of component_types` takes none" in run("list", "-C", project, "--of", "component_types", "arm").err


def test_names_to_complete(tmp_path: Path) -> None:
    project = write_project(tmp_path, f"libraries: {{ros: builtin}}\n{OWN}")
    names = component_type_listing.list_type_names(project)
    assert names[:2] == ("arm", "hand")
    assert "ros.amcl" in names
    assert component_type_listing.list_type_names(tmp_path / "nowhere") == ()


def test_a_new_instance_of_a_type_that_ships(run: Run, tmp_path: Path) -> None:
    project = write_project(
        tmp_path, "libraries: {ros: builtin}\ngroups:\n  g:\n    components:\n      a:\n        title: A\n"
    )
    result = run("new", "instance", "g.here", "ros.amcl", "-C", project)
    assert (result.status, result.err) == (0, "")
    text = (project / "archgen.yaml").read_text(encoding="utf-8")
    assert "is: ros.amcl" in text
    assert "scan:" in text
    assert "initialpose" not in text


def test_a_new_instance_of_a_type_of_another_distribution(run: Run, tmp_path: Path) -> None:
    project = write_project(tmp_path, "libraries: {ros: builtin}\ngroups: {g: {components: {a: {title: A}}}}\n")
    result = run("new", "instance", "g.here", "ros.gmapping", "-C", project)
    assert result.status == 2
    assert "it ships for noetic" in result.err


def test_each_distribution_has_some(run: Run, tmp_path: Path) -> None:
    for distro in KNOWN_DISTROS:
        (tmp_path / "archgen.yaml").write_text(HEAD.replace("jazzy", distro), encoding="utf-8")
        assert len(read_rows(run, tmp_path, "--library", "builtin")) > 25
